#pragma once

#include <dem/rig/direct_shear/grains.hpp>
#include <dem/rig/direct_shear/settings.hpp>
#include <dem/soil/packing.hpp>
#include <dem/world/world.hpp>

#include <cmath>
#include <span>
#include <string>
#include <type_traits>

namespace dem::rig::direct_shear {

/// What differs between the apparatus that a packing is made in and those that shear it.
struct Height {
  double seam = 0.0;      ///< m, height at which the halves meet
  double wall_top = 0.0;  ///< m, of the top box: the box's height, or more while grains are poured (a collar)
  double lid_mass = 1.0;  ///< kg
  double lid_low = 0.0;   ///< m, underside of the lid at the start
};

/// The apparatus of thesis table 3.1: four bodies (ground, bottom box, top box, lid), three prismatic joints, three
/// linear actuators (shaker, shearing, lid), full of grains. The floor's upper side is z = 0, the middle of the bottom
/// box is x = y = 0, and shearing moves the top box along +x. Walls are solid boxes, so rim and ledges are solid too.
template <class Model>
class Apparatus {
  static_assert(std::is_constructible_v<typename Model::Surfaces, surface::Box>,
                "the direct shear test is made of boxes: name surface::Box among the Model's Surfaces");

 public:
  using World = dem::World<Model>;
  static constexpr double lid_thickness = 0.01;  ///< m
  static constexpr double box_mass = 2.0;        ///< kg, of each half; the test is too slow for it to matter

  Apparatus(const Settings& s, const Grains<Model>& kind, const Height& height, std::span<const soil::Placement> grains)
      : world({.time_step = s.time_step,
               .time_step_safety = s.stable_share,
               .allow_unstable_time_step = s.allow_unstable_time_step,
               .overlap_limit = s.overlap_limit,
               .domain = domain(s, height),
               .threads = s.threads}),
        settings_(s),
        kind_(kind),
        height_(height) {
    species_ = world.add_species(kind.shape, {.material = "grain", .density = s.density});
    set_friction(1.0);
    build_boxes();
    build_lid();
    for (const auto& g : grains) {
      world.add_grain({.species = species_, .position = g.position, .rotation = g.rotation});
    }
  }

  /// This share of the friction of grains on grains and on walls acts from the next step on. All else as set. Throws
  /// Error for another share than 1 with a friction law that has no coefficient.
  void set_friction(double share) {
    friction_share_ = share;
    world.set_contact("grain", "grain", with_friction<Model>(kind_.on_grain, share));
    world.set_contact("grain", "wall", with_friction<Model>(kind_.on_wall, share));
  }

  /// Coefficient of friction of grains on grains, as it is now; NaN where the law has none.
  double friction() const { return friction_share_ * friction_of<Model>(kind_.on_grain); }

  /// Keeps the lid where it is, out of the way, while there is a packing to be made.
  void hold_lid() { world.machine().add_motion(mbd::prescribed_joint("held lid", lid_slide, 0.0)); }

  double lid_low() const { return world.machine().body(lid).position().z() - 0.5 * lid_thickness; }  ///< m
  double lid_speed() const { return world.machine().body(lid).velocity().z(); }                      ///< m/s
  double top_displacement() const { return world.machine().coordinate(top_slide); }                  ///< m
  double lid_weight() const { return 9.81 * height_.lid_mass; }                                      ///< N
  const Height& height() const { return height_; }
  double grain_volume() const { return kind_.shape.volume(); }  ///< m^3
  /// Force (N) of the grains on the lid, upwards, mean over the sensor's window.
  double lid_force() const { return world.machine().sensor(lid_sensor).mean().force.z; }

  World world;
  BodyId bottom, top, lid;
  JointId bottom_slide, top_slide, lid_slide;
  ActuatorId shaker, shearing, lid_drive;
  SensorId bottom_sensor, lid_sensor, shearing_sensor;

 private:
  static surface::Aabb domain(const Settings& s, const Height& height) {
    const double x = 0.5 * s.box_length + s.wall_thickness, y = 0.5 * s.box_width + s.wall_thickness;
    return {Vec3(-x, -y, -s.wall_thickness), Vec3(x, y, height.wall_top + lid_thickness)};
  }

  /// A body that is a box of the given edges; only its mass matters, for it does not turn.
  BodyId add_box_body(const char* name, double mass, const Vec3& edges, double z) {
    return world.machine().add_body(mbd::box_body(name, edges, mass / edges.prod()).at(Vec3(0.0, 0.0, z)));
  }

  /// Four walls about the opening between two heights, on a body whose centre is at the height z.
  void add_walls(BodyId body, const std::string& name, double low, double high, double z) {
    const double lx = settings_.box_length, ly = settings_.box_width, t = settings_.wall_thickness, h = high - low;
    const double middle = 0.5 * (low + high) - z;
    for (const double side : {-1.0, 1.0}) {
      const char* sign = side < 0.0 ? "-" : "+";
      world.add_surface(body, surface::Box(Vec3(t, ly + 2.0 * t, h)),
                        {.name = name + sign + "x", .position = {side * 0.5 * (lx + t), 0.0, middle}});
      world.add_surface(body, surface::Box(Vec3(lx, t, h)),
                        {.name = name + sign + "y", .position = {0.0, side * 0.5 * (ly + t), middle}});
    }
  }

  void build_boxes() {
    auto& m = world.machine();
    const double lx = settings_.box_length, ly = settings_.box_width, t = settings_.wall_thickness;
    const Vec3 outer(lx + 2.0 * t, ly + 2.0 * t, height_.seam + t);
    const double bottom_z = 0.5 * (height_.seam - t), top_z = 0.5 * (height_.seam + height_.wall_top);
    bottom = add_box_body("bottom box", box_mass, outer, bottom_z);
    top = add_box_body("top box", box_mass, Vec3(outer.x(), outer.y(), height_.wall_top - height_.seam), top_z);
    world.add_surface(bottom, surface::Box(Vec3(outer.x(), outer.y(), t)),
                      {.name = "floor", .position = {0.0, 0.0, -0.5 * t - bottom_z}});
    add_walls(bottom, "bottom wall ", 0.0, height_.seam, bottom_z);
    add_walls(top, "top wall ", height_.seam, height_.wall_top, top_z);

    const Vec3 x = Vec3::UnitX();
    bottom_slide = m.add_joint(mbd::prismatic("bottom slide", world.ground(), bottom, {0.0, 0.0, bottom_z}, x));
    top_slide = m.add_joint(mbd::prismatic("top slide", world.ground(), top, {0.0, 0.0, top_z}, x));
    // Stiff against the shear force of some 200 N: 20 micrometres. Damped critically at the mass of a half.
    const double k = 1e7, c = 2.0 * std::sqrt(k * box_mass);
    shaker = m.add_actuator(mbd::joint_actuator("shaker", bottom_slide, k, c));
    shearing = m.add_actuator(mbd::joint_actuator("shearing", top_slide, k, c));
    const double window = 1e-5 / settings_.shear_speed;  // a hundredth of a millimetre of travel
    bottom_sensor = m.add_sensor(mbd::contact_sensor("grains on the bottom box", bottom, window));
    shearing_sensor = m.add_sensor(mbd::actuator_sensor("shearing force", shearing, window));
  }

  /// The lid's actuator is a speed controller without a position: a damper under which the lid's weight sinks at the
  /// lid speed, ever slower as the grains take up the load, until they carry all of it.
  void build_lid() {
    auto& m = world.machine();
    const double gap = settings_.lid_clearance * 0.5 * settings_.half_edge;
    const Vec3 edges(settings_.box_length - 2.0 * gap, settings_.box_width - 2.0 * gap, lid_thickness);
    const double z = height_.lid_low + 0.5 * lid_thickness;
    lid = add_box_body("lid", height_.lid_mass, edges, z);
    world.add_surface(lid, surface::Box(edges), {.name = "lid"});
    lid_slide = m.add_joint(mbd::prismatic("lid slide", top, lid, {0.0, 0.0, z}, Vec3::UnitZ()));
    lid_drive = m.add_actuator(mbd::joint_actuator("lid drive", lid_slide, 0.0, lid_weight() / settings_.lid_speed));
    lid_sensor = m.add_sensor(mbd::contact_sensor("grains on the lid", lid, 5e-3));
  }

  Settings settings_;
  Grains<Model> kind_;
  Height height_;
  SpeciesId species_;
  double friction_share_ = 1.0;
};

}  // namespace dem::rig::direct_shear
