#pragma once

#include <dem/soil/bed_filling.hpp>
#include <dem/soil/bed_options.hpp>
#include <dem/soil/bed_report.hpp>
#include <dem/soil/container.hpp>
#include <dem/soil/lid.hpp>
#include <dem/soil/making.hpp>
#include <dem/soil/solid_layers.hpp>
#include <dem/world/mixture.hpp>
#include <dem/world/world.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <numbers>
#include <utility>
#include <vector>

namespace dem::soil {

/// A bed of grains in a container: filled to a height, as dense as asked for, and levelled. The world is the user's,
/// with species and contact constants, and has no other grains.
///
///     soil::Bed bed(world, soil::Container::cylinder(0.05), sand, {.height = 0.04});
///     const soil::BedReport made = bed.make();                      // how dense it is
///     for (const soil::SolidLayer& layer : bed.layers(0.005)) ...   // solid fraction by depth
///     save(world, "bed.h5");                                        // of <dem/io/checkpoint.hpp>
///
/// A program that starts from such a file makes the world and the Bed, which adds the walls, the lid and the inlet of
/// the rain, and calls load(world, "bed.h5") in place of make(); the Bed does not know that it is made then, and make()
/// would fill it again. load(world, "bed.h5", bed) of a file that was saved with the bed tells it. The lid is a body of
/// the machine; when the bed is made it stands still where it was, and touches nothing. The inlet is closed then.
///
/// A bed may be saved on its way as well, with its own fields:
///
///     bed.make(set_friction, [&] { if (is_time()) save(world, "bed.h5", bed); });
///     ...
///     load(world, "bed.h5", bed);        // in another run of the program
///     bed.make(set_friction, look);      // goes on, and ends in the same bits; nothing is left to do where it was
///     made
///
/// A Bed refers to its world, which must stay where it is.
template <class Model>
class Bed {
 public:
  /// Adds the walls. Throws Error for settings that make no sense.
  Bed(World<Model>& world, const Container& container, const Mixture& grains, const BedOptions& o)
      : world_((require_no_grains(world), require_gravity_down(world), world)),
        container_(container),
        options_((o.check(), o)),
        gravity_(world.state().options.gravity),
        filling_(world, container, grains, o),
        walls_(container.add_walls(world, filling_.top(), o.wall_material)),
        pressing_(0.0, o.lid_speed) {
    if (o.lid_pressure > 0.0) {
      lid_ = Lid(world, Vec3(container.length(), container.width(o.height), filling_.radius()),
                 o.lid_pressure * container.area(o.height), o.lid_speed, filling_.top(), o.wall_material);
    }
    begin(Stage::filling);
  }

  const Container& container() const { return container_; }
  const std::vector<SurfaceId>& walls() const { return walls_; }  ///< floor first
  /// m, above which no grain stands. Coarse grains, and such that cohere, lie lower in the mean: height_field() of
  /// ground_surface.hpp says where.
  double height() const { return options_.height; }
  SurfaceId lid() const { return lid_.surface(); }    ///< of no surface where there is none
  InletId inlet() const { return filling_.inlet(); }  ///< of the rain; of no inlet where there is none

  /// Fills the container, lets the grains come to rest, makes them as dense as asked for, presses them, and levels
  /// them. `set_friction(share)` is called while a bed is made denser, with shares from 1 to 0 and at last 1 again: it
  /// sets this share of the grains' friction, by World::set_contact. `look()` is called every few milliseconds: there
  /// the bed may be saved, or left by throwing. All of the friction is there while it is called; gravity is the shaken
  /// one while a bed is made denser. A bed that was left,
  /// or loaded on its way, goes on from there; one that is made stays as it is. Returns how dense it is, and says so in
  /// words where that is not as asked for. Throws Error if the grains do not come to rest in time, if they blow up, for
  /// a rain that finds no room, for a bed that settles denser than asked for, and for a density that shaking without
  /// friction does not reach.
  template <std::invocable<double> SetFriction, std::invocable Look>
  BedReport make(SetFriction&& set_friction, Look&& look) {
    const Stage after_density = lid_.is_there() ? Stage::pressing : Stage::filling;
    while (stage_ != Stage::made) {
      switch (stage_) {
        case Stage::filling:
          if (reaches_height()) strike_off(), begin(Stage::levelled);
          else fill_again();
          break;
        case Stage::raining: filling_.go_on_raining(running(), look), begin(Stage::fallen); break;
        case Stage::fallen:
          settle_on(look);
          if (options_.relative_density > 0.0) {
            if (fillings_ == 1) refuse_denser(solid_fraction(), options_);  // later ones lie on what is dense already
            begin(Stage::densifying);
          } else {
            begin(after_density);
          }
          break;
        case Stage::densifying: densify_on(set_friction, look), begin(Stage::dense); break;
        case Stage::dense: settle_on(look), begin(after_density); break;
        case Stage::pressing: press_on(look), begin(Stage::pressed); break;
        case Stage::pressed: settle_on(look), begin(Stage::filling); break;
        case Stage::levelled: settle_on(look), begin(Stage::made); break;
        case Stage::made: break;
      }
    }
    return report();
  }
  template <std::invocable<double> SetFriction>
  BedReport make(SetFriction&& set_friction) {
    return make(set_friction, [] {});
  }
  /// The same of a bed that is as dense as it settles.
  BedReport make() {
    if (options_.relative_density > 0.0) {
      fail("a bed of the relative density {:g} is made with less friction; give make() a function that sets it",
           options_.relative_density);
    }
    return make([](double) {});
  }
  /// How dense it is now, and in what that is not as asked for.
  BedReport report() const { return report_of_bed(solid_fraction(), options_); }
  bool is_made() const { return stage_ == Stage::made; }

  // The same step by step, by hand.

  /// Puts grains of this solid volume (m^3) over those that are there: in a lattice, turned at random, each moved
  /// within its cell; or by rain, until all of them have left the inlet. Throws Error if they are more than the walls
  /// hold, and for a rain that finds no room.
  void fill(double solid) {
    require_positive(solid, "solid volume of the grains of a bed", "m^3");
    if (!filling_.is_rained()) return filling_.place(solid);
    filling_.begin_rain(solid);
    filling_.go_on_raining(running(), [] {});
  }
  /// Runs until the grains rest (Settling).
  void settle() {
    settling_ = {world_.time(), rest(), options_.fall_speed};
    settle_on([] {});
  }
  /// Lowers the lid until the grains carry it within 2 % and it rests, both for 10 ms, takes it off, and lets the
  /// grains come to rest. Throws Error if that takes longer than the time limit, and for a bed without a lid.
  void press() {
    if (!lid_.is_there()) fail("a bed is to be pressed, but has no lid; set BedOptions::lid_pressure");
    lower_lid();
    press_on([] {});
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
    const double d = 2.0 * filling_.radius();
    if (height() < 3.0 * d) return solid_fraction_between(world_, container_, 0.0, height());
    return solid_fraction_between(world_, container_, d, height() - d);
  }
  /// As of the limits that were given; NaN without.
  double relative_density() const { return report().relative_density; }

  /// What of it is not the world's, for a bed that is saved on its way.
  template <class V>
  void fields(V& v) {
    v.given("bed", options_);
    v("stage", stage_), v("fillings", fillings_), v("filling", filling_);
    v("settling", settling_), v("densifying", densifying_), v("pressing", pressing_);
  }

 private:
  static void require_no_grains(const World<Model>& world) {
    std::size_t count = 0;
    for (const GrainId p : world.grains()) count += world.species(world.species_of(p)).is_held() ? 0U : 1U;
    if (count == 0) return;
    fail(
        "a bed is made in a world that has {} grain{} already: its walls and its rain would be put into them; make the "
        "bed first, or add these grains when it is made",
        count, count == 1 ? "" : "s");
  }
  static void require_gravity_down(const World<Model>& world) {
    const Vec3& g = world.state().options.gravity;
    if (g.z() < 0.0 && std::hypot(g.x(), g.y()) <= 0.02 * -g.z()) return;
    fail(
        "a bed comes to rest and is levelled under gravity along -z, but it is ({:g}, {:g}, {:g}) m/s^2; set "
        "WorldOptions::gravity, and turn it by set_gravity() when the bed is made",
        g.x(), g.y(), g.z());
  }
  /// What is going on. Of two that settle, what follows differs.
  enum class Stage { filling, raining, fallen, densifying, dense, pressing, pressed, levelled, made };

  void begin(Stage stage) {
    stage_ = stage;
    if (stage == Stage::densifying) densifying_ = {world_.time(), solid_fraction(), options_.densify_time};
    else if (stage == Stage::pressing) lower_lid();
    else if (stage != Stage::raining) settling_ = {world_.time(), rest(), options_.fall_speed};
  }

  double rest() const { return rest_speed(2.0 * filling_.radius(), gravity_.norm()); }  // m/s
  auto running() {
    return [this](double seconds) { run(seconds); };
  }

  /// Whether the topmost layer below the height is as full as those below.
  bool reaches_height() const {
    if (world_.grain_count() == 0) return false;
    const double d = 2.0 * filling_.radius(), from = std::max(0.0, height() - d);
    return solid_fraction_between(world_, container_, from, height()) >= 0.8 * solid_fraction();
  }
  void fill_again() {
    constexpr int most_fillings = 5;
    if (fillings_ == most_fillings) {
      fail("the bed does not reach {:g} m after {} fillings; raise BedOptions::expected_fraction", height(), fillings_);
    }
    ++fillings_;
    if (!filling_.is_rained()) return filling_.place(filling_.missing()), begin(Stage::fallen);
    filling_.begin_rain(filling_.missing());
    begin(Stage::raining);
  }
  template <class Look>
  void settle_on(Look&& look) {
    const double fall = options_.fall_speed > 0.0 ? filling_.top() / options_.fall_speed : 0.0;
    const double limit = options_.time_limit + fall;  // s
    while (!settling_.look(world_.time())) {
      if (world_.time() - settling_.start > limit) {
        fail(
            "the grains of a bed are not at rest after {:g} s: their r.m.s. speed is {:g} m/s, rest is below {:g}; "
            "raise BedOptions::time_limit or the damping",
            limit, settling_.speed, settling_.rest);
      }
      settling_.go_on(world_, running());
      look();
    }
  }
  /// Friction sinks to zero while the bed is shaken, until it is dense enough.
  template <class SetFriction, class Look>
  void densify_on(SetFriction&& set_friction, Look&& look) {
    const double w = 2.0 * std::numbers::pi * options_.frequency, wanted = options_.wanted();
    const Shaking shaking{gravity_, Vec3::UnitX(), options_.shaking * gravity_.norm() / (w * w), options_.frequency};
    while (densifying_.fraction < wanted) {
      const bool gains = densifying_.go_on(
          world_.time(), options_.densify_time, set_friction, [this] { return solid_fraction(); },
          [&] { shaking.run(world_, densifying_.start, running()); });
      if (!gains && densifying_.fraction < wanted) {
        world_.set_gravity(gravity_);
        set_friction(1.0);
        fail(
            "a bed is to have the solid fraction {:g}, but shaken without friction it comes to {:g}; lower "
            "BedOptions::relative_density, or measure the limits of this soil",
            wanted, densifying_.fraction);
      }
      set_friction(1.0);  // a program that goes on sets up all of it
      look();
    }
    world_.set_gravity(gravity_);
    set_friction(1.0);
  }
  void lower_lid() {
    double highest = 0.0;
    for (const GrainId p : world_.grains()) highest = std::max(highest, world_.position(p).z());
    lid_.move_to(world_, highest + 1.1 * filling_.radius());
    run(0.1);
    lid_.let_go(world_);
    pressing_ = {world_.time(), options_.lid_speed};
  }
  template <class Look>
  void press_on(Look&& look) {
    while (!pressing_.done) {
      run(1e-3);
      pressing_.look(world_.time(), lid_.carried(world_), lid_.speed(world_));
      if (!pressing_.done && world_.time() - pressing_.start > options_.time_limit) {
        fail(
            "the lid of a bed is not at rest after {:g} s: the grains carry {:.4g} N of {:.4g} N; raise "
            "BedOptions::time_limit or the damping",
            options_.time_limit, lid_.carried(world_) * lid_.load(), lid_.load());
      }
      look();
    }
    lid_.take_off(world_);
  }
  void run(double seconds) {
    if (const StepReport report = world_.run_for(seconds); !report) fail("{}", report.text);
  }

  World<Model>& world_;
  Container container_;
  BedOptions options_;
  Vec3 gravity_;
  BedFilling<Model> filling_;
  std::vector<SurfaceId> walls_;
  Lid lid_;
  Stage stage_ = Stage::filling;
  std::uint64_t fillings_ = 0;
  Settling settling_{0.0, 0.0};
  Densifying densifying_;
  Pressing pressing_;
};

}  // namespace dem::soil
