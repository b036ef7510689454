#pragma once
// The replay's script, third part: grains and machine parts as three.js draws them.

#include <string_view>

namespace dem::report::detail {

inline constexpr std::string_view kReplayScriptScene = R"JS(
// ---- shaders

// The sun stands still, its shadows with it; some light comes from the sky and from who looks.
const LIGHT = `
uniform vec3 sun;
uniform mat4 toShadow;
uniform sampler2D shadow;
varying vec3 at, n;
float sunAt(vec3 at, vec3 n) {
  vec3 place = (toShadow * vec4(at, 1.0)).xyz * 0.5 + 0.5;
  float slope = 1.0 - max(dot(n, sun), 0.0), seen = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec2 aside = (vec2(mod(float(i), 2.0), floor(float(i) / 2.0)) - 0.5) / 1536.0;
    vec4 packed = texture2D(shadow, place.xy + aside);
    float depth = dot(packed, vec4(1.0, 1.0 / 255.0, 1.0 / 65025.0, 1.0 / 16581375.0));
    seen += place.z < depth + 0.001 + 0.003 * slope ? 0.25 : 0.0;
  }
  vec3 outside = max(-place, place - 1.0);  // of what the sun has looked at, where nothing throws a shadow
  return max(dot(n, sun), 0.0) * (max(outside.x, max(outside.y, outside.z)) > 0.0 ? 1.0 : seen);
}
vec3 lit(vec3 base, vec3 at, vec3 n) {
  vec3 toEye = normalize(cameraPosition - at);
  float direct = sunAt(at, n), shine = pow(max(dot(n, normalize(sun + toEye)), 0.0), 30.0) * min(1.0, 4.0 * direct);
  return base * (0.22 + 0.2 * (0.5 + 0.5 * n.z) + 0.25 * max(dot(n, toEye), 0.0) + 0.55 * direct) + vec3(0.08 * shine);
}`;
// What the sun sees: how far away it is, in four bytes.
const DEPTH_FRAGMENT = `
uniform vec4 cut;
varying vec3 at;
void main() {
  if (dot(cut.xyz, at) > cut.w) discard;
  vec4 digits = fract(gl_FragCoord.z * vec4(1.0, 255.0, 65025.0, 16581375.0));
  gl_FragColor = digits - digits.yzww * vec4(1.0 / 255.0, 1.0 / 255.0, 1.0 / 255.0, 0.0);
}`;

// Grains are instances: a place of four 16-bit numbers, the last one a colour (0: not there), and a turn; of this frame
// (A) and of the next one (B).
const GRAIN_VERTEX = `
attribute vec4 placeA, placeB, turnA, turnB;
uniform vec3 low, size;
uniform float between;
varying vec3 at, n;
varying float value;
vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
void main() {
  float b = placeB.w > 0.0 ? between : 0.0;
  vec4 turnB2 = dot(turnA, turnB) < 0.0 ? -turnB : turnB;
  vec4 q = normalize(mix(turnA, turnB2, b));
  vec4 place = mix(placeA, placeB, b);
  value = (place.w * 65535.0 - 1.0) / 65534.0;
  at = low + size * place.xyz + turned(q, position);
  n = turned(q, normal);
  gl_Position = placeA.w > 0.0 ? projectionMatrix * viewMatrix * vec4(at, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}`;
const GRAIN_FRAGMENT = LIGHT + `
uniform sampler2D colours;
uniform vec3 plain;
uniform float coloured;
uniform vec4 cut;
varying float value;
void main() {
  if (dot(cut.xyz, at) > cut.w) discard;
  vec3 base = mix(plain, texture2D(colours, vec2(value * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb, coloured);
  if (gl_FrontFacing) {
    gl_FragColor = vec4(lit(base, at, normalize(n)), 1.0);
    return;
  }
  // What shows of the inside where a grain is cut looks like the face of the cut in front of it.
  vec3 toEye = cameraPosition - at;
  gl_FragColor = vec4(lit(base, at + (cut.w - dot(cut.xyz, at)) / dot(cut.xyz, toEye) * toEye, cut.xyz), 1.0);
}`;
const PART_VERTEX = `
varying vec3 at, n;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  at = world.xyz;
  n = mat3(modelMatrix[0].xyz, modelMatrix[1].xyz, modelMatrix[2].xyz) * normal;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;
const PART_FRAGMENT = LIGHT + `
uniform vec3 plain;
uniform float opacity;
void main() {
  vec3 facing = normalize(gl_FrontFacing ? n : -n);
  gl_FragColor = vec4(lit(plain, at, facing), opacity);
}`;

// 256 colours from violet over red to yellow: in OKLab (B. Ottosson, 2020) lightness and hue grow by the same amount
// from each to the next, so equal steps of a value look equal, also in grey.
function colourMap() {
  const bytes = new Uint8Array(4 * 256);
  for (let k = 0; k < 256; ++k) {
    const t = k / 255, light = 0.42 + 0.5 * t, hue = (285 + 165 * t) * Math.PI / 180;
    const a = 0.14 * Math.cos(hue), b = 0.14 * Math.sin(hue);
    const l = (light + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (light - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (light - 0.0894841775 * a - 1.2914855480 * b) ** 3;
    const linear = [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s];
    linear.forEach((x, channel) => {
      const y = Math.max(0, Math.min(1, x));
      bytes[4 * k + channel] = Math.round(255 * (y <= 0.0031308 ? 12.92 * y : 1.055 * y ** (1 / 2.4) - 0.055));
    });
    bytes[4 * k + 3] = 255;
  }
  return bytes;
}

// ---- the scene

// Older and newer versions of three.js call it by different names.
function setAttribute(geometry, name, attribute) {
  (geometry.setAttribute || geometry.addAttribute).call(geometry, name, attribute);
}
function geometryOf(mesh, geometry) {
  const {position, normal, index} = shaded(mesh);
  setAttribute(geometry, "position", new THREE.BufferAttribute(position, 3));
  setAttribute(geometry, "normal", new THREE.BufferAttribute(normal, 3));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

// The grains of one shape: rows `begin` to `begin + count` of a frame.
class Grains {
  constructor(mesh, begin, count, uniforms) {
    this.begin = begin;
    this.count = count;
    const geometry = geometryOf(mesh, new THREE.InstancedBufferGeometry());
    if ("instanceCount" in geometry) geometry.instanceCount = count; else geometry.maxInstancedCount = count;
    this.attributes = ["placeA", "turnA", "placeB", "turnB"].map((name, k) => {
      const numbers = k % 2 === 0 ? new Uint16Array(4 * count) : new Int16Array(4 * count);
      const attribute = new THREE.InstancedBufferAttribute(numbers, 4, true);
      setAttribute(geometry, name, attribute);
      return attribute;
    });
    const drawnBy = (fragmentShader) => new THREE.Mesh(geometry, new THREE.ShaderMaterial(
        {uniforms, vertexShader: GRAIN_VERTEX, fragmentShader}));
    this.object = drawnBy(GRAIN_FRAGMENT);
    this.caster = drawnBy(DEPTH_FRAGMENT);
    this.object.frustumCulled = this.caster.frustumCulled = false;
  }
  // Whether what lies behind the outsides shows, as it does where grains are cut.
  setOpen(open) {
    for (const {material} of [this.object, this.caster]) {
      material.side = open ? THREE.DoubleSide : THREE.FrontSide;
      material.needsUpdate = true;
    }
  }
  // Brings the numbers of a frame into the attributes of A (which = 0) or B (1); `colour` gives 1 to 65535 for a row.
  load(which, frame, frames, colour) {
    const [places, turns] = this.attributes.slice(2 * which, 2 * which + 2);
    const rows = frames.turn.length / frames.count, from = frame * rows + this.begin;
    for (let k = 0; k < this.count; ++k) {
      const row = from + k, packed = frames.turn[row];
      if (packed === ABSENT) {
        places.array[4 * k + 3] = 0;
        continue;
      }
      for (let axis = 0; axis < 3; ++axis) places.array[4 * k + axis] = frames.place[3 * row + axis];
      places.array[4 * k + 3] = colour(row, this.begin + k);
      writeTurn(packed, turns.array, 4 * k);
    }
    places.needsUpdate = turns.needsUpdate = true;
  }
}

// A part of the machine, with its edges. It throws a shadow where it is more solid than glass.
class Part {
  constructor(head, mesh, poses, uniforms) {
    this.name = head.name;
    this.poses = poses;
    this.still = poses.length === 7;
    const own = {plain: {value: new THREE.Vector3(0.55, 0.63, 0.72)}, opacity: {value: 1},
                 cut: {value: new THREE.Vector4(0, 0, 0, 1)}};
    const geometry = geometryOf(mesh, new THREE.BufferGeometry());
    const drawnBy = (fragmentShader) => new THREE.Mesh(geometry, new THREE.ShaderMaterial({
      uniforms: Object.assign(own, uniforms), vertexShader: PART_VERTEX, fragmentShader, side: THREE.DoubleSide}));
    this.object = drawnBy(PART_FRAGMENT);
    this.caster = drawnBy(DEPTH_FRAGMENT);
    const edges = new THREE.BufferGeometry();
    setAttribute(edges, "position", new THREE.BufferAttribute(sharpEdges(mesh), 3));
    this.edges = new THREE.LineSegments(edges, new THREE.LineBasicMaterial({color: 0x6b7f95}));
    this.object.add(this.edges);
    this.wanted = true;
  }
  setOpacity(opacity) {
    const {material} = this.object, solid = opacity > 0.99;
    material.uniforms.opacity.value = this.opacity = opacity;
    material.transparent = !solid;
    material.depthWrite = solid;
  }
  show(frame, next, between) {
    const pose = (f) => this.poses.subarray(this.still ? 0 : 7 * f, this.still ? 7 : 7 * f + 7);
    const a = pose(frame), b = pose(next), there = (p) => p.subarray(3).some((x) => x !== 0);
    this.object.visible = this.wanted && there(a);
    const turn = (p) => new THREE.Quaternion(p[4], p[5], p[6], p[3]);
    this.object.position.set(a[0], a[1], a[2]);
    this.object.quaternion.copy(turn(a));
    if (this.object.visible && there(b) && between > 0) {
      this.object.position.lerp(new THREE.Vector3(b[0], b[1], b[2]), between);
      this.object.quaternion.slerp(turn(b), between);
    }
    this.caster.visible = this.object.visible && this.opacity > 0.5;
    this.caster.position.copy(this.object.position);
    this.caster.quaternion.copy(this.object.quaternion);
  }
}
)JS";

}  // namespace dem::report::detail
