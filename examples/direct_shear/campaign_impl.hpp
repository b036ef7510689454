#pragma once

#include "campaign.hpp"
#include "frames.hpp"
#include "stages.hpp"

#include <dem/io/csv.hpp>
#include <dem/soil/packing_file.hpp>

namespace direct_shear {

inline dem::soil::Packing read_packing(const Settings& s) {
  auto packing = dem::soil::load_packing(s.packing_file);
  if (packing.shape != s.shape) {
    dem::fail(
        "the packing '{}' is one of grains of shape {}, but --shape is {}: other grains in these places would overlap; "
        "give --shape {}, or leave --packing-file out",
        s.packing_file, packing.shape, s.shape, packing.shape);
  }
  const auto differs = [](double a, double b) { return std::abs(a - b) > 1e-9; };
  if (differs(packing.half_edge, s.half_edge) || differs(packing.length_x, s.box_length) ||
      differs(packing.length_y, s.box_width)) {
    dem::fail(
        "the packing '{}' has grains of half-edge {:g} m in a box of {:g} x {:g} m, but the settings say {:g} m in "
        "{:g} x {:g} m; give --half-edge {:g} --box-length {:g} --box-width {:g}",
        s.packing_file, packing.half_edge, packing.length_x, packing.length_y, s.half_edge, s.box_length, s.box_width,
        packing.half_edge, packing.length_x, packing.length_y);
  }
  return packing;
}

/// What there is to say of a packing from where its grains are.
template <class Shape>
void measure(PackingResult& p, const Settings& s) {
  p.solid_fraction = inner_fraction(p.packing.grains, Grain<Shape>::make(s.half_edge).volume(), s);
  p.height = dem::soil::height_percentile(p.packing.grains, 0.95) + s.half_edge;
}

/// Says so when a packing has not come out as dense as asked for.
inline void compare_density(const PackingResult& p, dem::io::Progress& progress) {
  const double reached = relative_density(p.solid_fraction);
  if (!(std::abs(reached - p.asked_density) > 0.02)) return;  // also if either is not known
  progress.message(
      fmt::format("warning: the packing has relative density {:.2f}, but {:g} was asked for; change "
                  "--relative-density, --densify-time or --seed if that matters",
                  reached, p.asked_density));
}

template <class Integrator, class Shape>
void test_load(const Settings& s, Campaign& campaign, LoadResult& r, dem::io::Progress& progress) {
  const auto& grains = campaign.packing.packing.grains;
  double highest = 0.0;
  for (const auto& g : grains) highest = std::max(highest, g.position.z());
  highest += Grain<Shape>::make(s.half_edge).bounding_radius();
  if (highest > s.box_height) {
    throw Stopped(
        fmt::format("the specimen is {:.1f} mm tall, but the box {:.1f} mm; take fewer grains, a denser packing, "
                    "or a higher --box-height",
                    1e3 * highest, 1e3 * s.box_height));
  }
  const double seam = s.seam_height > 0.0 ? s.seam_height : 0.5 * campaign.packing.height;
  Rig<Integrator, Shape> rig(s, {.seam = seam, .wall_top = s.box_height, .lid_mass = r.load, .lid_low = highest},
                             grains);
  campaign.time_step_limit = rig.world.stable_time_step().contact;
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

    progress.begin(fmt::format("shear at {:.1f} kPa", 1e-3 * r.normal_stress), s.travel);
    std::optional<Frames> frames;
    if (s.vtk) frames.emplace(s, load_name(s, r.load));
    if (frames) frames->show(rig.world, 0.0);
    shear(rig, s, r, progress, [&](const auto& now) {
      if (frames) frames->show(now.world, now.top_displacement());
    });
    if (frames) frames->finish(rig.world, rig.top_displacement());
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
void run_campaign(const Settings& s, Campaign& campaign) {
  const bool read = !s.packing_file.empty();
  const int making = read ? 0 : making_stages(s);
  dem::io::InterruptGuard guard;
  const double start = dem::io::steady_seconds();
  dem::io::ProgressOptions options;
  options.stages = making + 2 * static_cast<int>(s.loads.size());
  dem::io::Progress progress(options);
  try {
    if (read) campaign.packing.packing = read_packing(s);
    else campaign.packing = make_packing<Integrator, Shape>(s, progress);
    measure<Shape>(campaign.packing, s);
    if (making > 0) progress.finish(fmt::format("solid fraction {:.3f}", campaign.packing.solid_fraction));
    compare_density(campaign.packing, progress);
    if (!read) dem::soil::save_packing(campaign.packing.packing, s.save_packing);
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
    campaign.problem = error.what();
  }
  progress.stop(campaign.problem);
  campaign.wall_time = dem::io::steady_seconds() - start;
}

}  // namespace direct_shear
