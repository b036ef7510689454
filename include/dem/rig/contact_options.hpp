#pragma once
// The constants of the thesis's contacts, which the settings of every rig have under the same names.

#include <dem/core/error.hpp>
#include <dem/rig/options.hpp>

namespace dem::rig {

/// Names the options of what a contact has besides K and C, whose defaults differ from rig to rig.
template <class Settings>
void add_contact_options(Options& options, Settings& s) {
  options.add("--separation-factor", s.separation_factor, "Sp, share of C while separating");
  options.add("--friction", s.friction, "mu, grain on grain");
  options.add("--friction-stiffness", s.friction_stiffness, "kt [N/m]; negative: as K");
  options.add("--velocity-stiffness", s.velocity_stiffness, "cv [N s/m]; negative: as C");
  options.add("--breaking-factor", s.breaking_factor, "friction kept by a broken asperity");
  options.add("--constants-for", s.constants_for, "half-edge that K, kt, C and cv are given for [m]");
  options.add("--scale-contacts", s.scale_contacts, "scale them to other sizes: K, kt ~ size, C, cv ~ size^2");
}

/// Checks the options that all rigs have for contacts of grains with the default laws, under the names that they have
/// in all of them. `stiffness_unit` is told with the stiffness. Beyond the upper ends no run comes to an end. Throws
/// Error.
template <class Settings>
void check_contact_options(const Settings& s, const char* stiffness_unit = "N/m") {
  require_positive(s.stiffness, "--stiffness", stiffness_unit);
  require_within(s.stiffness, 1.0, 1e12, "--stiffness (N/m)");
  require_within(s.damping, 0.0, 1e12, "--damping (N s/m)");
  require_within(s.separation_factor, 0.0, 1.0, "--separation-factor");
  require_non_negative(s.friction, "--friction", "(no unit)");
  require_within(s.friction_stiffness, 0.0, 1e12, "--friction-stiffness (N/m)");
  require_within(s.velocity_stiffness, 0.0, 1e12, "--velocity-stiffness (N s/m)");
  require_within(s.breaking_factor, 0.0, 1.0, "--breaking-factor");
  require_positive(s.constants_for, "--constants-for", "m");
}

/// Checks the size that the constants are for beside that of the grains: in another unit it is far off. Throws Error.
template <class Settings>
void check_constants_for(const Settings& s) {
  if (!s.scale_contacts) return;
  require_within(s.constants_for, 0.01 * s.half_edge, 100.0 * s.half_edge,
                 "--constants-for (m, from a hundredth of --half-edge to a hundred times it)");
}

/// Names the option by which grains may sleep.
inline void add_sleep_option(Options& options, bool& sleep) {
  options.flag("--sleep", sleep, "grains at rest are not worked on until something wakes them: faster, nearly the same")
      .off("--no-sleep");
}

/// Names the option that all replays have.
template <class Settings>
void add_replay_forces(Options& options, Settings& s) {
  options.add("--replay-forces", s.replay_forces, "force chains of a frame of the replay, the largest; 0: none");
}
template <class Settings>
void find_idle_replay(IdleOptions& idle, const Settings& s) {
  idle.unless(s.replay, "with a replay, without --no-replay", {"--replay-forces"});
}

/// Names the options of what a rig with grains leaves in its folder, in a group of their own. `replayed` is what its
/// replay shows: "a plate".
template <class Settings>
void add_output_options(Options& options, Settings& s, const char* replayed) {
  options.group("Output");
  options.add("--output", s.output, "folder; results of an earlier run in it are replaced").changes_no_result();
  options.flag("--replay", s.replay, text("replay of {} in the report (--replay=true) or none (--no-replay)", replayed))
      .off("--no-replay");
  add_replay_forces(options, s);
  options.flag("--vtk", s.vtk, "files for ParaView (--vtk=true) or none (--no-vtk)").off("--no-vtk");
}

}  // namespace dem::rig
