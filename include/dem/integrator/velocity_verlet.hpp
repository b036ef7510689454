#pragma once

#include <dem/integrator/motion.hpp>

namespace dem::integrator {

/// Velocity Verlet (kick, drift, forces, kick): one force evaluation a step. Second order, but first order where forces
/// depend on velocity, as these see the half-step velocity (usual in DEM codes).
struct VelocityVerlet {
  static constexpr int stages = 1;
  static constexpr bool predicts_before_forces = true;
  static constexpr double stability_limit = 2.0;

  template <class T>
  struct Memory {
    Vector3<T> linear, angular;  ///< acceleration at the end of the last step
  };

  template <class T>
  static DEM_FN void initialise(Memory<T>& last, const Acceleration<T>& a) {
    last.linear = a.linear;
    last.angular = a.angular;
  }

  template <class T>
  static DEM_HOT void before_forces(int, T dt, Motion<T>& m, Memory<T>& last) {
    const T half = T(0.5) * dt;
    m.velocity += half * last.linear;
    m.angular_velocity += half * last.angular;
    m.position += dt * m.velocity;
    turn(m.rotation, dt * m.angular_velocity);
  }

  template <class T>
  static DEM_HOT void after_forces(int, T dt, Motion<T>& m, Memory<T>& last, const Acceleration<T>& a) {
    const T half = T(0.5) * dt;
    m.velocity += half * a.linear;
    m.angular_velocity += half * a.angular;
    last.linear = a.linear;
    last.angular = a.angular;
  }
};

}  // namespace dem::integrator
