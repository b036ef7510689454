#pragma once

// Couplings: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd::detail {

/// The degree of freedom that a term of a coupling names, or the one of the kind that the term needs.
DEM_COLD inline Dof dof_of(const CouplingSpec::Term& term, const Parts& parts, std::size_t number,
                           const std::string& who) {
  using enum CouplingSpec::Moves;
  const Joint& j = known_joint(parts, term.joint, who);
  Dof dof = resolved(j.kind, term.dof);
  if (term.needs != any) {
    const Dofs& all = dofs_of(j.kind);
    const bool turns = term.needs == rotation;
    if (term.dof == Dof::own && all.has(turns ? Dof::turn : Dof::slide)) {
      dof = turns ? Dof::turn : Dof::slide;
    }
    if (dof == Dof::own || !all.has(dof) || is_rotation(dof) != turns) {
      fail(
          "{} needs as joint {} one that {}, but '{}' is a {}{}; exchange the joints, or name a degree of freedom that "
          "{} in the "
          "coupling's terms",
          who, number, turns ? "turns" : "slides", parts.joint_specs[term.joint.index()].name, name_of(j.kind),
          term.dof == Dof::own ? "" : dem::text(" and its {} does not", name_of(dof)), turns ? "turns" : "slides");
    }
  }
  return require_free_dof(j.kind, dof, who);
}

DEM_COLD inline Coupling make_coupling(const Parts& parts, CouplingSpec spec) {
  const std::string who = dem::text("coupling '{}'", spec.name);
  if (spec.terms.size() < 2) fail("{} joins {} coordinates, but needs at least 2", who, spec.terms.size());
  for (std::size_t i = 0; i < spec.terms.size(); ++i) {
    spec.terms[i].dof = dof_of(spec.terms[i], parts, i + 1, who);
    if (!std::isfinite(spec.terms[i].ratio) || spec.terms[i].ratio == 0.0) {
      fail("ratio {} of {} is {:g}, but must be finite and not zero", i + 1, who, spec.terms[i].ratio);
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (spec.terms[k].joint == spec.terms[i].joint && spec.terms[k].dof == spec.terms[i].dof) {
        fail("{} names the same coordinate twice; add up the ratios", who);
      }
    }
  }
  if (spec.stiffness) require_non_negative(*spec.stiffness, ("stiffness of " + who).c_str(), "per unit of the sum");
  if (spec.damping) require_non_negative(*spec.damping, ("damping of " + who).c_str(), "per unit of the sum's rate");
  Coupling g;
  g.offset = coupling_sum(spec, parts.joints, parts.bodies);
  g.k = spec.stiffness.value_or(0.0);
  g.c = spec.damping.value_or(0.0);
  g.spec = std::move(spec);
  return g;
}

/// A term's inverse masses of the joint's two bodies, along the coupling's sum: (sum x)^2 <= n sum x^2.
inline std::pair<double, double> inverse_mass_of(const Parts& m, const CouplingSpec& s,
                                                 const CouplingSpec::Term& term) {
  const Joint& j = m.joints[term.joint.index()];
  const auto [wa, wb] = inverse_mass_along(j, m.bodies[j.a], m.bodies[j.b], term.dof);
  const double r2 = term.ratio * term.ratio * static_cast<double>(s.terms.size());
  return {r2 * wa, r2 * wb};
}

inline void derive(const Parts& m, const CouplingSpec& s, Coupling& g, const Derivation& derivation) {
  double w = 0.0;
  for (const auto& term : s.terms) w += derivation.shared(m.joints[term.joint.index()], inverse_mass_of(m, s, term));
  g.k = s.stiffness.value_or(derivation.stiffness(joint_frequency, w));
  g.c = s.damping.value_or(Derivation::damping(g.k, w));
}

inline constexpr PartKind coupling_kind = {
    .rank = 4,
    .add_forces =
        [](Parts& m, const Evaluation&) {
          for (Coupling& g : m.couplings) apply_coupling(g, m.joints, m.bodies);
        },
    .list_elements =
        [](const Parts& m, std::vector<Element>& list) {
          for (std::size_t i = 0; i < m.couplings.size(); ++i) {
            const Coupling& g = m.couplings[i];
            Element e{&coupling_kind, i, {}};
            for (const auto& term : g.spec.terms) {
              const Joint& j = m.joints[term.joint.index()];
              const auto [wa, wb] = inverse_mass_of(m, g.spec, term);
              e.sides.push_back({j.a, g.k * wa, g.c * wa});
              e.sides.push_back({j.b, g.k * wb, g.c * wb});
            }
            list.push_back(std::move(e));
          }
        },
    .name_of = [](const Parts& m, std::size_t i) { return "coupling '" + m.couplings[i].spec.name + "'"; },
    .derive =
        [](Parts& m, const Derivation& derivation) {
          for (Coupling& g : m.couplings) detail::derive(m, g.spec, g, derivation);
        },
    .soften =
        [](Parts& m, const Derivation& derivation) {
          double worst = 0.0;
          for (Coupling& g : m.couplings) {
            const auto changes = [&](const auto& t) {
              return traits_of(m.joints[t.joint.index()].kind).changes_with_pose;
            };
            if (!std::any_of(g.spec.terms.begin(), g.spec.terms.end(), changes)) continue;
            worst = std::max(worst, 1.0);
            Coupling now = g;
            detail::derive(m, g.spec, now, derivation);
            lower_to(g.k, now.k, worst);
            lower_to(g.c, now.c, worst);
          }
          return worst;
        },
    .first_underived = [](const Parts& m) -> std::string {
      for (const Coupling& g : m.couplings) {
        if (!(g.spec.stiffness && g.spec.damping)) return "coupling '" + g.spec.name + "'";
      }
      return {};
    },
    .may_grow =
        [](const Parts& m) {
          return std::any_of(m.couplings.begin(), m.couplings.end(),
                             [](const Coupling& g) { return g.spec.stiffness || g.spec.damping; });
        }};

DEM_COLD inline CouplingId add_coupling(Parts& parts, CouplingSpec spec) {
  settle_name(spec.name, parts.couplings, "coupling", "couplings", name_in_spec);
  use(parts, coupling_kind);
  return keep<CouplingId>(parts, parts.couplings, make_coupling(parts, std::move(spec)));
}

}  // namespace dem::mbd::detail
