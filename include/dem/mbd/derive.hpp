#pragma once

#include <dem/mbd/stability.hpp>

#include <cmath>

namespace dem::mbd {

inline constexpr double endless_step = 1e30;  ///< s

/// The limits that a joint's user gave for a coordinate that has stops.
inline const JointLimits& limits_of(const JointSpec& s, Freedom freedom) {
  return *std::find_if(s.limits.begin(), s.limits.end(), [&](const JointLimits& l) { return l.freedom == freedom; });
}

/// Fills in every stiffness and damping that the user left open, for a time step dt (s); the formula stands in
/// stability.hpp. What the user gave stays.
inline void derive_stiffness(Parts& m, double dt) {
  using namespace detail;
  require_positive(dt, "time step", "s");
  const std::vector<double> n = shares_of(m, elements_of(m));
  // Stiffness for a frequency of `factor`/dt, where 1 N moves the shares by `w` m/s^2; nothing moves: nothing to hold.
  const auto stiff = [&](double factor, double w) { return w > 0.0 ? factor * factor / (dt * dt * w) : 0.0; };
  const auto damp = [](double k, double w) { return w > 0.0 ? 2.0 * damping_ratio * std::sqrt(k / w) : 0.0; };

  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    Joint& j = m.joints[i];
    const JointSpec& s = m.joint_specs[i];
    if (j.kind == JointKind::bushing || j.kind == JointKind::free) continue;
    const JointMobility w = mobility_of(j, m.bodies[j.a], m.bodies[j.b]);
    const double displacement = n[j.a] * w.displacement_a + n[j.b] * w.displacement_b;
    const double rotation = n[j.a] * w.rotation_a + n[j.b] * w.rotation_b;
    const bool both = displacement > 0.0 && rotation > 0.0;
    const double factor = joint_frequency * (both ? std::sqrt(0.5) : 1.0);
    // Derived damping belongs to the joint's whole frequency, which is higher than that of its displacements alone.
    const auto damping_of = [&](const std::optional<double>& k, double derived, double mobility) {
      return k ? damp(*k, mobility) : 2.0 * damping_ratio * derived * dt / joint_frequency;
    };
    j.k = s.stiffness.value_or(stiff(factor, displacement));
    j.kr = s.rotational_stiffness.value_or(stiff(factor, rotation));
    j.c = s.damping.value_or(damping_of(s.stiffness, j.k, displacement));
    j.cr = s.rotational_damping.value_or(damping_of(s.rotational_stiffness, j.kr, rotation));
  }
  const auto along = [&](const Joint& j, Freedom freedom) {
    const auto [wa, wb] = coordinate_mobility(j, m.bodies[j.a], m.bodies[j.b], freedom);
    return n[j.a] * wa + n[j.b] * wb;
  };
  for (JointStops& e : m.stops) {
    const double w = along(m.joints[e.joint], e.freedom);
    const JointLimits& given = limits_of(m.joint_specs[e.joint], e.freedom);
    e.stiffness = given.stiffness.value_or(stiff(joint_frequency, w));
    e.damping = given.damping.value_or(damp(e.stiffness, w));
  }
  for (JointRubbing& e : m.rubbing) {
    const Joint& j = m.joints[e.joint];
    const auto [wa, wb] = rubbing_mobility(j, m.bodies[j.a], m.bodies[j.b], e.radius);
    const double w = n[j.a] * wa + n[j.b] * wb;
    const JointFriction& given = *m.joint_specs[e.joint].friction;
    e.law.stiffness = given.stiffness.value_or(stiff(friction_frequency, w));
    e.law.velocity_stiffness = given.velocity_stiffness.value_or(damp(e.law.stiffness, w));
  }
  for (Coupling& g : m.couplings) {
    double w = 0.0;
    for (const auto& term : g.spec.terms) {
      const Joint& j = m.joints[term.joint.index()];
      w += term.ratio * term.ratio * static_cast<double>(g.spec.terms.size()) * along(j, term.freedom);
    }
    g.k = g.spec.stiffness.value_or(stiff(joint_frequency, w));
    g.c = g.spec.damping.value_or(damp(g.k, w));
  }
}

/// The same machine with what its user gave alone: laid out for a step without end, all that is derived vanishes but
/// for dampers that belong to a given stiffness.
inline Parts without_derived(Parts m) {
  derive_stiffness(m, endless_step);
  return m;
}

/// What has no stiffness yet: its name, or an empty text. Without a time step nothing can be derived.
inline std::string first_underived(const Parts& m) {
  using namespace detail;
  for (const JointSpec& s : m.joint_specs) {
    const bool holds = s.kind != JointKind::bushing && s.kind != JointKind::free;  // with stiffness that is derived
    const bool displacement = holds && hold_of(s.kind) != Hold::nothing && !(s.stiffness && s.damping);
    const bool rotation =
        holds && align_of(s.kind) != Align::nothing && !(s.rotational_stiffness && s.rotational_damping);
    if (displacement || rotation) return fmt::format("{} '{}'", name_of(s.kind), s.name);
    for (const JointLimits& stops : s.limits) {
      if (!(stops.stiffness && stops.damping)) return fmt::format("stops of '{}'", s.name);
    }
    if (s.friction && !(s.friction->stiffness && s.friction->velocity_stiffness)) {
      return fmt::format("friction of '{}'", s.name);
    }
  }
  for (const Coupling& g : m.couplings) {
    if (!(g.spec.stiffness && g.spec.damping)) return fmt::format("coupling '{}'", g.spec.name);
  }
  return {};
}

namespace detail {

/// Whether integrator I keeps x'' = -k x - c x' bounded over 400 steps of dt, from x = 1 and a given speed over scale.
template <class I>
bool stays_bounded(double k, double c, double dt, double start) {
  integrator::Motion<double> m = {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, Matrix3<double>::identity()};
  typename I::template Memory<double> memory{};
  const double scale = std::sqrt(k) + c;  // 1/s, makes a speed comparable with a displacement
  m.velocity.x = start * scale;
  const auto acceleration = [&] {
    return integrator::Acceleration<double>{{-k * m.position.x - c * m.velocity.x, 0, 0}, {0, 0, 0}};
  };
  I::template initialise<double>(memory, acceleration());
  for (int step = 0; step < 400; ++step) {
    for (int stage = 0; stage < I::stages; ++stage) {
      if constexpr (I::predicts_before_forces) I::template before_forces<double>(stage, dt, m, memory);
      I::template after_forces<double>(stage, dt, m, memory, acceleration());
    }
    if (!(std::abs(m.position.x) < 100.0 && std::abs(m.velocity.x) < 100.0 * scale)) return false;
  }
  return true;
}

/// The largest stable time step of x'' = -k x - c x' with integrator I, by bisection with the integrator itself.
template <class I>
double largest_stable_step(double k, double c) {
  if (k <= 0.0 && c <= 0.0) return 1e300;
  double low = 0.0, high = 4.0 / std::max(std::sqrt(k), c);
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    // Two starts: one of them might by chance be the one that does not grow.
    const bool stable = stays_bounded<I>(k, c, middle, 0.5) && stays_bounded<I>(k, c, middle, -0.37);
    (stable ? low : high) = middle;
  }
  return low;
}

}  // namespace detail

/// The largest time step at which all joints, couplings, springs and actuators are stable with integrator I, and the
/// part that limits it. Two bounds on the highest frequency are known, and the better one counts: the element bound
/// with equal shares, and the sum over everything on the element's bodies. No safety factor is in it.
template <class I>
StableTimeStep stable_time_step_of(const Parts& m) {
  using namespace detail;
  const std::vector<Element> elements = elements_of(m);
  const std::vector<double> n = shares_of(m, elements);
  std::vector<double> k(m.bodies.size(), 0.0), c(m.bodies.size(), 0.0);
  for (const Element& e : elements) {
    for (const Element::Side& s : e.sides) {
      k[s.body] += s.k;
      c[s.body] += s.c;
    }
  }
  StableTimeStep shares, sums;
  double worst_k[2] = {0, 0}, worst_c[2] = {0, 0};
  for (const Element& e : elements) {
    double ek[2] = {0, 0}, ec[2] = {0, 0}, own = 0.0;
    for (const Element::Side& s : e.sides) {
      ek[0] += n[s.body] * s.k;
      ec[0] += n[s.body] * s.c;
      ek[1] += k[s.body];
      ec[1] += c[s.body];
      own += s.k + s.c;
    }
    if (own <= 0.0) continue;  // a part without any stiffness limits nothing
    for (int i = 0; i < 2; ++i) {
      if (ek[i] <= worst_k[i] && ec[i] <= worst_c[i]) continue;
      StableTimeStep& found = i == 0 ? shares : sums;
      const double dt = largest_stable_step<I>(ek[i], ec[i]);
      if (dt < found.dt) {
        found = {dt, e.name};
        worst_k[i] = ek[i];
        worst_c[i] = ec[i];
      }
    }
  }
  return shares.dt > sums.dt ? shares : sums;
}

}  // namespace dem::mbd
