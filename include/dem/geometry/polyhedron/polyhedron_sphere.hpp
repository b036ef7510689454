#pragma once

#include <dem/geometry/cluster/ball_contacts.hpp>
#include <dem/geometry/polyhedron/polyhedron.hpp>

namespace dem::shape {

/// The contact of a sphere with a polyhedron: one point, on a face, an edge or a corner. `centre` leads from the centre
/// of the sphere's grain to the sphere's, `separation` from the former to the polyhedron's, global axes. Calls
/// callback(feature, ContactPoint) if they touch, with the sphere's grain as i; a sphere keeps its feature while it
/// rolls from a face over an edge, so friction remembers. The overlap is that of the sphere; the polyhedron counts with
/// the radius of the sphere of its volume in the effective one.
template <class Callback>
void collide_sphere(const Vector3<double>& centre, double radius, std::uint32_t feature, const Polyhedron& b,
                    const double* pose_b, const Vector3<double>& separation, Callback&& callback) {
  contact::BallContactPoint contact;
  if (!b.ball_contact(pose_b, centre - separation, radius, contact)) return;
  const double effective = radius * b.radius() / (radius + b.radius());
  callback(feature,
           contact::ContactPoint<double>{-contact.normal, contact.overlap, separation + contact.point, effective, 1.0});
}

/// Spheres and clusters against polyhedra: one contact a ball at the most, whose number is the feature.
template <BallShape Balls>
struct PairContact<Balls, Polyhedron> {
  template <class Callback>
  static void collide(const Balls& a, const double* pose_a, const Polyhedron& b, const double* pose_b,
                      const Vector3<double>& separation, Callback&& callback) {
    for (int k = 0; k < ball_count(a); ++k) {
      const PosedBall ball = posed_ball(a, pose_a, k);
      collide_sphere(ball.centre, ball.radius, static_cast<std::uint32_t>(k), b, pose_b, separation, callback);
    }
  }
};

}  // namespace dem::shape
