#pragma once

#include <dem/law/state.hpp>

#include <concepts>

namespace dem::contact {

/// A normal law is a struct of static functions and two struct templates of Ts:
///   Parameters<T>  constants of a pair of materials. It may have `static constexpr const char* names[]` with the names
///                  of all of them, by which messages tell them;
///   History<T>     what a contact has to remember between steps (empty if nothing): numbers, no vectors, as they
///                  are neither turned with the contact nor turned round where two grains change places;
///   force(parameters, state, history) -> T   the repulsive force in N (the world cuts off negative values only if the
///                  law does, with max(T(0), f): in this order a NaN stays one and is reported; a law that pulls is
///                  allowed);
///   stiffness(parameters, state) -> double   the largest slope dF/d(overlap) in N/m, from which the stable time step
///                  follows;
///   check(parameters)   throws dem::Error, in words, if a constant makes no sense;
///   damping(parameters, state) -> double   optional: the largest slope dF/d(approach speed) in N s/m, which shortens
///                  the stable time step as well;
///   inherited(history, overlap) -> History<double>   optional: what a point that turns up in a patch (of polyhedra)
///                  with this overlap remembers, from the mean of what the patch's points did; else it is new.
///   energy(parameters, state, history) -> double   optional: what the contact stores and gives back, in J. Without it
///                  all work on the law counts as dissipated (dem::energy_of).
/// The state for stiffness and damping is the deepest that a world allows (WorldOptions::overlap_limit).
template <class L>
concept NormalLaw = requires(const typename L::template Parameters<double>& p, const NormalState<double>& state,
                             typename L::template History<double>& history) {
  { L::force(p, state, history) } -> std::same_as<double>;
  { L::stiffness(p, state) } -> std::convertible_to<double>;
  L::check(p);
};

/// The damping of a law that tells it, in N s/m; 0 for one that does not.
template <class L>
double damping_of(const typename L::template Parameters<double>& p, const NormalState<double>& state) {
  if constexpr (requires { L::damping(p, state); }) {
    return L::damping(p, state);
  } else {
    return 0.0;
  }
}

/// What a new point of a patch remembers of the normal law, from the mean of what the patch's points did.
template <class L>
typename L::template History<double> inherited_by_point(const typename L::template History<double>& mean,
                                                        double overlap) {
  if constexpr (requires { L::inherited(mean, overlap); }) {
    return L::inherited(mean, overlap);
  } else {
    return {};
  }
}

template <class L>
constexpr void check_normal_law() {
  static_assert(
      requires { typename L::template Parameters<double>; },
      "NormalLaw: needs 'template <class T> struct Parameters', the constants of a pair of materials");
  static_assert(
      requires { typename L::template History<double>; },
      "NormalLaw: needs 'template <class T> struct History', what a contact remembers (may be empty)");
  static_assert(
      contact::holds_numbers_alone<L::template Parameters> && contact::holds_numbers_alone<L::template History>,
      "NormalLaw: Parameters<T> and History<T> hold nothing but Ts; write T for a bool, an int or a double");
  static_assert(
      requires(const typename L::template Parameters<double>& p, const NormalState<double>& state,
               typename L::template History<double>& history) {
        { L::force(p, state, history) } -> std::same_as<double>;
      },
      "NormalLaw: needs 'template <class T> static T force(const Parameters<T>&, const NormalState<T>&, History<T>&)' "
      "that returns the repulsive force as a T");
  static_assert(NormalLaw<L>,
                "NormalLaw: needs static stiffness(const Parameters<double>&, const NormalState<double>&) in N/m and "
                "check(const Parameters<double>&)");
}

}  // namespace dem::contact
