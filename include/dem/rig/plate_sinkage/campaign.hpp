#pragma once

#include <dem/report/replay_world.hpp>
#include <dem/rig/bed/kept_bed.hpp>
#include <dem/rig/frames.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/plate_sinkage.hpp>
#include <dem/rig/runs_in_turn.hpp>
#include <dem/rig/samples_file.hpp>
#include <dem/rig/session.hpp>
#include <dem/rig/side_by_side.hpp>

namespace dem::rig::plate_sinkage {

namespace detail {

/// One plate of a variant on so many threads, with its file, and for the run itself frames and perhaps a replay.
template <class Model>
void press(const PlateSinkage<Model>& test, const Bed<Model>& bed, int threads, const Variant& variant, PlateResult& r,
           report::Replay* replay, Session& session, Stages& stages) {
  const Settings& s = test.settings();
  const std::string plate = plate_name(r.width), file = variant.prefix() + plate;
  const auto save = [&] {
    evaluate(r, s);
    if (r.samples.empty()) return;
    save_samples<Sample>(session.folder() / (file + ".csv"), r.samples, sample_columns);
    if (r.unloading.empty()) return;
    save_samples<Unloading>(session.folder() / (file + "_unloading.csv"), r.unloading, unloading_columns);
  };
  work_and_save(
      [&] {
        PartOf<Model> part(session, stages, file);
        Frames frames(session, stages, s.vtk && variant.is_run_itself() ? plate : "", s.sinkage / 20.0, "this plate");
        const auto kept = stages.keep("plate", r), series = stages.keep("frames", frames);
        const auto pictures = stages.keep("replay", replay);
        if (part.is_done()) {
          stages.begin(text("press {:.0f} mm", 1e3 * r.width), 1.0);
          if (s.unload) stages.begin(text("draw up {:.0f} mm", 1e3 * r.width), 1.0);
          return stages.go_on(), stages.update(1.0);
        }
        Bed<Model> own = bed;
        own.world.set_threads(threads);
        test.press(std::move(own), r, stages, [&](const auto& world, double travel) {
          frames.show(travel, [&](io::VtkSeries& to) {
            add_grains(to, world);
            add_surfaces(to, world);
          });
          if (replay && replay->due(world.time())) replay->record(world);
        });
        stages.complete();
      },
      save);
}

/// The plates of a variant, side by side.
template <class Model>
void press_all(const PlateSinkage<Model>& test, const Bed<Model>& bed, VariantResult& result,
               std::optional<report::Replay>& replay, Session& session) {
  const Variant& v = result.variant;
  const Settings& s = v.settings;
  auto& plates = result.plates;
  for (const double width : s.widths) plates.push_back({.width = width});
  const std::size_t shown = plates.size() / 2;
  if (s.replay && v.is_run_itself())
    replay.emplace(
        report::ReplayOptions{.frames = 80, .interval = s.sinkage / s.speed / 60.0, .force_lines = s.replay_forces});
  const SharedThreads threads = share_threads(plates.size(), s.bed.threads, bed.world.threads());
  session.begin(v.is_run_itself() ? "press" : "press, " + v.text, static_cast<double>(plates.size()));
  const auto press_one = [&](std::size_t k, SharedStages& stages) {
    StagesOfOne own(stages, k, s.unload ? 2 : 1);
    report::Replay* const own_replay = v.is_run_itself() && k == shown && replay ? &*replay : nullptr;
    press(test, bed, threads.each, v, plates[k], own_replay, session, own);
  };
  work_and_save([&] { side_by_side(plates.size(), threads, session, press_one); },
                [&] { std::erase_if(plates, [](const PlateResult& r) { return r.samples.empty(); }); });  // not begun
  std::string found;
  for (const PlateResult& r : plates) {
    if (r.fit) found += text("{}{:.2f}", found.empty() ? "n " : ", ", r.fit->curve.exponent);
  }
  session.finish(found);
}

}  // namespace detail

/// The run of a program: a bed and all plates, side by side, and those of the study. What can be refused is refused
/// before session.begin_run(). `campaign` is filled as the run goes. Runs that share a bed which could not be made are
/// left out.
template <class Model, class ShapeOf>
void run_campaign(const Settings& settings, ShapeOf&& shape_of, Campaign& campaign, Session& session) {
  const PlateSinkage<Model> test(settings, shape_of);
  const auto& shape = test.shape();
  const auto start_of = [&](const Settings& s) {
    return start_of_bed(s.bed, s.grains, shape.volume(), shape.bounding_radius());
  };
  const auto all = variants(test.settings());
  for (const Variant& v : all) {  // what one of them cannot have is refused before the first is made
    const Settings s = PlateSinkage<Model>(v.settings, shape_of).settings();
    const int copies = share_threads(s.widths.size(), s.bed.threads).runs;
    if (s.bed.is_rained()) affordable_grains(s.bed, s.grains, shape.volume(), copies);
  }
  int stages = 0;
  for (const Variant& v : all) stages += 1 + (v.shares_bed() ? 0 : bed_stages(v.settings.bed));
  soil::Packing start = start_of(test.settings());
  BedStore store(session, test.settings().bed, test.settings().grains, BedStore::halves);
  session.begin_run(stages, store.also_replaced());

  std::optional<Bed<Model>> bed;
  const auto run = [&](const Variant& v, VariantResult& result) {
    const PlateSinkage<Model> variant(v.settings, shape_of);
    if (!v.shares_bed()) {
      bed.reset();
      const bool is_first = v.is_run_itself();
      bed.emplace(make_kept_bed(variant, is_first ? start : start_of(v.settings), session,
                                is_first ? static_cast<PartStore&>(store) : session.parts(), v.prefix() + "bed"));
      if (is_first) store.save_places(*bed);
    }
    result.level = bed->level;
    result.solid_fraction = bed->solid_fraction(bed->level);
    result.grains = bed->world.grain_count();
    result.time_step = bed->world.time_step();
    session.finish(level_text(result.level, result.solid_fraction));
    require_depth(v.settings, result.level);
    detail::press_all(variant, *bed, result, campaign.replay, session);
  };
  RunsInTurn runs(session, all.size());
  for (const Variant& v : all) {
    VariantResult& result = campaign.variants.emplace_back(VariantResult{.variant = v});
    if (!v.shares_bed() || bed) runs.run(v.text, [&] { run(v, result); });
  }
  runs.end();
}

}  // namespace dem::rig::plate_sinkage
