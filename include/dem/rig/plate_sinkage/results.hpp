#pragma once

#include <dem/report/replay_recorder.hpp>
#include <dem/rig/number.hpp>
#include <dem/rig/plate_sinkage/settings.hpp>
#include <dem/rig/samples.hpp>
#include <dem/terramechanics/bevameter_fit.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace dem::rig::plate_sinkage {

/// One row of a plate: forces are means over the interval before it.
struct Sample {
  double time;      ///< s, since the plate started
  double travel;    ///< m, downwards, since the plate started
  double sinkage;   ///< m, from where the smoothed pressure first is the threshold; set by evaluate()
  double pressure;  ///< Pa, upward force of the grains on the plate over its area
  double force;     ///< N, that force
  double drive;     ///< N, of the plate's actuator, downwards: the cross-check
};

inline constexpr Column<Sample> sample_columns[] = {{"time_s", &Sample::time},       {"travel_m", &Sample::travel},
                                                    {"sinkage_m", &Sample::sinkage}, {"pressure_Pa", &Sample::pressure},
                                                    {"force_N", &Sample::force},     {"drive_N", &Sample::drive}};

/// A plate that is drawn up again.
struct Unloading {
  double travel;    ///< m, downwards, since the plate started
  double pressure;  ///< Pa, as of Sample
};

inline constexpr Column<Unloading> unloading_columns[] = {{"travel_m", &Unloading::travel},
                                                          {"pressure_Pa", &Unloading::pressure}};

/// What pressing a plate has come to.
struct Pressing {
  double start = 0.0;                     ///< s
  double zero = not_known, travel = 0.0;  ///< m
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("zero", zero, "m"), v("travel", travel, "m");
  }
};

/// One plate.
struct PlateResult {
  double width = 0.0;  ///< m
  bool finished = false;
  std::vector<Sample> samples = {};
  std::vector<Unloading> unloading = {};  ///< with Settings::unload

  // Of the samples, by evaluate()
  terramechanics::PlateCurve curve = {};                   ///< smoothed, from zero sinkage on
  double unloading_stiffness = not_known;                  ///< Pa/m, with Settings::unload
  std::optional<terramechanics::PlateConstants> fit = {};  ///< none if there are too few points

  /// What a run that goes on takes over.
  template <class V>
  void fields(V& v) {
    v("finished", finished), v.numbers("samples", samples), v.numbers("unloading", unloading);
  }
};

/// All plates on a bed.
struct VariantResult {
  Variant variant;
  double level = not_known;           ///< m, height of the levelled bed
  double solid_fraction = not_known;  ///< of its inside, before the plates
  std::size_t grains = 0;
  double time_step = not_known;  ///< s
  std::vector<PlateResult> plates = {};

  /// N/m^3
  [[nodiscard]] double unit_weight() const { return 9.81 * variant.settings.grains.density * solid_fraction; }
};

/// Everything that a run finds.
struct Campaign {
  std::vector<VariantResult> variants = {};
  std::optional<report::Replay> replay = {};  ///< of the plate in the middle
};

/// The pressure (Pa) at a sinkage (m), between the points of a curve; NaN outside of them.
inline double pressure_at(const terramechanics::PlateCurve& c, double sinkage) {
  for (std::size_t i = 1; i < c.sinkage.size(); ++i) {
    if (c.sinkage[i - 1] <= sinkage && sinkage <= c.sinkage[i] && c.sinkage[i] > c.sinkage[i - 1]) {
      const double share = (sinkage - c.sinkage[i - 1]) / (c.sinkage[i] - c.sinkage[i - 1]);
      return c.pressure[i - 1] + share * (c.pressure[i] - c.pressure[i - 1]);
    }
  }
  return not_known;
}

/// The part of a curve that is fitted: from a share of the sinkage on.
inline terramechanics::PlateCurve fitted_part(const PlateResult& r, const Settings& s) {
  return terramechanics::within(r.curve, s.fit_from * s.sinkage, s.sinkage);
}

/// Slope (Pa/m) of pressure over travel while a plate is drawn up, by least squares, between 90 % and 10 % of the first
/// pressure; NaN where there are fewer than three samples in between, or they show no slope.
inline double unloading_slope(std::span<const Unloading> samples) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Unloading& u : samples) {
    const double share = u.pressure / samples.front().pressure, at = u.travel - samples.front().travel;
    if (!(share <= 0.9 && share >= 0.1)) continue;
    n += 1.0, x += at, y += u.pressure, xx += at * at, xy += at * u.pressure;
  }
  const double spread = n * xx - x * x, slope = (n * xy - x * y) / spread;
  return n >= 3.0 && spread > 0.0 && slope > 0.0 ? slope : not_known;
}

/// The smoothed curve of the samples, from zero sinkage on; empty while they carry less than the threshold.
inline terramechanics::PlateCurve curve_of(const PlateResult& r, const Settings& s) {
  terramechanics::PlateCurve all{
      .width = r.width,
      .sinkage = {},
      .pressure = smoothed<Sample>(r.samples, &Sample::travel, &Sample::pressure, s.smoothing * s.sinkage)};
  for (const Sample& sample : r.samples) all.sinkage.push_back(sample.travel);
  const auto carries = [&](double pressure) { return pressure >= s.threshold; };
  if (std::none_of(all.pressure.begin(), all.pressure.end(), carries)) return {};
  return terramechanics::zeroed(all, s.threshold);
}

/// The travel (m) at which sinkage begins on that curve; NaN while it is empty.
inline double zero_of(const PlateResult& r, const terramechanics::PlateCurve& curve) {
  return curve.sinkage.empty() ? not_known : r.samples.back().travel - curve.sinkage.back();
}

/// Finds where sinkage begins, the curve from there on, and k and n of p = k z^n (weighted logarithms).
inline void evaluate(PlateResult& r, const Settings& s) {
  r.unloading_stiffness = unloading_slope(r.unloading);
  r.curve = curve_of(r, s);
  if (r.curve.sinkage.empty()) return;
  const double zero = zero_of(r, r.curve);
  for (Sample& sample : r.samples) sample.sinkage = sample.travel - zero;
  const auto part = fitted_part(r, s);
  if (part.sinkage.size() < 10 || part.sinkage.back() < 2.0 * part.sinkage.front()) return;
  for (const double p : part.pressure) {
    if (!(p > 0.0)) return;
  }
  r.fit = terramechanics::fit_plate(part, terramechanics::PlateFit::weighted_logarithms);
}

/// The curves of the plates that can be fitted.
inline std::vector<terramechanics::PlateCurve> fitted_curves(const VariantResult& v) {
  std::vector<terramechanics::PlateCurve> curves;
  for (const PlateResult& r : v.plates) {
    if (r.fit) curves.push_back(fitted_part(r, v.variant.settings));
  }
  return curves;
}

}  // namespace dem::rig::plate_sinkage
