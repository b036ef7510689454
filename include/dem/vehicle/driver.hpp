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
///
/// A motor has a governor as well. Above a speed of the rims it takes the throttle back, in proportion, to none at a
/// second speed. It looks at every time step: a driver who looks a hundred times a second is too slow for it, as light
/// shafts and wheels get faster by metres per second in that time, and would switch the engine on and off. Its valve
/// lags by EngineSpec::governor_lag (an engine that is an actuator has none, and holds the middle of both speeds): on
/// the light drive shaft it then acts as a spring and damper in a row, which takes energy, and is stable with steps up
/// to some 1e-4 s for bands of 0.2 m/s and more.
struct Controls {
  double throttle = 0.0, brake = 0.0, steer = 0.0;
  double ease_from = no_limit, ease_to = no_limit;  ///< m/s, of the rims' mean, as the drive shaft turns

  static constexpr double no_limit = 1e300;
  static constexpr double largest_steer = 0.8;  ///< rad
  /// Throws Error for a throttle or brake that is not from 0 to 1, a steer beyond largest_steer either way, or unless
  /// both limits of the governor are given or none, the first not above the second. Rounding is let pass.
  void check() const {
    require(throttle, 0.0, 1.0, "throttle", "");
    require(brake, 0.0, 1.0, "brake", "");
    require(steer, -largest_steer, largest_steer, "steer", " rad, positive to the left");
    if ((ease_from < no_limit) == (ease_to < no_limit) && ease_from <= ease_to) return;
    fail(
        "the governor is to ease off from {:g} to {:g} m/s of the rims; give both ease_from and ease_to, the first not "
        "above the second, or neither",
        ease_from, ease_to);
  }
  /// Share of the throttle that the governor leaves at a speed of the rims (m/s).
  double governed(double rims) const {
    if (rims <= ease_from) return 1.0;
    return rims < ease_to ? (ease_to - rims) / (ease_to - ease_from) : 0.0;
  }

 private:
  static void require(double value, double lowest, double highest, const char* what, const char* unit) {
    constexpr double rounding = 1e-9;
    if (value >= lowest - rounding && value <= highest + rounding) return;
    fail("a driver's {} is {:g}, but must be from {:g} to {:g}{}", what, value, lowest, highest, unit);
  }
};

/// Turns the rims with a speed (m/s), or up to half of `band` (m/s) slower or faster, whatever the car does: by the
/// governor alone, at full throttle. It does not brake them, but an engine that is an actuator does. `steer` in rad.
inline Controls turn_rims(double steer, double wanted, double band = 0.4) {
  return {.throttle = 1.0, .steer = steer, .ease_from = wanted - 0.5 * band, .ease_to = wanted + 0.5 * band};
}

/// Holds a speed by throttle and brake: a PI controller whose integral stands still where the output is at its limit.
struct SpeedHold {
  double gain = 0.5;      ///< per m/s
  double integral = 0.1;  ///< per m
  double sum = 0.0;       ///< m, of the error so far

  /// Controls for a speed and the wanted one (m/s), dt (s) after the last call. `known` is output that
  /// is known to be needed, as for the wanted acceleration. The integral does not grow while something else eases the
  /// throttle off.
  Controls operator()(double speed, double wanted, double dt, double known = 0.0, bool is_eased = false) {
    const double error = wanted - speed, out = known + gain * error + integral * sum;
    const bool is_full = out >= 1.0 || is_eased;
    if (!((is_full && error > 0.0) || (out <= -1.0 && error < 0.0))) sum += dt * error;
    return {.throttle = std::clamp(out, 0.0, 1.0), .brake = std::clamp(-out, 0.0, 1.0)};
  }
  template <class V>
  void fields(V& v) {
    v("sum", sum, "m");
  }
};

/// Follows a path in the plane by preview steering: it aims at the point of the path that is a preview distance ahead,
/// and steers for the circle that leads there (pure pursuit). On a side slope this alone leaves the car beside the
/// path: it has to head up the slope, which it does only as far as it is below the path. `trim` makes that go away,
/// over some reach/trim of way: the steering angle grows with the sum of the car's offset from the path over the way.
struct PathFollower {
  std::vector<Vec3> path;      ///< m, global; straight lines between the points
  double wheelbase = 0.0;      ///< m, of the car, to be given: VehicleSpec::wheelbase()
  double preview = 5.0;        ///< m, at rest
  double preview_time = 0.6;   ///< s, of driving added to it
  double largest_steer = 0.6;  ///< rad
  double trim = 0.0;           ///< of reach^3/wheelbase; 0: none, from 4 on the car swings ever more about the path
  std::size_t next = 1;        ///< point of the path that the car heads for
  std::size_t beside = 0;      ///< piece of the path that the car is beside
  double offset_sum = 0.0;     ///< m^2, of the offset over the way, to the right
  Vec3 last = Vec3::Zero();    ///< m, where the car was at the last call
  bool has_last = false, is_near_end = false;

  /// Angle of the wheels (rad) at a position (m, of the rear axle), a heading (unit vector) and a speed (m/s). Throws
  /// Error for a path of less than two points, and without a wheelbase.
  double operator()(const Vec3& at, const Vec3& heading, double speed) {
    const double reach = preview + preview_time * std::abs(speed), beside_path = offset(at);
    if (!(wheelbase > 0.0)) {
      fail("the wheelbase of a path follower is {:g} m, but must be that of its car; give it VehicleSpec::wheelbase()",
           wheelbase);
    }
    next = std::max(next, beside + 1);
    while (next + 1 < path.size() && distance(path[next], at) < reach) ++next;
    is_near_end = next + 1 == path.size() && distance(path[next], at) < reach;
    const Vec3 aim = aim_at(at, reach);
    const double ahead = (aim - at).dot(heading);
    const double left = heading.x() * (aim.y() - at.y()) - heading.y() * (aim.x() - at.x());
    const double square = ahead * ahead + left * left;
    const double curvature = square > 0.0 ? 2.0 * left / square : 0.0;
    const double wanted = std::atan(wheelbase * curvature) + trim * wheelbase / (reach * reach * reach) * offset_sum;
    const double steer = std::clamp(wanted, -largest_steer, largest_steer);
    // The sum does not grow while the wheels are turned as far as they go.
    const double change = has_last ? -distance(at, last) * beside_path : 0.0;
    if (steer == wanted || change * offset_sum < 0.0) offset_sum += change;
    last = at, has_last = true;
    return steer;
  }
  /// m, of a position to the left of the path: of its piece beside the position, which goes on from call to call.
  /// Throws Error for a path of less than two points.
  double offset(const Vec3& at) {
    if (path.size() < 2) fail("a path has {} points, but needs at least 2", path.size());
    while (beside + 2 < path.size() && (along(beside, at) > 1.0 || away(beside + 1, at) <= away(beside, at))) ++beside;
    const Vec3 piece = path[beside + 1] - path[beside], to = at - path[beside];
    return (piece.x() * to.y() - piece.y() * to.x()) / std::max(1e-300, std::hypot(piece.x(), piece.y()));
  }

  /// True when the end of the path was nearer than the preview at the last call.
  bool at_end() const { return is_near_end; }

  template <class V>
  void fields(V& v) {
    v("next", next), v("beside", beside), v("offset_sum", offset_sum, "m^2"), v("last", last, "m");
    v("has_last", has_last), v("is_near_end", is_near_end);
  }

 private:
  static double distance(const Vec3& p, const Vec3& q) { return std::hypot(p.x() - q.x(), p.y() - q.y()); }
  /// How far along a piece of the path a position is: 0 at its begin, 1 at its end; past the end of one without length.
  double along(std::size_t k, const Vec3& at) const {
    const Vec3 piece = path[k + 1] - path[k], to = at - path[k];
    const double square = piece.x() * piece.x() + piece.y() * piece.y();
    return square > 0.0 ? (piece.x() * to.x() + piece.y() * to.y()) / square : 2.0;
  }
  /// m, from a piece of the path.
  double away(std::size_t k, const Vec3& at) const {
    return distance(path[k] + std::clamp(along(k, at), 0.0, 1.0) * (path[k + 1] - path[k]), at);
  }
  /// Where the path leaves the circle of radius `reach` about `at`, on the piece that ends at `next`; what of it is
  /// nearest if all of it is farther away.
  Vec3 aim_at(const Vec3& at, double reach) const {
    const Vec3 from = path[next - 1], to = path[next];
    double low = std::clamp(along(next - 1, at), 0.0, 1.0), high = 1.0;
    if (distance(to, at) < reach) return to;
    if (distance(from + low * (to - from), at) >= reach) return from + low * (to - from);
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      (distance(from + middle * (to - from), at) < reach ? low : high) = middle;
    }
    return from + low * (to - from);
  }
};

}  // namespace dem::vehicle
