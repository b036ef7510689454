#pragma once

#include <dem/terramechanics/pressure.hpp>
#include <dem/terramechanics/shear.hpp>

#include <numbers>

namespace dem::terramechanics {

/// What the semi-empirical laws know of a soil.
struct Soil {
  PressureLaw pressure = {};
  JanosiHanamoto shear = {};

  // The pressure under a wheel is largest at theta_m = (a0 + a1 s) theta_f (thesis eq. 7), s by the wheel's speed. Wong
  // and Reece (J. Terramechanics 4, 1967, 81-98) have 0.43 and 0.32 for dense, 0.18 and 0.32 for loose sand.
  double a0 = 0.43;
  double a1 = 0.32;
  /// Where a wheel leaves the soil: theta_r, rad, negative behind the lowest point. Not beyond -theta_f.
  double exit_angle = 0.0;
  /// If above 0 it stands for exit_angle: the share of the sinkage by which the soil follows the wheel up behind it,
  /// theta_r = -acos(1 - share z/r). From 0 to 1.
  double exit_share = 0.0;

  // Unloading and loading again go along a line of the slope k0 + A z, with the greatest sinkage z (Wong, Theory of
  // Ground Vehicles, section 2.4).
  //
  // Only soil columns unload. Where k0 is not known they spring back by at most a tenth of their sinkage
  // (ColumnLaw::unknown_ratio), which pushes a wheel from behind. The equations of a wheel know it by exit_share: a
  // small wheel on P1 (0.05 m x 0.03 m, 10 N, slip 0.3) pulls 5.56 N on columns, and by the equations with a0 = a1 = 0
  // 5.59 N with exit_share = 0.1, but 4.85 N with 0.
  double unloading_stiffness = 0.0;  ///< k0, Pa/m; 0: not known
  double unloading_growth =
      0.0;  ///< A, Pa/m^2; alone it counts where it is steeper than what stands for k0 (ColumnLaw)
};

/// Throws Error, in words, for constants that no soil has.
inline void check_soil(const Soil& soil) {
  check_pressure(soil.pressure);
  check_shear(soil.shear);
  if (const auto* reece = std::get_if<Reece>(&soil.pressure); reece && reece->cohesion != soil.shear.cohesion) {
    fail("cohesion is {:g} Pa in Reece's pressure and {:g} Pa in the shear strength; a soil has one", reece->cohesion,
         soil.shear.cohesion);
  }
  require_within(soil.a0, 0.0, 1.0, "a0 of the soil");
  require_within(soil.a1, 0.0, 1.0, "a1 of the soil");
  if (!(soil.a0 + soil.a1 < 1.0)) {
    fail(
        "a0 + a1 of the soil is {:g}, but must be below 1: at full slip the pressure would be largest where the wheel "
        "enters the soil, and zero there",
        soil.a0 + soil.a1);
  }
  require_within(soil.exit_angle, -0.5 * std::numbers::pi, 0.0,
                 "exit angle of the soil in rad (behind the lowest point)");
  require_within(soil.exit_share, 0.0, 1.0, "exit share of the soil");
  require_non_negative(soil.unloading_stiffness, "unloading stiffness of the soil", "Pa/m");
  require_non_negative(soil.unloading_growth, "growth of the soil's unloading stiffness", "Pa/m^2");
}

/// P1, a sand: the constants of D. Melanz's wheel-soil programs, for a wheel of 0.13 m x 0.16 m. The plate was 30 mm
/// wide.
inline constexpr Soil melanz_sand = {
    .pressure = WongReece{.k = 2.54e5, .n = 1.387, .plate_width = 0.03},
    .shear = {.cohesion = 139.28, .friction_angle = radians(34.74), .displacement = 0.515e-3},
    .a0 = 0.43,
    .a1 = 0.32,
};

/// P3, Mojave Martian Simulant (Agarwal, Senatore et al., arXiv:1901.10667). The source has no a0 and a1: those of
/// dense sand stand for them.
inline constexpr Soil mojave_martian_simulant = {
    .pressure = Bekker{.k_c = 846e3, .k_phi = 6708e3, .n = 1.4},
    .shear = {.cohesion = 600.0, .friction_angle = radians(35.0), .displacement = 0.6e-3},
};

}  // namespace dem::terramechanics
