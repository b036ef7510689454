#pragma once

#include <dem/core/stable_time_step.hpp>
#include <dem/core/text.hpp>
#include <dem/vehicle/tyre.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace dem::vehicle {

/// m, the deepest that a tyre may be in the road. Real ones are on their rim before.
inline double deepest_deflection(const TyreSpec& tyre) { return 0.5 * tyre.radius; }

/// Looks at a tyre in each step that is kept, and tells what has gone wrong, each thing once: a wheel that presses
/// deeper into the road than a tyre can, one that began in the road and is thrown out of it, and a time step that is
/// too large for the tyre.
///
/// A tyre of stiffness k and damping c under a wheel of mass m is stable in steps h with k h^2 + 2 c h < 4 m, as long
/// as nothing else bears on the wheel. The wheel is thrown up where that is exceeded, and where its speed changes by as
/// much as the tyre's force makes of its mass alone: a wheel that is held by others is let be.
class TyreWatch {
 public:
  /// After the first evaluation.
  void begin(const TyreSpec& tyre, const Body& wheel, const TyreState& s) {
    const bool can_throw = s.deflection > 0.0 && s.deflection * std::sqrt(tyre.stiffness / wheel.mass) > largest_throw;
    began_ = can_throw ? s.deflection : 0.0;
    begun_ = wheel.velocity(), at_ = s.time;
  }
  /// After an evaluation that is kept, dt (s) on from the one before.
  void look(const TyreSpec& tyre, const Road& road, const Body& wheel, const Vec3& axis, const TyreState& s,
            double dt) {
    const bool presses = s.load > 0.0;
    if (presses && s.deflection > deepest_deflection(tyre) && !is_told_deep_) tell_deep(tyre, wheel, s);
    has_touched_ = has_touched_ || presses;
    if (!has_touched_) gap_ = -depth_in(road, tyre.radius, wheel, axis);
    if (began_ > 0.0) follow_begin(tyre, road, wheel, s);
    if (!wheel.fixed && (tyre.stiffness * dt + 2.0 * tyre.damping) * dt > 4.0 * wheel.mass) {
      follow(tyre, road, wheel, s, dt);
    } else {
      thrown_ = 0.0;
    }
  }
  /// What was found since this was last asked, in words; empty if nothing.
  std::string take() { return std::exchange(found_, {}); }
  /// That the wheel has not touched the road so far, which is more than its radius (m) below it; else empty.
  std::string note(const std::string& wheel, double radius) const {
    if (has_touched_ || !(gap_ > radius)) return {};
    return text("The tyre of body '{}' has not touched the road yet, {:.3g} m below it.", wheel, gap_);
  }

  /// f(number) for all that it remembers. What f makes of the number is taken back.
  template <class F>
  void each(F&& f) {
    f(speed_), f(thrown_), f(gap_), f(began_), f(at_), f(begun_.x()), f(begun_.y()), f(begun_.z());
    for (bool* is : {&has_touched_, &is_told_deep_, &is_told_thrown_}) {
      double number = *is ? 1.0 : 0.0;
      f(number);
      *is = number > 0.0;
    }
  }

 private:
  static constexpr double longest_begin = 0.1;  // s, in which a tyre that begins in the road throws its wheel out
  static constexpr double largest_throw = 5.0;  // m/s

  DEM_SETUP void tell_deep(const TyreSpec& tyre, const Body& wheel, const TyreState& s) {
    is_told_deep_ = true;
    tell(
        text("the tyre of body '{}' is {:.3g} m deep in the road, more than half of its radius, {:g} m; start it "
             "higher, raise its stiffness ({:g} N/m under {:.3g} N), or check the road",
             wheel.name, s.deflection, tyre.radius, tyre.stiffness, s.load));
  }
  static Vec3 normal_under(const Road& road, const TyreSpec& tyre, const Body& wheel) {
    return road.under(wheel.position(), tyre.radius).normal;
  }
  /// Of a tyre that began in the road.
  void follow_begin(const TyreSpec& tyre, const Road& road, const Body& wheel, const TyreState& s) {
    const double speed = (wheel.velocity() - begun_).dot(normal_under(road, tyre, wheel));
    if (speed > largest_throw && !is_told_thrown_) {
      is_told_thrown_ = true;
      tell(
          text("the tyre of body '{}' began {:.3g} m deep in the road and throws the wheel up, by {:.3g} m/s; start it "
               "higher by that, or lower its stiffness ({:g} N/m)",
               wheel.name, began_, speed, tyre.stiffness));
    }
    if (s.load <= 0.0 || s.time - at_ > longest_begin) began_ = 0.0;
  }
  /// Of a tyre that is too stiff or damped for the step.
  void follow(const TyreSpec& tyre, const Road& road, const Body& wheel, const TyreState& s, double dt) {
    const double speed = wheel.velocity().dot(normal_under(road, tyre, wheel));
    const double rise = speed - std::exchange(speed_, speed);
    if (thrown_ > 0.0 && rise > 0.5 * thrown_ && !is_told_thrown_) tell_thrown(tyre, wheel, dt);
    thrown_ = s.load * dt / wheel.mass;
  }
  DEM_SETUP void tell_thrown(const TyreSpec& tyre, const Body& wheel, double dt) {
    is_told_thrown_ = true;
    const double m = wheel.mass, k = tyre.stiffness, c = tyre.damping;
    tell(text(
        "the tyre of body '{}' asks for steps below {:g} s, but they are {:g} s: it throws the wheel up; lower the "
        "time step, raise the machine's substeps, or lower the tyre's stiffness ({:g} N/m) or damping ({:g} N "
        "s/m)",
        wheel.name, rounded_down(m / (c + std::sqrt(c * c + m * k))), dt, k, c));  // k h^2 + 2 c h = m
  }
  void tell(const std::string& what) { found_ += (found_.empty() ? "" : "; ") + what; }

  double speed_ = 0.0;         // m/s, out of the road, in the step before; of a tyre that is too stiff or damped
  double thrown_ = 0.0;        // m/s a step, likewise
  double gap_ = 0.0;           // m, to the road, of a tyre that has not touched it yet
  double began_ = 0.0;         // m, in the road at the begin, where that can throw the wheel; 0 once that is over
  double at_ = 0.0;            // s, of the begin
  Vec3 begun_ = Vec3::Zero();  // m/s, of the wheel at the begin
  bool has_touched_ = false, is_told_deep_ = false, is_told_thrown_ = false;
  std::string found_;
};

}  // namespace dem::vehicle
