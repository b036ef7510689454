#pragma once

#include <dem/geometry/shape.hpp>

namespace dem::shape {

/// How grains of the shapes A and B touch: the customisation point by which shapes of different kinds share a world
/// (see Mixed). Specialise it for one order of the two; the other follows by itself:
///   template <>
///   struct PairContact<Egg, Brick> {
///     template <class Callback>
///     static void collide(const Egg& a, const double* pose_a, const Brick& b, const double* pose_b,
///                         const Vector3<double>& separation, Callback&& callback);
///   };
/// collide calls callback(feature, point) as a Shape's own does: contact points seen from a's centre, features
/// ascending and below 2^24; any type with geometry() will do. What a search wants to keep for a pair of neighbours
/// goes into a type WarmStart (copyable, empty when made, no byte of it padding), and collide then takes a WarmStart&
/// before the callback. To meet cohesion at a distance, collide also takes a gap (m) as a last argument, as that of a
/// ReachingShape does.
template <class A, class B>
struct PairContact;

/// Two grains of one kind: as the shape itself says.
template <Shape S>
struct PairContact<S, S> {
  template <class Callback, class... Gap>
  requires(sizeof...(Gap) == 0 || ReachingShape<S>) static DEM_HOT
      void collide(const S& a, const double* pose_a, const S& b, const double* pose_b,
                   const Vector3<double>& separation, Callback&& callback, Gap... gap) {
    S::collide(a, pose_a, b, pose_b, separation, callback, gap...);
  }
};
template <WarmStartedShape S>
struct PairContact<S, S> {
  using WarmStart = typename S::WarmStart;
  template <class Callback, class... Gap>
  requires(sizeof...(Gap) == 0 || ReachingShape<S>) static DEM_HOT
      void collide(const S& a, const double* pose_a, const S& b, const double* pose_b,
                   const Vector3<double>& separation, WarmStart& start, Callback&& callback, Gap... gap) {
    S::collide(a, pose_a, b, pose_b, separation, start, callback, gap...);
  }
};

/// The pair is specialised in this order.
template <class A, class B>
concept HasPairContact = requires {
  sizeof(PairContact<A, B>);
};

/// The pair, in whichever order it is specialised, also finds contacts across a gap.
template <class A, class B>
concept ReachesInOrder = requires(const A& a, const B& b, const double* pose, const Vector3<double>& separation) {
  PairContact<A, B>::collide(a, pose, b, pose, separation, AnyCallback{}, 1.0);
}
|| requires(const A& a, const B& b, const double* pose, const Vector3<double>& separation,
            typename PairContact<A, B>::WarmStart& start) {
  PairContact<A, B>::collide(a, pose, b, pose, separation, start, AnyCallback{}, 1.0);
};
template <class A, class B>
concept ReachingPair = ReachesInOrder<A, B> || ReachesInOrder<B, A>;

/// What a pair of A and B keeps between searches, in whichever order it is specialised.
struct NoWarmStart {};
template <class A, class B>
struct WarmStartOf {
  using type = NoWarmStart;
};
template <class A, class B>
requires requires { typename PairContact<A, B>::WarmStart; }
struct WarmStartOf<A, B> {
  using type = typename PairContact<A, B>::WarmStart;
};
template <class A, class B>
requires(!HasPairContact<A, B>) && requires { typename PairContact<B, A>::WarmStart; }
struct WarmStartOf<A, B> {
  using type = typename PairContact<B, A>::WarmStart;
};

/// A contact that was found from b's side, seen from a's.
DEM_HOT contact::ContactPoint<double> turned_round(const contact::Geometry<double>& g,
                                                   const Vector3<double>& separation) {
  return {-g.normal, g.overlap, g.arm + separation, g.effective_radius, g.weight, g.total_share};
}

/// Contacts of any two kinds, each a ContactPoint, through PairContact<A, B> or PairContact<B, A>; up to a gap (m)
/// where cohesion acts at a distance (else NoGap).
template <class A, class B, class WarmStart, class Callback, class Gap = NoGap>
DEM_HOT void collide_pair(const A& a, const double* pose_a, const B& b, const double* pose_b,
                          const Vector3<double>& separation, WarmStart& start, Callback&& callback, Gap gap = {}) {
  const auto call = [&](auto pair, const auto&... arguments) {
    using Pair = decltype(pair);
    const auto with = [&](const auto&... reach) {
      if constexpr (requires { typename Pair::WarmStart; }) {
        const auto split = [&](const auto& x, const double* pose_x, const auto& y, const double* pose_y,
                               const Vector3<double>& between, const auto& given) {
          Pair::collide(x, pose_x, y, pose_y, between, start, given, reach...);
        };
        split(arguments...);
      } else {
        Pair::collide(arguments..., reach...);
      }
    };
    if constexpr (std::is_same_v<Gap, NoGap>) with();
    else with(gap);
  };
  if constexpr (HasPairContact<A, B>) {
    call(PairContact<A, B>{}, a, pose_a, b, pose_b, separation, [&](std::uint32_t feature, const auto& point) {
      const contact::Geometry<double> g = point.geometry();
      callback(feature,
               contact::ContactPoint<double>{g.normal, g.overlap, g.arm, g.effective_radius, g.weight, g.total_share});
    });
  } else {
    static_assert(
        HasPairContact<B, A>,
        "Mixed: nothing says how these two shapes touch; specialise dem::shape::PairContact<A, B> for them, or include "
        "polyhedron_sphere.hpp / superquadric_polyhedron.hpp");
    call(PairContact<B, A>{}, b, pose_b, a, pose_a, -separation, [&](std::uint32_t feature, const auto& point) {
      callback(feature, turned_round(point.geometry(), separation));
    });
  }
}

}  // namespace dem::shape
