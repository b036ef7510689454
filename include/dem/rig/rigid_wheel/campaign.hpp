#pragma once

#include <dem/report/replay_world.hpp>
#include <dem/rig/bed/kept_bed.hpp>
#include <dem/rig/frames.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/rigid_wheel.hpp>
#include <dem/rig/samples_file.hpp>
#include <dem/rig/session.hpp>
#include <dem/rig/side_by_side.hpp>

namespace dem::rig::rigid_wheel {

/// The run of a program: a bed, the wheel set down on it, and all slips from there, side by side, one a thread. What
/// can be refused is refused before session.begin_run(). `campaign` is filled as the run goes.
template <class Model, class ShapeOf>
void run_campaign(const Settings& settings, ShapeOf&& shape_of, Campaign& campaign, Session& session) {
  const RigidWheel<Model> test(settings, shape_of);
  const Settings& s = test.settings();
  const soil::Packing start = start_of_bed(s.bed, s.grains, test.shape().volume(), test.shape().bounding_radius());
  BedStore store(session, s.bed, s.grains);
  session.begin_run(bed_stages(s.bed) + 2);

  Bed<Model> bed = make_kept_bed(test, start, session, store);
  store.save_places(bed);
  campaign.level = bed.level;
  campaign.solid_fraction = bed.solid_fraction(bed.level);
  campaign.grains = bed.world.particle_count();
  campaign.time_step = bed.world.time_step();
  session.finish(text("{:.1f} mm deep, solid fraction {:.3f}", 1e3 * bed.level, campaign.solid_fraction));
  const auto set_down = [&] {
    PartOf<Model> part(session, session, "set_down");
    auto stand = test.set_down(std::move(bed), session);
    const auto kept = session.keep("bed", stand.bed);
    session.complete(stand.bed.world);
    return stand;
  };
  const auto stand = set_down();
  campaign.set_down_sinkage = test.sinkage(stand);
  session.finish(text("{:.2f} mm deep", 1e3 * campaign.set_down_sinkage));

  for (const double slip : s.slips) campaign.slips.push_back({.slip = slip});
  const std::size_t shown = shown_slip(s.slips);
  if (s.replay)
    campaign.replay.emplace(
        report::ReplayOptions{.frames = 80, .interval = s.duration() / 60.0, .force_lines = s.replay_forces});
  const int threads = s.bed.threads > 0 ? s.bed.threads : std::max(1, omp_get_max_threads());
  session.begin("roll", static_cast<double>(s.slips.size()));
  side_by_side(s.slips.size(), threads, session, [&](std::size_t k, SharedStages& stages) {
    SlipResult& r = campaign.slips[k];
    const std::string name = slip_name(r.slip);
    const auto save = [&] {
      evaluate(r, campaign.level, s);
      if (!r.samples.empty()) save_samples<Sample>(session.folder() / (name + ".csv"), r.samples, sample_columns);
    };
    const auto roll = [&] {
      StagesOfOne own(stages, k);
      PartOf<Model> part(session, own, name);
      Frames frames(session, own, s.vtk && k == shown ? name : "", 0.05, "this slip");
      report::Replay* replay = campaign.replay && k == shown ? &*campaign.replay : nullptr;
      const auto kept = own.keep("slip", r), series = own.keep("frames", frames), pictures = own.keep("replay", replay);
      if (part.is_done()) return own.go_on(), own.update(1.0);
      test.roll(stand, r, own, [&](const auto& world, double share) {
        if (k != shown) return;
        frames.show(share, [&](io::VtkSeries& to) {
          add_grains(to, world);
          add_surfaces(to, world);
        });
        if (replay && replay->due(world.time())) replay->record(world);
      });
      own.complete();
    };
    work_and_save(roll, save);
  });
}

}  // namespace dem::rig::rigid_wheel
