#pragma once

#include <dem/geometry/any_callback.hpp>
#include <dem/geometry/contact_point.hpp>
#include <dem/geometry/mass_properties.hpp>
#include <dem/math/fingerprint.hpp>

#include <concepts>
#include <cstdint>
#include <variant>
#include <vector>

namespace dem::shape {

/// As AnyCallback, for sample points.
struct AnySamplePoint {
  void operator()(std::uint32_t, const contact::SamplePoint&) const {}
};

/// A shape is what a grain is. Its frame sits in the centre of mass along the principal axes. It has
///   pose_size            doubles cached per grain: the shape's points in global axes, relative to the grain's centre;
///   has_orientation      false if a turned grain is the same grain (spheres): then its rotation stays the identity;
///   most_contacts        upper bound of the contacts of one pair;
///   orient(R, pose)      fills that cache;
///   volume(), unit_inertia(), bounding_radius();
///   collide(a, pose_a, b, pose_b, separation, callback)   calls callback(feature, PairContactPoint) once per contact,
///                        features ascending, where separation leads from a's centre to b's;
///   mirrored(feature)    the feature number of the same contact when a and b change places;
///   sample_points(pose, callback)   calls callback(index, contact::SamplePoint) for each sphere or point that the
///                        shape shows to surfaces, indices ascending, below 4080.
/// It may also have
///   patch(), surface_patch()   where it touches with many points at once (see patch_of);
///   has_shares(), shares_fit   true if the points that it shows to a surface are shares of one contact, and a
///                              contact::Fit that says how these are fitted;
///   is_patch(feature)          if contacts of a pair are the points of one patch (see PatchShape);
///   penetration(pose, point, depth, outward_normal)   whether a point (m, from the grain's centre, global axes) lies
///                        inside, how deep, and which way is out: then corners and edges of surfaces are felt;
///   ball_contact(pose, centre, radius, contact)   whether a ball touches, and where (contact::BallContactPoint). Then
///                        surfaces that are balls are felt exactly, and lateral surfaces of cylinders through balls;
///   even_support(pose, way), beside_support(point, support, way)   of a round grain: the point that meets a plane
///                        first, and what another point weighs beside it. It then has mean_radius(), too;
///   is_ball(), mean_radius()   whether it is one ball, and the radius (m) of the sphere of the same volume: as that
///                        sphere a ball meets surfaces;
///   kind()               the std::variant of a shape that is one of several (Mixed);
///   fingerprint()        64 bits that tell whether two grains have the same shape (fingerprint_of): a saved state is
///                        refused where they differ. Without it the sample points are compared.
template <class S>
concept Shape = requires(const S& shape, const Matrix3<double>& rotation, double* pose,
                         const Vector3<double>& separation) {
  { S::pose_size } -> std::convertible_to<int>;
  { S::has_orientation } -> std::convertible_to<bool>;
  { S::most_contacts } -> std::convertible_to<std::size_t>;
  typename S::template PairContactPoint<double>;
  { shape.bounding_radius() } -> std::convertible_to<double>;
  { shape.volume() } -> std::convertible_to<double>;
  { shape.unit_inertia() } -> std::convertible_to<Vec3>;
  shape.orient(rotation, pose);
  S::collide(shape, pose, shape, pose, separation, AnyCallback{});
  { S::mirrored(std::uint32_t{}) } -> std::same_as<std::uint32_t>;
  shape.sample_points(pose, AnySamplePoint{});
};

/// A shape whose pairs have at most 64 possible contacts may also say which of them touch as bits, without branches,
/// and make the contact point of each later; the contact loop then has no branch that depends on the answer:
///   contact_bits(a, pose_a, b, pose_b, separation) -> uint64_t,  feature_of(bit), ascending with the bits,
///   contact_point(a, pose_a, b, pose_b, separation, feature) -> PairContactPoint.
template <class S>
concept BitShape = Shape<S> && requires(const S& shape, const double* pose, const Vector3<double>& separation) {
  { S::contact_bits(shape, pose, shape, pose, separation) } -> std::same_as<std::uint64_t>;
  { S::feature_of(0) } -> std::same_as<std::uint32_t>;
  {
    S::contact_point(shape, pose, shape, pose, separation, 0u)
    } -> std::same_as<typename S::template PairContactPoint<double>>;
};

/// A shape whose search for contacts starts warm, from what the last step found. WarmStart is what it keeps for each
/// pair of neighbours (empty when they are listed anew), and collide(a, pose_a, b, pose_b, separation, start, callback)
/// uses it. It belongs to the pair, not to a thread: results stay the same for any number of threads. To be saved it
/// must be trivially copyable, with no byte of padding.
template <class S>
concept WarmStartedShape = Shape<S> &&
    requires(const S& shape, const double* pose, const Vector3<double>& separation, typename S::WarmStart& start) {
  S::collide(shape, pose, shape, pose, separation, start, AnyCallback{});
};

/// A shape that may meet cohesion at a distance also finds contacts across a gap: collide takes the gap (m) as a last
/// argument and then hands over pairs of points up to that far apart, with a negative overlap; contact_bits of a
/// BitShape likewise. A WarmStartedShape takes both its warm start and the gap.
template <class S>
concept ReachingShape = Shape<S> && requires(const S& shape, const double* pose, const Vector3<double>& separation) {
  S::collide(shape, pose, shape, pose, separation, AnyCallback{}, 1.0);
} &&(!BitShape<S> ||
     requires(const S& shape, const double* pose, const Vector3<double>& separation) {
       { S::contact_bits(shape, pose, shape, pose, separation, 1.0) } -> std::same_as<std::uint64_t>;
     }) &&
    (!WarmStartedShape<S> ||
     requires(const S& shape, const double* pose, const Vector3<double>& separation, typename S::WarmStart& start) {
       S::collide(shape, pose, shape, pose, separation, start, AnyCallback{}, 1.0);
     });

template <class S>
concept HasPenetration = requires(const S& shape, const double* pose, const Vector3<double>& point, double& depth,
                                  Vector3<double>& outward_normal) {
  { shape.penetration(pose, point, depth, outward_normal) } -> std::same_as<bool>;
};
template <class S>
concept HasBallContact = requires(const S& shape, const double* pose, const Vector3<double>& centre,
                                  contact::BallContactPoint& contact) {
  { shape.ball_contact(pose, centre, 1.0, contact) } -> std::same_as<bool>;
};
template <class S>
concept HasSupport = requires(const S& shape, const double* pose, const Vector3<double>& v) {
  { shape.even_support(pose, v) } -> std::same_as<Vector3<double>>;
  { shape.beside_support(v, v, v) } -> std::same_as<double>;
};

/// The gap of models without cohesion at a distance: none. Widening by it is no instruction.
struct NoGap {};
template <class T>
DEM_HOT T widened(const T& reach, NoGap) {
  return reach;
}
template <class T>
DEM_HOT T widened(const T& reach, double gap) {
  return reach + T(gap);
}

template <class S>
constexpr void check_reaching_shape() {
  static_assert(
      ReachingShape<S>,
      "Shape: the model's cohesion acts at a distance, so collide (and contact_bits, if there) must take a gap "
      "in m as a last argument and find pairs up to that far apart; or choose a cohesion without range()");
}

/// What WarmStartedShapes keep for a list of pairs (WarmStart); nothing for other shapes.
template <class S>
struct WarmStarts {
  void reset(std::size_t) {}
  std::size_t bytes() const { return 0; }
};
template <WarmStartedShape S>
struct WarmStarts<S> {
  std::vector<typename S::WarmStart> start;
  void reset(std::size_t pairs) { start.assign(pairs, {}); }
  std::size_t bytes() const { return start.capacity() * sizeof(typename S::WarmStart); }
};

/// A shape whose pair contacts may be the points of one patch tells by their features, with `static bool
/// is_patch(std::uint32_t feature)`. Such points slide as one, so a point that turns up in a patch remembers what the
/// others do: when the patch changes its corners, or the way it is found, friction goes on.
template <class S>
concept PatchShape = Shape<S> && requires(std::uint32_t feature) {
  { S::is_patch(feature) } -> std::same_as<bool>;
};

/// f(kind) for a grain that is one of several kinds (Mixed), f(shape) for all others.
template <class S, class F>
DEM_HOT void visit_kind(const S& shape, F&& f) {
  if constexpr (requires { shape.kind(); }) {
    std::visit(f, shape.kind());
  } else {
    f(shape);
  }
}

/// Whether the points that a grain shows to a surface are shares of one contact, as it tells with has_shares().
template <class S>
bool has_shares(const S& shape) {
  if constexpr (requires { shape.has_shares(); }) {
    return shape.has_shares();
  } else {
    return false;
  }
}

/// A shape made of points may touch with many at once: patch() says with how many and of what weight, in a pair of
/// grains, and surface_patch() on a surface. For all others both are one.
template <class S>
contact::Patch patch_of(const S& shape) {
  if constexpr (requires {
                  { shape.patch() } -> std::same_as<contact::Patch>;
                }) {
    return shape.patch();
  } else {
    return {};
  }
}
template <class S>
contact::Patch surface_patch_of(const S& shape) {
  if constexpr (requires {
                  { shape.surface_patch() } -> std::same_as<contact::Patch>;
                }) {
    return shape.surface_patch();
  } else {
    return {};
  }
}

/// 64 bits that differ where shapes do: those that a shape tells, or those of its sample points.
template <class S>
std::uint64_t fingerprint(const S& shape) {
  if constexpr (requires {
                  { shape.fingerprint() } -> std::same_as<std::uint64_t>;
                }) {
    return shape.fingerprint();
  } else {
    alignas(64) double pose[S::pose_size > 0 ? S::pose_size : 1] = {};
    shape.orient(Matrix3<double>::identity(), pose);
    std::uint64_t hash = 0;
    shape.sample_points(pose, [&](std::uint32_t index, const contact::SamplePoint& p) {
      mix(hash, fingerprint_of(index, p.centre, p.radius, p.effective_radius, p.weight));
    });
    return hash;
  }
}

template <class S>
constexpr void check_shape() {
  static_assert(
      requires { S::pose_size; }, "Shape: needs 'static constexpr int pose_size', doubles cached per grain");
  static_assert(
      requires { S::has_orientation; }, "Shape: needs 'static constexpr bool has_orientation', false only for spheres");
  static_assert(
      requires { S::most_contacts; },
      "Shape: needs 'static constexpr std::size_t most_contacts', the most contacts a pair may have");
  static_assert(
      requires { typename S::template PairContactPoint<double>; },
      "Shape: needs 'template <class T> PairContactPoint', the raw numbers of a contact between two such shapes");
  static_assert(
      requires(const S& shape) {
        { shape.bounding_radius() } -> std::convertible_to<double>;
        { shape.volume() } -> std::convertible_to<double>;
        { shape.unit_inertia() } -> std::convertible_to<Vec3>;
      },
      "Shape: needs bounding_radius() in m, volume() in m^3 and unit_inertia(), the principal moments per density");
  static_assert(Shape<S>,
                "Shape: needs orient(R, pose), static collide(a, pose_a, b, pose_b, separation, callback), static "
                "mirrored(feature) and sample_points(pose, callback)");
}

}  // namespace dem::shape
