#pragma once

#include <dem/math/vector.hpp>

#include <cstdint>
#include <vector>

namespace dem::grain {

/// A contact of the last force evaluation, as the work that it does is counted from it. All in global axes.
struct ContactWork {
  std::uint32_t i;        ///< id of the grain
  std::uint32_t partner;  ///< id of the other grain, or number of the surface
  bool on_surface;
  Vector3<double> normal;     ///< from i into the partner
  Vector3<double> arm;        ///< m, from the centre of i to the contact point
  Vector3<double> other_arm;  ///< m, from the centre of mass of the partner
  Vector3<double> force;      ///< N, on i
  Vector3<double> moment;     ///< N m, on i: rolling resistance and torsion; the partner feels the opposite
  template <class V>
  void fields(V& v) {
    v("i", i), v("partner", partner), v("on_surface", on_surface), v("normal", normal), v("arm", arm, "m");
    v("other_arm", other_arm, "m"), v("force", force, "N"), v("moment", moment, "N m");
  }
};

/// Work (J) that went into contacts, by what took it.
struct WorkIntoContacts {
  double normal = 0.0;    ///< along the normal: repulsion and cohesion
  double friction = 0.0;  ///< in the tangent plane
  double rolling = 0.0;   ///< rolling resistance and torsion
  template <class V>
  void fields(V& v) {
    v("normal", normal, "J"), v("friction", friction, "J"), v("rolling", rolling, "J");
  }
};

/// Counts the work of contacts while a world runs, if it was asked to (dem::count_energy).
struct EnergyLedger {
  bool on = false;
  WorkIntoContacts into_contacts;  ///< since it was switched on
  WorkIntoContacts stored;         ///< J, in springs when it was switched on
  double by_surfaces = 0.0;        ///< J, work of machine parts on contacts of grains
  double came = 0.0;               ///< J, of grains that were added, less that of those that went
  double stopped = 0.0;            ///< J, motion of grains that fell asleep

  std::vector<ContactWork> last;                                   ///< the contacts of the step before
  std::vector<Vector3<double>> velocity, global_angular_velocity;  ///< m/s, rad/s, at the end of the step before, by id
  std::vector<double> energy;  ///< J, kinetic and potential, by id; NaN of grains that are not there
  std::vector<Vector3<double>> body_velocity, body_angular_velocity;  ///< the same of bodies, in global axes

  /// Whether the energy of a grain (id) is counted already: not of one that came since the last step.
  bool knows(std::uint32_t id) const { return id < energy.size() && energy[id] == energy[id]; }
  /// A grain (id) falls asleep, and loses its energy of motion (J).
  void stop(std::uint32_t id, double motion) {
    velocity[id] = global_angular_velocity[id] = {0, 0, 0};
    energy[id] -= motion;
  }

  template <class V>
  void fields(V& v) {
    v.given("energy_counted", on);
    v("into_contacts", into_contacts), v("stored_at_start", stored), v("by_surfaces", by_surfaces, "J");
    v("came", came, "J"), v("stopped", stopped, "J"), v("last", last), v("velocity", velocity, "m/s"),
        v("spin", global_angular_velocity, "rad/s");
    v("grains", energy, "J"), v("body_velocity", body_velocity, "m/s"), v("body_spin", body_angular_velocity, "rad/s");
  }
};

}  // namespace dem::grain
