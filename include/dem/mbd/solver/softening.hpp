#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/derive.hpp>

#include <algorithm>

namespace dem::mbd {

/// Keeps what was derived for one pose stable in others. A joint at a lever L of a body moves it by 1/m + L^2/I per
/// newton. So a spring that was derived for a short lever is too stiff for a long one. Every few steps such springs are
/// lowered to what would be derived in the present pose, with their limits, friction and couplings. Values that users
/// gave are left alone. Nothing is raised again: a strained spring that gets stiffer gains energy, while one that gets
/// softer loses some.
///
/// A part is derived for omega dt = 0.7 and half of critical damping. With each of the integrators it stays stable
/// until a newton moves its bodies 2.1 times as far. So there is time. A part that was too stiff by more than a fifth
/// is looked at again after one step. While the excess stays below a twentieth, the interval doubles each time, up to
/// 64 steps.
class Softening {
 public:
  Softening() = default;
  /// For what has been derived in `m` for steps of dt (s).
  Softening(Parts& m, double dt) : derivation_(m, dt) {
    if (lower(m) < 1.0) derivation_ = {};
  }

  /// To be called at the end of each step.
  void follow(Parts& m);

  template <class V>
  void fields(V& v) {
    v("dt", derivation_.dt, "s"), v("shares", derivation_.shares);
    v("interval", interval_), v("steps_left", steps_left_);
  }

 private:
  static constexpr int longest_interval = 64;  // steps

  /// Returns how many times too stiff the worst one was; 0 if no pose changes anything.
  double lower(Parts& m) const;

  detail::Derivation derivation_;
  int interval_ = 1, steps_left_ = 1;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void Softening::follow(Parts& m) {
  if (derivation_.shares.empty() || --steps_left_ > 0) return;
  const double excess = lower(m);
  interval_ = excess > 1.2 ? 1 : excess > 1.05 ? interval_ : std::min(2 * interval_, longest_interval);
  steps_left_ = interval_;
}

DEM_INLINE double Softening::lower(Parts& m) const {
  double worst = 0.0;
  for (const detail::PartKind* kind : m.kinds) {
    if (kind->soften) worst = std::max(worst, kind->soften(m, derivation_));
  }
  return worst;
}

}  // namespace dem::mbd

#endif
