#pragma once

#include <dem/rig/affordable.hpp>
#include <dem/rig/old_results.hpp>
#include <dem/rig/rig.hpp>
#include <dem/rig/sand_pile/fill_file.hpp>
#include <dem/rig/sand_pile/options.hpp>
#include <dem/rig/sand_pile/report.hpp>
#include <dem/rig/sand_pile/resolve.hpp>
#include <dem/rig/side_by_side.hpp>

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace dem::rig::sand_pile {

/// Grains that a program has a world for.
struct PileWorld {
  const char* name;  ///< Kind::world()
  /// Calls make_pile() with this world.
  void (*make)(const Settings&, PileResult&, report::Replay*, Session&, Stages&);
};

/// The sand pile as a program: piles of each kind and seed, side by side. It does not know the worlds, so that they are
/// compiled beside it.
class PileRig : public Rig {
 public:
  explicit PileRig(std::span<const PileWorld> worlds) : worlds_(worlds) {}

  void declare(Options& options) override { sand_pile::declare(options, settings); }
  void find_idle(IdleOptions& idle) const override { sand_pile::find_idle(idle, settings); }
  void resolve() override {
    sand_pile::resolve(settings);
    require_not_own(settings.fill_file, "--fill-file", output(), results());
  }
  std::string output() const override { return settings.output; }
  ResultNames results() const override {
    ResultNames names = {.files = {"results.csv"},
                         .plots = {"repose", "profiles", "angles", "angle_over_time"},
                         .frames = {"grains", "apparatus", "spheres", "superquadrics", "polyhedra"}};
    for (const char* shape : {"cube8", "polyhedron", "superquadric", "sphere"}) {
      for (const char* law : {"", "-viscous", "-rolling", "-braked"}) {
        for (const char* type : {".csv", ".txt", "_filled.txt", ".pvd"})
          names.files.push_back(text("{}{}_#+{}", shape, law, type));
      }
    }
    return names;
  }
  bool can_resume() const override { return true; }
  std::vector<OwnWord> words() const override { return {std::begin(own_words), std::end(own_words)}; }

  void run(Session& session) override {
    const std::vector<Kind> kinds = kinds_in(settings.kinds);
    for (const Kind& kind : kinds) {
      world_of(kind);
      if (!settings.fill_file.empty()) read_fill(settings, kind.shape);  // refused before anything is replaced
    }
    session.begin_run(1);
    auto& piles = campaign.piles;
    for (const Kind& kind : kinds) {
      for (std::uint64_t k = 0; k < settings.seeds; ++k) {
        PileResult& r = piles.emplace_back();
        r.kind = kind;
        r.seed = settings.seed + k;
      }
    }
    if (settings.replay)
      campaign.replay.emplace(
          report::ReplayOptions{.frames = 100, .interval = settings.frame_time, .force_lines = settings.replay_forces});
    const int most = settings.threads > 0 ? 0 : threads_for(settings.grains);
    const SharedThreads threads = share_threads(piles.size(), settings.threads, most);
    Settings of_one = settings;
    of_one.threads = threads.each;
    session.begin("piles", static_cast<double>(piles.size()));
    const auto make = [&](std::size_t k, SharedStages& stages) {
      StagesOfOne own(stages, k, 4);
      report::Replay* replay = k == 0 && campaign.replay ? &*campaign.replay : nullptr;
      world_of(piles[k].kind).make(of_one, piles[k], replay, session, own);
    };
    work_and_save([&] { side_by_side(piles.size(), threads, session, make); },
                  [&] { std::erase_if(piles, [](const PileResult& r) { return r.poured == 0; }); });  // not begun
    std::string angles;
    for (const PileResult& r : piles) angles += (angles.empty() ? "" : ", ") + number(degrees * r.flank.angle);
    session.finish(angles + " deg");
  }

  bool report(Report& report) const override { return sand_pile::report(report, settings, campaign); }

  Settings settings;
  Campaign campaign;

 private:
  const PileWorld& world_of(const Kind& kind) const {
    for (const PileWorld& world : worlds_) {
      if (kind.world() == world.name) return world;
    }
    throw InAnotherProgram(text("this program has no world for grains of the kind {}", kind.name));
  }

  std::span<const PileWorld> worlds_;
};

}  // namespace dem::rig::sand_pile
