#pragma once

#include <dem/mbd/solver/derive.hpp>

#include <algorithm>

namespace dem::mbd {

/// Keeps what was derived for one pose stable in others. A joint at a lever L of a body moves it by 1/m + L^2/I per
/// newton, so a spring that was laid out for a short lever is too stiff for a long one. Every few steps such springs
/// are lowered to what would be derived in the present pose, with their limits, friction and couplings; users' values
/// are left alone. Nothing is raised again, as a strained spring that gets stiffer gains energy, while one that gets
/// softer loses some.
///
/// Laid out at omega dt = 0.7 and half of critical damping, a part stays stable until a newton moves its bodies 2.1
/// times as far, with each of the integrators. So it is looked at again after a single step where it was found too
/// stiff by a fifth, and each time twice as late, up to 64 steps, where it was by less than a twentieth.
class Softening {
 public:
  Softening() = default;
  /// For what has been derived in `m` for steps of dt (s).
  Softening(Parts& m, double dt) : derivation_(m, dt) {
    if (lower(m) < 1.0) derivation_ = {};
  }

  /// To be called at the end of each step.
  void follow(Parts& m) {
    if (derivation_.shares.empty() || --steps_left_ > 0) return;
    const double excess = lower(m);
    interval_ = excess > 1.2 ? 1 : excess > 1.05 ? interval_ : std::min(2 * interval_, longest_interval);
    steps_left_ = interval_;
  }

 private:
  static constexpr int longest_interval = 64;  // steps

  /// Returns how many times too stiff the worst one was; 0 if no pose changes anything.
  double lower(Parts& m) const {
    double worst = 0.0;
    for (const detail::PartKind* kind : m.kinds) {
      if (kind->soften) worst = std::max(worst, kind->soften(m, derivation_));
    }
    return worst;
  }

  detail::Derivation derivation_;
  int interval_ = 1, steps_left_ = 1;
};

}  // namespace dem::mbd
