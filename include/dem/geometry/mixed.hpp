#pragma once

#include <dem/geometry/superquadric/superquadric_pairs.hpp>

#include <tuple>
#include <type_traits>
#include <variant>

namespace dem::shape {

namespace detail {

/// For each ordered pair of kinds what it keeps between searches; alternative 0 is nothing.
template <class... Kinds>
struct MixedWarmStarts {
  template <class A>
  using Row = std::tuple<typename WarmStartOf<A, Kinds>::type...>;
  template <class... Starts>
  static std::variant<NoWarmStart, Starts...> as_variant(std::tuple<Starts...>);
  using Variant = decltype(as_variant(std::tuple_cat(std::declval<Row<Kinds>>()...)));

  template <class A>
  static constexpr bool row_has_warm_start = !(std::same_as<typename WarmStartOf<A, Kinds>::type, NoWarmStart> && ...);
  static constexpr bool any = (row_has_warm_start<Kinds> || ...);
};

/// Gives Mixed its WarmStart only where some pair of kinds needs one.
template <bool Any, class... Kinds>
struct MixedBase {};
template <class... Kinds>
struct MixedBase<true, Kinds...> {
  using WarmStart = typename MixedWarmStarts<Kinds...>::Variant;
};

}  // namespace detail

/// A grain of one of several kinds, so that they share a world: Mixed<Sphere, SphereCluster<8>, Superquadric>. Each
/// pair of kinds touches as PairContact says; it costs what it needs and one choice among the kinds. Areas of contacts
/// are those that the pair hands over: with points of physical area in one kind and whole contacts in another, give
/// each pair of materials its own constants.
template <class... Kinds>
class Mixed : public detail::MixedBase<detail::MixedWarmStarts<Kinds...>::any, Kinds...> {
  static_assert(sizeof...(Kinds) >= 1 && sizeof...(Kinds) <= 255, "Mixed: name 1 to 255 shapes");
  using Start = typename detail::MixedWarmStarts<Kinds...>::Variant;
  template <class A>
  static constexpr bool reaches_each = (ReachingPair<A, Kinds> && ...);

 public:
  static constexpr int pose_size = std::max({int{Kinds::pose_size}...});
  static constexpr bool has_orientation = (Kinds::has_orientation || ...);
  static constexpr std::size_t most_contacts = std::max({std::size_t{Kinds::most_contacts}...});
  template <class T>
  using PairContactPoint = contact::ContactPoint<T>;

  template <class Kind>
  requires(std::same_as<Kind, Kinds> || ...) Mixed(const Kind& kind)
      : kind_(kind), bounding_radius_(kind.bounding_radius()) {}

  /// The shape as one of the kinds: a std::variant.
  const std::variant<Kinds...>& kind() const { return kind_; }

  double bounding_radius() const { return bounding_radius_; }
  double volume() const {
    return visit([](const auto& s) -> double { return s.volume(); });
  }
  Vec3 unit_inertia() const {
    return visit([](const auto& s) -> Vec3 { return s.unit_inertia(); });
  }
  std::uint64_t fingerprint() const {
    return fingerprint_of(kind_.index(), visit([](const auto& s) { return shape::fingerprint(s); }));
  }
  contact::Patch patch() const {
    return visit([](const auto& s) { return patch_of(s); });
  }
  contact::Patch surface_patch() const {
    return visit([](const auto& s) { return surface_patch_of(s); });
  }

  DEM_HOT void orient(const Matrix3<double>& r, double* pose) const {
    visit([&](const auto& s) { s.orient(r, pose); });
  }
  template <class Callback>
  DEM_HOT void sample_points(const double* pose, Callback&& callback) const {
    visit([&](const auto& s) { s.sample_points(pose, callback); });
  }
  /// With a warm start, for models whose kinds keep their searches; with a gap (m), for cohesion at a distance, where
  /// all kinds find contacts across it.
  template <class Callback>
  static DEM_HOT void collide(const Mixed& a, const double* pose_a, const Mixed& b, const double* pose_b,
                              const Vector3<double>& separation, Start& start, Callback&& callback) {
    collide_kinds(a, pose_a, b, pose_b, separation, start, callback, NoGap{});
  }
  template <class Callback>
  static DEM_HOT void collide(const Mixed& a, const double* pose_a, const Mixed& b, const double* pose_b,
                              const Vector3<double>& separation, Callback&& callback) {
    Start nothing;
    collide_kinds(a, pose_a, b, pose_b, separation, nothing, callback, NoGap{});
  }
  template <class Callback>
  static DEM_HOT void collide(const Mixed& a, const double* pose_a, const Mixed& b, const double* pose_b,
                              const Vector3<double>& separation, Callback&& callback,
                              double gap) requires(reaches_each<Kinds>&&...) {
    Start nothing;
    collide_kinds(a, pose_a, b, pose_b, separation, nothing, callback, gap);
  }
  template <class Callback>
  static DEM_HOT void collide(const Mixed& a, const double* pose_a, const Mixed& b, const double* pose_b,
                              const Vector3<double>& separation, Start& start, Callback&& callback,
                              double gap) requires(reaches_each<Kinds>&&...) {
    collide_kinds(a, pose_a, b, pose_b, separation, start, callback, gap);
  }

  /// Patches are found between grains of one kind only.
  static bool is_patch(std::uint32_t feature) requires(PatchShape<Kinds> || ...) {
    bool result = false;
    std::uint32_t number = 0;
    const auto ask = [&]<class Kind>(std::type_identity<Kind>) {
      if constexpr (PatchShape<Kind>) result |= feature >> feature_bits == number + 1 && Kind::is_patch(own(feature));
      ++number;
    };
    (ask(std::type_identity<Kinds>{}), ...);
    return result;
  }
  /// Kinds that differ number their contacts the same from either side.
  static std::uint32_t mirrored(std::uint32_t feature) {
    const std::uint32_t kind = feature >> feature_bits;
    std::uint32_t result = feature, number = 0;
    ((kind == ++number ? void(result = kind << feature_bits | Kinds::mirrored(own(feature))) : void()), ...);
    return result;
  }

 private:
  static constexpr int feature_bits = 24;
  /// A feature as the pair's own kind numbers it.
  static constexpr std::uint32_t own(std::uint32_t feature) { return feature & ((1u << feature_bits) - 1u); }

  template <class Callback, class Gap>
  static DEM_HOT void collide_kinds(const Mixed& a, const double* pose_a, const Mixed& b, const double* pose_b,
                                    const Vector3<double>& separation, Start& start, Callback&& callback, Gap gap) {
    a.visit_indexed([&]<std::size_t I>(const auto& x, std::integral_constant<std::size_t, I>) {
      b.visit_indexed([&]<std::size_t J>(const auto& y, std::integral_constant<std::size_t, J>) {
        using A = std::remove_cvref_t<decltype(x)>;
        using B = std::remove_cvref_t<decltype(y)>;
        // Features of a pair of one kind carry its number, so that mirrored() knows whom to ask.
        constexpr std::uint32_t kind = I == J ? std::uint32_t{I + 1} << feature_bits : 0u;
        const auto marked = [&](std::uint32_t feature, const auto& point) { callback(kind | feature, point); };
        if constexpr (std::same_as<typename WarmStartOf<A, B>::type, NoWarmStart>) {
          NoWarmStart none;
          collide_pair(x, pose_a, y, pose_b, separation, none, marked, gap);
        } else {
          constexpr std::size_t place = 1 + I * sizeof...(Kinds) + J;
          if (start.index() != place) start.template emplace<place>();
          collide_pair(x, pose_a, y, pose_b, separation, *std::get_if<place>(&start), marked, gap);
        }
      });
    });
  }

  template <std::size_t I = 0, class F>
  DEM_HOT decltype(auto) visit_indexed(F&& f) const {
    if constexpr (I + 1 == sizeof...(Kinds)) {
      return f(*std::get_if<I>(&kind_), std::integral_constant<std::size_t, I>{});
    } else {
      if (kind_.index() == I) return f(*std::get_if<I>(&kind_), std::integral_constant<std::size_t, I>{});
      return visit_indexed<I + 1>(f);
    }
  }
  template <class F>
  DEM_HOT decltype(auto) visit(F&& f) const {
    return visit_indexed([&](const auto& shape, auto) -> decltype(auto) { return f(shape); });
  }

  std::variant<Kinds...> kind_;
  double bounding_radius_;
};

}  // namespace dem::shape
