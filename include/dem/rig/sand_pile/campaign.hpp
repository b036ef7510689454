#pragma once

#include <dem/report/replay_world.hpp>
#include <dem/rig/frames.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/samples_file.hpp>
#include <dem/rig/sand_pile.hpp>
#include <dem/rig/session.hpp>
#include <dem/soil/packing_file.hpp>

namespace dem::rig::sand_pile {

/// What the files of a pile are called.
inline std::string pile_name(const PileResult& r) { return text("{}_{}", r.kind.name, r.seed); }

/// One pile of a program's run: with its frames, its file of samples, and a replay if there is to be one. `stages` are
/// the session, or those of one of several piles side by side.
template <class Model>
void make_pile(const SandPile<Model>& sand_pile, PileResult& r, report::Replay* replay, Session& session,
               Stages& stages) {
  const Settings& s = sand_pile.settings();
  const std::string name = pile_name(r);
  const auto make = [&] {
    PartOf<Model> part(session, stages, name);
    Frames frames(session, stages, s.vtk ? name : "", s.frame_time, "this pile");
    const auto kept = stages.keep("pile", r), series = stages.keep("frames", frames);
    const auto pictures = stages.keep("replay", replay);
    if (part.is_done()) {
      for (const char* stage : {": fill", ": let go", ": rest", ": creep"}) stages.begin(r.kind.name + stage, 1.0);
      return stages.go_on(), stages.update(1.0);
    }
    sand_pile.make(r, stages, [&](const auto& world) {
      frames.show(world.time(), [&](io::VtkSeries& to) {
        add_grains(to, world);
        add_surfaces(to, world, "apparatus");
        add_grain_shapes(to, world);
      });
      if (replay && replay->due(world.time())) replay->record(world);
    });
    stages.complete();
  };
  work_and_save(make, [&] {
    if (!r.samples.empty()) save_samples<Sample>(session.folder() / (name + ".csv"), r.samples, sample_columns);
    if (!r.fill.empty()) save_fill(s, r.kind.shape, r.fill, session.folder() / (name + "_filled.txt"));
    if (!r.pile.empty()) {
      const bool drains = s.method == "drain";
      const double length = drains ? s.box_length : 2.0 * s.plate_radius;
      const double width = drains ? s.box_width : 2.0 * s.plate_radius;
      std::vector<soil::Placement> pile = r.pile;
      for (auto& grain : pile) grain.position.x() += drains ? 0.5 * length : 0.0;  // its floor ends at x = 0
      soil::save_packing({s.half_edge, length, width, "a pile, " + s.method, std::move(pile), r.kind.shape},
                         session.folder() / (name + ".txt"));
    }
  });
}

}  // namespace dem::rig::sand_pile
