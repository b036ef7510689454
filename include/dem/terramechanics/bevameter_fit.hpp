#pragma once

#include <dem/terramechanics/plate_fit.hpp>

#include <span>

namespace dem::terramechanics {

/// Bekker's constants through the points of several plates.
struct BekkerFit {
  Bekker law = {};
  Bekker error = {};  ///< standard errors; NaN without a point to spare
  double r_squared = 1.0;
  std::size_t points = 0;
};

/// Reece's constants through the points of several plates.
struct ReeceFit {
  Reece law;
  double k_c_error = 0.0, k_phi_error = 0.0, n_error = 0.0;  ///< standard errors
  double r_squared = 1.0;
  std::size_t points = 0;
};

namespace detail {

inline void check_widths(std::span<const PlateCurve> plates, const char* what) {
  if (plates.empty()) fail("{}: 0 plates tell nothing; press plates of two widths", what);
  double least = 1e300, most = 0.0;
  for (const PlateCurve& plate : plates) {
    check_plate_curve(plate);
    least = plate.width < least ? plate.width : least;
    most = plate.width > most ? plate.width : most;
  }
  if (!(most > least * (1.0 + 1e-9))) {
    fail("{}: {} plates of one width cannot tell k_c from k_phi; press plates of different widths, or fit_plate alone",
         what, plates.size());
  }
}

}  // namespace detail

/// k_c, k_phi and n of p = (k_c/b + k_phi) z^n, all plates and points at once. A modulus that comes out negative says
/// that wider plates do not carry what Bekker's form expects; check_pressure refuses it. Throws Error for plates of one
/// width, and as fit_plate does.
inline BekkerFit fit_bekker(std::span<const PlateCurve> plates, PlateFit kind = PlateFit::pressures) {
  detail::check_widths(plates, "Bekker's fit");
  const auto fit = detail::fit_form<2>("Bekker's fit", plates, kind, [](double z, double b, std::array<double, 2>& u) {
    u = {1.0 / b, 1.0};
    return z;
  });
  return {.law = {.k_c = fit.value[0], .k_phi = fit.value[1], .n = fit.value[2]},
          .error = {.k_c = fit.error[0], .k_phi = fit.error[1], .n = fit.error[2]},
          .r_squared = fit.r_squared,
          .points = fit.points};
}

/// k_phi and n of p = k_phi z^n (frictional), or k_c and n of p = (k_c/b) z^n, all plates and points at once; the other
/// modulus is 0. Throws Error as fit_plate does.
inline BekkerFit fit_bekker_one(std::span<const PlateCurve> plates, bool frictional,
                                PlateFit kind = PlateFit::pressures) {
  const auto fit = detail::fit_form<1>("Bekker's fit", plates, kind, [&](double z, double b, std::array<double, 1>& u) {
    u = {frictional ? 1.0 : 1.0 / b};
    return z;
  });
  BekkerFit one{.r_squared = fit.r_squared, .points = fit.points};
  (frictional ? one.law.k_phi : one.law.k_c) = fit.value[0];
  (frictional ? one.error.k_phi : one.error.k_c) = fit.error[0];
  one.law.n = fit.value[1];
  one.error.n = fit.error[1];
  return one;
}

/// fit_bekker with moduli that a soil may have: one that comes out negative is left out, and the other one fitted alone
/// (fit_bekker_one). Wider plates on sand carry more, which a k_c below 0 would say.
inline BekkerFit fit_bekker_not_negative(std::span<const PlateCurve> plates, PlateFit kind = PlateFit::pressures) {
  const BekkerFit both = fit_bekker(plates, kind);
  if (both.law.k_c >= 0.0 && both.law.k_phi >= 0.0) return both;
  return fit_bekker_one(plates, both.law.k_c < 0.0, kind);
}

/// k_c', k_phi' and n of p = (c k_c' + gamma b k_phi') (z/b)^n for a soil of cohesion c (Pa) and unit weight gamma
/// (N/m^3). Without cohesion k_c' has no meaning and is 0, and one plate is enough. Throws Error as fit_bekker does.
inline ReeceFit fit_reece(std::span<const PlateCurve> plates, double cohesion, double unit_weight,
                          PlateFit kind = PlateFit::pressures) {
  require_non_negative(cohesion, "cohesion in Reece's fit", "Pa");
  require_positive(unit_weight, "unit weight in Reece's fit", "N/m^3");
  ReeceFit result;
  result.law.cohesion = cohesion;
  result.law.unit_weight = unit_weight;
  const auto keep = [&](const auto& fit) {
    constexpr std::size_t moduli = std::tuple_size_v<decltype(fit.value)> - 1;
    result.law.k_phi = fit.value[moduli - 1];
    result.k_phi_error = fit.error[moduli - 1];
    result.law.n = fit.value[moduli];
    result.n_error = fit.error[moduli];
    if (moduli == 2) {
      result.law.k_c = fit.value[0];
      result.k_c_error = fit.error[0];
    }
    result.r_squared = fit.r_squared;
    result.points = fit.points;
  };
  if (cohesion > 0.0) {
    detail::check_widths(plates, "Reece's fit");
    keep(detail::fit_form<2>("Reece's fit", plates, kind, [&](double z, double b, std::array<double, 2>& u) {
      u = {cohesion, unit_weight * b};
      return z / b;
    }));
  } else {
    keep(detail::fit_form<1>("Reece's fit", plates, kind, [&](double z, double b, std::array<double, 1>& u) {
      u = {unit_weight * b};
      return z / b;
    }));
  }
  return result;
}

/// k_c' and n of p = c k_c' (z/b)^n, all plates and points at once; k_phi' is 0. Throws Error as fit_plate does, and
/// unless the cohesion is above 0.
inline ReeceFit fit_reece_cohesive(std::span<const PlateCurve> plates, double cohesion, double unit_weight,
                                   PlateFit kind = PlateFit::pressures) {
  require_positive(cohesion, "cohesion in Reece's fit", "Pa");
  const auto fit = detail::fit_form<1>("Reece's fit", plates, kind, [&](double z, double b, std::array<double, 1>& u) {
    u = {cohesion};
    return z / b;
  });
  ReeceFit one;
  one.r_squared = fit.r_squared, one.points = fit.points;
  one.law.cohesion = cohesion, one.law.unit_weight = unit_weight;
  one.law.k_c = fit.value[0], one.law.k_phi = 0.0, one.law.n = fit.value[1];
  one.k_c_error = fit.error[0], one.k_phi_error = 0.0, one.n_error = fit.error[1];
  return one;
}

}  // namespace dem::terramechanics
