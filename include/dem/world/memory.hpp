#pragma once

#include <dem/world/state.hpp>

namespace dem {

/// Bytes that the grains of a world take: their state, neighbour lists, contacts and histories, room for growth
/// included.
template <class Model>
std::size_t memory_bytes(const WorldState<Model>& w) {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  std::size_t sum = 0;
  auto& p = const_cast<WorldState<Model>&>(w).grains;  // for_each_column has no const form; nothing is changed
  p.for_each_column([&](const AlignedVector<double>& column) { sum += bytes(column); });
  sum += bytes(p.view) + bytes(p.pose) + bytes(p.species) + bytes(p.id) + bytes(p.row_of) + bytes(p.number) +
         bytes(p.freed) + bytes(p.free_again);
  sum +=
      w.placed.bytes() + bytes(w.incoming_first) + bytes(w.incoming) + w.broad_phase.memory_bytes() + w.turns.bytes();
  const auto of_histories = [&](const auto& histories) {
    std::size_t b = bytes(histories.key);
    for (const auto& column : histories.history) b += bytes(column);
    return b;
  };
  const auto of_steps = [&](const auto& histories) {
    return of_histories(histories.now) + of_histories(histories.last);
  };
  const auto of_forces = [&](const grain::ContactForces& f) {
    std::size_t b = 0;
    for (const auto* columns : {&f.force, &f.torque_i, &f.torque_j}) {
      for (const auto& column : *columns) b += bytes(column);
    }
    return b;
  };
  for (const ContactScratch<Model>& s : w.scratch) {
    sum += sizeof(s) + bytes(s.pairs.close) + bytes(s.pairs.contact_bits) + bytes(s.pairs.hits) +
           bytes(s.pairs.contact_points) + bytes(s.pairs.listed) + bytes(s.pairs.renews) +
           of_histories(s.pairs.merged) + of_forces(s.pairs.forces) + bytes(s.surfaces.law_of) +
           bytes(s.surfaces.hits) + bytes(s.surfaces.contact_points) + bytes(s.surfaces.total_share) +
           s.surfaces.supports.bytes() + of_forces(s.surfaces.forces) + of_histories(s.pairs_now) +
           of_histories(s.surfaces_now);
  }
  if constexpr (Model::Domain::has_images) sum += bytes(w.images.grain) + bytes(w.images.shift) + bytes(w.images.level);
  sum += bytes(w.sleepers.grains) + bytes(w.sleepers.borne) + bytes(w.sleepers.working) + bytes(w.sleepers.doing) +
         bytes(w.sleepers.acted_on) + bytes(w.sleepers.awake_beside);
  for (const Columns3* kept :
       {&w.sleepers.kept_force, &w.sleepers.kept_torque, &w.sleepers.surface_force, &w.sleepers.surface_torque}) {
    sum += bytes(kept->x) + bytes(kept->y) + bytes(kept->z);
  }
  for (const Chunk<Model>& c : w.chunks) sum += bytes(c.around) + bytes(c.reached) + bytes(c.sleeps);
  const grain::EnergyLedger& l = w.ledger;
  sum += bytes(l.last) + bytes(l.velocity) + bytes(l.global_angular_velocity) + bytes(l.energy);
  for (const Chunk<Model>& c : w.chunks) {
    sum += sizeof(c) + bytes(c.candidate) + bytes(c.owner) + bytes(c.partner_load_first) + bytes(c.partner_loads) +
           bytes(c.surface_loads) + bytes(c.work) + of_steps(c.pair_contacts) + of_steps(c.surface_contacts) +
           c.searches.bytes();
  }
  return sum;
}

}  // namespace dem
