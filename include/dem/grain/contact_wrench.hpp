#pragma once

#include <dem/geometry/contact_point.hpp>
#include <dem/grain/contact_list.hpp>
#include <dem/grain/materials.hpp>
#include <dem/law/cohesion/none.hpp>
#include <dem/law/rolling/none.hpp>

#include <array>
#include <bit>
#include <type_traits>

namespace dem::grain {

/// Motion of the two partners of a contact relative to each other, global axes.
template <class T>
struct RelativeMotion {
  Vector3<T> separation;                              ///< m, from the centre of i to the centre of j
  Vector3<T> velocity;                                ///< m/s, of the centre of i minus that of j
  Vector3<T> angular_velocity_i, angular_velocity_j;  ///< rad/s, global
  T inverse_mass;                                     ///< 1/kg, 1/mi + 1/mj
};

template <class T>
struct PairWrench {
  Vector3<T> force;               ///< N, on i; the partner feels the opposite
  Vector3<T> torque_i, torque_j;  ///< N m, each about its own centre
};

/// Zero in every field of a history where (in the lanes where) the condition does not hold.
template <class T, class Mask, class History>
DEM_HOT void forget_unless(const Mask& condition, History& h) {
  if constexpr (!std::is_empty_v<History>) {
    auto fields = std::bit_cast<std::array<T, sizeof(History) / sizeof(T)>>(h);
    for (T& field : fields) field = select(condition, field, T(0));
    h = std::bit_cast<History>(fields);
  }
}

/// The normal force of the laws: repulsion minus cohesion on the grains, and what presses the contact together, which
/// limits friction, rolling resistance and torsion (see cohesion::Attraction).
template <class T>
struct NormalForce {
  T repulsion;  ///< N, of i on j along the normal
  T pressing;   ///< N
};
template <class Model, class T>
DEM_HOT NormalForce<T> normal_force(const contact::NormalState<T>& state, const ContactParameters<Model, T>& parameters,
                                    ContactHistory<Model, T>& history) {
  using Cohesion = typename Model::Cohesion;
  if constexpr (std::is_same_v<Cohesion, cohesion::None>) {
    const T force = Model::Normal::force(parameters.normal, state, history.normal);
    return {force, max(T(0), force)};  // a law that pulls presses nothing together
  } else {
    contact::NormalState<T> touching = state;
    if constexpr (cohesion::reaches<Cohesion>) touching.overlap = max(T(0), state.overlap);
    T force = Model::Normal::force(parameters.normal, touching, history.normal);
    if constexpr (cohesion::reaches<Cohesion>) {  // across a gap the normal law does nothing and remembers nothing
      force = select(state.overlap < T(0), T(0), force);
      forget_unless<T>(state.overlap >= T(0), history.normal);
    }
    const cohesion::Attraction<T> a = Cohesion::force(parameters.cohesion, state, history.cohesion);
    return {force - a.pull, max(T(0), force + a.grip)};
  }
}

/// The laws applied to one contact (T = double) or to a pack of contacts in a step of dt: eqs. 20-30. Updates the
/// history and returns the wrench and, in `overlap_ratio`, the overlap in effective diameters. Each of the integrator's
/// stages moves histories on by its share of the step. With two stages, at the step's start and end, that is the
/// trapezoidal rule by which the partners move as well, so that springs stretch by what the partners slip.
template <class Model, class T, class ContactPoint>
DEM_HOT PairWrench<T> contact_wrench(const ContactPoint& point, const RelativeMotion<T>& e,
                                     const ContactParameters<Model, T>& parameters, T dt,
                                     ContactHistory<Model, T>& history, T& overlap_ratio) {
  const contact::Geometry<T> g = point.geometry();
  const Vector3<T> arm_j = g.arm - e.separation;
  const Vector3<T> velocity = e.velocity + cross(e.angular_velocity_i, g.arm) - cross(e.angular_velocity_j, arm_j);
  const T approach = dot(velocity, g.normal);
  const Vector3<T> sliding = velocity - approach * g.normal;
  const T mass = T(1) / (e.inverse_mass * g.total_share);
  const T followed = T(1.0 / Model::Integrator::stages) * dt;

  const NormalForce<T> normal = normal_force<Model>(
      contact::NormalState<T>{g.overlap, approach, g.effective_radius, mass, followed, dt}, parameters, history);

  // The history's vectors follow the contact: they turn with the mean twist of the partners about the normal and stay
  // in the tangent plane.
  const T twist = T(0.5) * followed * dot(e.angular_velocity_i + e.angular_velocity_j, g.normal);
  const auto turn = [&](const Vector3<T>& v) { return v + twist * cross(g.normal, v) - dot(g.normal, v) * g.normal; };
  Model::Friction::carry(history.friction, turn);
  const Vector3<T> friction = Model::Friction::force(
      parameters.friction,
      contact::TangentialState<T>{sliding, normal.pressing, g.overlap, g.effective_radius, mass, followed, dt},
      history.friction);

  const Vector3<T> force = g.weight * (friction - normal.repulsion * g.normal);
  overlap_ratio = T(0.5) * g.overlap / g.effective_radius;
  PairWrench<T> wrench = {force, cross(g.arm, force), -cross(arm_j, force)};
  if constexpr (!std::is_same_v<typename Model::Rolling, rolling::None>) {
    const Vector3<T> turning = e.angular_velocity_i - e.angular_velocity_j;
    const T twisting = dot(turning, g.normal);
    Model::Rolling::carry(history.rolling, turn);
    const Vector3<T> torque =
        g.weight *
        Model::Rolling::torque(parameters.rolling,
                               rolling::RollingState<T>{g.normal, turning - twisting * g.normal, twisting,
                                                        normal.pressing, g.effective_radius, mass, followed, dt},
                               history.rolling);
    wrench.torque_i += torque;
    wrench.torque_j -= torque;
  }
  return wrench;
}

}  // namespace dem::grain
