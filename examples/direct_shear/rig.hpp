#pragma once

#include "settings.hpp"

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/soil/packing.hpp>
#include <dem/world/world.hpp>

#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace direct_shear {

/// The cube of half-edge h (m) as grains of a shape.
template <class Shape>
struct Grain;
template <>
struct Grain<dem::shape::SphereCluster<8>> {
  static auto make(double half_edge) { return dem::shape::cube8(half_edge); }
};
template <>
struct Grain<dem::shape::Polyhedron> {
  static auto make(double half_edge) { return dem::shape::cube(half_edge); }
};

/// Rounded: exponents of 8 leave 94 % of the cube's volume.
template <>
struct Grain<dem::shape::Superquadric> {
  static auto make(double half_edge) {
    return dem::shape::Superquadric(dem::Vec3::Constant(half_edge), dem::Vec3::Constant(8.0));
  }
};

template <class I, class S>
struct Sand : dem::Model {
  using Shape = S;
  using Surfaces = dem::surface::Set<dem::surface::Box>;
  using Normal = dem::contact::Penalty;
  using Friction = dem::friction::AsperitySpring;
  using BroadPhase = dem::broadphase::UniformGrid;
  using Integrator = I;
  using Executor = dem::exec::OpenMP;
};

/// What differs between the rig that a packing is made in and the rigs that shear it.
struct RigShape {
  double seam = 0.0;      ///< m, height at which the halves meet
  double wall_top = 0.0;  ///< m, of the top box: the box's height, or more while grains are poured (a collar)
  double lid_mass = 1.0;  ///< kg
  double lid_low = 0.0;   ///< m, underside of the lid at the start
};

/// The rig of thesis table 3.1: four bodies (ground, bottom box, top box, lid), three prismatic joints, three linear
/// actuators (shaker, shearing, lid), full of grains. The floor's upper side is z = 0, the middle of the bottom box is
/// x = y = 0, and shearing moves the top box along +x. Walls are solid boxes, so rim and ledges are solid too.
template <class Integrator, class Shape>
class Rig {
 public:
  using World = dem::World<Sand<Integrator, Shape>>;
  static constexpr double lid_thickness = 0.01;  ///< m
  static constexpr double box_mass = 2.0;        ///< kg, of each half; the test is too slow for it to matter

  Rig(const Settings& s, const RigShape& shape, std::span<const dem::soil::Placement> grains)
      : world({.time_step = s.time_step,
               .time_step_safety = s.stable_share,
               .allow_unstable_time_step = s.allow_unstable_time_step,
               .overlap_limit = s.overlap_limit,
               .domain = domain(s, shape),
               .threads = s.threads}),
        settings_(s),
        shape_(shape) {
    species_ = world.add_species(Grain<Shape>::make(s.half_edge), {.material = "grain", .density = s.density});
    set_friction(s.friction, s.wall_friction);
    build_boxes();
    build_lid();
    for (const auto& g : grains) {
      world.add_particle({.species = species_, .position = g.position, .rotation = g.rotation});
    }
  }

  /// Friction of grains on grains and of grains on walls, from the next step on. All else as set.
  void set_friction(double grain, double wall) {
    const double k = contact_scale(settings_);
    const auto constants = [&](double mu) {
      return typename World::Parameters{
          {k * settings_.stiffness, k * k * settings_.damping, settings_.separation_factor},
          {mu, k * settings_.friction_stiffness, k * k * settings_.velocity_stiffness, settings_.breaking_factor}};
    };
    world.set_contact("grain", "grain", constants(grain));
    world.set_contact("grain", "wall", constants(wall));
  }

  /// Keeps the lid where it is, out of the way, while there is a packing to be made.
  void hold_lid() { world.machine().add_motion(dem::mbd::prescribed_joint("held lid", lid_slide, 0.0)); }

  double lid_low() const { return world.machine().body(lid).position().z() - 0.5 * lid_thickness; }  ///< m
  double lid_speed() const { return world.machine().body(lid).velocity().z(); }                      ///< m/s
  double top_displacement() const { return world.machine().coordinate(top_slide); }                  ///< m
  double lid_weight() const { return 9.81 * shape_.lid_mass; }                                       ///< N
  const RigShape& shape() const { return shape_; }
  double grain_volume() const { return world.species(species_).shape.volume(); }  ///< m^3
  /// Force (N) of the grains on the lid, upwards, mean over the sensor's window.
  double lid_force() const { return world.machine().sensor(lid_sensor).mean().force.z; }

  World world;
  dem::BodyId bottom, top, lid;
  dem::JointId bottom_slide, top_slide, lid_slide;
  dem::ActuatorId shaker, shearing, lid_drive;
  dem::SensorId bottom_sensor, lid_sensor, shearing_sensor;

 private:
  static dem::surface::Bounds domain(const Settings& s, const RigShape& shape) {
    const double x = 0.5 * s.box_length + s.wall_thickness, y = 0.5 * s.box_width + s.wall_thickness;
    return {dem::Vec3(-x, -y, -s.wall_thickness), dem::Vec3(x, y, shape.wall_top + lid_thickness)};
  }

  /// A body that is a box of the given edges; only its mass matters, for it does not turn.
  dem::BodyId add_box_body(const char* name, double mass, const dem::Vec3& edges, double z) {
    return world.machine().add_body(dem::mbd::box_body(name, edges, mass / edges.prod()).at(dem::Vec3(0.0, 0.0, z)));
  }

  /// Four walls about the opening between two heights, on a body whose centre is at the height z.
  void add_walls(dem::BodyId body, const std::string& name, double low, double high, double z) {
    const double lx = settings_.box_length, ly = settings_.box_width, t = settings_.wall_thickness, h = high - low;
    const double middle = 0.5 * (low + high) - z;
    for (const double side : {-1.0, 1.0}) {
      const char* sign = side < 0.0 ? "-" : "+";
      world.add_surface(body, dem::surface::Box(dem::Vec3(t, ly + 2.0 * t, h)),
                        {.name = name + sign + "x", .position = {side * 0.5 * (lx + t), 0.0, middle}});
      world.add_surface(body, dem::surface::Box(dem::Vec3(lx, t, h)),
                        {.name = name + sign + "y", .position = {0.0, side * 0.5 * (ly + t), middle}});
    }
  }

  void build_boxes() {
    auto& m = world.machine();
    const double lx = settings_.box_length, ly = settings_.box_width, t = settings_.wall_thickness;
    const dem::Vec3 outer(lx + 2.0 * t, ly + 2.0 * t, shape_.seam + t);
    const double bottom_z = 0.5 * (shape_.seam - t), top_z = 0.5 * (shape_.seam + shape_.wall_top);
    bottom = add_box_body("bottom box", box_mass, outer, bottom_z);
    top = add_box_body("top box", box_mass, dem::Vec3(outer.x(), outer.y(), shape_.wall_top - shape_.seam), top_z);
    world.add_surface(bottom, dem::surface::Box(dem::Vec3(outer.x(), outer.y(), t)),
                      {.name = "floor", .position = {0.0, 0.0, -0.5 * t - bottom_z}});
    add_walls(bottom, "bottom wall ", 0.0, shape_.seam, bottom_z);
    add_walls(top, "top wall ", shape_.seam, shape_.wall_top, top_z);

    const dem::Vec3 x = dem::Vec3::UnitX();
    bottom_slide = m.add_joint(dem::mbd::prismatic("bottom slide", world.ground(), bottom, {0.0, 0.0, bottom_z}, x));
    top_slide = m.add_joint(dem::mbd::prismatic("top slide", world.ground(), top, {0.0, 0.0, top_z}, x));
    // Stiff against the shear force of some 200 N: 20 micrometres. Damped critically at the mass of a half.
    const double k = 1e7, c = 2.0 * std::sqrt(k * box_mass);
    shaker = m.add_actuator(dem::mbd::joint_actuator("shaker", bottom_slide, k, c));
    shearing = m.add_actuator(dem::mbd::joint_actuator("shearing", top_slide, k, c));
    const double window = 1e-5 / settings_.shear_speed;  // a hundredth of a millimetre of travel
    bottom_sensor = m.add_sensor(dem::mbd::contact_sensor("grains on the bottom box", bottom, window));
    shearing_sensor = m.add_sensor(dem::mbd::actuator_sensor("shearing force", shearing, window));
  }

  /// The lid's actuator is a speed controller without a position: a damper under which the lid's weight sinks at the
  /// lid speed, ever slower as the grains take up the load, until they carry all of it.
  void build_lid() {
    auto& m = world.machine();
    const double gap = settings_.lid_clearance * 0.5 * settings_.half_edge;
    const dem::Vec3 edges(settings_.box_length - 2.0 * gap, settings_.box_width - 2.0 * gap, lid_thickness);
    const double z = shape_.lid_low + 0.5 * lid_thickness;
    lid = add_box_body("lid", shape_.lid_mass, edges, z);
    world.add_surface(lid, dem::surface::Box(edges), {.name = "lid"});
    lid_slide = m.add_joint(dem::mbd::prismatic("lid slide", top, lid, {0.0, 0.0, z}, dem::Vec3::UnitZ()));
    lid_drive =
        m.add_actuator(dem::mbd::joint_actuator("lid drive", lid_slide, 0.0, lid_weight() / settings_.lid_speed));
    lid_sensor = m.add_sensor(dem::mbd::contact_sensor("grains on the lid", lid, 5e-3));
  }

  Settings settings_;
  RigShape shape_;
  dem::SpeciesId species_;
};

}  // namespace direct_shear
