#pragma once

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/geometry/pair_contact.hpp>
#include <dem/geometry/sphere/sphere.hpp>

namespace dem::shape {

// Spheres and clusters as what they both are, a few balls: how they touch each other, and what other shapes need to
// touch them.

/// A ball of a grain: its centre in global axes, from the grain's centre, and its radius (m).
struct PosedBall {
  Vector3<double> centre;
  double radius;
};

inline int ball_count(const Sphere&) { return 1; }
DEM_HOT PosedBall posed_ball(const Sphere& s, const double*, int) { return {{0, 0, 0}, s.radius()}; }

template <int N>
int ball_count(const SphereCluster<N>& c) {
  return c.count();
}
template <int N>
DEM_HOT PosedBall posed_ball(const SphereCluster<N>& c, const double* pose, int k) {
  constexpr int stride = SphereCluster<N>::stride;
  return {{pose[k], pose[stride + k], pose[2 * stride + k]}, c.radius(k)};
}

template <class S>
concept BallShape = Shape<S> && requires(const S& shape, const double* pose) {
  { ball_count(shape) } -> std::same_as<int>;
  { posed_ball(shape, pose, 0) } -> std::same_as<PosedBall>;
};

/// Which of two kinds comes first, as a pair of kinds has one order only: the one of fewer balls, spheres before
/// clusters of one ball.
template <BallShape A, BallShape B>
inline constexpr bool balls_before = A::most_contacts < B::most_contacts ||
                                     (A::most_contacts == B::most_contacts && A::pose_size < B::pose_size);

/// Every ball of a against every ball of b, up to a gap: a sphere is a cluster of one.
template <BallShape A, BallShape B>
requires balls_before<A, B>
struct PairContact<A, B> {
  template <class Callback, class Gap = NoGap>
  static DEM_HOT void collide(const A& a, const double* pose_a, const B& b, const double* pose_b,
                              const Vector3<double>& separation, Callback&& callback, Gap gap = {}) {
    for (int k = 0; k < ball_count(a); ++k) {
      const PosedBall p = posed_ball(a, pose_a, k);
      const Vector3<double> from = separation - p.centre;
      for (int m = 0; m < ball_count(b); ++m) {
        const PosedBall q = posed_ball(b, pose_b, m);
        const Vector3<double> link = from + q.centre;
        const double reach = widened(p.radius + q.radius, gap);
        if (dot(link, link) >= reach * reach) continue;
        callback(static_cast<std::uint32_t>(k * 256 + m),
                 contact::ClusterContactPoint<double>{p.centre, link, p.radius, q.radius});
      }
    }
  }
};

}  // namespace dem::shape
