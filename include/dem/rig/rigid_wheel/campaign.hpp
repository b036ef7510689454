#pragma once

#include <dem/report/replay_world.hpp>
#include <dem/rig/bed/kept_bed.hpp>
#include <dem/rig/frames.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/rigid_wheel.hpp>
#include <dem/rig/runs_in_turn.hpp>
#include <dem/rig/samples_file.hpp>
#include <dem/rig/session.hpp>
#include <dem/rig/side_by_side.hpp>

namespace dem::rig::rigid_wheel {

namespace detail {

/// The wheel on a bed.
template <class Model>
auto set_down(const RigidWheel<Model>& test, Bed<Model> bed, VariantResult& result, Session& session) {
  PartOf<Model> part(session, session, result.variant.prefix() + "set_down");
  auto stand = test.set_down(std::move(bed), session);
  const auto kept = session.keep("bed", stand.bed);
  session.complete(stand.bed.world);
  result.set_down_sinkage = test.sinkage(stand);
  session.finish(text("{:.2f} mm deep", 1e3 * result.set_down_sinkage));
  return stand;
}

/// All slips from there, side by side; for the run itself one of them with frames and a replay.
template <class Model>
void roll(const RigidWheel<Model>& test, const typename RigidWheel<Model>::Stand& stand, VariantResult& result,
          std::optional<report::Replay>& replay, Session& session) {
  const Settings& s = test.settings();
  const bool is_run = result.variant.is_run_itself();
  for (const double slip : s.slips) result.slips.push_back({.slip = slip});
  const std::size_t shown = is_run ? shown_slip(s.slips) : s.slips.size();
  if (s.replay && is_run)
    replay.emplace(report::ReplayOptions{
        .frames = 80, .interval = s.duration_at(s.slips[shown]) / 60.0, .force_lines = s.replay_forces});
  const SharedThreads threads = share_threads(s.slips.size(), s.bed.threads, stand.bed.world.threads());
  session.begin("roll", static_cast<double>(s.slips.size()));
  side_by_side(s.slips.size(), threads, session, [&](std::size_t turn, SharedStages& stages) {
    const std::size_t k = s.slips.size() - 1 - turn;  // the largest slip, whose run is longest, first
    SlipResult& r = result.slips[k];
    const std::string name = result.variant.prefix() + slip_name(r.slip);
    const auto save = [&] {
      evaluate(r, result.level, s);
      if (!r.samples.empty()) save_samples<Sample>(session.folder() / (name + ".csv"), r.samples, sample_columns);
    };
    const auto run = [&] {
      StagesOfOne own(stages, turn);
      PartOf<Model> part(session, own, name);
      Frames frames(session, own, s.vtk && k == shown ? name : "", 0.05, "this slip");
      report::Replay* shown_replay = replay && k == shown ? &*replay : nullptr;
      const auto kept = own.keep("slip", r), series = own.keep("frames", frames),
                 pictures = own.keep("replay", shown_replay);
      if (part.is_done()) return own.go_on(), own.update(1.0);
      test.roll(stand, threads.each, r, own, [&](const auto& world, double share) {
        if (k != shown) return;
        frames.show(share, [&](io::VtkSeries& to) {
          add_grains(to, world);
          add_surfaces(to, world);
        });
        if (shown_replay && shown_replay->due(world.time())) shown_replay->record(world);
      });
      own.complete();
    };
    work_and_save(run, save);
  });
  session.finish();
}

}  // namespace detail

/// The run of a program: a bed, the wheel set down on it, and all slips from there; and those of the study. What can be
/// refused is refused before session.begin_run(). `campaign` is filled as the run goes. Runs that share a bed which
/// could not be made are left out.
template <class Model, class ShapeOf>
void run_campaign(const Settings& settings, ShapeOf&& shape_of, Campaign& campaign, Session& session) {
  const RigidWheel<Model> test(settings, shape_of);
  const auto start_of = [&](const Settings& s) {
    return start_of_bed(s.bed, s.grains, test.shape().volume(), test.shape().bounding_radius());
  };
  const auto all = variants(test.settings());
  for (const Variant& v : all) {  // what one of them cannot have is refused before the first is made
    const Settings s = RigidWheel<Model>(v.settings, shape_of).settings();
    const int copies = share_threads(s.slips.size(), s.bed.threads).runs;
    if (s.bed.is_rained()) affordable_grains(s.bed, s.grains, test.shape().volume(), copies);
  }
  const auto needs_bed = [&](std::size_t k) { return k < all.size() && !all[k].shares_bed(); };
  int stages = 0;
  for (std::size_t k = 0; k < all.size(); ++k) stages += (needs_bed(k) ? bed_stages(all[k].settings.bed) : 0) + 2;
  const soil::Packing start = start_of(test.settings());
  BedStore store(session, test.settings().bed, test.settings().grains, BedStore::fixed_box);
  session.begin_run(stages, store.also_replaced());

  campaign.study.reserve(all.size());
  std::optional<Bed<Model>> bed;
  const auto run = [&](std::size_t k, VariantResult& result) {
    const Variant& v = all[k];
    const RigidWheel<Model> variant(v.settings, shape_of);
    if (k > 0) session.message(text("Study: {}", v.text));
    if (needs_bed(k)) {
      bed.reset();
      bed.emplace(make_kept_bed(variant, k == 0 ? start : start_of(v.settings), session,
                                k == 0 ? static_cast<PartStore&>(store) : session.parts(), v.prefix() + "bed"));
      if (k == 0) store.save_places(*bed);
    }
    result.level = bed->level;
    result.solid_fraction = bed->solid_fraction(bed->level);
    result.grains = bed->world.grain_count();
    result.time_step = bed->world.time_step();
    if (needs_bed(k)) session.finish(level_text(result.level, result.solid_fraction));
    const bool is_last = k + 1 == all.size() || needs_bed(k + 1);  // that this bed serves
    const auto stand = detail::set_down(variant, is_last ? std::move(*bed) : *bed, result, session);
    detail::roll(variant, stand, result, campaign.replay, session);
  };
  RunsInTurn runs(session, all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    VariantResult& result = k == 0 ? campaign : campaign.study.emplace_back();
    result.variant = all[k];
    if (needs_bed(k) || bed) runs.run(all[k].text, [&] { run(k, result); });
  }
  runs.end();
}

}  // namespace dem::rig::rigid_wheel
