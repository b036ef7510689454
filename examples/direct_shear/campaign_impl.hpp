#pragma once

#include "campaign.hpp"
#include "frames.hpp"
#include "start.hpp"

#include <dem/io/csv.hpp>

namespace direct_shear {

inline void warn_of_no_density(const char* where, const Settings& s, dem::io::Progress& progress) {
  progress.message(
      fmt::format("warning: the density {} is not known: the specimen is too small to measure it {:g} mm away from "
                  "walls, floor and top; take more --grains or a smaller --half-edge if that matters",
                  where, 1e3 * measuring_margin(s)));
}

/// What there is to say of a packing from where its grains are.
template <class Shape>
void measure(PackingResult& p, const Settings& s, dem::io::Progress& progress) {
  p.height = dem::soil::height_percentile(p.packing.grains, 0.95) + s.half_edge;
  p.solid_fraction = inner_fraction(p.packing.grains, Grain<Shape>::make(s.half_edge).volume(), s);
  if (!std::isfinite(p.solid_fraction)) warn_of_no_density("of the packing", s, progress);
}

/// Says so when a packing has not come out as dense as asked for.
inline void compare_density(const PackingResult& p, const Settings& s, dem::io::Progress& progress) {
  const double reached = relative_density(s, p.solid_fraction);
  if (!(std::abs(reached - p.asked_density) > 0.02)) return;  // also if either is not known
  progress.message(
      fmt::format("warning: the packing has relative density {:.2f}, but {:g} was asked for; change "
                  "--relative-density, --densify-time or --seed if that matters",
                  reached, p.asked_density));
}

template <class Integrator, class Shape>
void test_load(const Settings& s, Campaign& campaign, LoadResult& r, dem::io::Progress& progress) {
  const auto& grains = campaign.packing.packing.grains;
  const double highest = require_in_box<Shape>(grains, s);
  const double seam = s.seam_height > 0.0 ? s.seam_height : 0.5 * campaign.packing.height;
  Rig<Integrator, Shape> rig(s, {.seam = seam, .wall_top = s.box_height, .lid_mass = r.load, .lid_low = highest},
                             grains);
  campaign.time_step_limit = rig.world.stable_time_step().limited_by;
  rig.world.prepare();
  campaign.time_step = rig.world.time_step();
  const auto count_steps = [&] {
    campaign.grain_steps += static_cast<double>(rig.world.steps()) * static_cast<double>(grains.size());
  };
  try {
    progress.begin(fmt::format("consolidate {:.1f} kPa", 1e-3 * r.normal_stress), 1.0);
    consolidate(rig, s, progress);
    r.consolidation_time = rig.world.time();
    r.height = rig.lid_low();
    r.solid_fraction = inner_fraction(rig, s, r.height);
    if (!std::isfinite(r.solid_fraction)) warn_of_no_density("under the lid", s, progress);

    progress.begin(fmt::format("shear at {:.1f} kPa", 1e-3 * r.normal_stress), s.travel);
    Frames frames(s, load_name(s, r.load), [&](const std::string& why) {
      campaign.frames_problem = why;
      progress.message("warning: no more files for ParaView of this load: " + why);
    });
    frames.show(rig.world, 0.0);
    shear(rig, s, r, progress, [&](const auto& now) { frames.show(now.world, now.top_displacement()); });
    frames.finish(rig.world, rig.top_displacement());
  } catch (...) {
    count_steps();
    throw;
  }
  count_steps();
}

inline void save_samples(const Settings& s, const LoadResult& r) {
  if (r.samples.empty()) return;
  dem::io::CsvWriter csv(s.output / (load_name(s, r.load) + ".csv"),
                         {"time_s", "displacement_m", "shear_stress_Pa", "drive_stress_Pa", "lid_rise_m",
                          "lid_stress_Pa", "plane_normal_stress_Pa"},
                         {.digits = 7});
  for (const Sample& x : r.samples) {
    csv.row(x.time, x.displacement, x.stress, x.drive_stress, x.lid_rise, x.lid_stress, x.plane_stress);
  }
  csv.flush();  // so that a full disk is noticed
}

template <class Integrator, class Shape>
void run_campaign(const Settings& s, Campaign& campaign, const std::function<void()>& begin) {
  const bool read = !s.packing_file.empty();
  dem::soil::Packing first;
  try {
    first = start<Integrator, Shape>(s);
  } catch (const dem::Error& error) {
    throw dem::Error(in_options(error.what()));
  }
  begin();
  const int making = read ? 0 : making_stages(s);
  dem::io::InterruptGuard guard;
  const double start_time = dem::io::steady_seconds();
  dem::io::ProgressOptions options;
  options.stages = making + 2 * static_cast<int>(s.loads.size());
  dem::io::Progress progress(options);
  try {
    if (read) campaign.packing.packing = std::move(first);
    else {
      campaign.packing = make_packing<Integrator, Shape>(s, first.grains, progress);
      dem::soil::save_packing(campaign.packing.packing, s.save_packing);  // before anything else can go wrong
    }
    if (!s.packing_only) dem::soil::strike_off(campaign.packing.packing.grains, s.strike_off);
    measure<Shape>(campaign.packing, s, progress);
    if (making > 0) {
      const double fraction = campaign.packing.solid_fraction;
      progress.finish(std::isfinite(fraction) ? fmt::format("solid fraction {:.3f}", fraction) : "");
    }
    compare_density(campaign.packing, s, progress);
    for (const double load : s.loads) {
      LoadResult& r = campaign.loads.emplace_back();
      r.load = load;
      r.normal_stress = s.normal_stress(load);
      // The shear is spread over a band about ten grains thick.
      r.inertial_number = s.shear_speed / 10.0 * std::sqrt(s.density / r.normal_stress);
      if (r.inertial_number > 1e-3) {
        progress.message(
            fmt::format("warning: at {:.1f} kPa the inertial number is {:.2g}, above 1e-3: not slow any more; "
                        "lower --shear-speed to {:.3g} m/s",
                        1e-3 * r.normal_stress, r.inertial_number, s.shear_speed * 1e-3 / r.inertial_number));
      }
      try {
        test_load<Integrator, Shape>(s, campaign, r, progress);
      } catch (...) {
        evaluate(r, s);
        save_samples(s, r);
        throw;
      }
      evaluate(r, s);
      save_samples(s, r);
      progress.finish(fmt::format("maximum {:.1f} kPa", 1e-3 * r.maximum));
    }
  } catch (const Interrupted&) {
    campaign.interrupted = true;
  } catch (const std::exception& error) {
    campaign.problem = in_options(error.what());
  }
  progress.stop(campaign.problem);
  campaign.wall_time = dem::io::steady_seconds() - start_time;
}

}  // namespace direct_shear
