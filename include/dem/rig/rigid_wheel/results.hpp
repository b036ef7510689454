#pragma once

#include <dem/report/replay_recorder.hpp>
#include <dem/rig/bed/surface_profile.hpp>
#include <dem/rig/number.hpp>
#include <dem/rig/rigid_wheel/contact_print.hpp>
#include <dem/rig/rigid_wheel/settings.hpp>
#include <dem/rig/samples.hpp>
#include <dem/rig/steady_window.hpp>
#include <dem/soil/packing.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace dem::rig::rigid_wheel {

/// One row of a run: forces are means over the interval before it.
struct Sample {
  double time;          ///< s, since the wheel started
  double slip;          ///< 1 - v/(omega r), of the speeds as they were
  double travel;        ///< m, of the carriage
  double pull;          ///< N, drawbar pull: forward force of the grains on the wheel
  double torque;        ///< N m, that drives the wheel: minus that of the grains on it
  double sinkage;       ///< m, of the wheel's lowest point (without grousers) below the mean surface of the bed
  double carried;       ///< N, upward force of the grains on the wheel
  double drive_force;   ///< N, of the carriage's actuator, backwards: what pulls
  double motor_torque;  ///< N m, of the wheel's actuator
};

/// The slip's definition stands in its name: s = 1 - v/(omega r).
inline constexpr Column<Sample> sample_columns[] = {{"time_s", &Sample::time},
                                                    {"slip_1-v/(omega*r)", &Sample::slip},
                                                    {"travel_m", &Sample::travel},
                                                    {"drawbar_pull_N", &Sample::pull},
                                                    {"torque_Nm", &Sample::torque},
                                                    {"sinkage_m", &Sample::sinkage},
                                                    {"carried_N", &Sample::carried},
                                                    {"drive_force_N", &Sample::drive_force},
                                                    {"motor_torque_Nm", &Sample::motor_torque}};

/// Where a run at one slip started.
struct Rolling {
  double start = 0.0;             ///< s
  double rail = 0.0, axle = 0.0;  ///< m, rad
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("rail", rail, "m"), v("axle", axle, "rad");
  }
};

/// The run at one slip.
struct SlipResult {
  double slip = 0.0;  ///< 1 - v/(omega r), as asked for
  bool finished = false;
  std::vector<Sample> samples = {};
  std::vector<double> rut_y = {}, rut_z = {};  ///< m: height of the surface behind the wheel, across; empty: no rut yet
  ContactPrint print = {};                     ///< under the wheel, over the second half of the run

  // Of the samples, by evaluate()
  double window_from = not_known;  ///< s, where the steady window begins
  bool is_steady = false;
  MeanAndDeviation pull = {}, torque = {}, sinkage = {}, carried = {};
  double pull_error = not_known;     ///< N, standard error of its mean in time
  MeanAndDeviation efficiency = {};  ///< pull v/(torque omega), thesis eq. 44; known where the wheel drives and pulls
  Rut rut = {};                      ///< against the level of the bed

  /// What a run that goes on takes over.
  template <class V>
  void fields(V& v) {
    v("finished", finished), v.numbers("samples", samples), v("rut_y", rut_y), v("rut_z", rut_z);
    v("print", print);
  }
};

/// The run that is shown: that of the greatest slip up to 0.3, or else the first.
inline std::size_t shown_slip(const std::vector<double>& slips) {
  std::size_t shown = 0;
  for (std::size_t k = 0; k < slips.size(); ++k) shown = slips[k] <= 0.301 ? k : shown;
  return shown;
}

/// All slips on a bed.
struct VariantResult {
  Variant variant = {};
  double level = not_known;  ///< m, mean height of the surface
  double solid_fraction = not_known;
  std::size_t grains = 0;
  double time_step = not_known;         ///< s
  double set_down_sinkage = not_known;  ///< m, of the wheel at rest
  std::vector<SlipResult> slips = {};
};

/// Everything that a run finds: what is its own, and what its study is.
struct Campaign : VariantResult {
  std::vector<VariantResult> study = {};
  std::optional<report::Replay> replay = {};
};

/// Means over the steady window: the values after the time from which both pull and sinkage are steady by MSER-5.
inline void evaluate(SlipResult& r, double level, const Settings& s) {
  const auto all = [&](double Sample::*value) {
    std::vector<double> v;
    for (const Sample& x : r.samples) v.push_back(x.*value);
    return v;
  };
  const auto pull = all(&Sample::pull), sinkage = all(&Sample::sinkage);
  const SteadyWindow a = steady_window(pull), b = steady_window(sinkage);
  const std::size_t first = std::max(a.first, b.first);
  if (first >= r.samples.size()) return;
  r.is_steady = a.is_steady && b.is_steady;
  r.window_from = r.samples[first].time;
  const auto mean = [&](double Sample::*value) {
    const auto values = all(value);
    return mean_of(std::span(values).subspan(first));
  };
  r.pull = mean(&Sample::pull);
  r.pull_error = error_of_mean(std::span(pull).subspan(first));
  r.torque = mean(&Sample::torque);
  r.sinkage = mean(&Sample::sinkage);
  r.carried = mean(&Sample::carried);
  if (r.pull.mean > 0.0 && r.torque.mean > 0.0) {
    // Of the mean pull and the mean torque; its deviation is what both swing by together.
    const double arm = (1.0 - r.slip) * s.radius / r.torque.mean, share = r.pull.mean / r.torque.mean;
    std::vector<double> swing;
    for (std::size_t k = first; k < r.samples.size(); ++k) {
      swing.push_back(arm * (r.samples[k].pull - share * r.samples[k].torque));
    }
    r.efficiency = {arm * r.pull.mean, mean_of(swing).deviation};
  }
  r.rut = rut_between({r.rut_y, std::vector<double>(r.rut_y.size(), level)}, {r.rut_y, r.rut_z}, 0.0, s.width);
}

/// The surface across the bed between two places along x (m). Sets y and z.
inline void find_rut(std::span<const soil::Placement> grains, const Settings& s, double from, double to,
                     SlipResult& r) {
  const double half = 0.5 * s.bed.width;
  SurfaceProfile p = surface_profile(grains, s.grains.half_edge, from, to, -half, half);
  r.rut_y = std::move(p.y);
  r.rut_z = std::move(p.z);
}

}  // namespace dem::rig::rigid_wheel
