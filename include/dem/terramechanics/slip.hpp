#pragma once

#include <dem/core/error.hpp>

namespace dem::terramechanics {

/// How slip is counted, with omega the wheel's spin (rad/s), r its radius (m) and v its speed of travel (m/s).
enum class SlipDefinition {
  wheel_speed,   ///< s = 1 - v/(omega r): thesis table 5.3, and what eq. 11 takes. 1: spins on the spot
  travel_speed,  ///< s = omega r/v - 1: thesis eqs. 1 and 42. -1: locked
  larger_speed   ///< the first one where s >= 0, the second where s < 0: from -1 (locked) to 1 (spins on the spot)
};

/// A slip with its definition. All three are 0 for a wheel that rolls, positive for one that drives and negative for
/// one that brakes.
struct Slip {
  double value = 0.0;
  SlipDefinition definition = SlipDefinition::wheel_speed;

  /// v/(omega r), not negative. Not checked; see check_slip.
  double speed_ratio() const {
    const bool by_wheel =
        definition == SlipDefinition::wheel_speed || (definition == SlipDefinition::larger_speed && value >= 0.0);
    return by_wheel ? 1.0 - value : 1.0 / (1.0 + value);
  }
  /// The same motion's slip by another definition.
  Slip as(SlipDefinition other) const {
    const double ratio = speed_ratio();
    const bool by_wheel =
        other == SlipDefinition::wheel_speed || (other == SlipDefinition::larger_speed && ratio <= 1.0);
    return {definition == other ? value : by_wheel ? 1.0 - ratio : 1.0 / ratio - 1.0, other};
  }
};

/// The slip of a wheel of radius r (m) that turns with omega (rad/s) and travels with v (m/s). Throws Error unless both
/// speeds are positive, or one of them zero.
inline Slip slip_of(double omega, double radius, double speed, SlipDefinition definition) {
  require_positive(radius, "wheel radius", "m");
  require_non_negative(omega, "spin of the wheel", "rad/s; turn x about for a wheel that runs backwards");
  require_non_negative(speed, "speed of the wheel", "m/s; turn x about for a wheel that runs backwards");
  const double rim = omega * radius;
  if (!(rim + speed > 0.0)) fail("the wheel neither turns nor travels, so it has no slip; give it a spin or a speed");
  switch (definition) {
    case SlipDefinition::wheel_speed: return {1.0 - speed / rim, definition};
    case SlipDefinition::travel_speed: return {rim / speed - 1.0, definition};
    default: return {rim >= speed ? 1.0 - speed / rim : rim / speed - 1.0, definition};
  }
}

/// Throws Error for a slip that its definition does not know, and for a locked wheel, whose eq. 11 has no end.
inline void check_slip(const Slip& slip) {
  const bool by_wheel = slip.definition == SlipDefinition::wheel_speed;
  const bool by_travel = slip.definition == SlipDefinition::travel_speed;
  const bool fits = slip.value > (by_wheel ? -1e6 : -1.0 + 1e-6) && slip.value <= (by_travel ? 1e6 : 1.0);
  if (fits) return;
  fail("slip is {:g}, but {} lies {}; a locked wheel is braked by friction on the whole contact, use a slip near it",
       slip.value,
       by_wheel    ? "1 - v/(omega r)"
       : by_travel ? "omega r/v - 1"
                   : "slip by the larger speed",
       by_wheel    ? "between -1e6 (nearly locked) and 1"
       : by_travel ? "above -1 (locked) and below 1e6 (nearly on the spot)"
                   : "above -1 (locked) and up to 1");
}

}  // namespace dem::terramechanics
