#pragma once

#include <dem/coupling/body_contacts.hpp>
#include <dem/coupling/body_stability.hpp>
#include <dem/coupling/machine_surface.hpp>
#include <dem/coupling/surface_contacts.hpp>
#include <dem/grain/materials.hpp>
#include <dem/grain/neighbours.hpp>
#include <dem/grain/pair_contacts.hpp>
#include <dem/grain/sleep.hpp>
#include <dem/mbd/solver/solver.hpp>
#include <dem/world/model.hpp>
#include <dem/world/options.hpp>
#include <dem/world/stopwatch.hpp>

#include <set>

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
};

/// Everything a world consists of. Only World and the functions of the step see it.
template <class Model>
struct WorldState {
  using Shape = typename Model::Shape;
  using Integrator = typename Model::Integrator;
  using Surface = MachineSurface<typename Model::Surfaces>;

  WorldOptions options;
  double time = 0.0;
  double time_step = 0.0;
  std::uint64_t step = 0;

  Materials<Model> materials;
  std::vector<Species<Shape>> species;
  std::vector<SpeciesInertia> inertia;  ///< of the species
  double largest_radius = 0.0;          ///< m, bounding radius

  Particles<Shape, Integrator> particles;
  std::vector<Chunk<Model>> chunks;
  typename Model::BroadPhase broad_phase;
  std::vector<std::uint32_t> incoming_first;
  std::vector<grain::Incoming> incoming;
  double list_skin = 0.0;                ///< m, with which the neighbour list was made
  bool list_valid = false;               ///< false after grains were added or moved by hand
  std::uint64_t rebuilds = 0;            ///< neighbour lists made
  std::set<std::uint32_t> known_lost;    ///< ids of grains that were reported as lost
  std::vector<std::uint32_t> to_remove;  ///< ids of grains that are gone, but whose rows are there until the next list
  std::uint64_t remove_by = 0;           ///< the step in which that list is due, if there are any
  std::vector<Outlet> outlets;
  Outlet beyond_domain;  ///< of a domain that removes what leaves it
  grain::Sleepers sleepers;

  mbd::Mechanism machine;
  mbd::Solver<Integrator, typename Model::Joints> machine_solver;
  std::vector<Surface> surfaces;
  std::vector<coupling::FindHits<Model>> find_hits;  ///< of the surfaces: the code for their kinds
  std::vector<SurfaceSensor> surface_sensors;
  coupling::BodyContacts<Model> body_contacts;
  void (*find_body_contacts)(WorldState&) = nullptr;  ///< set with the first pair: other programs are without that code
  typename Model::Executor executor;
  std::vector<ContactScratch<Model>> scratch;  ///< of the executor's threads
  Stopwatch stopwatch;

  /// All that the future depends on but the grains and their contacts, which <dem/io/checkpoint.hpp> knows.
  template <class V>
  void fields(V& v) {
    v.given("time_step_wanted", options.time_step, "s"), v.given("time_step_safety", options.time_step_safety);
    v.given("skin", options.skin, "m"), v.given("overlap_limit", options.overlap_limit);
    v.given("has_domain", options.domain.has_value());
    if (options.domain)
      v.given("domain_low", options.domain->low, "m"), v.given("domain_high", options.domain->high, "m");
    v("gravity", options.gravity, "m/s^2"), v("time", time, "s"), v("time_step", time_step, "s"), v("steps", step);
    v("materials", materials), v.list("species", species, "species"), v("machine", machine);
    v.list("surfaces", surfaces, "surface"), v.list("surface_sensors", surface_sensors, "surface sensor");
    v.list("body_contacts", body_contacts.pairs, "body contact"), v("near_pairs", body_contacts.near);
    v("machine_solver", machine_solver), v("list_skin", list_skin, "m"), v("list_valid", list_valid);
    v("rebuilds", rebuilds), v("to_remove", to_remove), v("remove_by", remove_by);
    v.given("beyond_domain", options.beyond_domain), v.list("outlets", outlets, "outlet");
    v("beyond", beyond_domain);
  }

  double skin() const { return options.skin > 0.0 ? options.skin : 0.1 * largest_radius; }
};

/// True when some grain moved more than half the skin since the neighbour list was made.
template <class Model>
bool neighbours_outdated(const WorldState<Model>& w) {
  if (!w.list_valid) return w.particles.count > 0;
  double moved2 = 0.0;
  for (const auto& chunk : w.chunks) moved2 = std::max(moved2, chunk.moved2);
  return 4.0 * moved2 > w.list_skin * w.list_skin;
}

/// Sorts the grains in space, lists their neighbours, and carries the contact histories over.
template <class Model>
void rebuild_neighbours(WorldState<Model>& w) {
  auto& p = w.particles;
  std::vector<grain::Remembered<history_size<Model>>> pairs, surfaces;
  grain::collect_memories<Model>(std::span<const Chunk<Model>>(w.chunks), p, pairs, surfaces);
  if (!w.to_remove.empty()) {
    p.remove(w.to_remove);
    w.to_remove.clear();
    grain::forget_removed(p, pairs, surfaces);
  }

  if (p.count == 0) {
    w.chunks.clear();
    w.incoming.clear();
    w.list_valid = true;
    return;
  }
  const double reach = 2.0 * w.largest_radius + w.materials.range() + w.skin();
  const auto positions = [&] {
    return broadphase::Positions{p.position.x.data(), p.position.y.data(), p.position.z.data(), p.count};
  };
  w.broad_phase.build(positions(), reach);
  if (const auto order = w.broad_phase.order(); !order.empty()) {
    const std::vector<std::uint32_t> sorted(order.begin(), order.end());
    p.permute(sorted);
    w.broad_phase.build(positions(), reach);
  }
  p.listed_at = p.position;
  p.pad();

  w.chunks.resize(p.chunks());
  w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
    grain::list_candidates<Model>(c, w.chunks[c], p, w.broad_phase, w.species, w.materials.range() + w.skin());
    grain::refresh_chunk<Model>(c, w.chunks[c], p, w.species);
  });
  grain::list_incoming<Model>(std::span<const Chunk<Model>>(w.chunks), p.count, w.incoming_first, w.incoming);
  grain::return_memories<Model>(std::span<Chunk<Model>>(w.chunks), p, pairs, surfaces);
  w.list_valid = true;
  w.list_skin = w.skin();
  ++w.rebuilds;
}

/// Points of grains and of other bodies are found behind a finely cut mesh until they are so deep that it is reported.
template <class Model>
void find_points_deep_enough(WorldState<Model>& w) {
  const double share = 1.25 * std::min(1.0, 2.0 * w.options.overlap_limit);  // a step may go beyond
  const auto find_to = [&](auto& surface, double radius) {
    std::visit(
        [&](auto& geometry) {
          if constexpr (requires { geometry.find_points_to(1.0); }) geometry.find_points_to(share * radius);
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
  for (auto& s : w.surfaces) s.follow(w.machine.bodies()[s.body.index()]);
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

/// Sums the chunks' loads on each surface, in the order of the chunks, and hands them to the bodies.
template <class Model>
void load_bodies(WorldState<Model>& w) {
  for (auto& s : w.surfaces) s.force = s.torque = {0, 0, 0};
  for (const auto& chunk : w.chunks) {
    for (const SurfaceLoad& load : chunk.surface_loads) {
      w.surfaces[load.surface.index()].force += load.force;
      w.surfaces[load.surface.index()].torque += load.torque;
    }
  }
  for (const auto& s : w.surfaces) {
    Body& body = w.machine.body(s.body);
    body.force += s.force;
    body.torque += s.torque;
  }
}

}  // namespace dem
