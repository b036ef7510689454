#pragma once

#include <dem/rig/sand_pile/fill_file.hpp>
#include <dem/rig/sand_pile/forming.hpp>
#include <dem/rig/sand_pile/resolve.hpp>

#include <span>
#include <utility>

namespace dem::rig {

/// A sand pile: grains are left when a cylinder is lifted, poured through a funnel, or stay in a box that is emptied
/// through a slot. Its angle of repose is that of lines through the flank (soil::fit_flank).
///
///     dem::rig::sand_pile::Settings settings;
///     settings.method = "funnel";
///     using Pebbles = dem::rig::sand_pile::Sand<dem::shape::Sphere>;
///     dem::rig::SandPile<Pebbles> pile(settings, {dem::shape::Sphere(2e-3), on_grain, on_plate, on_container});
///     fmt::print("{} rad", pile.make(1).flank.angle);
///
/// `Model` names the shape and the laws; its Surfaces must have boxes and cylinders. Stages tell how far they are, and
/// are stopped by throwing, as those of DirectShear.
template <class M>
class SandPile {
 public:
  using Model = M;
  using Settings = sand_pile::Settings;
  using Grains = sand_pile::Grains<Model>;
  using Apparatus = sand_pile::Apparatus<Model>;

  /// Fills in what the settings leave open. Throws Error, in the names that the settings have on a command line, for
  /// what makes no sense.
  SandPile(Settings settings, Grains grains) : settings_(std::move(settings)), grains_(std::move(grains)) {
    sand_pile::resolve(settings_);
  }

  [[nodiscard]] const Settings& settings() const { return settings_; }
  [[nodiscard]] const Grains& grains() const { return grains_; }

  /// The grains before they fall. Throws Error if they have no place.
  [[nodiscard]] std::vector<soil::Placement> lattice(std::uint64_t seed) const {
    return sand_pile::lattice(settings_, grains_.shape.bounding_radius(), seed);
  }

  /// Makes one pile and measures it. The seed is that of grains that are rained in; a fill from a file has none.
  [[nodiscard]] sand_pile::PileResult make(std::uint64_t seed) const {
    sand_pile::PileResult result;
    result.kind.name = "grains";
    result.seed = seed;
    Stages quiet;
    make(result, quiet, [](const typename Apparatus::World&) {});
    return result;
  }

  /// The same with stages that are told, and a look at the world at each sample. `result` says which seed,
  /// and is filled as the pile is made, so that a run that is stopped leaves its samples.
  template <class Look>
  void make(sand_pile::PileResult& result, Stages& stages, Look&& look) const {
    const auto grains =
        settings_.fill_file.empty() ? lattice(result.seed) : sand_pile::read_fill(settings_, result.kind.shape);
    Apparatus rig(settings_, grains_, grains);
    result.poured = grains.size();
    result.time_step_limit = rig.world.stable_time_step().limited_by;
    rig.world.prepare();
    result.time_step = rig.world.time_step();
    sand_pile::Forming forming(settings_, rig, sand_pile::equal_radius(grains_.shape), result, stages, look);
    const auto kept = stages.keep("forming", forming);
    forming.fill();
    forming.let_go();
    forming.measure();
    result.finished = true;
  }

 private:
  Settings settings_;
  Grains grains_;
};

}  // namespace dem::rig
