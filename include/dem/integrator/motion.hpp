#pragma once

#include <dem/math/rotation.hpp>

#include <concepts>

namespace dem::integrator {

/// What an integrator advances: one rigid body (T = double) or a pack of grains (T = Pack). Angular velocity is in the
/// body frame, as the thesis writes the rotational equations (eq. 13), so the inertia stays constant.
template <class T>
struct Motion {
  Vector3<T> position;          ///< m, centre of mass, global frame
  Vector3<T> velocity;          ///< m/s, global frame
  Vector3<T> angular_velocity;  ///< rad/s, body frame
  Matrix3<T> rotation;          ///< body frame -> global frame
  template <class V>
  void fields(V& v) {
    v("position", position, "m"), v("velocity", velocity, "m/s"), v("angular_velocity", angular_velocity, "rad/s");
    v("rotation", rotation);
  }
};

template <class T>
struct Acceleration {
  Vector3<T> linear;   ///< m/s^2, global frame
  Vector3<T> angular;  ///< rad/s^2, body frame
};

/// Angular acceleration in the body frame from eq. 13, I w' = T - w x (I w), with the principal inertia; a component
/// whose inverse inertia is zero does not turn. The gyroscopic term is taken at the spin `lead` (s) ahead: integrators
/// that evaluate once a step use half a step, without which the term is explicit Euler and an asymmetric body gains
/// energy.
template <class T>
DEM_HOT Vector3<T> angular_acceleration(const Vector3<T>& torque_body, const Vector3<T>& w, const Vector3<T>& inertia,
                                        const Vector3<T>& inverse_inertia, const T& lead = T(0)) {
  const auto at = [&](const Vector3<T>& spin) {
    const Vector3<T> momentum = {inertia.x * spin.x, inertia.y * spin.y, inertia.z * spin.z};
    const Vector3<T> net = torque_body - cross(spin, momentum);
    return Vector3<T>{inverse_inertia.x * net.x, inverse_inertia.y * net.y, inverse_inertia.z * net.z};
  };
  return at(w + lead * at(w));
}

/// How far ahead an integrator wants the gyroscopic term, in a step of dt (s).
template <class I>
constexpr double gyroscopic_lead(double dt) {
  return I::stages == 1 ? 0.5 * dt : 0.0;
}

/// R <- R * R(angle), eq. 16.
template <class T>
DEM_FN void turn(Matrix3<T>& rotation, const Vector3<T>& angle_body) {
  rotation = rotation * rotation_from_vector(angle_body);
}

/// An integrator advances a motion by one step in `stages` force evaluations. In each stage the world calls
/// before_forces (if predicts_before_forces), evaluates the forces, and calls after_forces. Memory<T> is what has to be
/// kept per body between calls: a plain struct of Ts, empty if nothing is; initialise fills it from the acceleration of
/// the initial state, before the first step. Each evaluation moves what contacts remember on by dt/stages, at its own
/// velocities: stages must be such that these together are the rule by which after_forces moves positions.
template <class I>
concept Integrator = requires(int stage, double dt, Motion<double>& m, typename I::template Memory<double>& memory,
                              const Acceleration<double>& a) {
  { I::stages } -> std::convertible_to<int>;
  { I::predicts_before_forces } -> std::convertible_to<bool>;
  { I::stability_limit } -> std::convertible_to<double>;
  I::template initialise<double>(memory, a);
  I::template before_forces<double>(stage, dt, m, memory);
  I::template after_forces<double>(stage, dt, m, memory, a);
};

template <class I>
constexpr void check_integrator() {
  static_assert(
      requires { I::stages; }, "Integrator: needs 'static constexpr int stages', the force evaluations per step");
  static_assert(
      requires { typename I::template Memory<double>; },
      "Integrator: needs 'template <class T> struct Memory', a struct of Ts kept per body (may be empty)");
  static_assert(
      requires { I::stability_limit; },
      "Integrator: needs 'static constexpr double stability_limit', the largest omega*dt of an undamped spring");
  static_assert(Integrator<I>,
                "Integrator: needs static initialise<T>(Memory<T>&, const Acceleration<T>&), before_forces<T>(stage, "
                "dt, Motion<T>&, Memory<T>&) and "
                "after_forces<T>(stage, dt, Motion<T>&, Memory<T>&, const Acceleration<T>&)");
}

}  // namespace dem::integrator
