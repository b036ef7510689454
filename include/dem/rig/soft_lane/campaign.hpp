#pragma once

#include <dem/io/csv.hpp>
#include <dem/io/duration.hpp>
#include <dem/report/replay_world.hpp>
#include <dem/rig/bed/kept_bed.hpp>
#include <dem/rig/frames.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/session.hpp>
#include <dem/rig/soft_lane.hpp>
#include <dem/rig/soft_lane/tile.hpp>
#include <dem/vehicle/drawn_hull.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace dem::rig::soft_lane {

inline void save_telemetry(const std::filesystem::path& path, const std::vector<Sample>& samples) {
  io::CsvWriter csv(path, Sample{}.columns(), {.digits = 7});
  for (const Sample& x : samples) csv.row(x.row());
  csv.flush();
}

/// The run of a program: a bed, the lane, the car set down on it, and the drive, or several of them. Pictures are those
/// of the first. What can be refused is refused before
/// session.begin_run(). `c` is filled as the run goes.
template <class Model, class ShapeOf>
void run_campaign(const Settings& settings, ShapeOf&& shape_of, Campaign& c, Session& session) {
  const SoftLane<Model> test(settings, shape_of);
  const SoftLane<Repeating<Model>> of_tile(settings, shape_of);
  const Settings& s = test.settings();
  const soil::Packing start =
      start_of_bed(s.bed, s.grains, test.shape().volume(), test.shape().bounding_radius(), s.goes_along());
  BedStore store(session, s.bed, s.grains, s.goes_along() ? BedStore::repeating : BedStore::fixed_box);
  session.begin_run(bed_stages(s.bed) + s.passes * (s.slope_angle() != 0.0 ? 4 : 3), store.also_replaced());

  const io::SurfaceMesh hull = vehicle::drawn_hull(s.car);
  // A lane that goes along meets ever new grains: the limit is one of all that a replay meets.
  const double lengths = s.goes_along() ? 1.0 + s.path / s.length() : 1.0;
  if (s.replay)
    c.replay.emplace(report::ReplayOptions{.frames = 90,
                                           .interval = 0.05,
                                           .grains = static_cast<std::size_t>(12'000 * lengths),
                                           .force_lines = s.replay_forces});
  Frames frames(session, s.vtk ? "soft_lane" : "", 0.05);
  const auto look = [&](const auto& stand) {
    const auto& world = stand.world;
    frames.show(world.time(), [&](io::VtkSeries& series) {
      add_grains(series, world);
      add_surfaces(series, world);
    });
    if (c.replay && c.replay->due(world.time()))
      c.replay->record(world, std::vector{io::DrawnBody{stand.car.chassis, &hull}});
  };

  const auto look_at = [&](const auto& bed) {
    store.save_places(bed);
    c.solid_fraction = bed.solid_fraction(bed.level);
    session.finish(text("{:.1f} mm deep, solid fraction {:.3f}", 1e3 * bed.level, c.solid_fraction));
  };
  std::optional<soil::Tile> tile;
  double level = not_known, time_step = not_known;
  if (s.goes_along()) {
    const auto bed = make_kept_bed(of_tile, start, session, store);
    look_at(bed);
    level = bed.level, time_step = of_tile.time_step(bed);
    tile = make_kept_tile<Model>(s, test.shape(), bed, time_step, session);
    // Not its solid fraction: that would count the ground between the troughs.
    session.finish(text("{} grains, {:.2f} neighbours each", tile->grains.size(), tile->coordination));
  } else {
    const auto bed = make_kept_bed(test, start, session, store);
    look_at(bed);
    c.lane = lane_grains(s, soil::placements(bed.world));
    level = test.level(bed, c.lane), time_step = test.time_step(bed);
  }

  report::Replay* replay = c.replay ? &*c.replay : nullptr;
  for (int k = 1; k <= s.passes; ++k) {
    PartOf<Model> part(session, session, k == 1 ? "drive" : text("drive {}", k));
    const auto found = session.keep("found", c), series = session.keep("frames", frames),
               pictures = session.keep("replay", replay);
    if (part.is_done() && k < s.passes) {
      session.complete();
      continue;
    }
    const std::vector<soil::Placement> lane = c.lane;
    const auto no_look = [](const auto&) {};
    auto stand = tile ? test.set_down(*tile, level, time_step, session, no_look)
                      : test.set_down(lane, level, c.untouched, time_step, session, no_look);
    if (k > 1) stand.level = c.level;
    const auto drive = [&] {
      if (k == 1) test.drive(stand, c, session, look);
      else test.drive(stand, c, session, no_look);
      if (k < s.passes) return;
      const auto lane_too = session.keep("lane", stand), car_too = session.keep("car", stand.car);
      session.complete(stand.world);
    };
    work_and_save(drive, [&] {
      look_back(stand, s, c);
      evaluate(c, s);
      if (!c.samples.empty()) save_telemetry(session.folder() / "telemetry.csv", c.samples);
    });
    c.passes.push_back({c.means, c.rut_depth, c.samples.back().way, c.ended});
    session.finish(text("{} after {:.2f} m", c.ended, c.samples.back().way));
    if (k == s.passes) break;
    if (c.ended != ending::arrived) {
      session.message(text("pass {} of {} did not arrive: there are no more", k, s.passes));
      break;
    }
    // The next one starts where this one did, on the grains as they lie now.
    c.lane = soil::placements(stand.world), c.untouched = stand.before;
    c.forget_drive();
    session.complete();
  }
}

}  // namespace dem::rig::soft_lane
