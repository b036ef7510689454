#pragma once

#include <dem/core/error.hpp>
#include <dem/law/rolling/rolling_law.hpp>

namespace dem::rolling {

/// Constant torque against rolling: mu_r R* Fn (type A of Ai et al. 2011, doi:10.1016/j.powtec.2010.09.030). It has no
/// spring, so it slows grains down but holds none on a slope: there they creep. Where a step's worth of it would more
/// than stop the rolling (the inertia is that of a ball that twists, the smallest), it only stops it. Each contact does
/// so by itself: a ball that rolls at several at once may spin to and fro by as much as a step's worth of them.
struct ConstantTorque {
  template <class T>
  struct Parameters {
    T coefficient;  ///< mu_r, the tangent of the slope on which a ball begins to roll
    static constexpr const char* names[] = {"coefficient"};
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT Vector3<T> torque(const Parameters<T>& p, const RollingState<T>& s, History<T>&) {
    const T spin = norm(s.rolling);
    const T stopping =
        T(twisting_inertia) * s.effective_mass * s.effective_radius * s.effective_radius * spin / s.whole_step;
    const T size = min(p.coefficient * s.effective_radius * s.normal_force, stopping);
    return -(size / max(spin, T(1e-300)) * s.rolling);
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>&, Turn&&) {}

  static double stiffness(const Parameters<double>&, const contact::NormalState<double>&) { return 0.0; }
  static double energy(const Parameters<double>&, double, const History<double>&) { return 0.0; }
  static void check(const Parameters<double>& p) {
    require_non_negative(p.coefficient, "rolling coefficient", "(no unit)");
  }
};

}  // namespace dem::rolling
