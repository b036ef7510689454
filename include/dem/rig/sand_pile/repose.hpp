#pragma once
// The angles of repose of all kinds side by side, and what is published of spheres with rolling resistance.

#include <dem/report/plot_data.hpp>
#include <dem/rig/sand_pile/results.hpp>
#include <dem/rig/scatter.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::sand_pile {

/// The angle (deg) that the fit of Zhou, Xu, Yu and Zulli (Powder Technology 125, 2002, 45-54) gives spheres whose
/// rolling is resisted: phi = 68.61 mu_pp^0.27 mu_pw^0.22 m_pp^0.06 m_pw^0.12 d^-0.2, with the rolling lengths m and
/// the diameter d in mm. It was made on slopes that stay in a box which is emptied through a slot; rolling met a
/// constant torque. NaN of other kinds, and where one of its numbers is 0.
inline double angle_by_zhou(const Settings& s, const Kind& kind) {
  if (!kind.rolling) return not_known;
  const double d = 2e3 * sphere_radius(s.half_edge);
  const double angle = 68.61 * std::pow(s.friction, 0.27) * std::pow(s.plate_friction, 0.22) *
                       std::pow(1e3 * s.rolling_length, 0.06) * std::pow(1e3 * s.plate_rolling_length, 0.12) *
                       std::pow(d, -0.2);
  return angle > 0.0 ? angle : not_known;
}

/// What is said of that fit; empty where no kind has it.
inline std::string zhou_text(const Settings& s, const Campaign& c) {
  for (const PileResult& r : c.piles) {
    const double angle = angle_by_zhou(s, r.kind);
    if (!std::isfinite(angle)) continue;
    return text(
        "Spheres with rolling resistance have {:.1f} deg by the fit of Zhou et al. (2002). It is of slopes that stay "
        "in "
        "a box which is emptied through a slot{}; rolling met a constant torque, as that of sphere-braked does.",
        angle, s.method == "drain" ? "" : ", and these piles are made otherwise");
  }
  return {};
}

/// The mean angle of each kind with its scatter, and the fit beside it. Kinds of which nothing is known are left out.
inline io::Plot repose_plot(const Settings& s, const Campaign& c) {
  io::Plot plot{.title = "Angle of repose", .x_label = "grains", .y_label = "angle [deg]"};
  using Style = io::SeriesStyle;
  io::Series means{.name = "mean of the piles", .style = Style::Points, .color = 0};
  io::Series seeds{.name = "± standard deviation of the seeds", .color = 0};
  io::Series directions{.name = "one pile: ± over the directions", .style = Style::Dotted, .color = 0};
  io::Series each{.name = "each pile", .style = Style::Points, .color = 5};
  io::Series zhou{.name = "Zhou et al. 2002, a drained box", .style = Style::Points, .color = 1};
  const auto bar = [](io::Series& to, double x, double middle, double half) {
    to.x.insert(to.x.end(), {x, x, x});
    to.y.insert(to.y.end(), {middle - half, middle + half, not_known});
  };
  double x = 0.0;
  for (const auto& piles : by_kind(c)) {
    std::vector<double> angles;
    for (const PileResult* r : piles) {
      if (std::isfinite(r->flank.angle)) angles.push_back(degrees * r->flank.angle);
    }
    if (angles.empty()) continue;
    const Kind& kind = piles.front()->kind;
    plot.x_ticks.push_back({x += 1.0, kind.name});
    const Scatter spread = scatter_of(angles);
    means.x.push_back(x), means.y.push_back(spread.mean);
    if (angles.size() > 1) {
      bar(seeds, x, spread.mean, spread.deviation);
      for (const double angle : angles) each.x.push_back(x - 0.15), each.y.push_back(angle);
    } else {
      for (const PileResult* r : piles) {
        if (std::isfinite(r->flank.angle)) bar(directions, x, spread.mean, degrees * r->flank.scatter);
      }
    }
    zhou.x.push_back(x + 0.15), zhou.y.push_back(angle_by_zhou(s, kind));
  }
  plot.x_range = {.min = 0.5, .max = std::fmax(x, 1.0) + 0.5};
  plot.y_range = {.min = 0.0};
  plot.series = {std::move(means), std::move(seeds), std::move(directions), std::move(each), std::move(zhou)};
  return plot;
}

}  // namespace dem::rig::sand_pile
