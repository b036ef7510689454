#pragma once

#include <dem/core/function_like.hpp>
#include <dem/law/normal/normal_law.hpp>

#include <concepts>

namespace dem::friction {

using contact::TangentialState;

/// A law that tells its stiffness, which may depend on the overlap.
template <class L>
concept HasStiffness = requires(const typename L::template Parameters<double>& p,
                                const contact::NormalState<double>& state) {
  { L::stiffness(p, state) } -> std::convertible_to<double>;
}
|| requires(const typename L::template Parameters<double>& p) {
  { L::stiffness(p) } -> std::convertible_to<double>;
};

/// A friction law is a struct of static functions and two struct templates of Ts, like a normal law:
///   Parameters<T>, History<T>, check(parameters), stiffness(parameters) in N/m, or stiffness(parameters, NormalState)
///   where it depends on the overlap, optionally damping(parameters, NormalState) in N s/m, and
///   force(parameters, state, history) -> Vector3<T>   the force on i in N, in the tangent plane.
///   energy(parameters, history) -> double   optional: what the history's springs store, in J; without it none.
/// Vectors in a History are given in global axes; before each call the world turns them with the contact, and
/// carry(history, turn) says how: it applies `turn` to every vector member.
template <class L>
concept FrictionLaw = HasStiffness<L> &&
    requires(const typename L::template Parameters<double>& p, const TangentialState<double>& state,
             typename L::template History<double>& history) {
  { L::force(p, state, history) } -> std::same_as<Vector3<double>>;
  L::check(p);
  L::carry(history, FunctionLike<Vector3<double>(const Vector3<double>&)>{});
};

/// A friction law's stiffness, in N/m.
template <HasStiffness L>
double stiffness_of(const typename L::template Parameters<double>& p, const contact::NormalState<double>& state) {
  if constexpr (requires { L::stiffness(p, state); }) {
    return L::stiffness(p, state);
  } else {
    return L::stiffness(p);
  }
}

template <class L>
constexpr void check_friction_law() {
  static_assert(
      requires { typename L::template Parameters<double>; },
      "FrictionLaw: needs 'template <class T> struct Parameters', the constants of a pair of materials");
  static_assert(
      requires { typename L::template History<double>; },
      "FrictionLaw: needs 'template <class T> struct History', what a contact remembers (may be empty)");
  static_assert(
      contact::holds_numbers_alone<L::template Parameters> && contact::holds_numbers_alone<L::template History>,
      "FrictionLaw: Parameters<T> and History<T> hold nothing but Ts; write T for a bool, an int or a double");
  static_assert(
      requires(const typename L::template Parameters<double>& p, const TangentialState<double>& state,
               typename L::template History<double>& history) {
        { L::force(p, state, history) } -> std::same_as<Vector3<double>>;
      },
      "FrictionLaw: needs 'template <class T> static Vector3<T> force(const Parameters<T>&, const "
      "TangentialState<T>&, History<T>&)' that returns the force on i as a Vector3<T>");
  static_assert(FrictionLaw<L>,
                "FrictionLaw: needs static stiffness(const Parameters<double>&) in N/m, check(const "
                "Parameters<double>&) and carry(History<T>&, turn), which applies turn to every vector of the history");
}

}  // namespace dem::friction
