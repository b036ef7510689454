#pragma once

#include <dem/core/function_like.hpp>
#include <dem/law/normal/normal_law.hpp>

#include <concepts>

namespace dem::rolling {

/// What a law of rolling resistance or torsion may read about one contact (T = double) or a pack of contacts.
template <class T>
struct RollingState {
  Vector3<T> normal;         ///< unit vector from i towards j
  Vector3<T> rolling;        ///< rad/s, spin of i relative to j, without its part about the normal
  T twisting;                ///< rad/s, spin of i relative to j about the normal
  T normal_force;            ///< N, not negative: what friction is limited by
  T effective_radius;        ///< m
  T effective_mass;          ///< kg
  T time_step;               ///< s, as of contact::NormalState
  T whole_step = time_step;  ///< s, that the torque acts for
};

// Inertia of two partners against rolling and twisting over each other, in units of m* R*^2: exact for a solid ball on
// a fixed plane, which turns about the contact point (7/5) or about the normal (2/5).
inline constexpr double rolling_inertia = 1.4, twisting_inertia = 0.4;

/// A rolling law is a struct of static functions and two struct templates of Ts, like a friction law:
///   Parameters<T>, History<T>, check(parameters),
///   torque(parameters, state, history) -> Vector3<T>   the torque on i in N m; j feels the opposite;
///   stiffness(parameters, NormalState) -> double       the largest slope d(torque)/d(angle) in N m, and, optionally,
///   damping(parameters, NormalState) -> double         the largest slope d(torque)/d(spin) in N m s;
///   energy(parameters, radius, history) -> double      optional: what the history's springs store in J, for an
///                                                      effective radius in m; without it none;
///   carry(history, turn)                               applies `turn` to every vector of the history.
template <class L>
concept RollingLaw = requires(const typename L::template Parameters<double>& p, const RollingState<double>& state,
                              const contact::NormalState<double>& contact,
                              typename L::template History<double>& history) {
  { L::torque(p, state, history) } -> std::same_as<Vector3<double>>;
  { L::stiffness(p, contact) } -> std::convertible_to<double>;
  L::check(p);
  L::carry(history, FunctionLike<Vector3<double>(const Vector3<double>&)>{});
};

template <class L>
constexpr void check_rolling_law() {
  static_assert(
      requires { typename L::template Parameters<double>; },
      "RollingLaw: needs 'template <class T> struct Parameters', the constants of a pair of materials");
  static_assert(
      requires { typename L::template History<double>; },
      "RollingLaw: needs 'template <class T> struct History', what a contact remembers (may be empty)");
  static_assert(
      contact::holds_numbers_alone<L::template Parameters> && contact::holds_numbers_alone<L::template History>,
      "RollingLaw: Parameters<T> and History<T> hold nothing but Ts; write T for a bool, an int or a double");
  static_assert(
      requires(const typename L::template Parameters<double>& p, const RollingState<double>& state,
               typename L::template History<double>& history) {
        { L::torque(p, state, history) } -> std::same_as<Vector3<double>>;
      },
      "RollingLaw: needs 'template <class T> static Vector3<T> torque(const Parameters<T>&, const RollingState<T>&, "
      "History<T>&)' that returns the torque on i as a Vector3<T>");
  static_assert(RollingLaw<L>,
                "RollingLaw: needs static stiffness(const Parameters<double>&, const contact::NormalState<double>&) in "
                "N m, check(const Parameters<double>&) and carry(History<T>&, turn), which applies turn to every "
                "vector of the history");
}

}  // namespace dem::rolling
