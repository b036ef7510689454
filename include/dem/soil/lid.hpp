#pragma once

#include <dem/geometry/plane/plane.hpp>
#include <dem/math/rotation.hpp>
#include <dem/world/world.hpp>

#include <cmath>
#include <string>

namespace dem::soil {

/// A plane over a bed, which presses it by its weight: a body of the machine on a slide along z. It is held where it
/// is, or sinks in a damper, ever slower as the grains take it up. It touches grains only while it sinks.
class Lid {
 public:
  Lid() = default;
  /// Adds one that is held at the height `top` (m). `load` (N) is its weight, `speed` (m/s) that at which it sinks
  /// freely. Throws Error unless gravity points to the floor.
  template <class World>
  Lid(World& world, const Vec3& edges, double load, double speed, double top, const std::string& material)
      : load_(load), top_(top) {
    const Vec3 gravity = world.state().options.gravity;
    if (!(gravity.z() < 0.0)) fail("a lid presses a bed by its weight, but gravity does not point to the floor");
    auto& m = world.machine();
    const double mass = load / -gravity.z();
    const Vec3 at(0, 0, top);
    const BodyId body = m.add_body(mbd::box_body("lid", edges, mass / edges.prod()).at(at));
    slide_ = m.add_joint(mbd::prismatic("lid slide", m.ground(), body, at, Vec3::UnitZ()));
    constexpr double sag = 1e-5;  // m, of the lid as it is held
    const double k = load / sag;
    hold_ = m.add_actuator(mbd::joint_actuator("lid hold", slide_, k, 2.0 * std::sqrt(k * mass)));
    drive_ = m.add_actuator(mbd::joint_actuator("lid drive", slide_, 0.0, load / speed));
    m.switch_on(drive_, false);
    surface_ = world.add_surface(
        body, surface::Plane{},
        {.material = material, .name = "lid", .rotation = rotation_between(Vec3::UnitZ(), Vec3(0, 0, -1))});
    world.set_active(surface_, false);
  }

  bool is_there() const { return surface_.valid(); }
  SurfaceId surface() const { return surface_; }  ///< of no surface where there is none
  double load() const { return load_; }           ///< N

  /// Holds it at a height (m), where it comes to within a tenth of a second.
  template <class World>
  void move_to(World& world, double z) const {
    world.machine().set_target(hold_, z - top_);
  }
  /// It sinks.
  template <class World>
  void let_go(World& world) const {
    world.set_active(surface_, true);
    world.machine().switch_on(hold_, false), world.machine().switch_on(drive_, true);
  }
  /// It is held where it is, and touches nothing.
  template <class World>
  void take_off(World& world) const {
    auto& m = world.machine();
    m.set_target(hold_, m.coordinate(slide_));
    m.switch_on(hold_, true), m.switch_on(drive_, false);
    world.set_active(surface_, false);
  }
  /// Share of its load that the grains carry.
  template <class World>
  double carried(const World& world) const {
    return world.surface_force(surface_).z() / load_;
  }
  /// m/s, upwards.
  template <class World>
  double speed(const World& world) const {
    return world.machine().speed(slide_);
  }

 private:
  SurfaceId surface_ = {};
  JointId slide_ = {};
  ActuatorId hold_ = {}, drive_ = {};
  double load_ = 0.0, top_ = 0.0;  // N; m
};

}  // namespace dem::soil
