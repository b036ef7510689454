#pragma once

#include <dem/io/csv.hpp>
#include <dem/report/plot_data.hpp>
#include <dem/report/replay_page.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/report.hpp>
#include <dem/rig/sand_pile/repose.hpp>
#include <dem/rig/scatter.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

// What was found, as tables, plots and in words.

namespace dem::rig::sand_pile {

inline std::string number(double value, const char* format = "{:.1f}") { return rig::number(value, format); }

/// What is measured of a pile, in words.
inline std::string fit_text(const Settings& s) {
  return text(
      "The angle is that of lines of least squares through the flank, from {:g} to {:g} % of the pile's height, in {} "
      "{}: their mean, and their standard deviation over the directions. Creep is the way of the grains in {:g} s "
      "after "
      "that, in grain sizes.",
      1e2 * s.flank_high, 1e2 * s.flank_low,
      s.method == "drain" ? std::max<std::uint64_t>(1, s.directions / 3) : s.directions,
      s.method == "drain" ? "strips" : "sectors", s.creep_time);
}

/// Which kinds of grains stand, by the pile of each that creeps most; empty where no pile was watched.
inline std::string creep_text(const Campaign& c) {
  constexpr double limit = 1e-3, full_time = 10.0;  // sizes, s
  std::string kinds;
  double watched = full_time, longest = 0.0;
  for (const auto& piles : by_kind(c)) {
    double most = not_known;
    for (const PileResult* r : piles) {
      if (!std::isfinite(r->creep)) continue;
      most = std::fmax(most, r->creep);
      watched = std::min(watched, r->creep_time);
      longest = std::max(longest, r->creep_time);
    }
    if (std::isnan(most)) continue;
    kinds += text("{}{} {} ({:.2g})", kinds.empty() ? "" : ", ", piles.front()->kind.name,
                  most < limit ? "stands" : "creeps", most);
  }
  if (kinds.empty()) return {};
  return text(
      "A pile stands whose grains move by less than {:g} of their size in {:g} s (root mean square; the pile of each "
      "kind that creeps most): {}.{}",
      limit, full_time, kinds,
      watched < (1.0 - 1e-9) * full_time
          ? text(" They were watched for {:g} s alone: give --creep-time {:g}.", watched, full_time)
      : longest > 1.01 * full_time
          ? text(" They were watched for {:g} s: one that creeps by that may stand by this.", longest)
          : "");
}

inline io::Table angle_table(const Campaign& c) {
  io::Table t{.caption = "Angle of repose",
              .header = {"grains", "piles", "angle [deg]", "± directions", "± seeds", "after creep [deg]",
                         "creep, r.m.s. [grains]", "median", "height [mm]", "lost [%]", "at rest"}};
  for (const auto& piles : by_kind(c)) {
    std::vector<double> angle, scatter, after, creep, median, height, lost;
    bool at_rest = true;
    for (const PileResult* r : piles) {
      angle.push_back(degrees * r->flank.angle);
      scatter.push_back(degrees * r->flank.scatter);
      after.push_back(degrees * r->angle_after);
      creep.push_back(r->creep);
      median.push_back(r->creep_median);
      height.push_back(r->flank.angles.empty() ? not_known : 1e3 * r->flank.height);
      lost.push_back(1e2 * static_cast<double>(r->lost) / static_cast<double>(std::max<std::size_t>(r->poured, 1)));
      at_rest = at_rest && r->at_rest;
    }
    t.row(piles.front()->kind.name, piles.size(), number(scatter_of(angle).mean), number(scatter_of(scatter).mean),
          number(scatter_of(angle).deviation), number(scatter_of(after).mean), number(scatter_of(creep).mean, "{:.2g}"),
          number(scatter_of(median).mean, "{:.2g}"), number(scatter_of(height).mean), number(scatter_of(lost).mean),
          at_rest);
  }
  return t;
}

namespace detail {

inline void write_results_csv(const std::filesystem::path& path, const Campaign& c) {
  io::CsvWriter csv(path, {"grains", "seed", "angle_deg", "deviation_over_directions_deg", "height_m", "flank_from_m",
                           "flank_to_m", "at_rest", "creep_time_s", "creep_rms_grains", "creep_median_grains",
                           "angle_after_deg", "poured", "lost", "finished"});
  for (const PileResult& r : c.piles) {
    csv.row(r.kind.name, r.seed, cell(degrees * r.flank.angle), cell(degrees * r.flank.scatter), cell(r.flank.height),
            cell(r.flank.from), cell(r.flank.to), r.at_rest, cell(r.creep_time), cell(r.creep), cell(r.creep_median),
            cell(degrees * r.angle_after), r.poured, r.lost, r.finished);
  }
  csv.flush();  // so that a full disk is noticed
}

inline io::Plot profiles_plot(const Settings& s, const Campaign& c) {
  io::Plot plot{.title = "Mean profiles",
                .x_label = s.method == "drain" ? "distance from the back wall [mm]" : "distance from the axis [mm]",
                .y_label = "height [mm]"};
  int color = 0;
  for (const auto& piles : by_kind(c)) {
    io::Series line{.name = piles.front()->kind.name, .color = color++};
    const soil::Flank& f = shown_of(piles).flank;
    for (std::size_t k = 0; k < f.profile_s.size(); ++k) {
      line.x.push_back(1e3 * f.profile_s[k]);
      line.y.push_back(1e3 * f.profile_z[k]);
    }
    plot.series.push_back(std::move(line));
  }
  return plot;
}

inline io::Plot time_plot(const Campaign& c) {
  io::Plot plot{.title = "Angle of the flank over time", .x_label = "time [s]", .y_label = "angle [deg]"};
  plot.y_range = {.min = 0.0, .max = 60.0};
  int color = 0;
  for (const auto& piles : by_kind(c)) {
    io::Series line{.name = piles.front()->kind.name, .color = color++};
    for (const Sample& sample : shown_of(piles).samples) {
      line.x.push_back(sample.time);
      line.y.push_back(sample.angle);
    }
    plot.series.push_back(std::move(line));
  }
  return plot;
}

inline io::Plot angles_plot(const Campaign& c) {
  io::Plot plot{.title = "Angle over the direction", .x_label = "direction", .y_label = "angle [deg]"};
  plot.y_range.min = 0.0;
  int color = 0;
  for (const auto& piles : by_kind(c)) {
    io::Series points{.name = piles.front()->kind.name, .style = io::SeriesStyle::LinePoints, .color = color++};
    const soil::Flank& f = shown_of(piles).flank;
    for (std::size_t k = 0; k < f.angles.size(); ++k) {
      points.x.push_back(static_cast<double>(k + 1));
      points.y.push_back(degrees * f.angles[k]);
    }
    plot.series.push_back(std::move(points));
  }
  return plot;
}

inline std::vector<std::pair<std::string, std::string>> list_settings(const Settings& s) {
  const auto mm = [](double metres) { return text("{:g} mm", 1e3 * metres); };
  std::vector<std::pair<std::string, std::string>> list = {
      {"size", s.size},
      {"method", s.method},
      {"grains", text("{} of half-edge {}", s.grains, mm(s.half_edge))},
      s.fill_file.empty() ? std::pair<std::string, std::string>{"seeds", text("{}, from {}", s.seeds, s.seed)}
                          : std::pair<std::string, std::string>{"grains start from", s.fill_file},
      {"plate", s.plate},
      {"friction, grain on grain", text("{:g}", s.friction)},
      {"friction, grain on plate", text("{:g}", s.plate_friction)},
      {"friction, grain on container", text("{:g}", s.container_friction)},
      {"rolling length (sphere-rolling, sphere-braked)", mm(s.rolling_length)},
      {"normal stiffness K", text("{:g} N/m, given for {}", s.stiffness, mm(s.constants_for))},
      {"normal damping C", text("{:g} N s/m", s.damping)}};
  if (s.method == "drain") {
    list.push_back(
        {"box", text("{:g} x {:g} mm, slot {:g} mm", 1e3 * s.box_length, 1e3 * s.box_width, 1e3 * s.slot_width)});
  } else {
    list.push_back({"cylinder, plate", text("radius {:g} and {:g} mm", 1e3 * s.cylinder_radius, 1e3 * s.plate_radius)});
  }
  if (s.method == "lift") list.push_back({"lift speed", text("{:g} mm/s", 1e3 * s.lift_speed)});
  if (s.method == "funnel") {
    list.push_back(
        {"orifice", text("radius {:g} mm, {:g} mm above the plate", 1e3 * s.orifice_radius, 1e3 * s.orifice_height)});
  }
  return list;
}

}  // namespace detail

/// Writes results.csv, prints the results, and makes the plots and report.html with all settings. Shows what there is
/// when the run ended early. Returns whether there are files for ParaView.
inline bool report(Report& report, const Settings& s, const Campaign& c) {
  std::vector<std::string> words{fit_text(s)};
  if (auto creep = creep_text(c); !creep.empty()) words.push_back(std::move(creep));
  if (auto zhou = zhou_text(s, c); !zhou.empty()) words.push_back(std::move(zhou));
  for (const PileResult& r : c.piles) {
    if (auto note = no_angle_note(s, r); !note.empty()) words.push_back(std::move(note));
  }
  report.part("results.csv", [&] { detail::write_results_csv(report.folder() / "results.csv", c); });
  report.part("the printed report", [&] {
    fmt::print("\n");
    io::print(angle_table(c));
    for (const auto& line : words) fmt::print("{}\n", line);
  });
  report.page(detail::list_settings(s), [&](io::HtmlReport& page) {
    page.table(angle_table(c));
    for (const auto& line : words) page.paragraph(line);
    if (std::any_of(c.piles.begin(), c.piles.end(), [](const PileResult& r) { return !r.pile.empty(); })) {
      page.heading("Plots");
      report.plot(page, repose_plot(s, c), "repose", "Angle of repose of each kind of grain.");
      report.plot(page, detail::profiles_plot(s, c), "profiles",
                  "Mean profile of the first pile of each kind that was measured.");
      report.plot(page, detail::time_plot(c), "angle_over_time", "Angle of the flank while the pile is made.");
      report.plot(page, detail::angles_plot(c), "angles", "Angle of the flank in each direction.");
    }
    if (c.replay && c.replay->frames().size() > 1) page.heading("Replay").replay(*c.replay, "The first pile.");
  });
  return s.vtk && !c.piles.empty() && !c.piles.front().samples.empty();
}

}  // namespace dem::rig::sand_pile
