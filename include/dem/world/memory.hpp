#pragma once

#include <dem/world/state.hpp>

namespace dem {

/// Bytes that the grains of a world take: their state, neighbour lists, contacts and histories, room for growth
/// included.
template <class Model>
std::size_t memory_bytes(const WorldState<Model>& w) {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  std::size_t sum = 0;
  auto& p = const_cast<WorldState<Model>&>(w).particles;  // for_each_column has no const form; nothing is changed
  p.for_each_column([&](const AlignedVector<double>& column) { sum += bytes(column); });
  sum += bytes(p.view) + bytes(p.pose) + bytes(p.species) + bytes(p.id) + bytes(p.row_of);
  sum += bytes(w.incoming_first) + bytes(w.incoming) + w.broad_phase.memory_bytes();
  const auto of_memories = [&](const auto& memories) {
    std::size_t b = bytes(memories.now.key) + bytes(memories.last.key);
    for (const auto* memory : {&memories.now, &memories.last}) {
      for (const auto& column : memory->history) b += bytes(column);
    }
    return b;
  };
  for (const Chunk<Model>& c : w.chunks) {
    sum += sizeof(c) + bytes(c.candidate) + bytes(c.owner) + bytes(c.partner_load_first) + bytes(c.partner_loads) +
           bytes(c.surface_loads) + of_memories(c.pair_contacts) + of_memories(c.surface_contacts) + c.searches.bytes();
  }
  return sum;
}

}  // namespace dem
