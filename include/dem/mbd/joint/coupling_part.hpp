#pragma once

// Couplings: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd::detail {

/// The degree of freedom that a term of a coupling names, or the one of the kind that the term needs.
Dof dof_of(const CouplingSpec::Term& term, const Parts& parts, std::size_t number, const std::string& who);

using Terms = std::vector<CouplingSpec::Term>;

/// Resolves the degrees of freedom of terms. Throws Error for coordinates or ratios that cannot be.
void check_terms(const Parts& parts, Terms& terms, const std::string& who);

Coupling make_coupling(const Parts& parts, CouplingSpec spec);

/// A term's inverse masses of the joint's two bodies, along the terms' sum: (sum x)^2 <= n sum x^2.
std::pair<double, double> inverse_mass_of(const Parts& m, const Terms& all, const CouplingSpec::Term& term);

/// What holds a sum of coordinates with stiffness k and damping c.
Element element_of(const Parts& m, const PartKind& kind, std::size_t index, const Terms& terms, double k, double c);
bool any_changes_with_pose(const Parts& m, const Terms& terms);

void derive(const Parts& m, const CouplingSpec& s, Coupling& g, const Derivation& derivation);

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
            list.push_back(element_of(m, coupling_kind, i, g.spec.terms, g.k, g.c));
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
            if (!any_changes_with_pose(m, g.spec.terms)) continue;
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

/// One that is switched on takes hold of its coordinates where they are.
void switch_on(Parts& parts, Coupling& g, bool on);

/// Another ratio, from the present pose on. What is derived for the old one is carried over by the inverse masses of
/// both; the offset is such that the multiplier stays.
void set_ratio(Parts& parts, Coupling& g, std::size_t term, double ratio);

CouplingId add_coupling(Parts& parts, CouplingSpec spec);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE Dof dof_of(const CouplingSpec::Term& term, const Parts& parts, std::size_t number, const std::string& who) {
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

DEM_INLINE void check_terms(const Parts& parts, Terms& terms, const std::string& who) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i].dof = dof_of(terms[i], parts, i + 1, who);
    if (!std::isfinite(terms[i].ratio) || terms[i].ratio == 0.0) {
      fail("ratio {} of {} is {:g}, but must be finite and not zero", i + 1, who, terms[i].ratio);
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (terms[k].joint == terms[i].joint && terms[k].dof == terms[i].dof) {
        fail("{} names the same coordinate twice; add up the ratios", who);
      }
    }
  }
}

DEM_INLINE Coupling make_coupling(const Parts& parts, CouplingSpec spec) {
  const std::string who = dem::text("coupling '{}'", spec.name);
  if (spec.terms.size() < 2) fail("{} joins {} coordinates, but needs at least 2", who, spec.terms.size());
  check_terms(parts, spec.terms, who);
  if (spec.stiffness) require_non_negative(*spec.stiffness, ("stiffness of " + who).c_str(), "per unit of the sum");
  if (spec.damping) require_non_negative(*spec.damping, ("damping of " + who).c_str(), "per unit of the sum's rate");
  Coupling g;
  g.offset = coupling_sum(spec, parts.joints, parts.bodies);
  g.k = spec.stiffness.value_or(0.0);
  g.c = spec.damping.value_or(0.0);
  g.spec = std::move(spec);
  return g;
}

DEM_INLINE std::pair<double, double> inverse_mass_of(const Parts& m, const Terms& all, const CouplingSpec::Term& term) {
  const Joint& j = m.joints[term.joint.index()];
  const auto [wa, wb] = inverse_mass_along(j, m.bodies[j.a], m.bodies[j.b], term.dof);
  const double r2 = term.ratio * term.ratio * static_cast<double>(all.size());
  return {r2 * wa, r2 * wb};
}

DEM_INLINE Element element_of(const Parts& m, const PartKind& kind, std::size_t index, const Terms& terms, double k,
                              double c) {
  Element e{&kind, index, {}};
  for (const auto& term : terms) {
    const Joint& j = m.joints[term.joint.index()];
    const auto [wa, wb] = inverse_mass_of(m, terms, term);
    e.sides.push_back({j.a, k * wa, c * wa});
    e.sides.push_back({j.b, k * wb, c * wb});
  }
  return e;
}

DEM_INLINE bool any_changes_with_pose(const Parts& m, const Terms& terms) {
  return std::any_of(terms.begin(), terms.end(),
                     [&](const auto& t) { return traits_of(m.joints[t.joint.index()].kind).changes_with_pose; });
}

DEM_INLINE void derive(const Parts& m, const CouplingSpec& s, Coupling& g, const Derivation& derivation) {
  double w = 0.0;
  for (const auto& term : s.terms)
    w += derivation.shared(m.joints[term.joint.index()], inverse_mass_of(m, s.terms, term));
  g.k = s.stiffness.value_or(derivation.stiffness(joint_frequency, w));
  g.c = s.damping.value_or(Derivation::damping(g.k, w));
}

DEM_INLINE void switch_on(Parts& parts, Coupling& g, bool on) {
  if (on && !g.spec.on) g.offset = coupling_sum(g.spec, parts.joints, parts.bodies);
  g.spec.on = on;
  parts.couplings_changed |= on;
  if (!on) g.error = g.multiplier = 0.0;
}

DEM_INLINE void set_ratio(Parts& parts, Coupling& g, std::size_t term, double ratio) {
  const std::string who = dem::text("coupling '{}'", g.spec.name);
  if (term >= g.spec.terms.size()) {
    fail("term {} of {} was given a ratio, but it has {} (0 to {})", term, who, g.spec.terms.size(),
         g.spec.terms.size() - 1);
  }
  if (!std::isfinite(ratio) || ratio == 0.0) {
    fail("ratio {} of {} is {:g}, but must be finite and not zero; for neutral, switch it off", term + 1, who, ratio);
  }
  Derivation shares;
  shares.shares = shares_of(parts, elements_of(parts));
  const auto inverse_mass = [&] {
    double w = 0.0;
    for (const auto& t : g.spec.terms) {
      w += shares.shared(parts.joints[t.joint.index()], inverse_mass_of(parts, g.spec.terms, t));
    }
    return w;
  };
  const double error = coupling_sum(g.spec, parts.joints, parts.bodies) - g.offset, k = g.k, before = inverse_mass();
  g.spec.terms[term].ratio = ratio;
  parts.couplings_changed = true;
  const double after = inverse_mass();
  if (!g.spec.stiffness && after > 0.0) g.k *= before / after;
  if (!g.spec.damping) g.c = Derivation::damping(g.k, after);
  g.offset = coupling_sum(g.spec, parts.joints, parts.bodies) - (g.spec.on && g.k > 0.0 ? error * k / g.k : 0.0);
}

DEM_INLINE CouplingId add_coupling(Parts& parts, CouplingSpec spec) {
  settle_name(spec.name, parts.couplings, "coupling", "couplings", name_in_spec);
  use(parts, coupling_kind);
  parts.couplings_changed = true;
  return keep<CouplingId>(parts, parts.couplings, make_coupling(parts, std::move(spec)));
}

}  // namespace dem::mbd::detail

#endif
