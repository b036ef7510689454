#pragma once

// Terrains: how they are added, and what the solver asks of them. Only what has terrains includes this file.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/mechanism.hpp>

namespace dem::mbd {

namespace detail {

inline constexpr PartKind terrain_kind = {
    .rank = -1,  // before the loads, which apply what it finds
    .add_forces = [](Parts& m, const Evaluation& now) {
      const double share = now.is_last_stage ? now.slip_time / now.dt : 1.0;
      for (const TerrainPart& t : m.terrains) {
        t->evaluate(m.bodies, m.loads, {now.time, now.is_last_stage && !now.is_trial, share});
      }
    }};

}  // namespace detail

/// Adds a terrain to a machine. Throws Error for none, or a name that another one has.
TerrainId add_terrain(Mechanism& m, std::string name, std::unique_ptr<Terrain> terrain);

/// The terrain of an id. Throws Error if there is none.
inline Terrain& terrain_of(const Mechanism& m, TerrainId id) { return *known(m.parts().terrains, id, "terrain"); }

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE TerrainId add_terrain(Mechanism& m, std::string name, std::unique_ptr<Terrain> terrain) {
  Parts& parts = m.parts();
  require_no_step(parts);
  settle_name(name, parts.terrains, "terrain", "terrains", [](const TerrainPart& t) { return t.name; });
  parts.terrains.emplace_back(std::move(name), std::move(terrain));
  detail::use(parts, detail::terrain_kind);
  ++parts.revision;
  return TerrainId(parts.terrains.size() - 1);
}

}  // namespace dem::mbd

#endif
