#pragma once

// The velocities that a machine starts with. A body that was given a speed, on bodies that were given none, cannot move
// on as it is: its joints would pull the others along, and their dampers take what does not fit.

#include <dem/core/macros.hpp>
#include <dem/mbd/sensor/energy.hpp>
#include <dem/mbd/solver/held_rows.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace dem::mbd {

/// What becomes of velocities that joints, couplings and prescribed motions do not allow.
enum class GivenVelocities {
  project,  ///< they are changed with the least kinetic energy of the change: what a sudden stop in the joints leaves
  lead,     ///< bodies that move keep their velocities as far as they can, bodies at rest follow them
  refuse,   ///< an Error says what would have to change
  keep      ///< they stay as given, and the joints' dampers take the difference
};

/// What was changed of the velocities that were given.
struct AssemblyReport {
  double kinetic_before = 0.0, kinetic_after = 0.0;  ///< J, of all bodies
  double kinetic_of_change = 0.0;                    ///< J, what the changes would be worth alone
  std::string body;                                  ///< the one that gained or lost the most energy by its change
  double change = 0.0;                               ///< m/s, by which the velocity of its centre of mass changed
  double turn = 0.0;                                 ///< rad/s, by which its angular velocity changed

  /// What is within rounding of numbers with five digits counts as given: it stays as it is.
  bool has_changed() const { return kinetic_of_change > 1e-10 * std::max(kinetic_before, kinetic_after); }
  std::string text() const;
};

/// Changes the bodies' velocities to what joints with derived stiffness, couplings and prescribed motions allow. Those
/// of given stiffness may move, and are left alone. Joints whose directions differ by less than the root of `tolerance`
/// (rad) hold one direction. Throws Error if they are to be refused.
DEM_LAZY AssemblyReport joined_velocities(Parts& m, GivenVelocities how = GivenVelocities::project,
                                          double tolerance = 1e-13);

/// Moves the bodies so that joints and couplings with derived stiffness are off by `part` of what they are, with the
/// least change of positions as masses weigh them, and takes the speeds at which they open or close. Brakes and
/// clutches go on with the torque that they have.
DEM_LAZY void close_openings(Parts& m, double part);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE std::string AssemblyReport::text() const {
  return dem::text(
      "The given velocities did not fit the joints: body '{}' was changed by {:.3g} m/s and {:.3g} rad/s, the "
      "kinetic energy from {:.4g} to {:.4g} J.",
      body, change, turn, kinetic_before, kinetic_after);
}

DEM_LAZY_INLINE AssemblyReport joined_velocities(Parts& m, GivenVelocities how, double tolerance) {
  using namespace detail;
  AssemblyReport report;
  const std::vector<HeldRow> rows = held_rows(m);
  if (rows.empty()) return report;
  std::vector<integrator::Motion<double>> given;
  for (const Body& b : m.bodies) given.push_back(b.motion);
  const auto total = [&] {
    double sum = 0.0;
    for (const Body& b : m.bodies) sum += b.fixed ? 0.0 : kinetic_energy(b);
    return sum;
  };
  report.kinetic_before = total();
  const bool leads = how == GivenVelocities::lead;
  const auto response = [&](std::size_t i, const Wrench& impulse) {
    constexpr double reluctance = 1e-8;
    const Vector3<double>&v = given[i].velocity, &w = given[i].angular_velocity;
    const bool moves = dot(v, v) + dot(w, w) > 0.0;
    return (leads && moves ? reluctance : 1.0) * response_of(m.bodies[i], impulse);
  };
  std::vector<double> rates(rows.size());
  for (int pass = 0; pass < 3; ++pass) {  // the first does it, the others take what rounding left
    for (std::size_t k = 0; k < rows.size(); ++k) rates[k] = rows[k].rate - speed_of(m, rows[k]);
    solve_held(m, rows, rates, response, tolerance);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      for (const HeldRow::Side& s : rows[k].sides) {
        if (!gives_way(m, s.body)) continue;
        const Wrench by = rates[k] * response(s.body, s.push);
        integrator::Motion<double>& x = m.bodies[s.body].motion;
        x.velocity += by.force;
        x.angular_velocity += transpose_times(x.rotation, by.torque);
      }
    }
  }
  report.kinetic_after = total();
  double most = 0.0;
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    if (m.bodies[i].fixed) continue;
    Body by = m.bodies[i];
    by.motion.velocity = by.motion.velocity - given[i].velocity;
    by.motion.angular_velocity = by.motion.angular_velocity - given[i].angular_velocity;
    const double energy = kinetic_energy(by);
    report.kinetic_of_change += energy;
    if (!(energy > most)) continue;
    most = energy;
    report.body = by.name;
    report.change = norm(by.motion.velocity);
    report.turn = norm(by.motion.angular_velocity);
  }
  const bool refused = how == GivenVelocities::refuse && report.has_changed();
  if (!report.has_changed() || refused) {
    for (std::size_t i = 0; i < given.size(); ++i) m.bodies[i].motion = given[i];
  }
  if (refused) {
    fail(
        "the given velocities do not fit the joints: body '{}' would have to change by {:.3g} m/s and {:.3g} rad/s, "
        "the kinetic energy from {:.4g} to {:.4g} J; give every body the velocity that its joints leave it, or let "
        "given_velocities be project or lead",
        report.body, report.change, report.turn, report.kinetic_before, report.kinetic_after);
  }
  return report;
}

DEM_LAZY_INLINE void close_openings(Parts& m, double part) {
  using namespace detail;
  // Joints stand open, so two that hold a shaft differ in direction by some 1e-4 rad, or ten times that where a load
  // came at once. Taken for two directions they would hold its turn: within 3e-3 rad they are one.
  constexpr double as_open = 1e-5;
  const std::vector<HeldRow> rows = held_rows(m);
  std::vector<double> errors;
  for (const HeldRow& row : rows) errors.push_back((part - 1.0) * row.error);
  const auto response = [&](std::size_t i, const Wrench& impulse) { return response_of(m.bodies[i], impulse); };
  solve_held(m, rows, errors, response, as_open);
  std::vector<Wrench> by(m.bodies.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const HeldRow::Side& s : rows[k].sides) {
      if (gives_way(m, s.body)) by[s.body] = by[s.body] + errors[k] * response(s.body, s.push);
    }
  }
  const auto slips = [&m] {
    std::vector<double> all;
    for (const Clutch& u : m.clutches) all.push_back(slip_of(u, m.joints, m.bodies).value);
    return all;
  };
  const std::vector<double> before = slips();
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    integrator::Motion<double>& x = m.bodies[i].motion;
    x.position += by[i].force;
    x.rotation = rotation_from_vector(by[i].torque) * x.rotation;
  }
  const std::vector<double> after = slips();
  for (std::size_t i = 0; i < m.clutches.size(); ++i) m.clutches[i].history.anchor += after[i] - before[i];
  joined_velocities(m, GivenVelocities::project, as_open);
}

}  // namespace dem::mbd

#endif
