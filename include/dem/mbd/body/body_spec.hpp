#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/geometry/principal_axes.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/mbd/body/body_mass.hpp>

#include <string>
#include <utility>

namespace dem::mbd {

/// What a body is made from: its mass properties in a frame of the user's choice (the reference frame, e.g. that of the
/// drawing), and where that frame is at the start. `Machine::add_body` turns it into a Body, whose own frame sits in
/// the centre of mass along the principal axes.
struct BodySpec {
  std::string name;
  BodyMass mass_properties = {};
  Vec3 position = Vec3::Zero();          ///< m, origin of the reference frame, global
  Mat3 rotation = Mat3::Identity();      ///< reference frame -> global
  Vec3 velocity = Vec3::Zero();          ///< m/s, of the origin of the reference frame, global
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, global axes
  /// Never moves by itself; prescribed motion may still move it. With a velocity and no motion it stands where it is
  /// and carries what touches it along, as a belt does.
  bool fixed = false;

  BodySpec at(const Vec3& p, const Mat3& r = Mat3::Identity()) const;
  BodySpec moving(const Vec3& v, const Vec3& w = Vec3::Zero()) const;
};

namespace detail {

/// What `make` gives; what it refuses is told with the body's name.
template <class Make>
BodySpec made_of(std::string name, Make&& make) {
  try {
    const BodyMass mass = make();
    return {.name = std::move(name), .mass_properties = mass};
  } catch (const Error& e) {
    fail("body '{}': {}", name, e.what());
  }
}

}  // namespace detail

/// A body of given mass (kg) and inertia about its centre of mass (kg m^2) in reference axes: a tensor (3 x 3), or the
/// moments about x, y, z (a vector of 3) where these are principal axes.
template <class Derived>
BodySpec given_body(std::string name, double mass, const Eigen::MatrixBase<Derived>& inertia,
                    const Vec3& centre_of_mass = Vec3::Zero()) {
  static_assert(Derived::RowsAtCompileTime == 3 && (Derived::ColsAtCompileTime == 3 || Derived::ColsAtCompileTime == 1),
                "given_body: the inertia is a Mat3, or a Vec3 of principal moments");
  Mat3 tensor;
  if constexpr (Derived::ColsAtCompileTime == 3) {
    tensor = inertia;
  } else {
    const Vec3 moments = inertia;
    tensor = to_eigen(diagonal_matrix(from_eigen(moments)));
  }
  return {.name = std::move(name), .mass_properties = {mass, centre_of_mass, tensor}};
}
/// A box with full edges `size` (m), reference frame in its middle; density in kg/m^3.
DEM_SETUP inline BodySpec box_body(std::string name, const Vec3& size, double density) {
  return detail::made_of(std::move(name), [&] { return box_mass(size, density); });
}
/// A full cylinder about the z axis of its reference frame, which sits in its middle (m, kg/m^3).
DEM_SETUP inline BodySpec cylinder_body(std::string name, double radius, double length, double density) {
  return detail::made_of(std::move(name), [&] { return cylinder_mass(radius, length, density); });
}
DEM_SETUP inline BodySpec sphere_body(std::string name, double radius, double density) {
  return detail::made_of(std::move(name), [&] { return sphere_mass(radius, density); });
}
/// A body that stays where it is (or is moved by prescribed motion alone); it needs no mass.
DEM_SETUP inline BodySpec fixed_body(std::string name, const Vec3& position = Vec3::Zero()) {
  return {.name = std::move(name), .position = position, .fixed = true};
}

/// A Body with the pose of its reference frame in the body frame.
struct BuiltBody {
  Body body;
  Vec3 reference_origin;  ///< m, origin of the reference frame, in the body frame
  Mat3 reference_axes;    ///< reference frame -> body frame
};

/// Finds the principal axes and moves the reference frame's motion to the centre of mass. Throws Error if the body has
/// no mass, an impossible inertia, a rotation that is not one, or a number that is not finite.
BuiltBody build_body(const BodySpec& spec);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE BodySpec BodySpec::at(const Vec3& p, const Mat3& r) const {
  BodySpec s = *this;
  s.position = p;
  s.rotation = r;
  return s;
}

DEM_INLINE BodySpec BodySpec::moving(const Vec3& v, const Vec3& w) const {
  BodySpec s = *this;
  s.velocity = v;
  s.angular_velocity = w;
  return s;
}

DEM_INLINE BuiltBody build_body(const BodySpec& spec) {
  using V = Vector3<double>;
  const Matrix3<double> turn = from_eigen(spec.rotation);
  if (!(squared_norm(turn * transposed(turn) - diagonal_matrix(1, 1, 1)) <= 1e-18) || !(determinant(turn) > 0)) {
    fail(
        "the rotation of body '{}' is not a right-handed rotation (its rows are not orthonormal): use "
        "Eigen::AngleAxisd or Quaternion::normalized() to make it",
        spec.name);
  }
  for (const Vec3* v : {&spec.position, &spec.velocity, &spec.angular_velocity, &spec.mass_properties.centre_of_mass}) {
    if (!is_finite(from_eigen(*v))) {
      fail(
          "body '{}' was given ({:g}, {:g}, {:g}) as its position, velocity, angular velocity or centre of mass, which "
          "must be finite",
          spec.name, v->x(), v->y(), v->z());
    }
  }
  BuiltBody built;
  Body& b = built.body;
  const PrincipalAxes principal = principal_axes(spec.mass_properties.inertia);
  const Matrix3<double> axes = from_eigen(principal.rotation);
  b.name = spec.name;
  b.fixed = spec.fixed;
  b.mass = spec.mass_properties.mass;  // of a fixed body possibly 0: it cannot be set free
  b.inertia = principal.moments;
  check_body(b);
  const V centre = from_eigen(spec.mass_properties.centre_of_mass), spin = from_eigen(spec.angular_velocity);
  const V arm = turn * centre;
  b.motion.position = from_eigen(spec.position) + arm;
  b.motion.velocity = from_eigen(spec.velocity) + cross(spin, arm);
  b.motion.rotation = turn * axes;
  b.motion.angular_velocity = transpose_times(b.motion.rotation, spin);
  built.reference_origin = to_eigen(-transpose_times(axes, centre));
  built.reference_axes = to_eigen(transposed(axes));
  return built;
}

}  // namespace dem::mbd

#endif
