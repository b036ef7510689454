#pragma once

#include <dem/report/replay_world.hpp>
#include <dem/rig/direct_shear.hpp>
#include <dem/rig/direct_shear/packing_of_run.hpp>
#include <dem/rig/frames.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/samples_file.hpp>
#include <dem/rig/session.hpp>

#include <cmath>
#include <filesystem>

namespace dem::rig::direct_shear {

namespace detail {

/// Says so when a packing has not come out as dense as asked for.
inline void compare_density(const PackingResult& p, const Settings& s, Stages& stages) {
  const double reached = relative_density(s, p.solid_fraction);
  if (!(std::abs(reached - p.asked_density) > 0.02)) return;  // also if either is not known
  stages.message(
      text("warning: the packing has relative density {:.2f}, but {:g} was asked for; change "
           "--relative-density, --densify-time or --seed if that matters",
           reached, p.asked_density));
}

inline void warn_of_speed(const LoadResult& r, const Settings& s, Stages& stages) {
  if (!(r.inertial_number > 1e-3)) return;
  stages.message(
      text("warning: at {:.1f} kPa the inertial number is {:.2g}, above 1e-3: not slow any more; "
           "lower --shear-speed to {:.3g} m/s",
           1e-3 * r.normal_stress, r.inertial_number, s.shear_speed * 1e-3 / r.inertial_number));
}

/// Checks all that can be checked before the run, and returns what it starts from: the packing of --packing-file, or
/// the grains to be poured. Throws Error.
template <class Model>
soil::Packing start(const DirectShear<Model>& shear, Session& session) {
  const Settings& s = shear.settings();
  const bool made = s.packing_file.empty();
  soil::Packing packing;
  if (made) {
    check_amount(s, shear.grains().shape.volume());
  } else {
    packing = read_packing(s);
    if (!s.loads.empty()) require_in_box(packing.grains, s, shear.grains().shape.bounding_radius());
  }
  shear.check_time_step();
  if (made) {
    packing = {s.half_edge, s.box_length, s.box_width, {}, shear.lattice(), kind_of(s).name};
    session.require_writable(s.save_packing, "--save-packing");
  }
  return packing;
}

/// Whether a replay can show grains of a shape: those of your own need a grain_mesh(shape, divisions) beside them.
template <class Shape>
concept HasReplay = requires(const Shape& shape) {
  report::replay_shape(shape, 4);
};

/// One load on the packing, with its frames and its file of samples, and a replay if one is to be recorded.
template <class Model>
void test_load(const DirectShear<Model>& shear, const PackingResult& packing, LoadResult& r, report::Replay* replay,
               Session& session) {
  const Settings& s = shear.settings();
  const std::string name = load_name(s, r.load);
  const auto test = [&] {
    PartOf<Model> part(session, session, name);
    Frames frames(session, s.vtk ? name : "", s.vtk_interval, "this load");
    const auto kept = session.keep("load", r), frames_kept = session.keep("frames", frames);
    const auto pictures = session.keep("replay", replay);
    if (part.is_done()) {
      session.begin(text("consolidate {:.1f} kPa", 1e-3 * r.normal_stress));
      return session.begin(text("shear at {:.1f} kPa", 1e-3 * r.normal_stress));
    }
    shear.test(packing, r, session, [&](const Apparatus<Model>& rig, Moment moment) {
      const auto write = [&](io::VtkSeries& series) {
        add_grains(series, rig.world);
        add_surfaces(series, rig.world, "boxes");
        add_grain_shapes(series, rig.world, s.vtk_spheres);
      };
      if (moment == Moment::start) frames.show(0.0, write);  // where it is but for its spring
      else if (moment == Moment::sample) frames.show(rig.top_displacement(), write);
      else frames.finish(rig.top_displacement(), write);
      if constexpr (HasReplay<typename Model::Shape>) {
        if (replay && replay->due(rig.world.time())) replay->record(rig.world);
      }
    });
    session.complete();
  };
  work_and_save(test, [&] {
    evaluate(r, s);
    if (!r.samples.empty()) save_samples<Sample>(session.folder() / (name + ".csv"), r.samples, sample_columns);
  });
}

}  // namespace detail

/// The run of a program: makes (or reads) the packing, and tests it at each load, the same grains in a new apparatus
/// each time. What can be refused is refused before session.begin_run(). `campaign` is filled as the run goes, so that
/// what was found by the time it is stopped can be reported.
template <class Model>
void run_campaign(const DirectShear<Model>& shear, Campaign& campaign, Session& session) {
  const Settings& s = shear.settings();
  const bool made = s.packing_file.empty();
  soil::Packing first = detail::start(shear, session);
  const int making = made ? making_stages(s) : 0;
  const bool replaces = made && std::filesystem::exists(s.save_packing);
  session.begin_run(making + 2 * static_cast<int>(s.loads.size()),
                    replaces ? s.save_packing + " once there is a new packing" : "");
  PackingResult& packing = campaign.packing;
  if (made) {
    PartOf<Model> part(session, session, "packing");
    const auto kept = session.keep("packing", packing);
    if (!part.is_done()) packing = make_packing<Model>(s, shear.grains(), first.grains, session);
    else
      for (int k = 0; k < making; ++k) session.begin("packing");
    session.complete();
    soil::save_packing(packing.packing, s.save_packing);  // before anything else can go wrong
  } else {
    packing.packing = std::move(first);
  }
  shear.level(packing);
  if (!std::isfinite(packing.solid_fraction)) warn_of_no_density("of the packing", s, session);
  if (making > 0) {
    session.finish(std::isfinite(packing.solid_fraction) ? text("solid fraction {:.3f}", packing.solid_fraction) : "");
  }
  detail::compare_density(packing, s, session);
  for (const double load : s.loads) {
    LoadResult& r = campaign.loads.emplace_back(shear.of_load(load));
    detail::warn_of_speed(r, s, session);
    const bool in_the_middle = campaign.loads.size() - 1 == s.loads.size() / 2;
    if (s.replay && in_the_middle) {
      campaign.replay.emplace(report::ReplayOptions{
          .frames = 100, .interval = s.travel / s.shear_speed / 80.0, .force_lines = s.replay_forces});
    }
    detail::test_load(shear, packing, r, s.replay && in_the_middle ? &*campaign.replay : nullptr, session);
    session.finish(text("maximum {:.1f} kPa", 1e-3 * r.maximum));
  }
}

}  // namespace dem::rig::direct_shear
