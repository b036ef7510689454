#pragma once

#include <dem/core/error.hpp>
#include <dem/soil/fall_speed.hpp>
#include <dem/soil/relative_density.hpp>

#include <cstdint>
#include <string>

namespace dem::soil {

/// Settings of a bed.
struct BedOptions {
  double height = 0.0;             ///< m, of the levelled surface
  double relative_density = 0.0;   ///< 0: as it settles; above 0, `limits` are needed
  DensityLimits limits = {0, 0};   ///< of this soil
  double density_tolerance = 0.1;  ///< by which the relative density may differ from that, before something is said
  double expected_fraction = 0.6;  ///< solid fraction as it settles, by which grains are counted
  double room = 0.05;              ///< between grains as they are placed, in largest diameters
  double rain_flow = 0.0;          ///< kg/s, of grains that rain; 0: they are placed in a lattice, and fall together
  double fall_speed = 0.0;         ///< m/s, at which those of a lattice fall at most (limit_fall); 0: freely
  double rain_height = 0.05;       ///< m, of the inlet that it rains from, over the grains when it is full
  double densify_time = 0.5;       ///< s, in which friction goes to zero
  double shaking = 0.5;            ///< to and fro along x, while friction sinks, in weights
  double frequency = 25.0;         ///< Hz, of the shaking
  double lid_pressure = 0.0;       ///< Pa, by which a lid presses the grains flat before they are struck off; 0: none
  double lid_speed = 0.05;         ///< m/s, at which it comes down
  double time_limit = 5.0;         ///< s, in which grains must come to rest after their fall, and the lid on them
  std::uint64_t seed = 1;
  std::string wall_material = "wall";

  bool is_rained() const { return rain_flow > 0.0; }
  /// Throws Error for what makes no sense.
  void check() const {
    require_positive(height, "height of a bed", "m");
    require_within(relative_density, 0.0, 1.0, "relative density of a bed");
    require_within(density_tolerance, 0.0, 10.0, "tolerance of the relative density of a bed");
    require_within(expected_fraction, 0.01, 1.0, "solid fraction that a bed is expected to have");
    require_within(room, 0.0, 10.0, "room between grains as they are placed");
    require_non_negative(rain_flow, "flow of the rain on a bed", "kg/s");
    require_fall_speed(fall_speed, "the speed at which the grains of a bed fall at most");
    if (fall_speed > 0.0 && is_rained()) {
      fail(
          "a bed is to be rained, and its grains to fall at {:g} m/s at most, which is for grains that are placed in a "
          "lattice; leave out BedOptions::fall_speed, or BedOptions::rain_flow",
          fall_speed);
    }
    require_positive(rain_height, "height from which it rains on a bed", "m");
    require_positive(densify_time, "time in which a bed is made denser", "s");
    require_non_negative(shaking, "strength of shaking", "weights");
    require_positive(frequency, "frequency of shaking", "Hz");
    require_non_negative(lid_pressure, "pressure of the lid of a bed", "Pa");
    require_positive(lid_speed, "speed of the lid of a bed", "m/s");
    require_positive(time_limit, "time in which a bed must come to rest", "s");
    if (relative_density > 0.0 && !(limits.densest > limits.loosest && limits.loosest > 0.0)) {
      fail(
          "a bed is to have the relative density {:g}, but the solid fractions of its soil are given as {:g} at the "
          "loosest and {:g} at the densest; set BedOptions::limits",
          relative_density, limits.loosest, limits.densest);
    }
  }
  /// The solid fraction that the bed is to have.
  double wanted() const {
    return relative_density > 0.0 ? solid_fraction_at(relative_density, limits) : expected_fraction;
  }

  /// Compared where a bed goes on.
  template <class V>
  void fields(V& v) {
    v.given("height", height, "m"), v.given("relative_density", relative_density);
    v.given("loosest", limits.loosest), v.given("densest", limits.densest);
    v.given("expected_fraction", expected_fraction), v.given("room", room);
    v.given("rain_flow", rain_flow, "kg/s"), v.given("fall_speed", fall_speed, "m/s");
    v.given("rain_height", rain_height, "m");
    v.given("densify_time", densify_time, "s"), v.given("shaking", shaking), v.given("frequency", frequency, "Hz");
    v.given("lid_pressure", lid_pressure, "Pa"), v.given("lid_speed", lid_speed, "m/s");
    v.given("time_limit", time_limit, "s"), v.given("seed", seed);
  }
};

}  // namespace dem::soil
