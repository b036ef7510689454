#pragma once

#include <dem/core/error.hpp>
#include <dem/soil/bed_options.hpp>

#include <cmath>
#include <string>

namespace dem::soil {

/// How dense a bed has come out.
struct BedReport {
  double solid_fraction = std::nan("");
  double relative_density = std::nan("");  ///< NaN without limits
  std::string text = {};                   ///< in what it is not as asked for, and what to change; empty if it is
};

/// The report on a bed of a solid fraction. What is said of a density that differs by more than the tolerance: shaking
/// makes a bed denser in pieces of 5 ms, a lid and what settles afterwards go on with it, and nothing makes it looser.
inline BedReport report_of_bed(double solid_fraction, const BedOptions& o) {
  BedReport report{.solid_fraction = solid_fraction};
  if (o.limits.loosest > 0.0) report.relative_density = relative_density(solid_fraction, o.limits);
  if (!(o.relative_density > 0.0)) return report;
  const double more = report.relative_density - o.relative_density;
  if (std::abs(more) <= o.density_tolerance) return report;
  report.text = text(
      "the bed has the relative density {:.2f} (solid fraction {:.3f}), {} than {:g}, which was asked for; {}, or "
      "raise "
      "BedOptions::density_tolerance",
      report.relative_density, solid_fraction, more > 0.0 ? "denser" : "looser", o.relative_density,
      more < 0.0 ? "raise BedOptions::relative_density"
      : o.lid_pressure > 0.0
          ? "raise BedOptions::densify_time, so that it gets denser more slowly, or lower lid_pressure"
          : "raise BedOptions::densify_time, so that it gets denser more slowly");
  return report;
}

/// Throws Error for a bed that has settled denser than it is to be, by more than the tolerance: shaking does not loosen
/// it.
inline void refuse_denser(double settled, const BedOptions& o) {
  const double density = relative_density(settled, o.limits);
  if (!(density > o.relative_density + o.density_tolerance)) return;
  fail(
      "a bed is to have the relative density {:g}, but settles with {:.2f} (solid fraction {:.3f}), and shaking does "
      "not "
      "loosen it; raise BedOptions::relative_density, leave it at 0 for a bed as it settles, or measure the limits of "
      "this soil, which are given as {:g} and {:g}",
      o.relative_density, density, settled, o.limits.loosest, o.limits.densest);
}

}  // namespace dem::soil
