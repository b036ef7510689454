#pragma once

#include <dem/soil/making.hpp>
#include <dem/soil/relative_density.hpp>
#include <dem/soil/solid_layers.hpp>
#include <dem/world/mixture.hpp>
#include <dem/world/world.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <numbers>
#include <string>
#include <vector>

namespace dem::soil {

/// Settings of a bed.
struct BedOptions {
  double height = 0.0;             ///< m, of the levelled surface
  double relative_density = 0.0;   ///< 0: as it settles; above 0, `limits` are needed
  DensityLimits limits = {0, 0};   ///< of this soil
  double expected_fraction = 0.6;  ///< solid fraction as it settles, by which grains are counted
  double room = 0.05;              ///< between grains as they are placed, in largest diameters
  double densify_time = 0.5;       ///< s, in which friction goes to zero
  double shaking = 0.5;            ///< to and fro along x, while friction sinks, in weights
  double frequency = 25.0;         ///< Hz, of the shaking
  double lid_pressure = 0.0;       ///< Pa, by which a lid presses the grains flat before they are struck off; 0: none
  double lid_speed = 0.05;         ///< m/s, at which it comes down
  double time_limit = 5.0;         ///< s, in which the grains must come to rest, and the lid on them
  std::uint64_t seed = 1;
  std::string wall_material = "wall";
};

/// A bed of grains in a container: filled to a height, as dense as asked for, and levelled. The world is the user's,
/// with species and contact constants, and has no other grains.
///
///     soil::Bed bed(world, soil::Container::cylinder(0.05), sand, {.height = 0.04});
///     bed.make();
///     for (const soil::SolidLayer& layer : bed.layers(0.005)) ...   // solid fraction by depth
///     save(world, "bed.h5");                                        // of <dem/io/checkpoint.hpp>
///
/// A program that starts from such a file makes the world and the Bed, which adds the walls and the lid, and calls
/// load(world, "bed.h5") in place of make(). The lid is a body of the machine; when the bed is made it stands still
/// where it was, and touches nothing.
template <class Model>
class Bed {
 public:
  /// Adds the walls. Throws Error for settings that make no sense.
  Bed(World<Model>& world, const Container& container, const Mixture& grains, const BedOptions& o)
      : world_(world), container_(container), options_(o), random_(o.seed), gravity_(world.state().options.gravity) {
    require_positive(o.height, "height of a bed", "m");
    require_within(o.relative_density, 0.0, 1.0, "relative density of a bed");
    require_within(o.expected_fraction, 0.01, 1.0, "solid fraction that a bed is expected to have");
    require_within(o.room, 0.0, 10.0, "room between grains as they are placed");
    require_positive(o.densify_time, "time in which a bed is made denser", "s");
    require_non_negative(o.shaking, "strength of shaking", "weights");
    require_positive(o.frequency, "frequency of shaking", "Hz");
    require_non_negative(o.lid_pressure, "pressure of the lid of a bed", "Pa");
    require_positive(o.lid_speed, "speed of the lid of a bed", "m/s");
    require_positive(o.time_limit, "time in which a bed must come to rest", "s");
    if (o.relative_density > 0.0 && !(o.limits.densest > o.limits.loosest && o.limits.loosest > 0.0)) {
      fail(
          "a bed is to have the relative density {:g}, but the solid fractions of its soil are given as {:g} at the "
          "loosest and {:g} at the densest; set BedOptions::limits",
          o.relative_density, o.limits.loosest, o.limits.densest);
    }
    const auto mass_of = [&](SpeciesId s) { return world.species(s).mass; };
    draw_ = MixtureDraw(grains, mass_of);
    double numbers = 0.0, volumes = 0.0;
    for (const Mixture::Part& part : grains.parts) {
      const auto& shape = world.species(part.species).shape;
      const double number = grains.by == ShareOf::mass ? part.share / mass_of(part.species) : part.share;
      if (number > 0.0) radius_ = std::max(radius_, shape.bounding_radius());
      numbers += number, volumes += number * shape.volume();
    }
    cell_ = 2.0 * (1.0 + o.room) * radius_;
    // Half as high again as the lattice would need without walls.
    const double placed = volumes / numbers / (cell_ * cell_ * cell_);
    top_ = 1.5 * wanted() * (1.1 * o.height + 2.0 * cell_) / placed + 10.0 * cell_;
    walls_ = container.add_walls(world, top_, o.wall_material);
    if (o.lid_pressure > 0.0) add_lid();
  }

  const Container& container() const { return container_; }
  const std::vector<SurfaceId>& walls() const { return walls_; }  ///< floor first
  double height() const { return options_.height; }               ///< m, of the levelled surface
  SurfaceId lid() const { return lid_; }                          ///< of no surface where there is none

  /// Fills the container, lets the grains come to rest, makes them as dense as asked for, presses them, and levels
  /// them. `set_friction(share)` is called while a bed is made denser, with shares from 1 to 0 and at last 1 again: it
  /// sets this share of the grains' friction, by World::set_contact. Throws Error if the grains do not come to rest in
  /// time, if they blow up, and for a density that shaking without friction does not reach.
  template <std::invocable<double> SetFriction>
  void make(SetFriction&& set_friction) {
    constexpr int most_fillings = 5;
    for (int k = 0; !reaches_height(); ++k) {
      if (k == most_fillings) {
        fail("the bed does not reach {:g} m after {} fillings; raise BedOptions::expected_fraction", height(), k);
      }
      // A tenth and a layer more than fit, so that there is something to strike off.
      const double solid = wanted() * container_.volume(1.1 * height() + cell_);
      fill(std::max(solid - solid_volume(world_), 0.1 * solid));
      settle();
      if (options_.relative_density > 0.0) densify(set_friction);
      if (options_.lid_pressure > 0.0) press();
    }
    strike_off();
    settle();
  }
  /// The same of a bed that is as dense as it settles.
  void make() {
    if (options_.relative_density > 0.0) {
      fail("a bed of the relative density {:g} is made with less friction; give make() a function that sets it",
           options_.relative_density);
    }
    make([](double) {});
  }

  /// Puts grains of this solid volume (m^3) over those that are there: in a lattice, turned at random, each moved
  /// within its cell. Throws Error if they are more than the walls hold.
  void fill(double solid) {
    require_positive(solid, "solid volume of the grains of a bed", "m^3");
    double z = 0.5 * cell_;
    for (const GrainId p : world_.grains()) z = std::max(z, world_.position(p).z() + cell_);
    const auto half = [this](double length) { return std::floor(0.5 * length / cell_); };
    for (double put = 0.0; put < solid; z += cell_) {
      if (z + 0.5 * cell_ > top_) {
        fail("a bed of {:g} m needs more grains than its walls of {:g} m hold; lower BedOptions::room", height(), top_);
      }
      const double before = put, nx = half(container_.length()), ny = half(container_.width(z));
      for (double j = -ny; j <= ny; ++j) {
        for (double i = -nx; i <= nx && put < solid; ++i) {
          const Vec3 x(cell_ * i, cell_ * j, z);
          if (container_.clearance(x) < 0.5 * cell_) continue;
          const SpeciesId kind = draw_.draw(random_);
          const Vec3 shift = (cell_ - 2.0 * radius_) * random_.in_box(filled(-0.5), filled(0.5));
          world_.add_grain({.species = kind, .position = x + shift, .rotation = random_.rotation()});
          put += world_.species(kind).shape.volume();
        }
      }
      if (put == before) {
        fail("a container of {:g} m x {:g} m has no place for a grain that needs {:g} m", container_.length(),
             container_.width(z), cell_);
      }
    }
  }

  /// Runs until the grains rest (Settling).
  void settle() {
    Settling n{world_.time(), rest_speed(2.0 * radius_, gravity_.norm())};
    while (!n.look(world_.time())) {
      if (world_.time() - n.start > options_.time_limit) {
        fail(
            "the grains of a bed are not at rest after {:g} s: their r.m.s. speed is {:g} m/s, rest is below {:g}; "
            "raise BedOptions::time_limit or the damping",
            options_.time_limit, n.speed, n.rest);
      }
      n.go_on(world_, [this](double seconds) { run(seconds); });
    }
  }

  /// Lowers the lid until the grains carry it within 2 % and it rests, both for 10 ms, takes it off, and lets the
  /// grains come to rest. Throws Error if that takes longer than the time limit, and for a bed without a lid.
  void press() {
    if (!lid_.valid()) fail("a bed is to be pressed, but has no lid; set BedOptions::lid_pressure");
    auto& m = world_.machine();
    double highest = 0.0;
    for (const GrainId p : world_.grains()) highest = std::max(highest, world_.position(p).z());
    m.set_target(lid_hold_, highest + 1.1 * radius_ - top_);
    run(0.1);  // the lid comes over the grains
    const double weight = lid_weight();
    world_.set_active(lid_, true);
    m.switch_on(lid_hold_, false), m.switch_on(lid_drive_, true);
    for (Pressing n{world_.time(), options_.lid_speed}; !n.done;) {
      run(1e-3);
      const double force = world_.surface_force(lid_).z();
      n.look(world_.time(), force / weight, m.speed(lid_slide_));
      if (!n.done && world_.time() - n.start > options_.time_limit) {
        fail(
            "the lid of a bed is not at rest after {:g} s: the grains carry {:.4g} N of {:.4g} N; raise "
            "BedOptions::time_limit or the damping",
            options_.time_limit, force, weight);
      }
    }
    m.set_target(lid_hold_, m.coordinate(lid_slide_));
    m.switch_on(lid_hold_, true), m.switch_on(lid_drive_, false);
    world_.set_active(lid_, false);
    settle();
  }

  /// Takes off what stands above the height.
  void strike_off() {
    for (const GrainId p : world_.grains()) {
      const double radius = world_.species(world_.species_of(p)).shape.bounding_radius();
      if (world_.position(p).z() + radius > height()) world_.remove_grain(p);
    }
  }

  /// Solid fractions from the floor to the level, by layers of this thickness (m).
  std::vector<SolidLayer> layers(double thickness) const {
    return solid_layers(world_, container_, thickness, height());
  }
  /// Solid fraction away from the floor and the level by a largest grain's diameter, or of all if that leaves nothing.
  double solid_fraction() const {
    const double d = 2.0 * radius_;
    if (height() < 3.0 * d) return solid_fraction_between(world_, container_, 0.0, height());
    return solid_fraction_between(world_, container_, d, height() - d);
  }
  /// As of the limits that were given; NaN without.
  double relative_density() const {
    if (!(options_.limits.loosest > 0.0)) return std::nan("");
    return soil::relative_density(solid_fraction(), options_.limits);
  }

 private:
  double lid_weight() const { return options_.lid_pressure * container_.area(height()); }  // N

  /// A plane over the walls. It is held until it is lowered; then it sinks in a damper, ever slower as the grains take
  /// it up.
  void add_lid() {
    if (!(gravity_.z() < 0.0)) fail("a lid presses a bed by its weight, but gravity does not point to the floor");
    auto& m = world_.machine();
    const double mass = lid_weight() / -gravity_.z(), thickness = radius_;
    const Vec3 edges(container_.length(), container_.width(height()), thickness), at(0, 0, top_);
    const BodyId body = m.add_body(mbd::box_body("lid", edges, mass / edges.prod()).at(at));
    lid_slide_ = m.add_joint(mbd::prismatic("lid slide", m.ground(), body, at, Vec3::UnitZ()));
    constexpr double sag = 1e-5;  // m, of the lid as it is held
    const double k = lid_weight() / sag;
    lid_hold_ = m.add_actuator(mbd::joint_actuator("lid hold", lid_slide_, k, 2.0 * std::sqrt(k * mass)));
    lid_drive_ = m.add_actuator(mbd::joint_actuator("lid drive", lid_slide_, 0.0, lid_weight() / options_.lid_speed));
    m.switch_on(lid_drive_, false);
    lid_ = world_.add_surface(body, surface::Plane{},
                              {.material = options_.wall_material,
                               .name = "lid",
                               .rotation = rotation_between(Vec3::UnitZ(), Vec3(0, 0, -1))});
    world_.set_active(lid_, false);
  }

  double wanted() const {
    return options_.relative_density > 0.0 ? solid_fraction_at(options_.relative_density, options_.limits)
                                           : options_.expected_fraction;
  }
  /// Whether the topmost layer below the height is as full as those below.
  bool reaches_height() const {
    if (world_.grain_count() == 0) return false;
    const double d = 2.0 * radius_, from = std::max(0.0, height() - d);
    return solid_fraction_between(world_, container_, from, height()) >= 0.8 * solid_fraction();
  }
  void run(double seconds) {
    if (const StepReport report = world_.run_for(seconds); !report) fail("{}", report.text);
  }
  /// Friction sinks to zero while the bed is shaken, until it is dense enough.
  template <class SetFriction>
  void densify(SetFriction&& set_friction) {
    const double w = 2.0 * std::numbers::pi * options_.frequency;
    const Shaking shaking{gravity_, Vec3::UnitX(), options_.shaking * gravity_.norm() / (w * w), options_.frequency};
    Densifying n(world_.time(), solid_fraction(), options_.densify_time);
    while (n.fraction < wanted()) {
      const bool gains = n.go_on(
          world_.time(), options_.densify_time, set_friction, [this] { return solid_fraction(); },
          [&] { shaking.run(world_, n.start, [this](double seconds) { run(seconds); }); });
      if (!gains && n.fraction < wanted()) {
        fail(
            "a bed is to have the solid fraction {:g}, but shaken without friction it comes to {:g}; lower "
            "BedOptions::relative_density, or measure the limits of this soil",
            wanted(), n.fraction);
      }
    }
    world_.set_gravity(gravity_);
    set_friction(1.0);
    settle();
  }

  World<Model>& world_;
  Container container_;
  BedOptions options_;
  RandomStream random_;
  Vec3 gravity_;
  MixtureDraw draw_;
  std::vector<SurfaceId> walls_;
  SurfaceId lid_ = {};
  JointId lid_slide_ = {};
  ActuatorId lid_hold_ = {}, lid_drive_ = {};
  double radius_ = 0.0, cell_ = 0.0, top_ = 0.0;  // m: of the largest grain; of the lattice; of the walls
};

}  // namespace dem::soil
