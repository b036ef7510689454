#pragma once

#include <dem/geometry/cluster/ball_contacts.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/geometry/superquadric/superquadric_points.hpp>

namespace dem::shape {

/// Superquadric and sphere or cluster: the common normal with each ball, which passes through the ball's centre.
/// Feature: the ball. Grains of one ball keep their search. Found up to a gap (m).
template <BallShape Balls>
struct PairContact<Superquadric, Balls> {
  using WarmStart = CommonNormal;

  template <class Callback>
  static DEM_HOT void collide(const Superquadric& a, const double* pose_a, const Balls& b, const double* pose_b,
                              const Vector3<double>& separation, WarmStart& found, Callback&& callback,
                              double gap = 0.0) {
    const Matrix3<double> r = Superquadric::rotation(pose_a);
    for (int k = 0; k < ball_count(b); ++k) {
      const PosedBall ball = posed_ball(b, pose_b, k);
      if (k > 0) found = {};
      const Vector3<double> centre = transpose_times(r, separation + ball.centre);
      if (!find_ball_contact(a.solid(), centre, ball.radius, found, gap)) continue;
      const double radius = a.mean_radius() * ball.radius / (a.mean_radius() + ball.radius);
      callback(static_cast<std::uint32_t>(k),
               contact::ContactPoint<double>{r * found.normal, found.overlap, r * found.point, radius, 1.0});
    }
    if (ball_count(b) > 1) found = {};
  }
};

/// The points of a superquadric in each ball (eq. 33). Feature: ball * 4096 + point.
template <BallShape Balls>
struct PairContact<SuperquadricPoints, Balls> {
  template <class Callback>
  static DEM_HOT void collide(const SuperquadricPoints& a, const double* pose_a, const Balls& b, const double* pose_b,
                              const Vector3<double>& separation, Callback&& callback) {
    const Matrix3<double> r = SuperquadricPoints::rotation(pose_a);
    const PointTable& points = a.points();
    for (int m = 0; m < ball_count(b); ++m) {
      const PosedBall ball = posed_ball(b, pose_b, m);
      const Vector3<double> global = separation + ball.centre;
      if (!(norm(global) < a.bounding_radius() + ball.radius)) continue;
      const Vector3<double> centre = transpose_times(r, global);
      const double radius = a.mean_radius() * ball.radius / (a.mean_radius() + ball.radius);
      const auto find = [&](auto&& found) {
        for (int at = 0; at < points.count; at += pack_width) {
          const auto k = static_cast<std::size_t>(at);
          const Pack x = load(&points.x[k]) - Pack(centre.x), y = load(&points.y[k]) - Pack(centre.y);
          const Pack z = load(&points.z[k]) - Pack(centre.z);
          for (std::uint32_t in = bits(x * x + y * y + z * z < Pack(ball.radius * ball.radius)); in != 0;
               in &= in - 1) {
            const int point = at + std::countr_zero(in);
            const Vector3<double> arm = r * points[point], link = global - arm;
            const double distance = max(norm(link), 1e-300), depth = ball.radius - distance;
            const Vector3<double> normal = (1.0 / distance) * link;
            found(static_cast<std::uint32_t>(m * 4096 + point),
                  contact::ContactPoint<double>{normal, depth, arm - (0.5 * depth) * normal, radius,
                                                points.weight[static_cast<std::size_t>(point)]});
          }
        }
      };
      if (a.has_shares()) {
        share_points(find, callback);
      } else {
        find(callback);
      }
    }
  }
};

/// Superquadrics of either policy: the points of both boundaries, as among SuperquadricPoints. Where these weigh by
/// area a Superquadric, whose points have shares, shows none of its own.
template <>
struct PairContact<SuperquadricPoints, Superquadric> {
  template <class Callback>
  static DEM_HOT void collide(const SuperquadricPoints& a, const double* pose_a, const Superquadric& b,
                              const double* pose_b, const Vector3<double>& separation, Callback&& callback) {
    SuperquadricPoints::collide_by_points(a, pose_a, b, pose_b, separation,
                                          [&](std::uint32_t feature, const contact::ContactPoint<double>& point) {
                                            if (a.has_shares() || (feature & SuperquadricPoints::other_way) == 0)
                                              callback(feature, point);
                                          });
  }
};

}  // namespace dem::shape
