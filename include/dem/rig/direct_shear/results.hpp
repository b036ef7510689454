#pragma once

#include <dem/report/replay_recorder.hpp>
#include <dem/rig/number.hpp>
#include <dem/rig/samples.hpp>
#include <dem/soil/packing.hpp>
#include <dem/soil/rest.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace dem::rig::direct_shear {

/// One row of a shearing stage: means over about 0.01 mm of travel.
struct Sample {
  double time;          ///< s, since the rig was built
  double displacement;  ///< m, of the top box against the bottom box
  double stress;        ///< Pa, x-force of the grains on the bottom box over the area
  double drive_stress;  ///< Pa, force of the shearing actuator over the area: the cross-check
  double lid_rise;      ///< m, since shearing began: dilation
  double lid_stress;    ///< Pa, force of the grains on the lid over the area
  double plane_stress;  ///< Pa, what the bottom box carries, less the grains in it, over the area
};

/// The columns of the file of a load.
inline constexpr Column<Sample> sample_columns[] = {{"time_s", &Sample::time},
                                                    {"displacement_m", &Sample::displacement},
                                                    {"shear_stress_Pa", &Sample::stress},
                                                    {"drive_stress_Pa", &Sample::drive_stress},
                                                    {"lid_rise_m", &Sample::lid_rise},
                                                    {"lid_stress_Pa", &Sample::lid_stress},
                                                    {"plane_normal_stress_Pa", &Sample::plane_stress}};

/// What a stage of a packing or a test has come to.
struct StageOfTest {
  double start = 0.0;  ///< s
  soil::StaysBelow slow = {0.0, 0.0}, loaded = {0.0, 0.0};
  bool done = false;
  double lid = 0.0, below = 0.0;  ///< m, of the lid at the start; N, weight of the grains below the plane of shear
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("slow", slow), v("loaded", loaded), v("done", done), v("lid", lid, "m");
    v("below", below, "N");
  }
};

/// The test at one load.
struct LoadResult {
  double load = 0.0;                      ///< kg
  double normal_stress = 0.0;             ///< Pa, m g/A before shearing
  double solid_fraction = not_known;      ///< before shearing, inside of the specimen
  double height = not_known;              ///< m, of the lid before shearing
  double consolidation_time = not_known;  ///< s, simulated
  double inertial_number = not_known;
  double time_step = 0.0;            ///< s
  std::string time_step_limit = {};  ///< what limits the stable one
  bool finished = false;             ///< the whole travel was done
  std::vector<Sample> samples = {};

  // Of the samples, by evaluate()
  double maximum = not_known;         ///< Pa, of the smoothed shear stress
  double at_maximum = not_known;      ///< m of travel
  double residual = not_known;        ///< Pa
  double dilation = not_known;        ///< m, lid rise at the end
  double drive_mismatch = not_known;  ///< largest |drive - sensor| of the smoothed stresses, over the maximum
  double plane_stress = not_known;    ///< Pa, at the maximum
  double lid_share = not_known;       ///< force of the grains on the lid over its weight, mean while shearing
  /// Pa, m g over the areas that `maximum` and `residual` are over: normal_stress, unless areas are corrected.
  double normal_at_maximum = not_known, normal_at_residual = not_known;

  /// What a run that goes on takes over.
  template <class V>
  void fields(V& v) {
    v("solid_fraction", solid_fraction), v("height", height, "m"), v("consolidation_time", consolidation_time, "s");
    v("time_step", time_step, "s"), v("time_step_limit", time_step_limit), v("finished", finished);
    v.numbers("samples", samples);
  }
};

/// The specimen before any load.
struct PackingResult {
  soil::Packing packing = {};
  double solid_fraction = not_known;  ///< inside of the packing, away from walls
  double height = not_known;          ///< m, where 95 % of the grains' centres are below, plus half an edge
  double asked_density = not_known;   ///< relative, that it was densified towards
  double coordination = not_known;    ///< grains that touch a grain, mean

  /// Of a packing that is made: what follows is measured.
  template <class V>
  void fields(V& v) {
    v("packing", packing), v("asked_density", asked_density), v("coordination", coordination);
  }
};

/// All that was found, also when the run ended early.
struct Campaign {
  PackingResult packing = {};
  std::vector<LoadResult> loads = {};
  std::optional<report::Replay> replay = {};  ///< of the load in the middle
};

/// Table 3.3 of the thesis: normal and maximum shear stress (Pa), and the angle (deg); and the experiment's range.
struct Reference {
  double normal_stress, maximum;
};
inline constexpr Reference thesis[] = {{16895.0, 13483.0278}, {44145.0, 33794.4444}, {71395.0, 56128.8889}};
inline constexpr double thesis_angle_deg = 38.043, experiment_low_deg = 34.2, experiment_high_deg = 43.5;

/// The thesis's maximum shear stress (Pa) at a normal stress that it has (within 0.5 %), else NaN.
inline double thesis_maximum(double normal_stress) {
  for (const Reference& r : thesis) {
    if (std::abs(normal_stress / r.normal_stress - 1.0) < 0.005) return r.maximum;
  }
  return not_known;
}

}  // namespace dem::rig::direct_shear
