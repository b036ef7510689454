#pragma once

#include <dem/terramechanics/wheel_forces.hpp>

#include <span>
#include <vector>

namespace dem::terramechanics {

/// The wheel at the sinkage at which the soil carries a load (N), to 1e-10 of the load; the least where there are
/// several. Slip by any SlipDefinition and of any sign. Throws Error as wheel_forces does, and for a load that the soil
/// does not carry at any sinkage up to the radius.
inline WheelForces wheel_under_load(const Wheel& wheel, const Soil& soil, const Slip& slip, double load,
                                    const WheelModel& model = {}) {
  require_positive(load, "load on the wheel", "N");
  const auto lacking = [&](double z) { return wheel_forces(wheel, soil, slip, z, model).load - load; };
  // Where shear stresses push the front of a braked wheel down, what is carried does not grow for ever. The steps are
  // finer near the surface, as the sinkage of a light load is small.
  constexpr int steps = 60;
  double below = 0.0, most = 0.0, most_at = 0.0;
  for (int k = 1; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    const double z = k < steps ? wheel.radius * share * share * share : wheel.radius * (1.0 - 1e-9);
    const double rest = lacking(z);
    if (rest >= 0.0) {
      while (below == 0.0 || lacking(below) >= 0.0) {  // a load below that of the first step
        below = 0.1 * (below == 0.0 ? z : below);
        if (below < 1e-30 * wheel.radius) fail("load {:g} N on the wheel is too small to sink by anything", load);
      }
      return wheel_forces(wheel, soil, slip, find_root(lacking, below, z), model);
    }
    if (rest + load > most) {
      most = rest + load;
      most_at = z;
    }
    below = z;
  }
  fail(
      "the soil cannot carry {:g} N under this wheel at slip {:g}: at most {:.4g} N, at a sinkage of {:.4g} m; lower "
      "the load, or take a larger or wider wheel",
      load, slip.value, most, most_at);
}

/// The same over a list of slips, which may be of any sign: pull, torque and sinkage curves.
inline std::vector<WheelForces> slip_sweep(const Wheel& wheel, const Soil& soil, std::span<const double> slips,
                                           SlipDefinition definition, double load, const WheelModel& model = {}) {
  std::vector<WheelForces> curve;
  for (const double s : slips) curve.push_back(wheel_under_load(wheel, soil, {s, definition}, load, model));
  return curve;
}

}  // namespace dem::terramechanics
