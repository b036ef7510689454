#pragma once

#include <dem/world/neighbours.hpp>
#include <dem/world/release_ids.hpp>
#include <dem/world/run_shared.hpp>
#include <dem/world/sleep.hpp>

namespace dem {

/// Calls list(), which lists neighbours, between two steps, as grains have come: those that were there before and the
/// machine go on as they were, and nothing is initialised again. Integrators that predict move grains by chunks before
/// they ask for forces, so new grains have to be listed by then.
template <class Model, class List>
void list_between_steps(WorldState<Model>& w, List&& list) {
  w.stopwatch.start();
  list();
  find_sleepers(w);
  choose_working_chunks(w);
  w.sleepers.all_work = true;
  w.grains_added = false;
  w.stopwatch.stop(Phase::neighbours);
}

/// The same between two runs, after which every rank knows all grains and the bounds of all chunks.
template <class Model, class List>
void list_between_runs(WorldState<Model>& w, List&& list) {
  list_between_steps(w, list);
  if constexpr (Model::Domain::has_ranks) {
    w.domain.is_whole = !w.domain.is_shared();
    gather_rows(w);
  }
}

/// What an integrator remembers of the grain of a new row: nothing touched it, so weight alone accelerates it.
template <class Model>
void begin_to_fall(WorldState<Model>& w, std::size_t row) {
  auto& p = w.grains;
  if (w.species[p.species[row]].is_held()) return;
  typename Model::Integrator::template Memory<double> memory{};
  Model::Integrator::template initialise<double>(memory, {from_eigen(w.options.gravity), {0, 0, 0}});
  p.set_memory(row, memory);
}

/// Lists neighbours anew between two runs, with grains that `change(histories)` puts in: the same ones on every rank,
/// which shares what they remember with the others (see is_told_here). `asked()` is a number that tells which: ranks
/// compare it.
template <class Model, class Asked, class Change>
void relist(WorldState<Model>& w, [[maybe_unused]] Asked&& asked, Change&& change) {
  require_between_runs(w, "a bed whose grains come or go");
  detail::Compared compared;
  if constexpr (Model::Domain::has_ranks) compared = {.asked = asked(), .grains = w.grains_added};
  together(
      w, domain::Call::tiles, "as grains came or went",
      [&] { list_between_runs(w, [&] { rebuild_neighbours(w, change); }); }, compared);
}
/// Whether this rank is the one that hands over what item number `n` of those that come remembers: each has its share.
template <class Model>
bool is_told_here([[maybe_unused]] const WorldState<Model>& w, [[maybe_unused]] std::size_t n) {
  if constexpr (Model::Domain::has_ranks) {
    return n % static_cast<std::size_t>(w.domain.ranks()) == static_cast<std::size_t>(w.domain.rank());
  }
  return true;
}

/// The species of grains that are held and are otherwise like those of `s`; made when the world has none.
template <class World>
SpeciesId held_twin(World& world, SpeciesId s) {
  const auto kind = world.species(s);  // a copy: the list may grow
  if (kind.is_held()) return s;
  const auto& all = world.state().species;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& o = all[k];
    if (o.is_held() && o.material == kind.material && o.mass == kind.mass && o.inertia == kind.inertia &&
        shape::fingerprint(o.shape) == shape::fingerprint(kind.shape)) {
      return SpeciesId(k);
    }
  }
  return world.add_species(
      kind.shape, {.material = world.state().materials.name(kind.material), .density = kind.density, .held = true});
}

/// A grain stands still from now on, or moves by itself again, as the species says that it is of now; its contacts go
/// on. Its neighbours have to be listed anew after it. Where energy is counted, held grains have none.
template <class Model>
void change_species(WorldState<Model>& w, std::size_t row, SpeciesId to) {
  auto& p = w.grains;
  const auto& from = w.species[p.species[row]];
  const bool stands = w.species[to.index()].is_held();
  if (w.ledger.on && from.is_held() != stands) {
    const double fall = from.mass * dot(from_eigen(w.options.gravity), p.position[row]);
    w.ledger.came +=
        (stands ? -1.0 : 1.0) * (kinetic_energy(from, p.velocity[row], p.local_angular_velocity[row]) - fall);
  }
  p.species[row] = to.value;
  if (p.id[row] < w.sleepers.grains.size()) w.sleepers.grains[p.id[row]] = {};  // it wakes
  if (!stands) return;
  p.velocity.set(row, {0, 0, 0});
  p.local_angular_velocity.set(row, {0, 0, 0});
  p.set_memory(row, {});
}

}  // namespace dem
