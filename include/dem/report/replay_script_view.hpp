#pragma once
// The replay's script, fourth part: what is shown of a replay at a time, by which colours, cut where.

#include <string_view>

namespace dem::report::detail {

inline constexpr std::string_view kReplayScriptView = R"JS(
// ---- what is shown

// The value below which a share of the values lies; 0 of none.
function quantile(values, share) {
  const sorted = Float64Array.from(values).sort();
  return sorted.length ? sorted[Math.round(share * (sorted.length - 1))] : 0;
}
// Values of a function of rows of frames and their grains, of all of them or of an even choice of some 200,000.
function valuesOf(head, frames, value) {
  const rows = frames.turn.length, values = [];
  // The step has no divisor in common with the number of grains, so that each grain is met.
  const common = (a, b) => b ? common(b, a % b) : a;
  let step = Math.max(1, Math.floor(rows / 200000));
  while (step > 1 && common(step, head.grains) > 1) ++step;
  for (let row = 0; row < rows; row += step) {
    if (frames.turn[row] !== ABSENT) values.push(value(row, row % head.grains));
  }
  return values;
}

// By what grains are coloured: name, unit, upper end of the legend, and the value of a row of a frame (a grain in it).
function colourings(head, frames) {
  const size = [0, 1, 2].map((axis) => (head.high[axis] - head.low[axis]) / 65535);
  const displacement = (row, grain) => {
    let sum = 0;
    for (let k = 0; k < 3; ++k) sum += (size[k] * (frames.place[3 * row + k] - frames.first[3 * grain + k])) ** 2;
    return Math.sqrt(sum);
  };
  const scalar = (which, most) => (row) => (frames.scalar[2 * row + which] / 255) ** 2 * most;
  const list = [{name: "speed", unit: "m/s", value: scalar(0, head.speed)},
                {name: "net contact force", unit: "N", value: scalar(1, head.force)},
                {name: "displacement", unit: "m", value: displacement}];
  for (const colouring of list) {
    const values = valuesOf(head, frames, colouring.value);
    // A few fast grains are not to take all colours from the others, unless only few move at all.
    colouring.most = quantile(values, 0.98) || quantile(values, 1);
  }
  if (head.sleep) {
    const awake = (row) => 1 - frames.asleep[row];
    list.push({name: "asleep or awake", unit: "", most: 1, value: awake, ends: ["asleep", "awake"]});
  }
  list.push({name: "one colour", unit: "", most: 0, value: null});
  return list;
}

class View {
  constructor(head, bytes, canvas, context) {
    const reader = new Reader(bytes);
    const meshes = head.shapes.map((shape) => reader.mesh(shape));
    this.head = head;
    this.frames = Object.assign(readFrames(head, reader), {count: head.times.length});
    this.colourings = colourings(head, this.frames);
    this.map = colourMap();
    const texture = new THREE.DataTexture(this.map, 256, 1, THREE.RGBAFormat);
    texture.needsUpdate = true;
    const vector = (x) => new THREE.Vector3(...x);
    this.sun = new Sun();
    this.uniforms = Object.assign({
      colours: {value: texture}, plain: {value: vector([0.76, 0.66, 0.48])}, coloured: {value: 1},
      cut: {value: new THREE.Vector4(0, 0, 0, 1)}, between: {value: 0}, low: {value: vector(head.low)},
      size: {value: vector(head.high).sub(vector(head.low))}}, this.sun.uniforms);
    this.scene = new THREE.Scene();
    let begin = 0;
    this.grains = [];
    head.shapes.forEach((shape, k) => {
      if (shape.grains > 0) this.grains.push(new Grains(meshes[k], begin, shape.grains, this.uniforms));
      begin += shape.grains;
    });
    this.parts = head.parts.map((part) => {
      const mesh = reader.mesh(part);
      return new Part(part, mesh, reader.floats(7 * part.poses), this.sun.uniforms);
    });
    this.forces = head.forces && new Forces(head.forces, readForces(head.forces, reader), this.uniforms);
    for (const {object} of [...this.grains, ...this.parts]) this.scene.add(object);
    for (const {caster} of [...this.grains, ...this.parts]) this.sun.scene.add(caster);
    this.renderer = new THREE.WebGLRenderer({canvas, context, antialias: true, alpha: true});
    this.canvas = canvas;
    this.orbit = new Orbit(canvas, () => this.redraw(false));
    this.findBox(meshes);
    this.loaded = [-1, -1];
    this.time = head.times[0];
    this.colouring = this.scale = this.colourings[0];
    this.setOpacity(this.grains.length > 0 ? 0.12 : 1);
  }

  // The box around what is looked at: where grains mostly are, or else the parts.
  findBox(meshes) {
    const low = [...this.head.low], high = [...this.head.high];
    const largest = (points) => points.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    if (this.grains.length > 0) {
      const reach = meshes.reduce((most, mesh) => Math.max(most, largest(mesh.points)), 0);
      for (let k = 0; k < 3; ++k) {
        const places = valuesOf(this.head, this.frames, (row) => this.frames.place[3 * row + k]);
        const at = (share) => this.head.low[k] + quantile(places, share) / 65535 * (this.head.high[k] - this.head.low[k]);
        [low[k], high[k]] = [at(0.01) - reach, at(0.99) + reach];
      }
    } else {
      const box = new THREE.Box3();
      for (const part of this.parts) {
        for (const frame of [0, this.frames.count - 1]) {
          part.show(frame, frame, 0);
          part.object.updateMatrixWorld();
          box.expandByObject(part.object);
        }
      }
      box.min.toArray(low);
      box.max.toArray(high);
    }
    const radius = 0.5 * Math.hypot(...[0, 1, 2].map((k) => high[k] - low[k])) || 1;
    this.low = low;
    this.high = high;
    const middle = [0, 1, 2].map((k) => (low[k] + high[k]) / 2);
    this.orbit.frame(middle, radius);
    this.sun.frame(middle, radius);
  }

  setOpacity(opacity) {
    for (const part of this.parts) part.setOpacity(opacity);
    this.redraw();
  }
  // Force chains lie over the grains, which can be left out.
  setForces(wanted) {
    this.forces.wanted = wanted;
    this.redraw(false);
  }
  setGrains(wanted) {
    for (const {object, caster} of this.grains) object.visible = caster.visible = wanted;
    this.redraw();
  }
  setColouring(colouring, ofFrame) {
    this.colouring = this.scale = colouring;
    this.ofFrame = ofFrame;
    this.uniforms.coloured.value = colouring.value ? 1 : 0;
    this.loaded = [-1, -1];
    this.redraw();
  }
  // The colouring with the upper end that is wanted at a frame: that of the run, or of the frame.
  scaleOf(frame) {
    if (!this.ofFrame || !this.colouring.value || this.colouring.ends || this.loaded[0] === frame) return this.scale;
    const values = [], {grains} = this.head;
    for (let row = frame * grains; row < (frame + 1) * grains; ++row) {
      if (this.frames.turn[row] !== ABSENT) values.push(this.colouring.value(row, row % grains));
    }
    this.scale = Object.assign({}, this.colouring, {most: quantile(values, 0.98) || quantile(values, 1)});
    this.loaded = [-1, -1];
    return this.scale;
  }
  // Hides the grains on the side of a plane that is nearer in the first view: across an axis (0 to 2), at a share of
  // the box; axis -1: none.
  setCut(axis, share) {
    const side = axis === 1 ? -1 : 1, normal = [0, 1, 2].map((k) => k === axis ? side : 0);
    const most = axis < 0 ? 1 : side * (this.low[axis] + share * (this.high[axis] - this.low[axis]));
    this.uniforms.cut.value.set(...normal, most);
    for (const grains of this.grains) grains.setOpen(axis >= 0);
    this.redraw();
  }
  // Between two frames grains and parts are where they would be if they moved straight and evenly.
  setTime(time) {
    this.time = time;
    this.redraw();
  }
  get frame() {
    const times = this.head.times;
    let frame = 0;
    while (frame + 1 < times.length && times[frame + 1] <= this.time) ++frame;
    return frame;
  }

  // At the next occasion; with new shadows unless only the camera has moved.
  redraw(moved = true) {
    this.moved = this.moved || moved;
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.draw());
  }
  draw() {
    this.asked = false;
    const {times} = this.head, frame = this.frame, next = Math.min(frame + 1, times.length - 1);
    const between = next > frame ? (this.time - times[frame]) / (times[next] - times[frame]) : 0;
    const {value, most} = this.scaleOf(frame), scale = most > 0 ? 65534 / most : 0;
    const colour = value ? (row, grain) => 1 + Math.min(65534, Math.round(scale * value(row, grain))) : () => 1;
    [frame, between > 0 ? next : -1].forEach((wanted, which) => {
      if (wanted < 0 || this.loaded[which] === wanted) return;
      for (const grains of this.grains) grains.load(which, wanted, this.frames, colour);
      this.loaded[which] = wanted;
    });
    this.uniforms.between.value = between;
    for (const part of this.parts) part.show(frame, next, between);
    if (this.moved) this.sun.draw(this.renderer);
    this.moved = false;
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.render(this.scene, this.orbit.camera);
    if (this.forces && this.forces.wanted) {
      this.forces.show(frame, next, between);
      this.renderer.autoClear = false;
      this.renderer.clearDepth();
      this.renderer.render(this.forces.scene, this.orbit.camera);
      this.renderer.autoClear = true;
    }
    if (this.drawn) this.drawn(frame, this.scale);
  }
  resize() {
    const width = Math.max(1, this.canvas.parentNode.clientWidth), height = Math.max(1, this.canvas.parentNode.clientHeight);
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setSize(width, height, false);
    this.orbit.resize(width, height);
    this.redraw();
  }
}
)JS";

}  // namespace dem::report::detail
