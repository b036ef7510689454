#pragma once

#include <dem/soil/bed_options.hpp>
#include <dem/soil/container.hpp>
#include <dem/soil/making.hpp>
#include <dem/soil/solid_layers.hpp>
#include <dem/world/mixture.hpp>
#include <dem/world/world.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>

namespace dem::soil {

/// Puts the grains of a bed into its container: in a lattice, all at once, or by rain from an inlet above. Bed has one.
template <class Model>
class BedFilling {
 public:
  /// Adds the inlet of the rain, closed. Throws Error for a mixture that makes no sense, and for a container that no
  /// rain falls into.
  BedFilling(World<Model>& world, const Container& container, const Mixture& grains, const BedOptions& o)
      : world_(world), container_(container), options_(o), random_(o.seed) {
    const auto mass_of = [&](SpeciesId s) { return world.species(s).mass; };
    draw_ = MixtureDraw(grains, mass_of);
    double numbers = 0.0, radii = 0.0, volumes = 0.0, masses = 0.0;
    for (const Mixture::Part& part : grains.parts) {
      const auto& shape = world.species(part.species).shape;
      const double number = grains.by == ShareOf::mass ? part.share / mass_of(part.species) : part.share;
      if (number > 0.0) radius_ = std::max(radius_, shape.bounding_radius());
      radii += number * shape.bounding_radius();
      numbers += number, volumes += number * shape.volume(), masses += number * mass_of(part.species);
    }
    density_ = masses / volumes;
    cell_ = 2.0 * (1.0 + o.room) * radius_;
    if (const double across = 2.0 * radii / numbers; o.height < 2.0 * across) {
      fail("a bed of {:g} m is to be made of grains of {:g} m across, but must be two of them high at least, {:g} m",
           o.height, across, 2.0 * across);
    }
    if (const double count = missing() * numbers / volumes; count > 4e9) {
      fail(
          "a bed of {:g} m x {:g} m x {:g} m takes {:.2g} grains of {:g} m across, but a world has at most 4e9; all "
          "lengths are in m",
          container_.length(), container_.width(o.height), o.height, count, 2.0 * radius_);
    }
    if (o.is_rained()) {
      add_inlet(grains);
    } else {  // half as high again as the lattice would need without walls
      const double placed = volumes / numbers / (cell_ * cell_ * cell_);
      top_ = 1.5 * o.wanted() * (1.1 * o.height + 2.0 * cell_) / placed + 10.0 * cell_;
    }
  }

  double radius() const { return radius_; }  ///< m, bounding radius of the largest grain
  double top() const { return top_; }        ///< m, how high the walls must be
  InletId inlet() const { return inlet_; }   ///< of the rain; of no inlet where there is none
  bool is_rained() const { return inlet_.valid(); }

  /// Solid volume (m^3) of grains that are put in now: a tenth and a layer more than fit, so that there is something to
  /// strike off; at least a tenth of that.
  double missing() const {
    const double all = options_.wanted() * container_.volume(1.1 * options_.height + cell_);
    return std::max(all - solid_volume(world_), 0.1 * all);
  }

  /// Puts grains of this solid volume (m^3) over those that are there: in a lattice, turned at random, each moved
  /// within its cell. Throws Error if they are more than the walls hold.
  void place(double solid) {
    double z = 0.5 * cell_;
    for (const GrainId p : world_.grains()) z = std::max(z, world_.position(p).z() + cell_);
    const auto half = [this](double length) { return std::floor(0.5 * length / cell_); };
    for (double put = 0.0; put < solid; z += cell_) {
      if (z + 0.5 * cell_ > top_) {
        fail("a bed of {:g} m needs more grains than its walls of {:g} m hold; lower BedOptions::room", options_.height,
             top_);
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
      if (put == before) refuse_narrow(z);
    }
  }

  /// Opens the inlet for grains of this solid volume (m^3). go_on_raining() is what follows.
  void begin_rain(double solid) {
    const double there = solid_volume(world_);
    raining_ = {world_.time(), there + solid, there};
    world_.set_open(inlet_, true);
  }
  /// Rains until these grains have left the inlet, and closes it. Calls `look()` now and then. Throws Error where that
  /// takes twice as long as it should.
  template <std::invocable<double> Run, std::invocable Look>
  void go_on_raining(Run&& run, Look&& look) {
    const double limit = options_.time_limit + 2.0 * raining_.wanted * density_ / options_.rain_flow;
    while (!raining_.is_done()) {
      if (world_.time() - raining_.start > limit) {
        world_.set_open(inlet_, false);
        fail(
            "the rain on a bed has brought {:g} m^3 of {:g} m^3 of grains after {:g} s, as there is no room where it "
            "comes from; lower BedOptions::rain_flow, or raise BedOptions::rain_height if the grains reach up to it",
            raining_.solid, raining_.wanted, limit);
      }
      raining_.go_on(world_, run);
      look();
    }
    world_.set_open(inlet_, false);
  }

  template <class V>
  void fields(V& v) {
    v.given("mixture", draw_);
    v("random", random_), v("raining", raining_);
  }

 private:
  /// Over the middle of the level, and as wide: a trough is wider up there.
  void add_inlet(const Mixture& grains) {
    const double height = options_.height, near = 1.05 * radius_;
    const double low = 1.1 * height + cell_ + options_.rain_height + radius_, high = low + 2.0 * cell_;
    const double x = 0.5 * container_.length() - near, y = 0.5 * container_.width(height) - near;
    if (!(x > 0.0) || !(y > 0.0)) refuse_narrow(height);
    const InletRegion region = container_.is_round()
                                   ? InletRegion::disc(Vec3(0, 0, 0.5 * (low + high)), Vec3::UnitZ(), x, high - low)
                                   : InletRegion::box(Vec3(-x, -y, low), Vec3(x, y, high));
    inlet_ = world_.add_inlet(
        region, {.name = "rain", .grains = grains, .mass_flow = options_.rain_flow, .seed = options_.seed});
    world_.set_open(inlet_, false);
    top_ = high + 2.0 * cell_;
  }
  [[noreturn]] void refuse_narrow(double z) const {
    fail("a container of {:g} m x {:g} m has no place for a grain that needs {:g} m; enlarge it", container_.length(),
         container_.width(z), cell_);
  }

  World<Model>& world_;
  Container container_;
  BedOptions options_;
  RandomStream random_;
  MixtureDraw draw_;
  InletId inlet_ = {};
  double radius_ = 0.0, cell_ = 0.0, top_ = 0.0;  // m: of the largest grain; of the lattice; of the walls
  double density_ = 0.0;                          // kg/m^3, of the grains' solid
  Raining raining_;
};

}  // namespace dem::soil
