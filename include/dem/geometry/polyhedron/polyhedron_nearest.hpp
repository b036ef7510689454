#pragma once

#include <dem/geometry/polyhedron/polyhedron_tables.hpp>

#include <cmath>

namespace dem::shape {

/// The point of a polyhedron's boundary that is nearest to a point, in the polyhedron's frame.
struct NearestPoint {
  Vector3<double> outward;  ///< unit vector from the boundary towards the outside, through the point asked for
  double height;            ///< m, of the point asked for above the boundary; negative inside
};

/// Nearest point of a polygon (one face), for points above its plane: inside its sides, else on the nearest side. The
/// square of the distance goes to `distance2`, the way from the nearest point to p is returned.
inline Vector3<double> way_from_face(const PolyhedronTables& t, int face, double height, const Vector3<double>& p,
                                     double& distance2) {
  const int first = t.first_side[static_cast<std::size_t>(face)],
            end = t.first_side[static_cast<std::size_t>(face + 1)];
  Vector3<double> best = height * t.normal(face);
  distance2 = height * height;
  bool above = true;
  for (int s = first; s < end && above; ++s) {
    const PolyhedronTables::Side& side = t.side[static_cast<std::size_t>(s)];
    above = dot(side.outward, p) <= side.offset;
  }
  if (above) return best;
  distance2 = 1e300;
  for (int s = first; s < end; ++s) {
    const PolyhedronTables::Edge& e = t.edge[static_cast<std::size_t>(t.side[static_cast<std::size_t>(s)].edge)];
    const Vector3<double> from = p - t.corner(e.tail), along = t.corner(e.head) - t.corner(e.tail);
    const double share = max(0.0, min(1.0, dot(from, along) / dot(along, along)));
    const Vector3<double> way = from - share * along;
    const double d2 = dot(way, way);
    if (d2 >= distance2) continue;
    distance2 = d2;
    best = way;
  }
  return best;
}

/// Nearest point of the whole boundary. False if p is at least `reach` away from it.
inline bool nearest_point(const PolyhedronTables& t, const Vector3<double>& p, double reach, NearestPoint& result) {
  double best2 = reach * reach, highest = -1e300;
  int highest_face = 0;
  bool found = false;
  for (int f = 0; f < t.faces; ++f) {
    const double height = dot(t.normal(f), p) - t.offset[static_cast<std::size_t>(f)];
    if (height >= reach) return false;
    if (height > highest) {
      highest = height;
      highest_face = f;
    }
    if (height <= 0.0) continue;
    double distance2;
    const Vector3<double> way = way_from_face(t, f, height, p, distance2);
    if (distance2 >= best2) continue;
    best2 = distance2;
    found = true;
    const double distance = std::sqrt(distance2);
    result = {(1.0 / distance) * way, distance};
  }
  if (highest > 0.0) return found;
  // Inside: out through the nearest face.
  result = {t.normal(highest_face), highest};
  return true;
}

}  // namespace dem::shape
