#pragma once

#include <dem/core/error.hpp>

namespace dem::rig {

/// Checks the options that all rigs have for contacts of grains with the default laws, under the names that they have
/// in all of them. `stiffness_unit` is told with the stiffness. Throws Error.
template <class Settings>
void check_contact_options(const Settings& s, const char* stiffness_unit = "N/m") {
  require_positive(s.stiffness, "--stiffness", stiffness_unit);
  require_non_negative(s.damping, "--damping", "N s/m");
  require_within(s.separation_factor, 0.0, 1.0, "--separation-factor");
  require_non_negative(s.friction, "--friction", "(no unit)");
  require_non_negative(s.friction_stiffness, "--friction-stiffness", "N/m");
  require_non_negative(s.velocity_stiffness, "--velocity-stiffness", "N s/m");
  require_within(s.breaking_factor, 0.0, 1.0, "--breaking-factor");
  require_positive(s.constants_for, "--constants-for", "m");
}

}  // namespace dem::rig
