#pragma once

#include <dem/core/error.hpp>
#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace dem::vehicle {

/// What a driver does: throttle and brake 0 to 1; the angle of the steered wheels in rad, positive to the left.
struct Controls {
  double throttle = 0.0, brake = 0.0, steer = 0.0;
};

/// Holds a speed by throttle and brake: a PI controller whose integral stands still where the output is at its limit.
struct SpeedHold {
  double gain = 0.5;      ///< per m/s
  double integral = 0.1;  ///< per m
  double sum = 0.0;       ///< m, of the error so far

  /// Controls for a speed and the wanted one (m/s), dt (s) after the last call.
  Controls operator()(double speed, double wanted, double dt) {
    const double error = wanted - speed, out = gain * error + integral * sum;
    if (!((out >= 1.0 && error > 0.0) || (out <= -1.0 && error < 0.0))) sum += dt * error;
    return {.throttle = std::clamp(out, 0.0, 1.0), .brake = std::clamp(-out, 0.0, 1.0)};
  }
};

/// Follows a path in the plane by preview steering: it aims at the point of the path that is a preview distance ahead,
/// and steers for the circle that leads there (pure pursuit).
struct PathFollower {
  std::vector<Vec3> path;      ///< m, global; straight lines between the points
  double wheelbase = 3.378;    ///< m
  double preview = 5.0;        ///< m, at rest
  double preview_time = 0.6;   ///< s, of driving added to it
  double largest_steer = 0.6;  ///< rad
  std::size_t next = 0;        ///< point of the path that the car heads for

  /// Angle of the wheels (rad) at a position (m, of the rear axle), a heading (unit vector) and a speed (m/s). Throws
  /// Error for a path of less than two points.
  double operator()(const Vec3& at, const Vec3& heading, double speed) {
    if (path.size() < 2) fail("a path has {} points, but needs at least 2", path.size());
    const double reach = preview + preview_time * std::abs(speed);
    while (next + 1 < path.size() && distance(path[next], at) < reach) ++next;
    const Vec3 aim = aim_at(at, reach);
    const double ahead = (aim - at).dot(heading);
    const double left = heading.x() * (aim.y() - at.y()) - heading.y() * (aim.x() - at.x());
    const double square = ahead * ahead + left * left;
    const double curvature = square > 0.0 ? 2.0 * left / square : 0.0;
    return std::clamp(std::atan(wheelbase * curvature), -largest_steer, largest_steer);
  }
  /// True when the end of the path is nearer than the preview.
  bool at_end() const { return next + 1 >= path.size(); }

 private:
  static double distance(const Vec3& p, const Vec3& q) { return std::hypot(p.x() - q.x(), p.y() - q.y()); }
  /// Where the path leaves the circle of radius `reach` about `at`, on its present piece.
  Vec3 aim_at(const Vec3& at, double reach) const {
    if (next == 0) return path[1];
    const Vec3 from = path[next - 1], to = path[next];
    double low = 0.0, high = 1.0;
    if (distance(to, at) < reach || distance(from, at) > reach) return to;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      (distance(from + middle * (to - from), at) < reach ? low : high) = middle;
    }
    return from + low * (to - from);
  }
};

}  // namespace dem::vehicle
