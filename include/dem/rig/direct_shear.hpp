#pragma once

#include <dem/rig/direct_shear/evaluate.hpp>
#include <dem/rig/direct_shear/pouring.hpp>
#include <dem/rig/direct_shear/resolve.hpp>
#include <dem/rig/direct_shear/sand.hpp>
#include <dem/rig/direct_shear/shearing.hpp>
#include <dem/rig/direct_shear/start.hpp>

#include <utility>

namespace dem::rig {

/// The direct shear test of thesis chapter 3 with grains of your own: they are packed into a box of two halves, a lid
/// loads them, and the upper half is pushed over the lower one.
///
///     dem::rig::direct_shear::Settings settings;
///     settings.half_edge = 2e-3;  // m, of the cube that a grain about fills
///     settings.own_kind = {.name = "capsule", .limits = {0.55, 0.70}};
///     dem::rig::DirectShear<Sand> shear(settings, {.shape = capsule, .on_grain = {...}, .on_wall = {...}});
///     const auto packing = shear.make_packing();
///     const auto result = shear.test(packing, 16.2);  // kg on the lid
///     fmt::print("{} Pa", result.maximum);
///
/// `Model` names the shape and the laws; its Surfaces must have boxes. Stages tell how far they are, and are stopped by
/// throwing: Stopped when the simulation reports a problem or a stage has no end, Interrupted after Ctrl-C if an
/// io::InterruptGuard watches for it.
template <class M>
class DirectShear {
 public:
  using Model = M;
  using Settings = direct_shear::Settings;
  using Grains = direct_shear::Grains<Model>;
  using Apparatus = direct_shear::Apparatus<Model>;

  /// When a test calls its `look(apparatus, moment)`.
  using Moment = direct_shear::Moment;

  /// Fills in what the settings leave open. Throws Error, in the names that the settings have on a command line, for
  /// what makes no sense.
  DirectShear(Settings settings, Grains grains) : settings_(std::move(settings)), grains_(std::move(grains)) {
    direct_shear::resolve(settings_);
  }

  [[nodiscard]] const Settings& settings() const { return settings_; }
  [[nodiscard]] const Grains& grains() const { return grains_; }

  /// Throws Error for a time step that is not stable, or so short that the test would have no end.
  void check_time_step() const { direct_shear::check_time_step<Model>(settings_, grains_); }

  /// The grains before they are poured. Throws Error if they do not fit into the box or the machine.
  [[nodiscard]] std::vector<soil::Placement> lattice() const {
    direct_shear::check_amount(settings_, grains_.shape.volume());
    return direct_shear::lattice(settings_, grains_.shape.bounding_radius());
  }

  /// Pours grains, by default lattice(), makes them as dense as asked for, levels and measures them.
  direct_shear::PackingResult make_packing(Stages& stages) const { return make_packing(lattice(), stages); }
  direct_shear::PackingResult make_packing() const {
    Stages quiet;
    return make_packing(quiet);
  }
  direct_shear::PackingResult make_packing(std::span<const soil::Placement> grains, Stages& stages) const {
    auto result = direct_shear::make_packing<Model>(settings_, grains_, grains, stages);
    level(result);
    return result;
  }

  /// Strikes off the highest grains of a packing, if it will be tested, and finds its height and solid fraction.
  void level(direct_shear::PackingResult& p) const {
    if (!settings_.packing_only) soil::strike_off(p.packing.grains, settings_.strike_off);
    p.height = soil::height_percentile(p.packing.grains, 0.95) + settings_.half_edge;
    p.solid_fraction = direct_shear::inner_fraction(p.packing.grains, grains_.shape.volume(), settings_);
  }

  /// Loads a packing that was levelled, shears it, and evaluates the samples. Throws Error if it stands out of the box.
  [[nodiscard]] direct_shear::LoadResult test(const direct_shear::PackingResult& packing, double load) const {
    Stages quiet;
    direct_shear::LoadResult result = of_load(load);
    test(packing, result, quiet, [](const Apparatus&, Moment) {});
    direct_shear::evaluate(result, settings_);
    return result;
  }

  /// The same with stages that are told, and a look at the apparatus as shearing starts, after each sample, and at the
  /// end. `result` is filled as the test goes, so that a test that is stopped leaves its samples; they are not
  /// evaluated.
  template <class Look>
  void test(const direct_shear::PackingResult& packing, direct_shear::LoadResult& result, Stages& stages,
            Look&& look) const {
    using namespace direct_shear;
    const auto& placements = packing.packing.grains;
    const double highest = require_in_box(placements, settings_, grains_.shape.bounding_radius());
    const double seam = settings_.seam_height > 0.0 ? settings_.seam_height : 0.5 * packing.height;
    Apparatus rig(settings_, grains_,
                  {.seam = seam, .wall_top = settings_.box_height, .lid_mass = result.load, .lid_low = highest},
                  placements);
    result.time_step_limit = rig.world.stable_time_step().limited_by;
    rig.world.prepare();
    result.time_step = rig.world.time_step();
    stages.begin(text("consolidate {:.1f} kPa", 1e-3 * result.normal_stress), 1.0);
    consolidate(rig, settings_, stages, [&] {
      result.consolidation_time = rig.world.time();
      result.height = rig.lid_low();
      result.solid_fraction = inner_fraction(rig, settings_, result.height);
      if (!std::isfinite(result.solid_fraction)) warn_of_no_density("under the lid", settings_, stages);
    });
    stages.begin(text("shear at {:.1f} kPa", 1e-3 * result.normal_stress), settings_.travel);
    shear(rig, settings_, result, stages, [&](Moment moment) { look(std::as_const(rig), moment); });
  }

  /// The result of a load (kg) before its test.
  [[nodiscard]] direct_shear::LoadResult of_load(double load) const {
    direct_shear::LoadResult r;
    r.load = load;
    r.normal_stress = settings_.normal_stress(load);
    // The shear is spread over a band about ten grains thick.
    r.inertial_number = settings_.shear_speed / 10.0 * std::sqrt(settings_.density / r.normal_stress);
    return r;
  }

 private:
  Settings settings_;
  Grains grains_;
};

}  // namespace dem::rig
