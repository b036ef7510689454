#pragma once

#include <dem/shape/ball_contacts.hpp>
#include <dem/shape/polyhedron.hpp>

namespace dem::shape {

/// The point of a polyhedron's skin that is nearest to a point, in the polyhedron's frame.
struct NearestPoint {
  Vector3<double> outward;  ///< unit vector from the skin towards the outside, through the point asked for
  double height;            ///< m, of the point asked for above the skin; negative inside
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

/// Nearest point of the whole skin. False if p is at least `reach` away from it.
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

/// The contact of a sphere with a polyhedron: one point, on a face, an edge or a corner. `centre` leads from the centre
/// of the sphere's grain to the sphere's, `separation` from the former to the polyhedron's, global axes. Calls
/// sink(feature, PointTouch) if they touch, with the sphere's grain as i; a sphere keeps its feature while it rolls
/// from a face over an edge, so friction remembers. The overlap is that of the sphere;
/// the polyhedron counts with the radius of the sphere of its volume in the effective one.
template <class Sink>
void collide_sphere(const Vector3<double>& centre, double radius, std::uint32_t feature, const Polyhedron& b,
                    const double* pose_b, const Vector3<double>& separation, Sink&& sink) {
  const Matrix3<double> turn = Polyhedron::rotation(pose_b);
  NearestPoint nearest;
  if (!nearest_point(b.tables(), transpose_times(turn, centre - separation), radius, nearest)) return;
  const Vector3<double> normal = -(turn * nearest.outward);
  const double overlap = radius - nearest.height;
  const double effective = radius * b.radius() / (radius + b.radius());
  sink(feature,
       contact::PointTouch<double>{normal, overlap, centre + (radius - 0.5 * overlap) * normal, effective, 1.0});
}

/// Spheres and clusters against polyhedra: one contact a ball at the most, whose number is the feature.
template <BallShape Balls>
struct PairContact<Balls, Polyhedron> {
  template <class Sink>
  static void collide(const Balls& a, const double* pose_a, const Polyhedron& b, const double* pose_b,
                      const Vector3<double>& separation, Sink&& sink) {
    for (int k = 0; k < ball_count(a); ++k) {
      const PosedBall ball = posed_ball(a, pose_a, k);
      collide_sphere(ball.centre, ball.radius, static_cast<std::uint32_t>(k), b, pose_b, separation, sink);
    }
  }
};

}  // namespace dem::shape
