#pragma once

#include <dem/integrator/motion.hpp>

namespace dem::integrator {

/// The thesis's explicit predictor-corrector (section 2.5): two iterations a step, each evaluates the forces at the
/// newest state and applies the trapezoidal rule from the state at the start of the step (eqs. 14-16). Second order;
/// the amplitude of an undamped spring decays by about (omega dt)^4/8 a step, which keeps stiff contacts quiet. Springs
/// that slip stretches, as those of friction, move on by half a step in each iteration, and lose a quarter of that.
/// Momentum is kept to rounding, angular momentum to second order in dt: see "Numbers" in ARCHITECTURE.md.
struct PredictorCorrector {
  static constexpr int stages = 2;
  static constexpr bool predicts_before_forces = false;
  static constexpr double stability_limit = 2.0;

  template <class T>
  struct Memory {
    Motion<T> start;       ///< state at the start of the step
    Acceleration<T> last;  ///< acceleration at the start of the step, as the last corrector found it
  };

  template <class T>
  static DEM_FN void initialise(Memory<T>& memory, const Acceleration<T>& a) {
    memory.last = a;
  }

  template <class T>
  static DEM_FN void before_forces(int, T, Motion<T>&, Memory<T>&) {}

  template <class T>
  static DEM_HOT void after_forces(int stage, T dt, Motion<T>& m, Memory<T>& memory, const Acceleration<T>& a) {
    if (stage == 0) memory.start = m;
    const Motion<T>& s = memory.start;
    const T half = T(0.5) * dt;
    m.velocity = s.velocity + half * (a.linear + memory.last.linear);
    m.angular_velocity = s.angular_velocity + half * (a.angular + memory.last.angular);
    m.position = s.position + half * (m.velocity + s.velocity);
    m.rotation = s.rotation * rotation_from_vector(half * (m.angular_velocity + s.angular_velocity));
    if (stage == 1) memory.last = a;
  }
};

}  // namespace dem::integrator
