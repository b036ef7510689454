#pragma once

#include <dem/core/error.hpp>
#include <dem/law/friction/friction_law.hpp>
#include <dem/law/friction/spring_slider.hpp>

struct SlipWeakening {  // a spring that slips at mu Fn, mu falling from `coefficient` to `residual` over `distance`
  template <class T>
  struct Parameters {
    T coefficient, residual, distance, stiffness, damping;
  };
  template <class T>
  struct History {
    dem::Vector3<T> spring;
    T slipped;
  };

  template <class T>
  static DEM_HOT dem::Vector3<T> force(const Parameters<T>& p, const dem::contact::TangentialState<T>& s,
                                       History<T>& h) {
    const T mu = p.coefficient - (p.coefficient - p.residual) * dem::min(T(1), h.slipped / p.distance);
    dem::Vector3<T> spring = p.stiffness * (h.spring + s.time_step * s.velocity);
    const T trial = norm(spring);
    const dem::Vector3<T> f = dem::friction::slide(spring, p.damping, s.velocity, mu * s.normal_force);
    h.slipped += (trial - norm(spring)) / p.stiffness;
    h.spring = T(1) / p.stiffness * spring;
    return -f;
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>& h, Turn&& turn) {  // vectors turn with the contact
    h.spring = turn(h.spring);
  }
  static double stiffness(const Parameters<double>& p) { return p.stiffness; }
  static void check(const Parameters<double>& p) {
    dem::require_within(p.residual, 0.0, p.coefficient, "residual friction");
  }
};
