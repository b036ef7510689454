#pragma once

// What the solver asks of a kind of part (joints, springs, actuators ...): its forces and its stiffness. Each kind
// answers in a file of its own, <kind>_part.hpp, and the solver calls the kinds that a machine has. So a program has
// the code of the parts that it adds, and of no others, but for programs that link dem::compiled.
//
// How stiff a machine is, and how stiff it may be. Element bound: give each of the n elements on a body 1/n of the
// body's mass and inertia. Then the highest frequency of the whole machine is at most the highest frequency of a single
// element with its shares (the machine's energies are the sums of the elements' energies). With the inverse effective
// mass W of a body at the joint, per unit force or torque,
//   omega_e^2 <= sum over the element's bodies of n * largest eigenvalue(K^1/2 W K^1/2).
// A stiffness that the user leaves open is derived so that omega_e dt = 0.7:
//   k = share (0.7/dt)^2 / sum(n W),  share = 1/2 if the joint holds both displacements and rotations, else 1,
// and the damping so that this frequency has the damping ratio 0.5: c = k dt/0.7, or sqrt(k / sum(n W)) if
// the stiffness is the user's. Limits and joint friction are derived in the same way (friction with omega_e dt = 0.1).

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd::detail {

inline constexpr double joint_frequency = 0.7, friction_frequency = 0.1, damping_ratio = 0.5;

struct PartKind;

/// What a part adds to the stiffness of the machine: for each of its bodies, omega^2 and omega-damping per share.
struct Element {
  struct Side {
    std::uint32_t body;
    double k = 0.0;  ///< 1/s^2
    double c = 0.0;  ///< 1/s
  };
  const PartKind* kind;
  std::size_t index;  ///< among the parts of its kind
  std::vector<Side> sides;
};

/// The time (s) of the state at which forces are evaluated, and the machine's time step (s). Each stage of a step
/// stretches the springs of joint friction by its share of the step, slip_time (s); 0 outside of a step. Turns are
/// followed in the last stage only.
struct Evaluation {
  double time, dt, slip_time;
  bool is_last_stage;
  bool is_trial;  ///< sub-steps that are taken again: nothing is to be remembered
  double followed() const { return is_last_stage ? dt : 0.0; }
};

struct Derivation;

/// Every function but add_forces may be left out.
struct PartKind {
  int rank;  ///< in the order of evaluation
  void (*add_forces)(Parts& parts, const Evaluation& now) = nullptr;
  /// Lists its elements with their present stiffness; what is still to be derived counts as 0.
  void (*list_elements)(const Parts& parts, std::vector<Element>& list) = nullptr;
  std::string (*name_of)(const Parts& parts, std::size_t index) = nullptr;  ///< in reports
  /// Fills in the stiffness and damping that users left open, in the present pose; what they gave stays.
  void (*derive)(Parts& parts, const Derivation& derivation) = nullptr;
  /// Lowers what was derived to what would be derived in the present pose; returns how many times too stiff the worst
  /// one was, at least 1, or 0 if no pose can change what was derived.
  double (*soften)(Parts& parts, const Derivation& derivation) = nullptr;
  /// What has no stiffness yet: its name, or an empty text.
  std::string (*first_underived)(const Parts& parts) = nullptr;
  /// Whether stiffness that its users gave can become too much in another pose.
  bool (*may_grow)(const Parts& parts) = nullptr;
  /// The function of a user that gave no number in the newest step, in words; empty if all did.
  std::string (*not_a_number)(const Parts& parts) = nullptr;
};

/// Lets the solver call a kind of part; to be called with each part that is added.
void use(Parts& parts, const PartKind& kind);

/// Every element with its present stiffness.
std::vector<Element> elements_of(const Parts& parts);

/// Lists an element between a joint's two bodies, of stiffness k (N/m) and damping c (N s/m).
void add_element(std::vector<Element>& list, const PartKind& kind, std::size_t index, std::uint32_t a, std::uint32_t b,
                 const std::pair<double, double>& w, double k, double c);
void add_element(std::vector<Element>& list, const PartKind& kind, std::size_t index, const Joint& j,
                 const std::pair<double, double>& w, double k, double c);

/// A joint as reports call it.
std::string joint_in_words(const Parts& parts, std::size_t joint);

/// Number of elements on each body: the shares into which its mass is cut. Counts parts, whatever their stiffness is.
std::vector<double> shares_of(const Parts& parts, const std::vector<Element>& elements);

/// Stiffness and damping that are derived for a time step.
struct Derivation {
  double dt = 0.0;             ///< s
  std::vector<double> shares;  ///< on each body

  Derivation() = default;
  Derivation(const Parts& parts, double time_step)
      : dt(require_positive(time_step, "time step", "s")), shares(shares_of(parts, elements_of(parts))) {}

  /// Stiffness for a frequency of `factor`/dt, where 1 N moves the shares by `w` m/s^2; nothing moves: nothing to hold.
  double stiffness(double factor, double w) const { return w > 0.0 ? factor * factor / (dt * dt * w) : 0.0; }
  static double damping(double k, double w) { return w > 0.0 ? 2.0 * damping_ratio * std::sqrt(k / w) : 0.0; }
  /// The inverse masses of a joint's two bodies, with their shares.
  double shared(const Joint& j, const std::pair<double, double>& inverse_mass) const {
    return shares[j.a] * inverse_mass.first + shares[j.b] * inverse_mass.second;
  }
};

/// Lowers a value to what is allowed, but not for rounding alone. `worst`: how many times too large the worst one was.
void lower_to(double& value, double allowed, double& worst);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void use(Parts& parts, const PartKind& kind) {
  require_no_step(parts);
  auto at = parts.kinds.begin();
  while (at != parts.kinds.end() && (*at)->rank < kind.rank) ++at;
  if (at == parts.kinds.end() || *at != &kind) parts.kinds.insert(at, &kind);
}

DEM_INLINE std::vector<Element> elements_of(const Parts& parts) {
  std::vector<Element> list;
  for (const PartKind* kind : parts.kinds) {
    if (kind->list_elements) kind->list_elements(parts, list);
  }
  return list;
}

DEM_INLINE void add_element(std::vector<Element>& list, const PartKind& kind, std::size_t index, std::uint32_t a,
                            std::uint32_t b, const std::pair<double, double>& w, double k, double c) {
  list.push_back({&kind, index, {{a, k * w.first, c * w.first}, {b, k * w.second, c * w.second}}});
}

DEM_INLINE void add_element(std::vector<Element>& list, const PartKind& kind, std::size_t index, const Joint& j,
                            const std::pair<double, double>& w, double k, double c) {
  add_element(list, kind, index, j.a, j.b, w, k, c);
}

DEM_INLINE std::string joint_in_words(const Parts& parts, std::size_t joint) {
  const JointSpec& s = parts.joint_specs[joint];
  return name_of(s.kind) + (" '" + s.name + "'");
}

DEM_INLINE std::vector<double> shares_of(const Parts& parts, const std::vector<Element>& elements) {
  std::vector<double> n(parts.bodies.size(), 0.0);
  for (const Element& e : elements) {
    for (const Element::Side& s : e.sides) n[s.body] += 1.0;
  }
  return n;
}

DEM_INLINE void lower_to(double& value, double allowed, double& worst) {
  if (!(value > 1.001 * allowed)) return;
  worst = std::max(worst, value / allowed);
  value = allowed;
}

}  // namespace dem::mbd::detail

#endif
