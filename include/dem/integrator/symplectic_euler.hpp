#pragma once

#include <dem/integrator/motion.hpp>

namespace dem::integrator {

/// Symplectic (semi-implicit) Euler: v += a dt, x += v dt. One force evaluation a step, first order, no energy drift;
/// the fastest choice, and identical in position to the leapfrog scheme when forces do not depend on velocity.
struct SymplecticEuler {
  static constexpr int stages = 1;
  static constexpr bool predicts_before_forces = false;
  static constexpr double stability_limit = 2.0;

  template <class T>
  struct Memory {};

  template <class T>
  static DEM_FN void initialise(Memory<T>&, const Acceleration<T>&) {}

  template <class T>
  static DEM_FN void before_forces(int, T, Motion<T>&, Memory<T>&) {}

  template <class T>
  static DEM_HOT void after_forces(int, T dt, Motion<T>& m, Memory<T>&, const Acceleration<T>& a) {
    m.velocity += dt * a.linear;
    m.angular_velocity += dt * a.angular;
    m.position += dt * m.velocity;
    turn(m.rotation, dt * m.angular_velocity);
  }
};

}  // namespace dem::integrator
