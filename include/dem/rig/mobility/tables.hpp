#pragma once

#include <dem/report/heat_map.hpp>
#include <dem/report/plot_data.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/mobility/cases.hpp>
#include <dem/terramechanics/wheel_load.hpp>

#include <string>
#include <utility>
#include <vector>

// What was found, as tables, plots and maps.

namespace dem::rig::mobility {

/// The soil of a case in words.
inline std::string ground_of(const Case& c) {
  if (c.lane.size() == 1) return c.lane[0].soil.name;
  std::string words;
  for (const auto& part : c.lane) words += (words.empty() ? "" : ", ") + text("{:g} m {}", part.length, part.soil.name);
  return words;
}

inline io::Table drive_table(const Campaign& c) {
  io::Table t{.caption = "Drives; means over the second half of the way",
              .header = {"soil", "slope [%]", "side [%]", "weight [kN]", "ended", "way [m]", "time [s]", "speed [m/s]",
                         "slip", "sinkage [mm]", "resistance [kN]", "of the weight", "energy [kJ/m]", "drift [mm]",
                         "ruts [mm]", "computing"}};
  for (std::size_t k = 0; k < c.results.size(); ++k) {
    const Case& of = c.cases[k];
    const Result& r = c.results[k];
    t.row(ground_of(of), number(of.slope, "{:g}"), number(of.side_slope, "{:g}"), number(1e-3 * r.weight, "{:.1f}"),
          r.ended.empty() ? "not driven" : r.ended, number(r.way), number(r.time), number(r.speed),
          number(r.slip, "{:.3f}"), number(1e3 * r.sinkage, "{:.1f}"), number(1e-3 * r.resistance),
          number(r.resistance / r.weight, "{:.3f}"), number(1e-3 * r.energy_per_metre), number(1e3 * r.drift, "{:.0f}"),
          number(1e3 * r.rut_left, "{:.0f}") + ", " + number(1e3 * r.rut_right, "{:.0f}"), number(r.computing));
  }
  return t;
}

inline io::Table pull_table(const Result& r) {
  io::Table t{
      .caption = "Pull on the load cell over slip 1 - v/(omega r)",
      .header = {"slip", "pull [kN]", "of the weight", "torque [kN m]", "sinkage [mm]", "engine [kW]", "efficiency"}};
  for (const PullPoint& p : r.pulls) {
    t.row(number(p.slip, "{:.3f}"), number(1e-3 * p.pull), number(p.pull / r.weight, "{:.3f}"), number(1e-3 * p.torque),
          number(1e3 * p.sinkage, "{:.1f}"), number(1e-3 * p.power), number(p.pull > 0.0 ? p.efficiency : not_known));
  }
  return t;
}

inline constexpr const char* words_text =
    "Soil is columns with memory (dynamic Bekker). Slip is (omega r - v)/max(|omega r|, |v|) with the "
    "tyre's radius, unloaded. Sinkage is that of a tyre's lowest point below the untouched soil. Resistance is the sum "
    "of "
    "torque/r - pull over the wheels: what the soil takes of the thrust. Energy is that of the engine. Computing is "
    "seconds of one core for a second of the car.";

/// A quantity of the results over another.
template <class X, class Y>
io::Plot plot_over(const Campaign& c, const char* title, const char* x_label, const char* y_label, X&& x, Y&& y) {
  io::Plot plot{.title = title, .x_label = x_label, .y_label = y_label, .legend = io::Legend::None};
  io::Series line{.style = io::SeriesStyle::LinePoints};
  std::string before;
  for (std::size_t k = 0; k < c.results.size(); ++k) {
    if (c.results[k].ended.empty()) continue;
    line.x.push_back(x(c.cases[k], k));
    line.y.push_back(y(c.results[k]));
    // Once for those that end alike one after the other.
    const std::string& ended = c.results[k].ended;
    if (!c.results[k].goes() && ended != before && std::isfinite(line.y.back())) {
      plot.annotations.push_back({line.x.back(), line.y.back(), ended, false});
    }
    before = ended;
  }
  plot.series = {std::move(line)};
  return plot;
}

/// Pull over slip, beside four wheels of the semi-empirical equations on a quarter of the weight each, on the first
/// soil of the lane, at the slips at which it carries them.
inline io::Plot pull_plot(const Case& of, const Result& r, const terramechanics::Wheel& wheel) {
  const terramechanics::NamedSoil& soil = of.lane[0].soil;
  io::Plot plot{.title = "Drawbar pull on " + ground_of(of), .x_label = "slip 1 - v/(ωr)", .y_label = "pull [kN]"};
  io::Series car{.name = "car on a load cell", .style = io::SeriesStyle::LinePoints};
  for (const PullPoint& p : r.pulls) car.x.push_back(p.slip), car.y.push_back(1e-3 * p.pull);
  io::Series wheels{.name = "four single wheels on " + soil.name + ", equations of Bekker and Wong",
                    .style = io::SeriesStyle::Dashed};
  for (double slip = 0.05; slip < 0.81; slip += 0.05) {
    try {
      const auto w = terramechanics::wheel_under_load(wheel, soil.soil, {slip}, 0.25 * r.weight);
      wheels.x.push_back(slip), wheels.y.push_back(4e-3 * w.pull);
    } catch (const Error&) {
      // The soil does not carry the wheel at this slip.
    }
  }
  plot.series = {std::move(car)};
  if (!wheels.x.empty()) plot.series.push_back(std::move(wheels));
  return plot;
}

/// A map of the results over the sides of a study; `columns` of them lie side by side.
template <class Value, class Text>
io::HeatMap map_of(const Campaign& c, std::string title, std::vector<double> x, std::vector<double> y, Value&& value,
                   Text&& words) {
  io::HeatMap map{.title = std::move(title), .x = std::move(x), .y = std::move(y)};
  for (const Result& r : c.results) {
    map.value.push_back(r.goes() ? value(r) : not_known);
    map.texts.push_back(r.goes() ? words(r) : r.ended.empty() ? "?" : r.ended);
  }
  return map;
}

/// The height of the soil at the end.
inline io::HeatMap rut_map(const terramechanics::ColumnField& f) {
  io::HeatMap map{.title = "Ruts", .x_label = "along the lane [m]", .y_label = "across [m]", .c_label = "height [mm]"};
  for (std::size_t ix = 0; ix < f.grid.nx; ++ix) map.x.push_back(f.grid.x(ix));
  for (std::size_t iy = 0; iy < f.grid.ny; ++iy) map.y.push_back(f.grid.y(iy));
  for (std::size_t row = 0; row < f.grid.size(); ++row) map.value.push_back(1e3 * f.surface(row));
  map.is_soil = map.same_scale = true;
  map.width = 1400, map.height = 420;
  return map;
}

/// A value over time, of the drive that is shown.
template <class Of>
io::Series line_of(const Driven& d, std::string name, int color, Of&& of) {
  io::Series line{.name = std::move(name), .color = color};
  for (const Sample& x : d.samples) line.x.push_back(x.way), line.y.push_back(of(x));
  return line;
}
/// A value of all four wheels over the way.
inline io::Plot wheel_plot(const Driven& d, double vehicle::WheelSample::*value, double scale, const char* title,
                           const char* label) {
  io::Plot plot{.title = title, .x_label = "way [m]", .y_label = label};
  for (std::size_t k = 0; k < 4; ++k) {
    plot.series.push_back(line_of(d, vehicle::corner_names[k], static_cast<int>(k),
                                  [&](const Sample& x) { return scale * x.wheels[k].*value; }));
  }
  return plot;
}

}  // namespace dem::rig::mobility
