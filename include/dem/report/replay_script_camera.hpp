#pragma once
// The replay's script, second part: the camera, turned and moved with mouse or fingers, and the sun.

#include <string_view>

namespace dem::report::detail {

inline constexpr std::string_view kReplayScriptCamera = R"JS(
// ---- the camera

// Looks at `target` from `distance`, `azimuth` and `elevation` (rad) around z, which stays upright. Dragging turns;
// dragging with the right button or Shift, or with two fingers, moves; the wheel or two fingers zoom.
class Orbit {
  constructor(element, changed) {
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.element = element;
    this.changed = changed;
    this.pointers = new Map();
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    element.addEventListener("pointerdown", (event) => this.press(event));
    element.addEventListener("pointermove", (event) => this.drag(event));
    for (const end of ["pointerup", "pointercancel"]) {
      element.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    element.addEventListener("wheel", (event) => {
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 30 : 1;
      this.zoom(Math.exp(0.0015 * Math.max(-300, Math.min(300, lines * event.deltaY))));
    }, {passive: false});
    element.addEventListener("dblclick", () => this.reset());
    element.addEventListener("keydown", (event) => this.key(event));
  }

  // Shows all of a box, seen from the front, the right and above.
  frame(middle, radius) {
    this.home = {middle, radius};
    this.reset();
  }
  reset() {
    this.target = new THREE.Vector3(...this.home.middle);
    this.radius = this.home.radius;
    this.azimuth = -1.05;
    this.elevation = 0.45;
    this.distance = 1.05 * this.radius / Math.sin(15 * Math.PI / 180) / Math.min(1, this.camera.aspect);
    this.place();
  }

  press(event) {
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    this.moves = event.button === 2 || event.button === 1 || event.shiftKey;
  }
  drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = {x: event.clientX, y: event.clientY}, dx = now.x - before.x, dy = now.y - before.y;
    if (this.pointers.size === 2) {
      const [other] = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      const apart = (p) => Math.max(10, Math.hypot(p.x - other.x, p.y - other.y));
      this.zoom(apart(before) / apart(now));
      this.pan(dx / 2, dy / 2);
    } else if (this.pointers.size === 1) {
      if (this.moves) this.pan(dx, dy); else this.turn(-0.008 * dx, 0.008 * dy);
    }
    this.pointers.set(event.pointerId, now);
  }
  key(event) {
    const turns = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]};
    const zooms = {"+": 0.9, "-": 1 / 0.9};
    if (turns[event.key]) this.turn(...turns[event.key]);
    else if (zooms[event.key]) this.zoom(zooms[event.key]);
    else return;
    event.preventDefault();
  }

  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.max(-1.55, Math.min(1.55, this.elevation + elevation));
    this.place();
  }
  zoom(factor) {
    this.distance = Math.max(0.01 * this.radius, Math.min(50 * this.radius, factor * this.distance));
    this.place();
  }
  // By so many pixels.
  pan(right, down) {
    const pixel = 2 * this.distance * Math.tan(15 * Math.PI / 180) / this.element.clientHeight;
    const x = new THREE.Vector3(1, 0, 0).applyQuaternion(this.camera.quaternion);
    const y = new THREE.Vector3(0, 1, 0).applyQuaternion(this.camera.quaternion);
    this.target.addScaledVector(x, -right * pixel).addScaledVector(y, down * pixel);
    this.place();
  }
  resize(width, height) {
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }
  place() {
    const level = Math.cos(this.elevation);
    const out = new THREE.Vector3(level * Math.cos(this.azimuth), level * Math.sin(this.azimuth), Math.sin(this.elevation));
    this.camera.position.copy(this.target).addScaledVector(out, this.distance);
    this.camera.lookAt(this.target);
    this.camera.near = Math.max(this.distance - 4 * this.radius, 0.02 * this.distance);
    this.camera.far = this.distance + 40 * this.radius;
    this.camera.updateProjectionMatrix();
    this.changed();
  }
}

// ---- the sun

// Looks down on the same box as the camera, and keeps in a picture how far it sees.
class Sun {
  constructor() {
    this.scene = new THREE.Scene();
    this.target = new THREE.WebGLRenderTarget(2048, 2048, {minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter});
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    this.uniforms = {sun: {value: new THREE.Vector3(-0.45, -0.5, 1).normalize()}, shadow: {value: this.target.texture},
                     toShadow: {value: new THREE.Matrix4()}};
  }
  frame(middle, radius) {
    const camera = this.camera;
    Object.assign(camera, {left: -radius, right: radius, bottom: -radius, top: radius, near: 0, far: 6 * radius});
    camera.position.set(...middle).addScaledVector(this.uniforms.sun.value, 3 * radius);
    camera.lookAt(...middle);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    const back = new THREE.Matrix4();
    if (back.invert) back.copy(camera.matrixWorld).invert(); else back.getInverse(camera.matrixWorld);
    this.uniforms.toShadow.value.multiplyMatrices(camera.projectionMatrix, back);
  }
  draw(renderer) {
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0xffffff, 1);
    renderer.clear();
    renderer.render(this.scene, this.camera);
    renderer.setRenderTarget(null);
  }
}
)JS";

}  // namespace dem::report::detail
