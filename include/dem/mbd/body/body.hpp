#pragma once

#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/core/macros.hpp>
#include <dem/integrator/motion.hpp>

#include <algorithm>
#include <string>

namespace dem {

/// The two frames of a body.
enum class BodyFrame {
  reference,  ///< in which it was made: that of BodySpec, of the drawing, of its mesh
  principal   ///< the origin in the centre of mass, axes along the principal axes: that of Body
};

/// A rigid body of a machine (thesis section 2.1). The body frame sits in the centre of mass, its axes are the
/// principal axes of inertia. Forces and torques are gathered in the global frame, torques about the centre of mass.
struct Body {
  std::string name;
  double mass = 1.0;            ///< kg
  Vec3 inertia = Vec3::Ones();  ///< kg m^2, principal moments
  bool fixed = false;           ///< never moves by itself; prescribed motion may still move it

  integrator::Motion<double> motion = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, Matrix3<double>::identity()};
  Vector3<double> force = {0, 0, 0};   ///< N, sum of this stage's forces, gravity not included
  Vector3<double> torque = {0, 0, 0};  ///< N m, about the centre of mass, global axes

  template <class V>
  void fields(V& v) {
    v.given("name", name), v.given("mass", mass, "kg"), v.given("inertia", inertia, "kg m^2"), v("fixed", fixed);
    v("motion", motion), v("force", force, "N"), v("torque", torque, "N m");
  }
  /// A body without mass cannot be set free.
  bool is_fixed_for_good() const { return fixed && !(mass > 0.0); }
  Vec3 position() const { return to_eigen(motion.position); }
  Vec3 velocity() const { return to_eigen(motion.velocity); }
  Mat3 rotation() const { return to_eigen(motion.rotation); }
  /// rad/s in global axes.
  Vec3 angular_velocity() const { return to_eigen(motion.rotation * motion.angular_velocity); }

  /// Global position of a point given in the body frame (eq. 20).
  Vec3 point(const Vec3& local) const { return to_eigen(motion.position + motion.rotation * from_eigen(local)); }
  /// Global velocity of a point given in the body frame (eq. 20).
  Vec3 point_velocity(const Vec3& local) const;

  /// Adds a force (N, global axes) that acts at a global point (eqs. 22-24) to this stage's sum. A machine clears the
  /// sums before each evaluation, so what is added between two steps is lost: a force that lasts is a load
  /// (mbd::applied_force, mbd::custom_load); this is for code that calls a machine's phases itself, after clear_forces.
  void apply(const Vec3& f, const Vec3& at);
  /// Adds a torque (N m, global axes) likewise.
  void apply_torque(const Vec3& t) { torque += from_eigen(t); }
};

/// Throws Error if the body cannot be integrated.
void check_body(const Body& b);

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE Vec3 Body::point_velocity(const Vec3& local) const {
  const Vector3<double> spin = motion.rotation * motion.angular_velocity;
  return to_eigen(motion.velocity + cross(spin, motion.rotation * from_eigen(local)));
}

DEM_INLINE void Body::apply(const Vec3& f, const Vec3& at) {
  force += from_eigen(f);
  torque += cross(from_eigen(at) - motion.position, from_eigen(f));
}

DEM_INLINE void check_body(const Body& b) {
  if (b.fixed) return;
  const auto what = [&](const char* field) { return field + (" of body '" + b.name + "'"); };
  require_positive(b.mass, what("mass").c_str(), "kg (or set fixed = true)");
  for (int k = 0; k < 3; ++k) {
    require_positive(b.inertia[k], what("principal inertia").c_str(), "kg m^2 (or set fixed = true)");
  }
  const double largest = std::max({b.inertia[0], b.inertia[1], b.inertia[2]});
  const double others = b.inertia[0] + b.inertia[1] + b.inertia[2] - largest;
  if (largest > others * 1.01) {  // data sheets round
    fail(
        "principal inertias {:g}, {:g}, {:g} kg m^2 of body '{}' belong to no mass distribution: the largest must not "
        "exceed the sum of the other two by more than 1 %; check the units and the order",
        b.inertia.x(), b.inertia.y(), b.inertia.z(), b.name);
  }
}

}  // namespace dem

#endif
