#pragma once

// Bushings whose load over displacement is a table: rubber that stiffens, play, stops.

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/curve.hpp>
#include <dem/mbd/joint/bushing.hpp>

#include <memory>

namespace dem::mbd {

namespace detail {

inline double load_of(const Curve& c, double x) { return c.empty() ? 0.0 : c(x); }
inline double stored_in(const Curve& c, double x) { return c.empty() ? 0.0 : c.integral(0.0, x); }
inline double steepest_of(const Curve& c) { return c.empty() ? 0.0 : c.steepest(); }

/// As penalty<Hold::bushing, Align::bushing>, with loads from tables. The three axes share no energy, so each load is
/// the gradient of its own, and the torque that of the rotation vector's (rotation_vector.hpp).
void bushing_table_force(Joint& j, Body& a, Body& b, const Vector3<double>& wa, const Vector3<double>& wb, double);

/// J.
double bushing_table_energy(const Joint& j, const FrameOfA& at, const Matrix3<double>& B, const Vector3<double>& d);

void take_tables(Joint& j, const JointSpec& s, const Vector3<double>& gap, const std::string& who);

constexpr JointTraits traits_of_bushing_tables() {
  JointTraits t = bushing_joint;  // it is as stiff as the steepest slopes of its tables
  t.name = "bushing with tables";
  t.take = take_tables;
  t.force = bushing_table_force;
  t.energy = bushing_table_energy;
  return t;
}

}  // namespace detail

inline constexpr JointTraits bushing_table_joint = detail::traits_of_bushing_tables();
inline constexpr JointKind JointKind::bushing_with_tables{bushing_table_joint};

/// A bushing with tables, and dampers (N s/m, N m s/rad), along and about the x, y, z axes of a frame with z along
/// axis. The stable time step counts the steepest slope of each table.
JointSpec bushing(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis, BushingTables tables,
                  const Vec3& damping, const Vec3& rotational_damping);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void bushing_table_force(Joint& j, Body& a, Body& b, const Vector3<double>& wa, const Vector3<double>& wb,
                                    double) {
  using V = Vector3<double>;
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const BushingTables& t = *j.tables;
  const V rb = B * j.point_b, ra = b.motion.position - a.motion.position + rb, w = wb - wa;
  const V d = ra - A * j.point_a, v = b.motion.velocity - a.motion.velocity + cross(wb, rb) - cross(wa, ra);
  const V x = A * j.axes_a.x, y = A * j.axes_a.y, z = A * j.axes_a.z;
  j.force = -(load_of(t.x, dot(x, d)) + j.c3.x * dot(x, v)) * x - (load_of(t.y, dot(y, d)) + j.c3.y * dot(y, v)) * y -
            (load_of(t.z, dot(z, d)) + j.c3.z * dot(z, v)) * z;
  const V r = rotation_vector(x, y, z, B * j.axes_b.x, B * j.axes_b.y, B * j.axes_b.z);
  const V spring =
      rotation_vector_torque(r, {load_of(t.about_x, r.x), load_of(t.about_y, r.y), load_of(t.about_z, r.z)});
  j.torque = (spring.x - j.cr3.x * dot(x, w)) * x + (spring.y - j.cr3.y * dot(y, w)) * y +
             (spring.z - j.cr3.z * dot(z, w)) * z;
  act(a, b, ra, rb, j.force, j.torque);
}

DEM_INLINE double bushing_table_energy(const Joint& j, const FrameOfA& at, const Matrix3<double>& B,
                                       const Vector3<double>& d) {
  const BushingTables& t = *j.tables;
  const auto r = rotation_vector(at.x(), at.y(), at.z(), B * j.axes_b.x, B * j.axes_b.y, B * j.axes_b.z);
  return stored_in(t.x, dot(at.x(), d)) + stored_in(t.y, dot(at.y(), d)) + stored_in(t.z, dot(at.z(), d)) +
         stored_in(t.about_x, r.x) + stored_in(t.about_y, r.y) + stored_in(t.about_z, r.z);
}

DEM_INLINE void take_tables(Joint& j, const JointSpec& s, const Vector3<double>& gap, const std::string& who) {
  take_constants(j, s, gap, who);
  j.tables = s.bushing_tables;
}

}  // namespace dem::mbd::detail

namespace dem::mbd {

DEM_INLINE JointSpec bushing(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis,
                             BushingTables tables, const Vec3& damping, const Vec3& rotational_damping) {
  using detail::steepest_of;
  JointSpec s = joint(JointKind::bushing_with_tables, std::move(name), a, b, at, axis);
  s.bushing_stiffness = {steepest_of(tables.x), steepest_of(tables.y), steepest_of(tables.z)};
  s.bushing_rotational_stiffness = {steepest_of(tables.about_x), steepest_of(tables.about_y),
                                    steepest_of(tables.about_z)};
  s.bushing_damping = damping;
  s.bushing_rotational_damping = rotational_damping;
  s.bushing_tables = std::make_shared<const BushingTables>(std::move(tables));
  return s;
}

}  // namespace dem::mbd

#endif
