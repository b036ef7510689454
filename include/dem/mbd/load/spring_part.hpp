#pragma once

// Springs: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/line_element.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd::detail {

inline constexpr PartKind spring_kind = {
    .rank = 5,
    .add_forces =
        [](Parts& m, const Evaluation&) {
          for (Spring& s : m.springs) apply_spring(s, m.joints, m.bodies);
        },
    .list_elements =
        [](const Parts& m, std::vector<Element>& list) {
          for (std::size_t i = 0; i < m.springs.size(); ++i) {
            const Spring& s = m.springs[i];
            const Body &a = m.bodies[s.a], &b = m.bodies[s.b];
            const auto steepest = [](const Curve& c) { return c.empty() ? 0.0 : c.steepest(); };
            const double k = steepest(s.spec.force_over_length), c = steepest(s.spec.force_over_speed);
            if (s.spec.joint.valid()) {
              const auto w = inverse_mass_along(m.joints[s.spec.joint.index()], a, b, s.spec.dof);
              add_element(list, spring_kind, i, s.a, s.b, w, k, c);
            } else {
              const Coordinate q = distance_of(s.point_a, s.point_b, a, b);
              const double pull = s.spec.force_over_length.empty() ? 0.0 : -s.spec.force_over_length(q.value - s.start);
              add_line_element(list, m, spring_kind, i, s.a, s.b, q, {k, c, pull});
            }
          }
        },
    .name_of = [](const Parts& m, std::size_t i) { return "spring '" + m.springs[i].spec.name + "'"; },
    .may_grow = [](const Parts& m) { return !m.springs.empty(); }};

SpringId add_spring(Parts& parts, SpringSpec spec);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE SpringId add_spring(Parts& parts, SpringSpec spec) {
  settle_name(spec.name, parts.springs, "spring", "springs", name_in_spec);
  Spring s;
  const std::string who = "spring '" + spec.name + "'";
  if (spec.on_joint) {
    const Joint& j = known_joint(parts, spec.joint, who);
    spec.dof = require_free_dof(j.kind, spec.dof, who);
    s.a = j.a;
    s.b = j.b;
  } else {
    attach_points(parts, s, spec, who);
    s.a = spec.a.value;
    s.b = spec.b.value;
  }
  s.spec = std::move(spec);
  if (s.spec.from_start) s.start = coordinate_of(s, parts.joints, parts.bodies[s.a], parts.bodies[s.b]).value;
  use(parts, spring_kind);
  return keep<SpringId>(parts, parts.springs, std::move(s));
}

}  // namespace dem::mbd::detail

#endif
