#pragma once

#include <dem/contact/touch.hpp>
#include <dem/math/mass_properties.hpp>

#include <concepts>
#include <cstdint>

namespace dem::shape {

/// A sink for the concept check below; a real one evaluates the contact.
struct AnySink {
  template <class Touch>
  void operator()(std::uint32_t, const Touch&) const {}
};
struct AnyProbe {
  void operator()(std::uint32_t, const Vector3<double>&, double) const {}
};

/// A shape is what a grain is. Its frame sits in the centre of mass along the principal axes. It has
///   pose_size            doubles cached per grain: the shape's points in global axes, relative to the grain's centre;
///   has_orientation      false if a turned grain is the same grain (spheres): then its rotation stays the identity;
///   most_contacts        upper bound of the contacts of one pair;
///   orient(R, pose)      fills that cache;
///   volume(), unit_inertia(), bounding_radius();
///   collide(a, pose_a, b, pose_b, separation, sink)   calls sink(feature, PairTouch) once per contact, features
///                        ascending, where separation leads from a's centre to b's;
///   mirrored(feature)    the feature number of the same contact when a and b change places;
///   probe(pose, sink)    calls sink(index, centre, radius) for each sphere (or point: radius 0) that the shape shows
///   to
///                        surfaces.
template <class S>
concept Shape = requires(const S& shape, const Matrix3<double>& rotation, double* pose,
                         const Vector3<double>& separation) {
  { S::pose_size } -> std::convertible_to<int>;
  { S::has_orientation } -> std::convertible_to<bool>;
  { S::most_contacts } -> std::convertible_to<std::size_t>;
  typename S::template PairTouch<double>;
  { shape.bounding_radius() } -> std::convertible_to<double>;
  { shape.volume() } -> std::convertible_to<double>;
  { shape.unit_inertia() } -> std::convertible_to<Vec3>;
  shape.orient(rotation, pose);
  S::collide(shape, pose, shape, pose, separation, AnySink{});
  { S::mirrored(std::uint32_t{}) } -> std::same_as<std::uint32_t>;
  shape.probe(pose, AnyProbe{});
};

/// A shape whose pairs have at most 64 possible contacts may also say which of them touch as bits, without branches,
/// and make the touch of each later; the contact loop then has no branch that depends on the answer:
///   touching(a, pose_a, b, pose_b, separation) -> uint64_t,  feature_of(bit), ascending with the bits,
///   touch(a, pose_a, b, pose_b, separation, feature) -> PairTouch.
template <class S>
concept BitShape = Shape<S> && requires(const S& shape, const double* pose, const Vector3<double>& separation) {
  { S::touching(shape, pose, shape, pose, separation) } -> std::same_as<std::uint64_t>;
  { S::feature_of(0) } -> std::same_as<std::uint32_t>;
  { S::touch(shape, pose, shape, pose, separation, 0u) } -> std::same_as<typename S::template PairTouch<double>>;
};

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
      requires { typename S::template PairTouch<double>; },
      "Shape: needs 'template <class T> PairTouch', the raw numbers of a contact between two such shapes");
  static_assert(
      requires(const S& shape) {
        { shape.bounding_radius() } -> std::convertible_to<double>;
        { shape.volume() } -> std::convertible_to<double>;
        { shape.unit_inertia() } -> std::convertible_to<Vec3>;
      },
      "Shape: needs bounding_radius() in m, volume() in m^3 and unit_inertia(), the principal moments per density");
  static_assert(Shape<S>,
                "Shape: needs orient(R, pose), static collide(a, pose_a, b, pose_b, separation, sink), static "
                "mirrored(feature) and probe(pose, sink)");
}

}  // namespace dem::shape
