#pragma once

#include <dem/geometry/any_callback.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <variant>

namespace dem::surface {

/// Axis-aligned bounding box.
struct Aabb {
  Vec3 low, high;  ///< m
};

/// A surface is what a machine part shows to the grains, a solid in its own frame. It has
///   near(point, radius)   false only if a sphere there cannot touch. It is cheap and may say true too often. It takes
///                         doubles, and packs, for which it gives a mask;
///   contacts(point, radius, callback)   calls callback(feature, normal, gap) once per contact of the sphere, features
///                         ascending. The unit normal leads from the sphere into the surface. The gap is the distance
///                         along it from the sphere's centre to the surface, negative inside;
///   bounds()              in its own frame; infinite where it has no end.
/// What it may also have stands in surface_traits.hpp.
template <class S>
concept Surface = requires(const S& s, const Vector3<double>& point, double radius, const Vector3<Pack>& points) {
  { s.near(point, radius) } -> std::same_as<bool>;
  { s.near(points, Pack(radius)) } -> std::same_as<PackMask>;
  s.contacts(point, radius, AnyCallback{});
  { s.bounds() } -> std::same_as<Aabb>;
};

/// Cuts the range [from, to] of shares of a way to where |x + share step| < half; false if nothing is left.
inline bool clip_between(double x, double step, double half, double& from, double& to) {
  if (step == 0.0) return std::abs(x) < half && from < to;
  const double one = (-half - x) / step, other = (half - x) / step;
  from = std::max(from, std::min(one, other));
  to = std::min(to, std::max(one, other));
  return from < to;
}

/// Parts of one edge in a solid that contacts of bodies can tell apart: the prongs of a fork, across a blade. Beyond
/// them the prongs' own edges still feel the blade.
inline constexpr std::uint32_t most_parts = 4;

template <class S>
constexpr void check_surface() {
  static_assert(
      requires(const S& s) {
        { s.bounds() } -> std::same_as<Aabb>;
      },
      "Surface: needs bounds() that returns surface::Aabb in the surface's own frame");
  static_assert(Surface<S>,
                "Surface: needs near(point, radius), for doubles (bool) and packs (PackMask), and "
                "contacts(point, radius, callback)");
}

/// The kinds of surface that a model's machine parts may have.
template <Surface... Kinds>
using Set = std::variant<Kinds...>;

template <class Kind, class Set>
inline constexpr bool is_one_of = false;
template <class Kind, class... Kinds>
inline constexpr bool is_one_of<Kind, std::variant<Kinds...>> = (std::is_same_v<Kind, Kinds> || ...);

}  // namespace dem::surface
