#pragma once

#include <dem/geometry/polyhedron/polyhedron_patch.hpp>

namespace dem::shape {

// Separating axis test of two convex polyhedra. The axes are the normals of all faces, and the cross products of each
// edge of one body with each edge of the other. The bodies overlap if and only if they overlap along all of these, and
// the axis of least overlap is among them (S. Gottschalk, 1996; the pairs of edges that matter: D. Gregorius, Game
// Developers Conference 2013).

/// Where the points of body y are in the frame of body x: turn * p + shift.
struct Placing {
  Matrix3<double> turn;
  Vector3<double> shift;

  DEM_HOT Vector3<double> operator()(const Vector3<double>& p) const { return turn * p + shift; }
};

DEM_HOT void place_corners(const PolyhedronTables& y, const Placing& at, SeenCorners& seen) {
  const Matrix3<double>& r = at.turn;
  for (int k = 0; k < y.corner_lanes; k += pack_width) {
    const auto i = static_cast<std::size_t>(k);
    const Pack px = load(&y.corner_x[i]), py = load(&y.corner_y[i]), pz = load(&y.corner_z[i]);
    store(Pack(r.row0.x) * px + Pack(r.row0.y) * py + Pack(r.row0.z) * pz + Pack(at.shift.x), seen.x + k);
    store(Pack(r.row1.x) * px + Pack(r.row1.y) * py + Pack(r.row1.z) * pz + Pack(at.shift.y), seen.y + k);
    store(Pack(r.row2.x) * px + Pack(r.row2.y) * py + Pack(r.row2.z) * pz + Pack(at.shift.z), seen.z + k);
  }
}

/// What the faces of one body (x) know of the corners of another (y).
struct FaceAxes {
  double depth;  ///< m, overlap along the best face normal
  int face;      ///< of x
  /// Height of y's corner k above x's face f at [k * x.face_lanes + f], m.
  alignas(64) double height[PolyhedronTables::most_corners * (PolyhedronTables::most_faces + 8)];

  /// The corner of y that is deepest under the best face.
  int deepest(const PolyhedronTables& x, const PolyhedronTables& y) const {
    int result = 0;
    double lowest = height[face];
    for (int k = 1; k < y.corners; ++k) {  // by conditional moves: where it is, no branch predictor knows
      const double h = height[k * x.face_lanes + face];
      result = h < lowest ? k : result;
      lowest = min(h, lowest);
    }
    return result;
  }
};

/// All face normals of x at once, a pack of faces at a time. False if one of them separates the bodies.
inline bool test_faces(const PolyhedronTables& x, const PolyhedronTables& y, const SeenCorners& seen, FaceAxes& out) {
  out.depth = 1e300;
  for (int f = 0; f < x.face_lanes; f += pack_width) {
    const auto i = static_cast<std::size_t>(f);
    const Pack nx = load(&x.normal_x[i]), ny = load(&x.normal_y[i]), nz = load(&x.normal_z[i]), h = load(&x.offset[i]);
    Pack lowest(1e300);
    for (int k = 0; k < y.corners; ++k) {
      const Pack height = nx * Pack(seen.x[k]) + ny * Pack(seen.y[k]) + nz * Pack(seen.z[k]) - h;
      store(height, out.height + k * x.face_lanes + f);
      lowest = min(lowest, height);
    }
    const double highest = largest(lowest);
    if (highest >= 0.0) return false;
    if (-highest < out.depth) {
      out.depth = -highest;
      out.face = f + std::countr_zero(bits(lowest == Pack(highest)));
    }
  }
  return true;
}

/// Edges of y that come near x: not wholly further than `reach` beyond one of x's faces. Returns how many.
inline int list_near_edges(const PolyhedronTables& x, const PolyhedronTables& y, const FaceAxes& of_x, double reach,
                           int* list) {
  int n = 0;
  for (int e = 0; e < y.edges; ++e) {
    const PolyhedronTables::Edge& edge = y.edge[static_cast<std::size_t>(e)];
    const double *tail = of_x.height + edge.tail * x.face_lanes, *head = of_x.height + edge.head * x.face_lanes;
    bool beyond = false;
    for (int f = 0; f < x.face_lanes; f += pack_width)
      beyond |= any_of(min(load(tail + f), load(head + f)) > Pack(reach));
    list[n] = e;
    n += beyond ? 0 : 1;
  }
  return n;
}

/// The pair of edges whose common normal has the least overlap, in the frame of a.
struct EdgeAxis {
  double depth = 1e300;
  Vector3<double> normal;  ///< unit vector out of a
  int of_a = -1, of_b = -1;
};

/// Edges of b as columns, seen from a: direction, the normals of both faces, a point.
struct EdgeColumns {
  static constexpr int room = PolyhedronTables::most_edges + 8;
  alignas(64) double dx[room], dy[room], dz[room], lx[room], ly[room], lz[room], rx[room], ry[room], rz[room], px[room],
      py[room], pz[room];

  void set(int k, const PolyhedronTables& b, const Placing& at, const PolyhedronTables::Edge& e,
           const Vector3<double>& tail) {
    const Vector3<double> d = at.turn * e.direction, l = at.turn * b.normal(e.left), r = at.turn * b.normal(e.right);
    dx[k] = d.x, dy[k] = d.y, dz[k] = d.z;
    lx[k] = l.x, ly[k] = l.y, lz[k] = l.z;
    rx[k] = r.x, ry[k] = r.y, rz[k] = r.z;
    px[k] = tail.x, py[k] = tail.y, pz[k] = tail.z;
  }
  /// An edge that crosses none.
  void clear(int k) {
    for (double* column : {dx, dy, dz, lx, ly, lz, rx, ry, rz, px, py, pz}) column[k] = 0.0;
  }
};

/// Tries the listed edges of a with those of b. A pair of edges makes a face of the Minkowski difference of the bodies,
/// and so an axis that matters, if the arcs between the normals of their faces cross on the unit sphere (those of b
/// turned round). Parallel edges make none. False if an axis separates the bodies.
inline bool test_edges(const PolyhedronTables& a, const int* list_a, int count_a, const PolyhedronTables& b,
                       const int* list_b, int count_b, const Placing& b_in_a, const SeenCorners& seen_b,
                       EdgeAxis& best) {
  EdgeColumns c;
  for (int k = 0; k < count_b; ++k) {
    const PolyhedronTables::Edge& e = b.edge[static_cast<std::size_t>(list_b[k])];
    c.set(k, b, b_in_a, e, seen_b[e.tail]);
  }
  for (int k = count_b; k < round_up_to_pack(count_b); ++k) c.clear(k);
  for (int m = 0; m < count_a; ++m) {
    const PolyhedronTables::Edge& e = a.edge[static_cast<std::size_t>(list_a[m])];
    const Vector3<double> left = a.normal(e.left), right = a.normal(e.right), tail = a.corner(e.tail);
    const Vector3<Pack> d = {Pack(e.direction.x), Pack(e.direction.y), Pack(e.direction.z)};
    const Vector3<Pack> l = {Pack(left.x), Pack(left.y), Pack(left.z)};
    const Vector3<Pack> r = {Pack(right.x), Pack(right.y), Pack(right.z)};
    const Vector3<Pack> p = {Pack(tail.x), Pack(tail.y), Pack(tail.z)};
    for (int k = 0; k < count_b; k += pack_width) {
      const Vector3<Pack> dir = {load(c.dx + k), load(c.dy + k), load(c.dz + k)};
      const Pack a1 = dot(l, dir), a2 = dot(r, dir);
      const Pack b1 = dot(Vector3<Pack>{load(c.lx + k), load(c.ly + k), load(c.lz + k)}, d);
      const Pack b2 = dot(Vector3<Pack>{load(c.rx + k), load(c.ry + k), load(c.rz + k)}, d);
      const Vector3<Pack> axis = cross(d, dir);
      const Pack size2 = dot(axis, axis);
      const auto cross_each_other =
          a1 * a2 < Pack(0.0) && b1 * b2 < Pack(0.0) && b1 * a2 < Pack(0.0) && size2 > Pack(1e-16);
      std::uint32_t found = bits(cross_each_other);
      if (found == 0) continue;
      // The axis leaves a where a's faces look.
      const Pack inverse = Pack(1.0) / sqrt(max(size2, Pack(1e-300)));
      const Pack sign = select(dot(axis, l + r) > Pack(0.0), inverse, -inverse);
      const Vector3<Pack> normal = sign * axis;
      const Pack depth = dot(normal, p - Vector3<Pack>{load(c.px + k), load(c.py + k), load(c.pz + k)});
      for (; found != 0; found &= found - 1) {
        const int at = std::countr_zero(found);
        const double overlap = lane(depth, at);
        if (overlap <= 0.0) return false;
        if (overlap >= best.depth) continue;
        best = {overlap, {lane(normal.x, at), lane(normal.y, at), lane(normal.z, at)}, list_a[m], list_b[k + at]};
      }
    }
  }
  return true;
}

}  // namespace dem::shape
