#pragma once

// Brakes and clutches: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/coupling_part.hpp>
#include <dem/mbd/joint/joint_part.hpp>

namespace dem::mbd::detail {

void derive(const Parts& m, Clutch& u, const Derivation& derivation);
/// What a clutch holds when its stiffness was another one (k) stays where it is: the anchor gives way instead.
void keep_torque(Clutch& u, double k);

/// Capacity (N m) of a limited-slip differential's plates per N m of its coupling's multiplier. The outputs get
/// S = (|r1| + |r2|) lambda together. T moves over from one to the other: (S/2 + T) = bias_ratio (S/2 - T).
double plate_bias(const Coupling& differential, double bias_ratio);

inline constexpr PartKind clutch_kind = {
    .rank = 8,  // after the couplings, of which a limited-slip differential takes its capacity
    .add_forces =
        [](Parts& m, const Evaluation& now) {
          for (Clutch& u : m.clutches) {
            double multiplier = 0.0;
            if (u.spec.differential.valid()) {
              const Coupling& g = m.couplings[u.spec.differential.index()];
              u.bias = plate_bias(g, u.spec.bias_ratio);  // its ratios may change
              multiplier = g.multiplier;
            }
            apply_clutch(u, m.joints, m.bodies, now.time, now.dt, multiplier, now.is_last_stage);
          }
        },
    .list_elements =  // one that is open may close in the next step, so it counts as if it were closed
    [](const Parts& m, std::vector<Element>& list) {
      for (std::size_t i = 0; i < m.clutches.size(); ++i) {
        const Clutch& u = m.clutches[i];
        list.push_back(element_of(m, clutch_kind, i, u.spec.terms, u.k, u.c));
      }
    },
    .name_of = [](const Parts& m, std::size_t i) { return "clutch or brake '" + m.clutches[i].spec.name + "'"; },
    .derive =
        [](Parts& m, const Derivation& derivation) {
          for (Clutch& u : m.clutches) {
            const double k = u.k;
            detail::derive(m, u, derivation);
            keep_torque(u, k);
          }
        },
    .soften =
        [](Parts& m, const Derivation& derivation) {
          double worst = 0.0;
          for (Clutch& u : m.clutches) {
            if (!any_changes_with_pose(m, u.spec.terms)) continue;
            worst = std::max(worst, 1.0);
            Clutch now = u;
            detail::derive(m, now, derivation);
            const double k = u.k;
            lower_to(u.k, now.k, worst);
            lower_to(u.c, now.c, worst);
            keep_torque(u, k);
          }
          return worst;
        },
    .first_underived = [](const Parts& m) -> std::string {
      for (const Clutch& u : m.clutches) {
        if (!(u.spec.stiffness && u.spec.damping)) return "clutch or brake '" + u.spec.name + "'";
      }
      return {};
    },
    .may_grow =
        [](const Parts& m) {
          return std::any_of(m.clutches.begin(), m.clutches.end(),
                             [](const Clutch& u) { return u.spec.stiffness || u.spec.damping; });
        },
    .not_a_number = [](const Parts& m) -> std::string {
      for (const Clutch& u : m.clutches) {
        const bool by_coupling = u.spec.differential.valid();
        if (std::isnan(u.capacity) && !by_coupling) return "The capacity of clutch or brake '" + u.spec.name + "'";
      }
      return {};
    }};

/// The two outputs of a differential.
void take_differential(const Parts& parts, Clutch& u, const std::string& who);

ClutchId add_clutch(Parts& parts, ClutchSpec spec);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void derive(const Parts& m, Clutch& u, const Derivation& derivation) {
  double w = 0.0;
  for (const auto& t : u.spec.terms)
    w += derivation.shared(m.joints[t.joint.index()], inverse_mass_of(m, u.spec.terms, t));
  u.k = u.spec.stiffness.value_or(derivation.stiffness(joint_frequency, w));
  u.c = u.spec.damping.value_or(Derivation::damping(u.k, w));
}

DEM_INLINE void keep_torque(Clutch& u, double k) {
  if (!u.history.is_closed || k == u.k || !(k > 0.0 && u.k > 0.0)) return;
  const double stretch = u.history.stretch * k / u.k;
  u.history.anchor -= stretch - u.history.stretch;
  u.history.stretch = stretch;
}

DEM_INLINE double plate_bias(const Coupling& differential, double bias_ratio) {
  const Terms& t = differential.spec.terms;
  return 0.5 * (std::abs(t[1].ratio) + std::abs(t[2].ratio)) * (bias_ratio - 1.0) / (bias_ratio + 1.0);
}

DEM_INLINE void take_differential(const Parts& parts, Clutch& u, const std::string& who) {
  const Coupling& g = known(parts.couplings, u.spec.differential, ("coupling of " + who).c_str());
  const auto& t = g.spec.terms;
  if (t.size() != 3 || t[1].ratio != t[2].ratio) {
    fail("{} limits the slip of coupling '{}', which is no differential(...) with two like outputs", who, g.spec.name);
  }
  if (!(u.spec.bias_ratio >= 1.0) || !std::isfinite(u.spec.bias_ratio)) {
    fail("the bias ratio of {} is {:g}, but must be finite and at least 1, which is an open differential", who,
         u.spec.bias_ratio);
  }
  u.spec.terms = {{t[1].joint, 1.0, t[1].dof}, {t[2].joint, -1.0, t[2].dof}};
  u.bias = plate_bias(g, u.spec.bias_ratio);
}

DEM_INLINE ClutchId add_clutch(Parts& parts, ClutchSpec spec) {
  settle_name(spec.name, parts.clutches, "clutch or brake", "clutches or brakes", name_in_spec);
  const std::string who = dem::text("clutch or brake '{}'", spec.name);
  if (spec.stiffness) require_positive(*spec.stiffness, ("stiffness of " + who).c_str(), "N m/rad or N/m");
  if (spec.damping) require_non_negative(*spec.damping, ("damping of " + who).c_str(), "N m s/rad or N s/m");
  Clutch u;
  u.spec = std::move(spec);
  if (u.spec.differential.valid()) take_differential(parts, u, who);
  if (u.spec.terms.empty()) {
    const JointId slip = add_joint(parts, free_joint("slip of " + who, u.spec.a, u.spec.b, u.spec.at, u.spec.axis));
    u.spec.terms = {{slip, 1.0, Dof::turn}};
  }
  check_terms(parts, u.spec.terms, who);
  u.k = u.spec.stiffness.value_or(0.0);
  u.c = u.spec.damping.value_or(0.0);
  use(parts, clutch_kind);
  return keep<ClutchId>(parts, parts.clutches, std::move(u));
}

}  // namespace dem::mbd::detail

#endif
