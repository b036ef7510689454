#pragma once
// A box of grains with a lid that levels them: what the rigs that press, roll or cut stand on.

#include <dem/geometry/box/box.hpp>
#include <dem/rig/affordable.hpp>
#include <dem/rig/bed/bed_settings.hpp>
#include <dem/soil/bulk_density.hpp>
#include <dem/world/world.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

namespace dem::rig {

/// Grains of one shape in an open box: the floor's upper side is z = 0, its middle is x = y = 0. Walls are solid boxes,
/// as high as the grains need while they are rained. The box is one fixed body, or two halves on slides along x, as
/// those of the direct shear test, that actuators hold. A copy of a bed is the same bed, to the last bit, with its
/// contact histories: several tests may start from one. Where the Model's Domain is periodic, the bed repeats itself
/// along x, without walls there.
template <class M>
class Bed {
 public:
  using Model = M;
  using World = dem::World<Model>;
  using Shape = typename Model::Shape;
  static constexpr bool is_endless = Model::Domain::has_images;

  /// How the box is built.
  struct Box {
    bool halves = false;    ///< a bottom and a top box on slides; else one fixed body
    double wall_top = 0.0;  ///< m
  };

  Bed(const BedSettings& bed, const GrainSettings& grains, const Shape& shape, const Box& box,
      std::span<const soil::Placement> places)
      : world({.time_step_safety = bed.stable_share,
               .overlap_limit = 1.0,
               .domain = surface::Aabb{Vec3(-0.5 * bed.length - (is_endless ? 0.0 : bed.wall_thickness),
                                            -0.5 * bed.width - bed.wall_thickness, -bed.wall_thickness),
                                       Vec3(0.5 * bed.length + (is_endless ? 0.0 : bed.wall_thickness),
                                            0.5 * bed.width + bed.wall_thickness, box.wall_top + 0.1)},
               .periodic = {.x = is_endless},
               .threads = bed.threads > 0 ? bed.threads : threads_for(places.size()),
               .sleep = bed.sleep ? std::optional<SleepOptions>(SleepOptions{}) : std::nullopt}),
        bed_(bed),
        grains_(grains),
        grain_volume_(shape.volume()) {
    species_ = world.add_species(shape, {.material = "grain", .density = grains.density});
    set_friction(1.0);
    build_box(box);
    for (const auto& p : places) {
      world.add_grain({.species = species_, .position = p.position, .rotation = p.rotation});
    }
  }

  [[nodiscard]] const BedSettings& settings() const { return bed_; }
  [[nodiscard]] const GrainSettings& grains() const { return grains_; }
  [[nodiscard]] double grain_volume() const { return grain_volume_; }     ///< m^3
  [[nodiscard]] double area() const { return bed_.length * bed_.width; }  ///< m^2
  [[nodiscard]] double margin() const {
    return 3.0 * grains_.half_edge;
  }  ///< m, from walls and top to where density is measured

  /// This share of the friction of grains on grains and on walls acts from the next step on.
  void set_friction(double share) {
    world.set_contact("grain", "grain", grain_contact<Model>(grains_, share * grains_.friction));
    world.set_contact("grain", "wall", grain_contact<Model>(grains_, share * grains_.wall_friction));
  }

  /// Solid fraction of the inside of the bed; NaN of one that has no inside. `surface` (m) is the height of
  /// the level, if there is one.
  [[nodiscard]] double solid_fraction(double surface = -1.0) const {
    return soil::inner_fraction(soil::placements(world), grains_.half_edge, grain_volume_, bed_.length, bed_.width,
                                margin(), surface);
  }

  /// Puts a lid over the grains (level() of make_bed.hpp lowers it), by a slide and a drive. The drive is a damper
  /// under which the lid's weight sinks at the lid speed, ever slower as the grains take up the load.
  void add_lid() {
    auto& m = world.machine();
    const double gap = 0.125 * grains_.half_edge, thickness = 0.01;
    const double length = is_endless ? bed_.length + 2.0 * beyond() : bed_.length - 2.0 * gap;
    const Vec3 edges(length, bed_.width - 2.0 * gap, thickness);
    if (!std::isfinite(lid_at)) {  // in a run that goes on the grains are not where they were
      double highest = 0.0;
      for (const auto p : world.grains()) highest = std::max(highest, world.position(p).z());
      lid_at = highest + world.species(species_).shape.bounding_radius() + 0.5 * thickness;
    }
    const double z = lid_at;
    const double weight = lid_weight();
    lid = m.add_body(mbd::box_body("lid", edges, weight / 9.81 / edges.prod()).at(Vec3(0.0, 0.0, z)));
    lid_surface = world.add_surface(lid, surface::Box(edges), {.name = "lid"});
    lid_slide = m.add_joint(mbd::prismatic("lid slide", top, lid, {0.0, 0.0, z}, Vec3::UnitZ()));
    lid_drive = m.add_actuator(mbd::joint_actuator("lid drive", lid_slide, 0.0, weight / bed_.lid_speed));
    lid_sensor = m.add_sensor(mbd::contact_sensor("grains on the lid", lid, 5e-3));
  }
  [[nodiscard]] double lid_weight() const { return bed_.lid_pressure * area(); }                     ///< N
  [[nodiscard]] double lid_low() const { return world.machine().body(lid).position().z() - 0.005; }  ///< m, underside

  /// Takes the lid off: it stays where it is, but touches nothing any more.
  void take_lid_off() {
    auto& m = world.machine();
    m.add_motion(mbd::prescribed_joint("held lid", lid_slide, m.coordinate(lid_slide)));
    world.set_active(lid_surface, false);
  }

  /// What of it is not the world's, for a run that goes on after it was stopped.
  template <class V>
  void fields(V& v) {
    v("surface_level", level, "m"), v("lid_at", lid_at, "m");
  }

  World world;
  double level = std::nan("");   ///< m, mean height of the levelled surface
  double lid_at = std::nan("");  ///< m, height of the lid's middle where it was put over the grains
  BodyId bottom, top, lid;       ///< a fixed box is both bottom and top
  JointId lid_slide;
  ActuatorId lid_drive;
  SensorId lid_sensor;
  SurfaceId lid_surface;

 private:
  /// m, by which the floor reaches beyond the bed: under the walls, or as far as images of grains do.
  [[nodiscard]] double beyond() const { return is_endless ? 4.0 * grains_.edge() : bed_.wall_thickness; }

  void add_walls(BodyId body, const std::string& name, double low, double high, double z) {
    const double lx = bed_.length, ly = bed_.width, t = bed_.wall_thickness, middle = 0.5 * (low + high) - z;
    for (const double side : {-1.0, 1.0}) {
      const char* sign = side < 0.0 ? "-" : "+";
      if (!is_endless) {
        world.add_surface(body, surface::Box(Vec3(t, ly + 2.0 * t, high - low)),
                          {.name = name + sign + "x", .position = {side * 0.5 * (lx + t), 0.0, middle}});
      }
      world.add_surface(body, surface::Box(Vec3(is_endless ? lx + 2.0 * beyond() : lx, t, high - low)),
                        {.name = name + sign + "y", .position = {0.0, side * 0.5 * (ly + t), middle}});
    }
  }

  void build_box(const Box& box) {
    auto& m = world.machine();
    const double t = bed_.wall_thickness;
    // Grains of a file may lie lower than the depth that the size has.
    const double seam = box.halves ? 0.5 * std::min(bed_.depth, box.wall_top) : box.wall_top;
    const Vec3 outer(bed_.length + 2.0 * beyond(), bed_.width + 2.0 * t, t);
    const double mass = bed_.half_mass;
    const auto half = [&](const char* name, double height) {
      return m.add_body(mbd::box_body(name, outer, mass / outer.prod()).at(Vec3(0.0, 0.0, height)));
    };
    bottom = box.halves ? half("bottom box", 0.0) : m.add_body(mbd::fixed_body("bottom box"));
    world.add_surface(bottom, surface::Box(outer), {.name = "floor", .position = {0.0, 0.0, -0.5 * t}});
    add_walls(bottom, "wall ", 0.0, seam, 0.0);
    top = bottom;
    if (!box.halves) return;
    top = half("top box", seam);
    add_walls(top, "top wall ", seam, box.wall_top, seam);
    const double k = bed_.half_stiffness, c = 2.0 * std::sqrt(k * mass);
    for (const BodyId body : {bottom, top}) {
      const std::string name = m.body(body).name;
      const JointId slide = m.add_joint(
          mbd::prismatic(name + " slide", m.ground(), body, Vec3(0.0, 0.0, body == top ? seam : 0.0), Vec3::UnitX()));
      m.add_actuator(mbd::joint_actuator(name + " drive", slide, k, c));
    }
  }

  BedSettings bed_;
  GrainSettings grains_;
  double grain_volume_;
  SpeciesId species_;
};

}  // namespace dem::rig
