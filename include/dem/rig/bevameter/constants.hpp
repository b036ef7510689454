#pragma once
// The constants of a soil from the curves of plates and shear tests, with confidence intervals.

#include <dem/core/error.hpp>
#include <dem/rig/direct_shear/evaluate.hpp>
#include <dem/rig/plate_sinkage/results.hpp>
#include <dem/rig/scatter.hpp>
#include <dem/terramechanics/bevameter_fit.hpp>
#include <dem/terramechanics/confidence.hpp>
#include <dem/terramechanics/shear_fit.hpp>
#include <dem/terramechanics/soil.hpp>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dem::rig::bevameter {

using terramechanics::Estimate;

/// What is known of a soil.
struct Constants {
  std::array<Estimate, 3> bekker = {};  ///< k_c (Pa/m^(n-1)), k_phi (Pa/m^n), n; a modulus that came out negative is 0
  std::array<Estimate, 3> reece = {};   ///< k_c', k_phi', n, likewise; k_c' is 0 without cohesion
  Estimate cohesion = {};               ///< Pa
  Estimate friction_angle = {};         ///< rad
  Estimate displacement = {};           ///< K, m
  Estimate unloading = {};              ///< Pa/m
  double bekker_r_squared = 0.0, reece_r_squared = 0.0;
  bool has_cohesion = false;  ///< false: it does not differ from none, and the strength goes through the origin
  /// Pa and rad, of the line that does not go through the origin; of two strengths without an error.
  Estimate free_cohesion = {}, free_friction_angle = {};
  std::vector<double> rising = {};       ///< Pa, loads whose shear stress is largest at the end of the travel
  std::vector<double> loaded_with = {};  ///< Pa, of each of the shear curves; they have the stress on the plane
  double unit_weight = 0.0;              ///< N/m^3
  double relative_density = 0.0;
  bool is_density_measured = true;  ///< false: the plates' bed is too small for that (bed_density())
  std::vector<terramechanics::JanosiFit> shear_curves = {};
  terramechanics::Soil bekker_soil = {}, reece_soil = {};
};

/// Curves cut into so many pieces of equal sinkage each; those with fewer than two points are left out.
inline std::vector<terramechanics::PlateCurve> pieces_of(std::span<const terramechanics::PlateCurve> curves,
                                                         std::size_t pieces) {
  std::vector<terramechanics::PlateCurve> result;
  for (const auto& curve : curves) {
    const double first = curve.sinkage.front(), step = (curve.sinkage.back() - first) / static_cast<double>(pieces);
    for (std::size_t k = 0; k < pieces; ++k) {
      terramechanics::PlateCurve piece{.width = curve.width, .sinkage = {}, .pressure = {}};
      for (std::size_t i = 0; i < curve.sinkage.size(); ++i) {
        const auto at =
            std::min(pieces - 1, static_cast<std::size_t>(std::max(0.0, (curve.sinkage[i] - first) / step)));
        if (at != k) continue;
        piece.sinkage.push_back(curve.sinkage[i]);
        piece.pressure.push_back(curve.pressure[i]);
      }
      if (piece.sinkage.size() > 1) result.push_back(std::move(piece));
    }
  }
  return result;
}

/// The curve of a load up to its strength, for Janosi's fit.
inline terramechanics::ShearCurve shear_curve(const direct_shear::LoadResult& r, const direct_shear::Settings& s) {
  terramechanics::ShearCurve curve{.normal_stress = r.plane_stress, .displacement = {}, .stress = {}};
  const auto stress = direct_shear::smoothed(r.samples, &direct_shear::Sample::stress, s.smoothing);
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const double j = r.samples[i].displacement;
    if (j <= 0.0 || j > r.at_maximum) continue;
    curve.displacement.push_back(j);
    curve.stress.push_back(stress[i]);
  }
  return curve;
}

/// Janosi's law of a load's curve; none of a curve without a bend to fit, as one that is largest at once: its strength
/// counts all the same.
inline std::optional<terramechanics::JanosiFit> janosi_fit(const direct_shear::LoadResult& r,
                                                           const direct_shear::Settings& s) {
  const auto curve = shear_curve(r, s);
  if (curve.displacement.size() < 3) return {};
  try {
    return terramechanics::fit_janosi_below(curve, r.maximum);
  } catch (const Error&) {
    return {};
  }
}

/// The mean of values that do not depend on each other, with its standard error.
inline Estimate mean_estimate(std::span<const double> values) {
  const Scatter all = scatter_of(values);
  return {all.mean, all.error(), all.count > 1 ? all.count - 1 : 0};
}

/// Cohesion and friction angle of the strengths, and K of the curves. The normal stress is that on the plane of shear,
/// which bears more than the box is loaded with, most of all under light loads: over the load the line would have too
/// much cohesion. The cohesion is kept where it differs from none with the confidence; else the line goes through the
/// origin. So it does with two strengths: a line through two points is exact, and no error can be told.
inline void find_strength(Constants& c, const direct_shear::Campaign& shear, const direct_shear::Settings& s,
                          double confidence) {
  using terramechanics::Intercept;
  std::vector<double> sigma, tau, bends;  // of the latter K, m
  for (const auto& r : shear.loads) {
    if (!r.finished || !(r.maximum > 0.0)) continue;
    sigma.push_back(r.plane_stress);
    tau.push_back(r.maximum);
    c.loaded_with.push_back(r.normal_stress);
    if (const auto fit = janosi_fit(r, s)) {
      c.shear_curves.push_back(*fit);
      bends.push_back(fit->displacement);
    } else {
      c.shear_curves.push_back({.normal_stress = r.plane_stress,
                                .strength = r.maximum,
                                .strength_error = not_known,
                                .displacement = not_known,
                                .displacement_error = not_known,
                                .r_squared = not_known});
    }
    // A mean over the smoothing can be largest no later than half of that before the end.
    if (r.at_maximum > 0.95 * (s.travel - 0.5 * s.smoothing)) c.rising.push_back(r.normal_stress);
  }
  if (sigma.size() > 1) {
    const auto line = terramechanics::fit_mohr_coulomb(sigma, tau, Intercept::free);
    c.free_cohesion = {line.cohesion, line.cohesion_error, sigma.size() - 2};
    c.has_cohesion = line.cohesion > c.free_cohesion.half_width(confidence);
    c.free_friction_angle = {line.friction_angle, line.friction_angle_error, sigma.size() - 2};
    c.cohesion = c.free_cohesion;
    c.friction_angle = c.free_friction_angle;
  }
  if (!c.has_cohesion) {
    const auto line = terramechanics::fit_mohr_coulomb(sigma, tau, Intercept::zero);
    c.cohesion = {0.0, 0.0, sigma.size() - 1};
    c.friction_angle = {line.friction_angle, line.friction_angle_error, sigma.size() - 1};
  }
  c.displacement = mean_estimate(bends);
}

/// Bekker's and Reece's constants of the plates, each with its error over `pieces` of every curve.
inline void find_moduli(Constants& c, std::span<const terramechanics::PlateCurve> curves, std::size_t pieces) {
  using namespace terramechanics;
  constexpr auto kind = PlateFit::weighted_logarithms;
  const auto cut = pieces_of(curves, pieces);
  const BekkerFit b = fit_bekker_not_negative(curves, kind);
  const bool cohesive = b.law.k_c > 0.0, frictional = b.law.k_phi > 0.0;
  c.bekker = jackknife<3>(std::span<const PlateCurve>(cut), [&](std::span<const PlateCurve> some) {
    const Bekker law = cohesive && frictional ? fit_bekker(some, kind).law : fit_bekker_one(some, frictional, kind).law;
    return std::array{law.k_c, law.k_phi, law.n};
  });
  c.bekker_r_squared = b.r_squared;
  // Here too a modulus that comes out negative is left out; without cohesion there is no k_c'.
  double cohesion = c.cohesion.value;
  bool is_cohesive_alone = false;
  if (cohesion > 0.0) {
    const Reece law = fit_reece(curves, cohesion, c.unit_weight, kind).law;
    is_cohesive_alone = law.k_c >= 0.0 && law.k_phi < 0.0;
    if (law.k_c < 0.0) cohesion = 0.0;
  }
  const auto fit_reece_here = [&](std::span<const PlateCurve> some) {
    return is_cohesive_alone ? fit_reece_cohesive(some, cohesion, c.unit_weight, kind)
                             : fit_reece(some, cohesion, c.unit_weight, kind);
  };
  c.reece = jackknife<3>(std::span<const PlateCurve>(cut), [&](std::span<const PlateCurve> some) {
    const Reece law = fit_reece_here(some).law;
    return std::array{law.k_c, law.k_phi, law.n};
  });
  c.reece_r_squared = fit_reece_here(curves).r_squared;
}

/// How dense the plates' bed is. Where it is too small to measure that, it is what was asked for, or the loosest where
/// nothing was.
struct BedDensity {
  double solid_fraction, relative_density;
  bool is_measured;
};
inline BedDensity bed_density(const plate_sinkage::VariantResult& plates) {
  const plate_sinkage::Settings& s = plates.variant.settings;
  const double solid = plates.solid_fraction, asked = s.bed.relative_density;
  if (std::isfinite(solid)) return {solid, s.grains.relative_density(solid), true};
  return {soil::solid_fraction_at(asked, s.grains.limits), asked, false};
}

/// All constants. Throws Error where plates or shear curves are too few.
inline Constants find_constants(const plate_sinkage::VariantResult& plates, const direct_shear::Campaign& shear,
                                const direct_shear::Settings& shear_settings, std::size_t pieces, double confidence) {
  using namespace terramechanics;
  Constants c;
  const BedDensity density = bed_density(plates);
  c.unit_weight = 9.81 * plates.variant.settings.grains.density * density.solid_fraction;
  c.relative_density = density.relative_density;
  c.is_density_measured = density.is_measured;
  find_strength(c, shear, shear_settings, confidence);
  const auto curves = plate_sinkage::fitted_curves(plates);
  if (curves.size() < 2) {
    fail("{} of {} plates can be fitted, but two are needed; raise --sinkage", curves.size(), plates.plates.size());
  }
  find_moduli(c, curves, pieces);
  std::vector<double> slopes;
  for (const auto& r : plates.plates) slopes.push_back(r.unloading_stiffness);
  c.unloading = mean_estimate(slopes);

  Soil soil;
  soil.shear = {c.cohesion.value, c.friction_angle.value, c.displacement.value};
  soil.a0 = c.relative_density < 0.5 ? 0.18 : 0.43;  // Wong and Reece's loose and dense sand
  if (std::isfinite(c.unloading.value)) soil.unloading_stiffness = c.unloading.value;
  soil.pressure = Bekker{c.bekker[0].value, c.bekker[1].value, c.bekker[2].value};
  c.bekker_soil = soil;
  soil.pressure = Reece{c.reece[0].value, c.reece[1].value, c.reece[2].value, c.cohesion.value, c.unit_weight};
  c.reece_soil = soil;
  check_soil(c.bekker_soil);
  check_soil(c.reece_soil);
  return c;
}

}  // namespace dem::rig::bevameter
