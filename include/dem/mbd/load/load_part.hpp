#pragma once

// Loads: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd::detail {

inline constexpr PartKind load_kind = {
    .rank = 0,
    .add_forces =
        [](Parts& m, const Evaluation& now) {
          for (Load& load : m.loads) apply_load(load, m.bodies, now.time, now.dt);
        },
    .not_a_number = [](const Parts& m) -> std::string {
      for (const Load& l : m.loads) {
        if (std::isnan(l.size)) return "The size of load '" + l.spec.name + "'";
        const Wrench& w = l.wrench;
        if (l.spec.has_law() && std::isnan(dot(w.force, {1, 1, 1}) + dot(w.torque, {1, 1, 1}))) {
          return "The force or torque of load '" + l.spec.name + "'";
        }
      }
      return {};
    }};

LoadId add_load(Parts& parts, LoadSpec spec);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE LoadId add_load(Parts& parts, LoadSpec spec) {
  settle_name(spec.name, parts.loads, "load", "loads", name_in_spec);
  const std::string who = dem::text("load '{}'", spec.name);
  const Body& b = known_body(parts, spec.body, who);
  if (spec.pair_law && known_body(parts, spec.a, who).name == b.name) {
    fail("{} acts between body '{}' and itself; give it two different bodies", who, b.name);
  }
  if (!spec.has_law()) require_one_moves(b, b, who);
  const Vector3<double> n = unit(spec.direction, who);
  Load load;
  load.point = to_body(b, finite_point(spec.at, "the point of " + who));
  load.direction = spec.follows_body ? transpose_times(b.motion.rotation, n) : n;
  load.spec = std::move(spec);
  use(parts, load_kind);
  return keep<LoadId>(parts, parts.loads, std::move(load), false);
}

}  // namespace dem::mbd::detail

#endif
