#pragma once
// The replay's script, first part: from the text in the page to frames of grains and meshes.

#include <string_view>

namespace dem::report::detail {

inline constexpr std::string_view kReplayScriptData = R"JS(
// ---- what the page holds

// Text in base64 -> zlib stream -> bytes.
async function unpack(text) {
  const letters = atob(text.trim());
  const packed = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; ++k) packed[k] = letters.charCodeAt(k);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Reads what encode() in replay_encode.hpp has written, in the same order.
class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  plane(count) {
    this.at += count;
    return this.bytes.subarray(this.at - count, this.at);
  }
  // Numbers as folded differences, `size` bytes each, byte by byte.
  words(count, size) {
    const planes = [];
    for (let k = 0; k < size; ++k) planes.push(this.plane(count));
    const result = new Uint32Array(count);
    let before = 0;
    for (let i = 0; i < count; ++i) {
      let folded = 0;
      for (let k = 0; k < size; ++k) folded |= planes[k][i] << (8 * k);
      before += (folded >>> 1) ^ -(folded & 1);
      result[i] = before;
    }
    return result;
  }
  mesh(head) {
    const points = new Float32Array(3 * head.vertices);
    for (let axis = 0; axis < 3; ++axis) {
      const steps = this.words(head.vertices, 3);
      const step = (head.high[axis] - head.low[axis]) / 65535;
      for (let v = 0; v < head.vertices; ++v) points[3 * v + axis] = head.low[axis] + step * steps[v];
    }
    return {points, corners: this.words(head.corners, 4), smooth: head.smooth};
  }
  floats(count) {
    const copy = this.plane(4 * count).slice();
    const view = new DataView(copy.buffer);
    return Float32Array.from({length: count}, (_, k) => view.getFloat32(4 * k, true));
  }
}

const ABSENT = 0xffffffff;

// All frames of the grains: places (three 16-bit steps each), packed turns (ABSENT: not there), speeds and forces (8
// bits), and who sleeps; frame after frame. `first` is where each grain was when it was first there.
function readFrames(head, reader) {
  const grains = head.grains, frames = head.times.length, half = 511 | 511 << 10 | 511 << 20;
  const planes = head.planes.map((count) => reader.plane(count)), at = new Array(planes.length).fill(0);
  const take = (plane) => planes[plane][at[plane]++];
  const place = new Uint16Array(3 * grains * frames), turn = new Uint32Array(grains * frames);
  const scalar = new Uint8Array(2 * grains * frames), first = new Uint16Array(3 * grains);
  const asleep = new Uint8Array(head.sleep ? grains * frames : 0);
  const places = new Uint16Array(3 * grains), turns = new Uint32Array(grains).fill(half);
  const scalars = new Uint8Array(2 * grains), met = new Uint8Array(grains);
  const unfold = (folded) => (folded >>> 1) ^ -(folded & 1);
  for (let f = 0; f < frames; ++f) {
    for (let g = 0; g < grains; ++g) {
      const what = take(0), row = f * grains + g;
      if (what === 8) {
        turn[row] = ABSENT;
        continue;
      }
      if (what & 1) {
        for (let k = 0; k < 3; ++k) places[3 * g + k] += unfold(take(1 + 2 * k) | take(2 + 2 * k) << 8);
      }
      if (what & 2) {
        const rest = take(10), old = turns[g];
        let packed = ((old >>> 30) ^ (rest & 3)) << 30;
        for (let k = 0; k < 3; ++k) {
          const change = unfold(take(7 + k) | (rest >> (2 + 2 * k) & 3) << 8);
          packed |= ((old >>> (10 * k)) + change & 1023) << (10 * k);
        }
        turns[g] = packed;
      }
      if (what & 4) {
        for (let k = 0; k < 2; ++k) scalars[2 * g + k] += unfold(take(11 + k));
      }
      for (let k = 0; k < 3; ++k) {
        if (!met[g]) first[3 * g + k] = places[3 * g + k];
        place[3 * row + k] = places[3 * g + k];
      }
      met[g] = 1;
      if (head.sleep) asleep[row] = what >> 4;
      turn[row] = turns[g];
      scalar[2 * row] = scalars[2 * g];
      scalar[2 * row + 1] = scalars[2 * g + 1];
    }
  }
  return {place, turn, scalar, asleep, first};
}

// The force chains: of each frame the ends of its lines (six 16-bit steps each), their forces (8 bits), and which line
// of the next frame each is (-1: none).
function readForces(head, reader) {
  const planes = head.planes.map((count) => reader.plane(count)), at = new Array(planes.length).fill(0);
  const take = (plane) => planes[plane][at[plane]++], unfold = (folded) => (folded >>> 1) ^ -(folded & 1);
  const frames = [];
  const read = (frame, what, before, force, isNew) => {
    const line = before.slice();
    for (let k = 0; k < 6; ++k) {
      if (isNew && k >= 3) line[k] = line[k - 3];
      if (what & 2) line[k] = line[k] + unfold(take(1 + 2 * k) | take(2 + 2 * k) << 8) & 65535;
    }
    frame.ends.push(...line);
    frame.force.push(what & 4 ? force + unfold(take(13)) & 255 : force);
    return line;
  };
  let last = {ends: [], force: [], next: []};
  for (const added of head.added) {
    const frame = {ends: [], force: []};
    last.next = Int32Array.from(last.force, (force, k) => {
      const what = take(0);
      if (what === 0) return -1;
      read(frame, what, last.ends.slice(6 * k, 6 * k + 6), force, false);
      return frame.force.length - 1;
    });
    for (let k = 0, before = [0, 0, 0, 0, 0, 0]; k < added; ++k) before = read(frame, take(0), before, 0, true);
    frame.next = new Int32Array(frame.force.length).fill(-1);
    frames.push(last = frame);
  }
  return frames.map(({ends, force, next}) => ({ends: Uint16Array.from(ends), force: Uint8Array.from(force), next}));
}

// The quaternion x, y, z, w of a packed turn, into to[at...at + 3], times 32767.
function writeTurn(packed, to, at) {
  const most = packed >>> 30, step = 1 / (Math.SQRT2 * 511);
  let rest = 1, shift = 0, q = [0, 0, 0, 0];
  for (let k = 0; k < 4; ++k) {
    if (k === most) continue;
    q[k] = ((packed >>> shift & 1023) - 511) * step;
    rest -= q[k] * q[k];
    shift += 10;
  }
  q[most] = Math.sqrt(Math.max(0, rest));
  for (let k = 0; k < 4; ++k) to[at + k] = Math.round(32767 * q[(k + 1) % 4]);
}

// ---- meshes

// Corners of a mesh with normals: where two triangles meet at less than the mesh's smooth angle they share one.
function shaded({points, corners, smooth}) {
  const triangles = corners.length / 3, flat = new Float32Array(corners.length), around = new Map();
  for (let t = 0; t < triangles; ++t) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * corners[3 * t + k]);
    const u = [0, 1, 2].map((k) => points[b + k] - points[a + k]), v = [0, 1, 2].map((k) => points[c + k] - points[a + k]);
    flat[3 * t] = u[1] * v[2] - u[2] * v[1];
    flat[3 * t + 1] = u[2] * v[0] - u[0] * v[2];
    flat[3 * t + 2] = u[0] * v[1] - u[1] * v[0];
    for (let k = 0; k < 3; ++k) {
      const vertex = corners[3 * t + k];
      if (!around.has(vertex)) around.set(vertex, []);
      around.get(vertex).push(t);
    }
  }
  const size = (t) => Math.hypot(flat[3 * t], flat[3 * t + 1], flat[3 * t + 2]) || 1;
  const dot = (s, t) => flat[3 * s] * flat[3 * t] + flat[3 * s + 1] * flat[3 * t + 1] + flat[3 * s + 2] * flat[3 * t + 2];
  const least = Math.cos(smooth) - 1e-6, position = [], normal = [], index = [], made = new Map();
  for (let t = 0; t < triangles; ++t) {
    for (let k = 0; k < 3; ++k) {
      const vertex = corners[3 * t + k], n = [0, 0, 0];
      for (const s of around.get(vertex)) {
        if (s !== t && dot(s, t) < least * size(s) * size(t)) continue;
        for (let axis = 0; axis < 3; ++axis) n[axis] += flat[3 * s + axis];  // as much as its area
      }
      const length = Math.hypot(...n) || 1, key = vertex + ":" + n.map((x) => Math.round(1000 * x / length));
      if (!made.has(key)) {
        made.set(key, made.size);
        for (let axis = 0; axis < 3; ++axis) {
          position.push(points[3 * vertex + axis]);
          normal.push(n[axis] / length);
        }
      }
      index.push(made.get(key));
    }
  }
  return {position: new Float32Array(position), normal: new Float32Array(normal), index: new Uint32Array(index)};
}

// The edges of a mesh that bend by more than half a radian or are a border, as pairs of points.
function sharpEdges({points, corners}) {
  const normals = [], edges = new Map(), lines = [];
  for (let t = 0; t < corners.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => points.subarray(3 * corners[t + k], 3 * corners[t + k] + 3));
    const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]], v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.hypot(...n) || 1;
    normals.push(n.map((x) => x / length));
    for (let k = 0; k < 3; ++k) {
      const [from, to] = [corners[t + k], corners[t + (k + 1) % 3]];
      const key = Math.min(from, to) + ":" + Math.max(from, to);
      if (!edges.has(key)) edges.set(key, {from, to, sides: []});
      edges.get(key).sides.push(normals.length - 1);
    }
  }
  for (const {from, to, sides} of edges.values()) {
    const [m, n] = [normals[sides[0]], normals[sides[sides.length - 1]]];
    if (sides.length === 2 && m[0] * n[0] + m[1] * n[1] + m[2] * n[2] > Math.cos(0.5)) continue;
    for (const vertex of [from, to]) lines.push(...points.subarray(3 * vertex, 3 * vertex + 3));
  }
  return new Float32Array(lines);
}
)JS";

}  // namespace dem::report::detail
