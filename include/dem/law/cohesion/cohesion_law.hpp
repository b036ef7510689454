#pragma once

#include <dem/law/normal/normal_law.hpp>

#include <concepts>

namespace dem::cohesion {

using contact::NormalState;

/// What cohesion does to a contact. The force between the partners is the normal law's repulsion minus `pull`.
/// Friction, rolling resistance and torsion are limited by the repulsion plus `grip`, not negative: the repulsion that
/// balances a pull is as good for friction as any other (Derjaguin's law, Ft = mu (F + adhesion)), so most laws have no
/// grip.
template <class T>
struct Attraction {
  T pull;  ///< N, draws the partners together
  T grip;  ///< N
};

/// A cohesion law is a struct of static functions and two struct templates of Ts, like a normal law:
///   Parameters<T>, History<T> (numbers, no vectors), check(parameters),
///   force(parameters, state, history) -> Attraction<T>, where the overlap may be negative (a gap) if the law reaches;
///   stiffness(parameters, state) -> double   the largest slope of the pull against the overlap in N/m;
///   range(parameters, radius) -> double      only of a law that acts at a distance: the largest gap in m at which
///                  partners of that effective radius (or a smaller one) still attract each other. The search, the
///                  narrow phase and the histories of contacts then keep pairs up to that gap;
///   energy(parameters, state, history) -> double   optional: the potential of the pull in J, 0 where the partners are
///                  apart for good, so negative where they hold each other; without it none;
///   NormalLaw, check_with(parameters, its parameters)   only of a law that is made for one normal law.
template <class L>
concept CohesionLaw = requires(const typename L::template Parameters<double>& p, const NormalState<double>& state,
                               typename L::template History<double>& history) {
  { L::force(p, state, history) } -> std::same_as<Attraction<double>>;
  { L::stiffness(p, state) } -> std::convertible_to<double>;
  L::check(p);
};

/// True if a law acts at a distance.
template <class L>
inline constexpr bool reaches = requires(const typename L::template Parameters<double>& p) {
  L::range(p, 1.0);
};

/// Throws Error if the constants of a law that is made for one normal law do not fit that law's.
template <class L, class NormalParameters>
void check_with_normal_law(const typename L::template Parameters<double>& p, const NormalParameters& normal) {
  if constexpr (requires { L::check_with(p, normal); }) L::check_with(p, normal);
}

template <class L, class Normal>
constexpr void check_cohesion_law() {
  if constexpr (requires { typename L::NormalLaw; }) {
    static_assert(std::same_as<Normal, typename L::NormalLaw>,
                  "CohesionLaw: this one is made for one normal law (its NormalLaw), but the model names another");
  }
  static_assert(
      requires { typename L::template Parameters<double>; },
      "CohesionLaw: needs 'template <class T> struct Parameters', the constants of a pair of materials");
  static_assert(
      requires { typename L::template History<double>; },
      "CohesionLaw: needs 'template <class T> struct History', what a contact remembers (may be empty)");
  static_assert(
      contact::holds_numbers_alone<L::template Parameters> && contact::holds_numbers_alone<L::template History>,
      "CohesionLaw: Parameters<T> and History<T> hold nothing but Ts; write T for a bool, an int or a double");
  static_assert(
      requires(const typename L::template Parameters<double>& p, const NormalState<double>& state,
               typename L::template History<double>& history) {
        { L::force(p, state, history) } -> std::same_as<Attraction<double>>;
      },
      "CohesionLaw: needs 'template <class T> static Attraction<T> force(const Parameters<T>&, const NormalState<T>&, "
      "History<T>&)' that returns pull and grip");
  static_assert(CohesionLaw<L>,
                "CohesionLaw: needs static stiffness(const Parameters<double>&, const NormalState<double>&) in N/m and "
                "check(const Parameters<double>&)");
}

}  // namespace dem::cohesion
