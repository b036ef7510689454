#pragma once
// The replay's script, part of its scene: force chains as three.js draws them.

#include <string_view>

namespace dem::report::detail {

inline constexpr std::string_view kReplayScriptForces = R"JS(
// ---- force chains

// Lines as ribbons that face who looks, as WebGL draws lines of one width only: the wider, and the redder, the larger
// the force is.
const FORCE_VERTEX = `
attribute vec3 from, to;
attribute float strength;
uniform float width;
varying vec3 at;
varying float share, aside;
void main() {
  at = mix(from, to, position.x);
  share = strength;
  aside = position.y;
  vec3 side = cross(to - from, cameraPosition - at);
  at += side / max(length(side), 1e-30) * position.y * width * (0.12 + 0.88 * strength);
  gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
}`;
const FORCE_FRAGMENT = `
uniform vec4 cut;
varying vec3 at;
varying float share, aside;
void main() {
  if (dot(cut.xyz, at) > cut.w) discard;
  vec3 base = mix(vec3(0.16, 0.38, 0.72), vec3(0.86, 0.12, 0.09), share);
  gl_FragColor = vec4(base * (1.0 - 0.45 * aside * aside), 1.0);
}`;

class Forces {
  constructor(head, frames, uniforms) {
    this.frames = frames;
    this.low = head.low;
    this.size = head.high.map((high, k) => (high - head.low[k]) / 65535);
    // A few large forces are not to make all others thin. The widest lines are a third as wide as lines are long.
    const every = Math.max(1, Math.floor(frames.reduce((sum, {force}) => sum + force.length, 0) / 200000));
    const forces = [], lengths = [];
    for (const {force, ends} of frames) {
      for (let k = 0; k < force.length; k += every) {
        forces.push((force[k] / 255) ** 2 * head.most);
        lengths.push(Math.hypot(...this.size.map((size, axis) => size * (ends[6 * k + 3 + axis] - ends[6 * k + axis]))));
      }
    }
    this.most = quantile(forces, 0.98) || quantile(forces, 1);
    this.scale = head.most / this.most / 65025;
    const count = Math.max(...frames.map(({force}) => force.length));
    const geometry = this.geometry = new THREE.InstancedBufferGeometry();
    setAttribute(geometry, "position", new THREE.BufferAttribute(new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    [this.from, this.to, this.strength] = [["from", 3], ["to", 3], ["strength", 1]].map(([name, size]) => {
      const attribute = new THREE.InstancedBufferAttribute(new Float32Array(size * count), size);
      setAttribute(geometry, name, attribute);
      return attribute;
    });
    this.object = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
      uniforms: Object.assign({width: {value: quantile(lengths, 0.5) / 6}}, uniforms), vertexShader: FORCE_VERTEX,
      fragmentShader: FORCE_FRAGMENT, side: THREE.DoubleSide}));
    this.object.frustumCulled = false;
    this.scene = new THREE.Scene();
    this.scene.add(this.object);
    this.wanted = false;
  }
  // Where the lines of a frame are; those that the next frame has too are on their way to it.
  show(frame, next, between) {
    const {ends, force, next: then} = this.frames[frame], later = this.frames[next];
    for (let k = 0; k < force.length; ++k) {
      const goes = next > frame && then[k] >= 0 ? between : 0, line = 6 * then[k];
      for (let c = 0; c < 6; ++c) {
        const a = ends[6 * k + c], steps = goes > 0 ? a + goes * (later.ends[line + c] - a) : a;
        (c < 3 ? this.from : this.to).array[3 * k + c % 3] = this.low[c % 3] + this.size[c % 3] * steps;
      }
      const a = force[k] ** 2, b = goes > 0 ? later.force[then[k]] ** 2 : a;
      this.strength.array[k] = Math.min(1, this.scale * (a + goes * (b - a)));
    }
    for (const attribute of [this.from, this.to, this.strength]) attribute.needsUpdate = true;
    const count = "instanceCount" in this.geometry ? "instanceCount" : "maxInstancedCount";
    this.geometry[count] = force.length;
    this.object.visible = force.length > 0;
  }
}
)JS";

}  // namespace dem::report::detail
