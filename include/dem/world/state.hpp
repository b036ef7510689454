#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/macros.hpp>
#include <dem/coupling/body_contacts.hpp>
#include <dem/coupling/body_stability.hpp>
#include <dem/coupling/buried.hpp>
#include <dem/coupling/machine_surface.hpp>
#include <dem/grain/energy_ledger.hpp>
#include <dem/grain/grain_load.hpp>
#include <dem/grain/held.hpp>
#include <dem/grain/materials.hpp>
#include <dem/grain/neighbours.hpp>
#include <dem/grain/pair_contacts.hpp>
#include <dem/grain/skin.hpp>
#include <dem/grain/sleep.hpp>
#include <dem/grain/turns.hpp>
#include <dem/mbd/solver/lazy_solver.hpp>
#include <dem/world/model.hpp>
#include <dem/world/options.hpp>
#include <dem/world/placed.hpp>
#include <dem/world/stopwatch.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dem {

using SurfaceSensorId = Id<struct SurfaceSensorTag>;  ///< measures the grains' force on one surface

/// The grains' force on a surface, averaged.
struct SurfaceSensor {
  SurfaceId surface;
  mbd::WindowAverage average;
  template <class V>
  void fields(V& v) {
    v.given("surface", surface), v("average", average);
  }
};

/// What a thread writes down while it finds contacts.
template <class Model>
struct ContactScratch {
  grain::PairScratch<Model> pairs;
  coupling::SurfaceScratch surfaces;
  ContactHistories<history_size<Model>> pairs_now, surfaces_now;  ///< lent to the chunk that is worked on

  /// A chunk gets memory for the histories of this step, which the thread has in its cache, or gives it back.
  void lend(Chunk<Model>& chunk) {
    std::swap(pairs_now, chunk.pair_contacts.now);
    std::swap(surfaces_now, chunk.surface_contacts.now);
  }
};

/// How grains are moved when their forces are known.
struct MoveStage {
  int stage = 0;                  ///< of the integrator
  bool keeps_histories = false;   ///< what contacts remember is what the next evaluation starts from
  bool cleans_rotations = false;  ///< rotation matrices are made orthonormal
  bool at_once = false;           ///< within the sweep that finds contacts
};

/// What a world consists of whatever its model.
struct WorldCommon {
  DEM_VALUE(WorldCommon)

  WorldOptions options;
  double time = 0.0;
  double time_step = 0.0;
  double time_of_forces = 0.0;                ///< s, that the present evaluation is of
  std::optional<std::string> time_step_note;  ///< of a machine that makes it small; none where it is not known yet
  std::uint64_t step = 0;
  bool is_broken_off = false;  ///< an exception ended the newest step within it

  std::vector<SpeciesInertia> inertia;  ///< of the species
  double largest_radius = 0.0;          ///< m, bounding radius
  double smallest_radius = HUGE_VAL;    ///< m, the same

  std::optional<surface::Aabb> borders;  ///< WorldOptions::domain, without end where it repeats itself
  std::vector<std::uint32_t> incoming_first;
  std::vector<grain::Incoming> incoming;
  double list_skin = 0.0;         ///< m, with which the neighbour list was made
  grain::SkinChoice skin_choice;  ///< unless a skin was given
  bool list_valid = false;        ///< false after grains were added or moved by hand
  bool grains_added = false;      ///< by hand, and are in no list yet: see World::prepare
  Placed placed;
  std::string odd_note;                  ///< in words, of surfaces that are there twice, or a body that nothing holds
  std::string placed_note;               ///< in words, of a deep overlap of what was placed before or within this run
  std::uint64_t rebuilds = 0;            ///< neighbour lists made
  std::set<std::uint32_t> known_lost;    ///< ids of grains that were reported as lost
  std::vector<std::uint32_t> to_remove;  ///< ids of grains that are gone, but whose rows are there until the next list
  std::uint64_t remove_by = 0;           ///< the step in which that list is due, if there are any
  std::vector<Outlet> outlets;
  Outlet beyond_domain;  ///< of a domain that removes what leaves it
  std::vector<Inlet> inlets;
  std::uint64_t put_in_at = 0;          ///< the step in which inlets put in what is due at the latest
  std::vector<grain::HeldGrains> held;  ///< attached to machine parts
  grain::Sleepers sleepers;
  grain::Turns turns;
  MoveStage move;

  mbd::Mechanism machine;
  SurfaceSet new_surfaces;  ///< added or switched on since they were last compared with the cell and the grains
  std::vector<SurfaceSensor> surface_sensors;
  Stopwatch stopwatch;

  GrainLoadLaw grain_load;  ///< on each grain; usually none

  grain::EnergyLedger ledger;
};

/// Everything a world consists of. Only World and the functions of the step see it.
template <class Model>
struct WorldState : WorldCommon {
  using Shape = typename Model::Shape;
  using Integrator = typename Model::Integrator;
  using Surface = MachineSurface<typename Model::Surfaces>;

  Materials<Model> materials;
  std::vector<Species<Shape>> species;

  GrainColumns<Shape, Integrator> grains;
  std::vector<Chunk<Model>> chunks;
  typename Model::BroadPhase broad_phase;
  typename Model::Domain domain;
  grain::Images<typename Model::Domain> images;

  mbd::LazySolver<Integrator, typename Model::Joints> machine_solver;
  std::vector<Surface> surfaces;
  std::vector<coupling::FindHits<Model>> find_hits;  ///< of the surfaces: the code for their kinds
  std::vector<coupling::IsBuried<Model>> is_buried;  ///< the same; null of most kinds
  coupling::BodyContacts<Model> body_contacts;
  typename Model::Executor executor;
  std::vector<ContactScratch<Model>> scratch;  ///< of the executor's threads

  // Set with the first of what they are for: other programs are without that code.
  void (*put_in)(WorldState&) = nullptr;                                                ///< what inlets give
  void (*carry_held)(WorldState&) = nullptr;                                            ///< attached grains
  void (*load_by_held)(WorldState&) = nullptr;                                          ///< the same
  void (*find_body_contacts)(WorldState&) = nullptr;                                    ///< of pairs of surfaces
  void (*record_contacts)(WorldState&, std::size_t, ContactScratch<Model>&) = nullptr;  ///< count_energy()
  void (*count_energy)(WorldState&) = nullptr;                                          ///< at the end of a step

  /// All that the future depends on but the grains and their contacts, which <dem/io/checkpoint.hpp> knows.
  template <class V>
  void fields(V& v) {
    v.given("time_step_wanted", options.time_step, "s"), v.given("time_step_safety", options.time_step_safety);
    v.given("skin", options.skin, "m"), v.given("overlap_limit", options.overlap_limit);
    v.given("has_domain", options.domain.has_value());
    if (options.domain)
      v.given("domain_low", options.domain->low, "m"), v.given("domain_high", options.domain->high, "m");
    if constexpr (Model::Domain::has_images) v("cell", domain);
    v("gravity", options.gravity, "m/s^2"), v("time", time, "s"), v("time_step", time_step, "s"), v("steps", step);
    v("materials", materials);
    v.list("species", species, "species", [this](const auto& s) { return " of '" + materials.name(s.material) + "'"; });
    v("machine", machine);
    v.list("surfaces", surfaces, "surface"), v.list("surface_sensors", surface_sensors, "surface sensor");
    v.list("body_contacts", body_contacts.pairs, "body contact"), v("near_pairs", body_contacts.near);
    v("machine_solver", machine_solver), v("list_skin", list_skin, "m"), v("list_valid", list_valid);
    v("grains_added", grains_added);
    v("skin_choice", skin_choice), v("rebuilds", rebuilds), v("to_remove", to_remove), v("remove_by", remove_by);
    v.given("beyond_domain", options.beyond_domain), v.list("outlets", outlets, "outlet");
    v("beyond", beyond_domain), v("energy", ledger), v.list("inlets", inlets, "inlet"), v("put_in_at", put_in_at);
    v("held", held);
    if (grain_load) v.given("set_grain_load", true);
  }

  /// The chunks that this process works on, from first to second: all, unless ranks share them.
  std::pair<std::size_t, std::size_t> own_chunks() const {
    if constexpr (Model::Domain::has_ranks) return domain.own();
    return {0, chunks.size()};
  }
  /// m^2, of the farthest that a grain of this process went since the neighbour list was made.
  double own_moved2() const {
    double moved2 = 0.0;
    const auto [begin, end] = own_chunks();
    for (std::size_t c = begin; c < end; ++c) moved2 = std::max(moved2, chunks[c].moved2);
    return moved2;
  }
  /// m^2, of all.
  double moved2() const {
    if constexpr (Model::Domain::has_ranks) {
      return domain.moved2_of_all ? *domain.moved2_of_all : domain.largest(own_moved2());
    }
    return own_moved2();
  }
  /// Grains are about to move, or the list is another one.
  void forget_moved2() {
    if constexpr (Model::Domain::has_ranks) domain.moved2_of_all.reset();
  }
  /// m, the same; and half of how far the cells of a sheared domain went by each other.
  double moved() const {
    double moved = std::sqrt(moved2());
    if constexpr (domain::IsSheared<typename Model::Domain>) moved += 0.5 * std::abs(domain.offset() - images.offset);
    return moved;
  }
};

/// Throws Error while the grains are in the memory of the executor, and those here are old.
template <class Model>
void require_grains_here([[maybe_unused]] const WorldState<Model>& w, [[maybe_unused]] const char* what) {
  if constexpr (exec::FlatExecutor<typename Model::Executor>) {
    if (w.executor.holds_grains()) {
      fail("{} is asked for within a run, while the grains are in the executor's memory; end the run first", what);
    }
  }
}

/// Throws Error within a run that ranks share, when no rank knows all grains, or of an executor with memory of its own,
/// which has them then.
template <class Model>
void require_between_runs(const WorldState<Model>& w, const char* what) {
  if constexpr (Model::Domain::has_ranks) {
    if (!w.domain.is_whole) {
      fail("{} is asked for within a run, when no rank knows all grains; end the run first", what);
    }
  }
  require_grains_here(w, what);
}

/// Whether the grain of this id sleeps, as far as this process knows.
template <class Model>
bool is_asleep(const WorldState<Model>& w, std::uint32_t id) {
  return w.options.sleep && id < w.sleepers.grains.size() && w.sleepers.grains[id].asleep;
}

/// A new neighbour list is due, whether grains have left this one or not.
template <class Model>
void give_up_list(WorldState<Model>& w) {
  if (w.list_valid) w.skin_choice.moved = w.moved();
  w.list_valid = false;
}

/// Points of grains and of other bodies are found behind a finely cut mesh until they are so deep that it is reported.
template <class Model>
DEM_SETUP void find_points_deep_enough(WorldState<Model>& w) {
  const double share = 1.25 * std::min(1.0, 2.0 * w.options.overlap_limit);  // a step may go beyond
  const auto find_to = [&](auto& surface, double radius) {
    std::visit(
        [&]<class G>(G& geometry) {
          if constexpr (surface::FindsPointsDeep<G>) geometry.find_points_to(share * radius);
        },
        surface.geometry);
  };
  for (auto& s : w.surfaces) find_to(s, w.largest_radius);
  for (const coupling::BodyPair& pair : w.body_contacts.pairs) {
    auto &a = w.surfaces[pair.a.index()], &b = w.surfaces[pair.b.index()];
    find_to(a, coupling::point_radius(b));
    find_to(b, coupling::point_radius(a));
  }
}

/// Surfaces go where their bodies are.
template <class Model>
void place_surfaces(WorldState<Model>& w) {
  const mbd::CarriedBodies carried(w.machine.parts());
  for (auto& s : w.surfaces) s.follow(w.machine.bodies()[s.body.index()], !carried.has(s.body));
}

/// Surfaces note how far they go within a step: see SurfaceOnBody::went.
template <class Model>
void begin_step_of_surfaces(WorldState<Model>& w) {
  for (auto& s : w.surfaces) s.begin_step(w.machine.bodies()[s.body.index()]);
}
template <class Model>
void end_step_of_surfaces(WorldState<Model>& w) {
  for (auto& s : w.surfaces) s.end_step(w.machine.bodies()[s.body.index()]);
}

/// Hands the surfaces' loads of a step, by grains and by surfaces of other bodies, to the sensors.
template <class Model>
void sample_surface_sensors(WorldState<Model>& w) {
  for (SurfaceSensor& s : w.surface_sensors) {
    const auto& surface = w.surfaces[s.surface.index()];
    Wrench load = {surface.force, surface.torque};
    for (const std::uint32_t k : w.body_contacts.near) {
      const coupling::BodyPair& pair = w.body_contacts.pairs[k];
      if (pair.a == s.surface) load = load + Wrench{pair.force, pair.torque_a};
      if (pair.b == s.surface) load = load + Wrench{-pair.force, pair.torque_b};
    }
    s.average.add(load, w.time_step);
  }
}

/// Hands the loads that grains put on surfaces to their bodies.
template <class Model>
void pass_on_loads(WorldState<Model>& w) {
  for (const auto& s : w.surfaces) {
    Body& body = w.machine.body(s.body);
    body.force += s.force;
    body.torque += s.torque;
  }
}

/// Sums the chunks' loads on each surface, in the order of the chunks, and hands them to the bodies.
template <class Model>
void load_bodies(WorldState<Model>& w) {
  for (auto& s : w.surfaces) s.force = s.torque = {0, 0, 0};
  const auto add = [&](const SurfaceLoad& load) {
    w.surfaces[load.surface.index()].force += load.force;
    w.surfaces[load.surface.index()].torque += load.torque;
  };
  if constexpr (Model::Domain::has_ranks) {
    std::vector<SurfaceLoad> loads;
    const auto [begin, end] = w.own_chunks();
    for (std::size_t c = begin; c < end; ++c) {
      const auto& of_chunk = w.chunks[c].surface_loads;
      loads.insert(loads.end(), of_chunk.begin(), of_chunk.end());
    }
    if (!w.surfaces.empty()) loads = w.domain.gathered(loads, w.domain.room_for_loads);
    for (const SurfaceLoad& load : loads) add(load);
  } else {
    for (const auto& chunk : w.chunks) {
      for (const SurfaceLoad& load : chunk.surface_loads) add(load);
    }
  }
  pass_on_loads(w);
}

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_DEFINE_VALUE(WorldCommon)

}  // namespace dem

#endif
