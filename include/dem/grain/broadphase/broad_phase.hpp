#pragma once

#include <dem/core/function_like.hpp>
#include <dem/math/vector.hpp>

#include <concepts>
#include <cstdint>
#include <span>

namespace dem::broadphase {

/// Centres of the grains, n each (m).
struct Positions {
  const double* x;
  const double* y;
  const double* z;
  std::size_t n;
};

/// How far grains reach that are of several sizes.
struct Sizes {
  std::span<const double> radius_of_kind;  ///< m, bounding radius
  const std::uint32_t* kind;               ///< of each grain; null: all have the radius 0
  double gap;                              ///< m: grains nearer than their radii and this are to be found
};

/// A broad phase finds candidates for contact. It has
///   - build(positions, reach): takes note of all grains; two grains farther apart than `reach` need not be found;
///   - build(positions, sizes): optional, then called instead: two farther apart than their radii and the gap need not
///     be found;
///   - either of them with an executor as well: optional, then called instead, for threads to share the work;
///   - finder(): an object of which each thread has its own, with for_each_candidate(i, f). That calls f(j) once for
///     each j > i within reach of i, and for others, in any order. Optional: has_runs() and for_each_run(i, f); where
///     the former is true, the latter calls f(first, last) for runs of those j instead, in rising order, no two of
///     which overlap. That costs less. It is not asked for in worlds with images;
///   - order(): a permutation that puts grains near in space near in memory, or an empty span;
///   - place(x, reach): optional, static: the number by which order() sorts a grain at x. With it, ranks sort grains
///     together of which each has a part;
///   - memory_bytes(): what it holds;
///   - reordered() or reordered(executor): optional: the grains were put in order(). Without it they are built anew.
template <class B>
concept BroadPhase = requires(B& b, const B& built, const Positions& positions, double reach) {
  b.build(positions, reach);
  built.finder().for_each_candidate(std::size_t{0}, FunctionLike<void(std::uint32_t)>{});
  { built.memory_bytes() } -> std::convertible_to<std::size_t>;
  { built.order() } -> std::convertible_to<std::span<const std::uint32_t>>;
};

/// A broad phase that can use that grains are of several sizes.
template <class B>
concept KnowsSizes = requires(B& b, const Positions& positions, const Sizes& sizes) {
  b.build(positions, sizes);
};

/// A broad phase of grains of one reach that sorts each by itself.
template <class B>
concept SortsByPlace = !KnowsSizes<B> && requires(B & b, const Positions& all, const Vector3<double>& x, double reach) {
  { B::place(x, reach) } -> std::same_as<std::uint64_t>;
  b.build(all, reach);
  b.reordered();
};

/// A finder of a broad phase that may know runs of grains.
template <class Finder>
concept FindsRuns = requires(Finder& f) {
  { f.has_runs() } -> std::convertible_to<bool>;
  f.for_each_run(std::size_t{0}, FunctionLike<void(std::uint32_t, std::uint32_t)>{});
};

/// Lets a broad phase take note of grains; threads share the work where it can. `how_far` is a reach (m) or Sizes.
template <class B, class HowFar, class Executor>
void build(B& b, const Positions& at, const HowFar& how_far, Executor& executor) {
  if constexpr (requires { b.build(at, how_far, executor); }) b.build(at, how_far, executor);
  else b.build(at, how_far);
}

/// Tells a broad phase that the grains were put in its order(). False if it has to be built anew.
template <class B, class Executor>
bool reordered(B& b, Executor& executor) {
  if constexpr (requires { b.reordered(executor); }) b.reordered(executor);
  else if constexpr (requires { b.reordered(); }) b.reordered();
  else return false;
  return true;
}

template <class B>
constexpr void check_broad_phase() {
  static_assert(
      requires(B & b, const Positions& positions) { b.build(positions, 1.0); },
      "BroadPhase: needs build(const Positions&, double reach)");
  static_assert(
      BroadPhase<B>,
      "BroadPhase: needs finder() const with for_each_candidate(i, f), which calls f(j) for each j > i; order() const; "
      "memory_bytes() const");
}

}  // namespace dem::broadphase
