#pragma once

// Springs: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd::detail {

inline constexpr PartKind spring_kind = {
    .rank = 5,
    .add_forces =
        [](Parts& m, const Evaluation&) {
          for (Spring& s : m.springs) apply_spring(s, m.bodies);
        },
    .list_elements =
        [](const Parts& m, std::vector<Element>& list) {
          for (std::size_t i = 0; i < m.springs.size(); ++i) {
            const Spring& s = m.springs[i];
            const std::uint32_t a = s.spec.a.value, b = s.spec.b.value;
            const auto w = inverse_mass_of_line(s.point_a, s.point_b, m.bodies[a], m.bodies[b]);
            const auto steepest = [](const Curve& c) { return c.empty() ? 0.0 : c.steepest(); };
            add_element(list, spring_kind, i, a, b, w, steepest(s.spec.force_over_length),
                        steepest(s.spec.force_over_speed));
          }
        },
    .name_of = [](const Parts& m, std::size_t i) { return "spring '" + m.springs[i].spec.name + "'"; },
    .may_grow = [](const Parts& m) { return !m.springs.empty(); }};

DEM_COLD inline SpringId add_spring(Parts& parts, SpringSpec spec) {
  settle_name(spec.name, parts.springs, "spring", "springs", name_in_spec);
  Spring s;
  attach_points(parts, s, spec, "spring '" + spec.name + "'");
  s.spec = std::move(spec);
  use(parts, spring_kind);
  return keep<SpringId>(parts, parts.springs, std::move(s));
}

}  // namespace dem::mbd::detail
