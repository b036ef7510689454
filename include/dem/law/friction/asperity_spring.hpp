#pragma once

#include <dem/core/error.hpp>
#include <dem/law/friction/friction_law.hpp>

namespace dem::friction {

/// Asperity-spring friction (thesis section 2.2.2, eqs. 29-30): a spring to an anchor point that slips when the
/// asperities break, in parallel with a velocity ramp. `slip` is the vector from the anchor to the contact point.
///   spring   f = kt |slip|; where f > mu Fn the anchor moves until the spring keeps breaking_factor * mu Fn
///   ramp     min(cv |vt|, mu Fn) against the sliding velocity
/// The sum of both never exceeds mu Fn. A contact that sticks is damped by the whole ramp, so its slope counts in the
/// stable time step.
struct AsperitySpring {
  template <class T>
  struct Parameters {
    T coefficient;         ///< mu
    T stiffness;           ///< kt, N/m
    T velocity_stiffness;  ///< cv, N s/m
    T breaking_factor;     ///< in [0, 1]; 0: a broken asperity loses its whole force
    static constexpr const char* names[] = {"coefficient", "stiffness", "velocity_stiffness", "breaking_factor"};
  };
  template <class T>
  struct History {
    Vector3<T> slip;  ///< m
  };

  template <class T>
  static DEM_HOT Vector3<T> force(const Parameters<T>& p, const TangentialState<T>& s, History<T>& h) {
    const T tiny = T(1e-300);  // keeps 0/0 away; far below any length or force that matters
    const T limit = p.coefficient * s.normal_force;

    h.slip += s.time_step * s.velocity;
    const T stretch = p.stiffness * norm(h.slip);
    h.slip = select(stretch > limit, p.breaking_factor * limit / max(stretch, tiny), T(1)) * h.slip;

    const T speed = norm(s.velocity);
    const T ramp = min(p.velocity_stiffness * speed, limit) / max(speed, tiny);
    const Vector3<T> sum = p.stiffness * h.slip + ramp * s.velocity;
    const T size = norm(sum);
    return -(select(size > limit, limit / max(size, tiny), T(1)) * sum);
  }

  template <class T, class Turn>
  static DEM_HOT void carry(History<T>& h, Turn&& turn) {
    h.slip = turn(h.slip);
  }

  static double stiffness(const Parameters<double>& p) { return p.stiffness; }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>&) {
    return p.velocity_stiffness;
  }
  static double energy(const Parameters<double>& p, const History<double>& h) {
    return 0.5 * p.stiffness * dot(h.slip, h.slip);
  }

  static void check(const Parameters<double>& p) {
    require_non_negative(p.coefficient, "friction coefficient", "(no unit)");
    require_non_negative(p.stiffness, "friction spring stiffness", "N/m");
    require_non_negative(p.velocity_stiffness, "friction velocity stiffness", "N s/m");
    require_within(p.breaking_factor, 0.0, 1.0, "asperity breaking factor");
  }
};

}  // namespace dem::friction
