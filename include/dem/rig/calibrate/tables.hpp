#pragma once
// What a search found, as tables and plots.

#include <dem/io/csv.hpp>
#include <dem/report/plot_data.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/bed/grain_settings.hpp>
#include <dem/rig/calibrate/search.hpp>
#include <dem/rig/calibrate/trial.hpp>
#include <dem/rig/number.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::calibrate {

inline constexpr const char* method_text =
    "Each measured quantity is fitted by a polynomial over the constants, of first degree, or of second where the "
    "points "
    "allow it: what runs with other seeds scatter about it is noise. The constants are those at which these surfaces "
    "are "
    "nearest to the targets; their errors are those of surfaces and targets, divided by the slopes. New points are "
    "tried "
    "about what was found, within three standard errors.";

/// The name of a constant with its unit.
inline std::string titled(Constant c) {
  const std::string unit = units_of_constants[static_cast<int>(c)];
  return names_of_constants[static_cast<int>(c)] + (unit.empty() ? "" : " [" + unit + "]");
}
inline std::string titled(Quantity q) {
  return text("{} [{}]", names_of_quantities[static_cast<int>(q)], units_of_quantities[static_cast<int>(q)]);
}
inline std::string number(double value, const char* format = "{:.4g}") { return rig::number(value, format); }

/// A unit, and what it is a stiffness of.
inline std::string unit_of(const Settings& s, Constant c) {
  if (c == Constant::stiffness) return text("N/m for half-edge {:g} mm", 1e3 * size_of_constants(s));
  const std::string unit = units_of_constants[static_cast<int>(c)];
  return unit.empty() ? "-" : unit;
}

/// A constant that was found, with its standard error in its own unit.
inline terramechanics::Estimate estimate_of(const Settings& s, const Found& f, std::size_t k) {
  const Constant c = constants_of(s)[k];
  const double step = 1e-4;
  const double slope = (value_at(s, c, f.place[k] + step) - value_at(s, c, f.place[k] - step)) / (2.0 * step);
  return {value_at(s, c, f.place[k]), slope * f.error[k], f.freedom};
}

inline std::string found_text(const Settings& s, const Found& f) {
  std::string words;
  const auto constants = constants_of(s);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const auto e = estimate_of(s, f, k);
    words += text("{}{} {} ± {}", words.empty() ? "" : ", ", names_of_constants[static_cast<int>(constants[k])],
                  number(e.value), number(e.half_width(), "{:.2g}"));
    const auto& range = range_of(s, constants[k]);
    if (!(2.0 * e.half_width() <= range[1] - range[0])) words += " (wider than its range: not told by the targets)";
    if (f.place[k] < 1e-3 || f.place[k] > 1.0 - 1e-3) words += " (at the end of its range)";
    if (f.is_beyond(k)) {
      words += text(" (beyond the points that were tried, {} to {}: extrapolated; try more with --go-on and --trials)",
                    number(value_at(s, constants[k], f.low[k])), number(value_at(s, constants[k], f.high[k])));
    }
    if (!s.known.empty()) words += text(" (made with {:g})", s.known[k]);
  }
  if (f.other.empty()) return words;
  words += "; but ";
  for (std::size_t k = 0; k < constants.size(); ++k) {
    words += text("{}{} {}", k > 0 ? ", " : "", names_of_constants[static_cast<int>(constants[k])],
                  number(value_at(s, constants[k], f.other[k])));
  }
  words += text(" fit{} the target{} as well: narrow the range, as by --{}-range, to the one that is meant",
                constants.size() > 1 ? "" : "s", quantities_of(s).size() > 1 ? "s" : "",
                names_of_constants[static_cast<int>(constants.front())]);
  return words;
}

inline io::Table found_table(const Settings& s, const Found& f) {
  io::Table t{.caption = "Constants of the grains that reproduce the targets",
              .header = {"constant", "found", "standard error", "± 95 %", "deg. of freedom", "made with"}};
  const auto constants = constants_of(s);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const auto e = estimate_of(s, f, k);
    t.row(text("{} [{}]", names_of_constants[static_cast<int>(constants[k])], unit_of(s, constants[k])),
          number(e.value), number(e.error, "{:.2g}"), number(e.half_width(), "{:.2g}"), text("{}", e.freedom),
          s.known.empty() ? "-" : number(s.known[k]));
  }
  return t;
}

inline io::Table goals_table(const Settings& s, const Found& f, const std::vector<Goal>& goals) {
  io::Table t{
      .caption = "Targets, and the surfaces at what was found",
      .header = {"quantity", "target", "its error", "surface", "its error", "one run scatters by", "surface is"}};
  const auto quantities = quantities_of(s);
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    const Surrogate& y = f.surrogates[q];
    t.row(titled(quantities[q]), number(goals[q].value), number(goals[q].error_with(y.scatter()), "{:.2g}"),
          number(y.value(f.place)), number(y.error(f.place), "{:.2g}"), number(y.scatter(), "{:.2g}"),
          y.is_quadratic() ? "of second degree" : "plane");
  }
  return t;
}

inline io::Table tried_table(const Settings& s, const std::vector<Trial>& tried) {
  io::Table t{.caption = "What was tried (tried.csv); point 0 made the target", .header = {"point", "seed"}};
  for (const Constant c : constants_of(s)) t.header.push_back(titled(c));
  for (const Quantity q : quantities_of(s)) t.header.push_back(titled(q));
  for (const Trial& x : tried) {
    std::vector<std::string> cells{text("{}", x.point), text("{}", x.seed)};
    for (const double v : x.values) cells.push_back(number(v));
    for (const double v : x.results) cells.push_back(number(v));
    t.rows.push_back(std::move(cells));
  }
  return t;
}

/// A quantity over the first constant, the others as they were found. The curve ends with the points that were tried.
inline io::Plot response_plot(const Settings& s, const std::vector<Trial>& tried, const Found& f,
                              const std::vector<Goal>& goals, std::size_t q) {
  constexpr const char* of_quantities[] = {"Angle of friction", "Angle of repose", "Mean pressure on the plate",
                                           "Exponent of the plate's curve"};
  constexpr const char* of_constants[] = {"the friction of grains", "the stiffness", "the relative density",
                                          "the rolling length"};
  const Constant first = constants_of(s).front();
  const Quantity quantity = quantities_of(s)[q];
  const double scale = quantity == Quantity::pressure ? 1e-3 : 1.0;  // kPa
  io::Plot plot{.title = text("{} over {}, size {}", of_quantities[static_cast<int>(quantity)],
                              of_constants[static_cast<int>(first)], s.size),
                .x_label = titled(first),
                .y_label = quantity == Quantity::pressure ? "pressure [kPa]" : titled(quantity)};
  io::Series points{.name = "runs", .style = io::SeriesStyle::Points, .color = 0};
  for (const Trial& t : tried) {
    if (t.point == 0) continue;
    points.x.push_back(t.values.front());
    points.y.push_back(scale * t.results[q]);
  }
  io::Series line{.name = "fitted curve", .style = io::SeriesStyle::Line, .color = 0};
  io::Series low{.name = "± standard error", .style = io::SeriesStyle::Dotted, .color = 0}, high = low;
  high.name = "";
  std::vector<double> place = f.place;
  for (int k = 0; k <= 60; ++k) {
    place.front() = f.low.front() + (f.high.front() - f.low.front()) * k / 60.0;
    const double x = value_at(s, first, place.front()), y = f.surrogates[q].value(place);
    const double error = f.surrogates[q].error(place);
    for (auto* series : {&line, &low, &high}) series->x.push_back(x);
    line.y.push_back(scale * y), low.y.push_back(scale * (y - error)), high.y.push_back(scale * (y + error));
  }
  const auto& range = range_of(s, first);
  const double target = scale * goals[q].value, error = scale * goals[q].error_with(f.surrogates[q].scatter());
  const auto level = [&](std::string name, double y, io::SeriesStyle style) {
    return io::Series{.name = std::move(name), .x = range, .y = {y, y}, .style = style, .color = 1};
  };
  const terramechanics::Estimate e = estimate_of(s, f, 0);
  const double half = e.half_width(), found = scale * f.surrogates[q].value(f.place);
  io::Series here{.name = "found", .x = {e.value}, .y = {found}, .style = io::SeriesStyle::Points, .color = 2};
  plot.series = {points,
                 line,
                 low,
                 high,
                 level("target", target, io::SeriesStyle::Dashed),
                 level("± its error", target - error, io::SeriesStyle::Dotted),
                 level("", target + error, io::SeriesStyle::Dotted),
                 here};
  if (std::isfinite(half)) {
    plot.series.push_back({.name = "± 95 %, within its range",
                           .x = {std::max(range[0], e.value - half), std::min(range[1], e.value + half)},
                           .y = {found, found},
                           .style = io::SeriesStyle::Line,
                           .color = 2});
  }
  return plot;
}

/// The points in the order in which they were tried, as shares of their ranges.
inline io::Plot search_plot(const Settings& s, const std::vector<Trial>& tried) {
  io::Plot plot{.title = "Points that were tried",
                .x_label = "point",
                .y_label = "share of the range [-]",
                .y_range = {.min = 0.0, .max = 1.0}};
  const auto constants = constants_of(s);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    io::Series line{.name = names_of_constants[static_cast<int>(constants[k])], .style = io::SeriesStyle::LinePoints};
    for (const Trial& t : tried) {
      if (t.point == 0 || (!line.x.empty() && line.x.back() == static_cast<double>(t.point))) continue;
      line.x.push_back(static_cast<double>(t.point));
      line.y.push_back(place_of(s, constants[k], t.values[k]));
    }
    plot.series.push_back(std::move(line));
  }
  return plot;
}

inline void write_found(const std::filesystem::path& path, const Settings& s, const Found& f) {
  io::CsvWriter csv(path, {"constant", "value", "standard_error", "half_interval_95", "degrees_of_freedom", "unit"});
  const auto constants = constants_of(s);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const auto e = estimate_of(s, f, k);
    const int c = static_cast<int>(constants[k]);
    csv.row(names_of_constants[c], cell(e.value), cell(e.error), cell(e.half_width()), e.freedom,
            unit_of(s, constants[k]));
  }
  csv.flush();
}

/// Names and values for the report.
inline NamesAndValues list_settings(const Settings& s) {
  NamesAndValues list{{"size of the rigs", s.size}};
  for (const Constant c : constants_of(s)) {
    const std::string unit = unit_of(s, c);
    list.emplace_back(names_of_constants[static_cast<int>(c)],
                      text("from {:g} to {:g}{}", range_of(s, c)[0], range_of(s, c)[1], unit == "-" ? "" : " " + unit));
  }
  list_settings(list, s.held);
  if (scales(s.held))
    list.emplace_back("K, kt, C and cv are for half-edge", text("{:g} mm", 1e3 * size_of_constants(s)));
  list.emplace_back("points", text("{}, {} seeds each, chosen {} at once", s.trials, s.repeats, s.batch));
  return list;
}

}  // namespace dem::rig::calibrate
