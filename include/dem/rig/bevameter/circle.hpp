#pragma once
// The wheel in the grains beside what the constants of their soil predict.

#include <dem/io/csv.hpp>
#include <dem/report/plot_data.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/bevameter/tables.hpp>
#include <dem/rig/rigid_wheel/columns.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::bevameter {

using terramechanics::WheelForces;

/// What the constants say of the wheel at each of its runs; none where the soil does not carry it.
struct Prediction {
  const char* name;
  std::vector<std::optional<WheelForces>> at_runs;
};
using Predictions = std::array<Prediction, 3>;

/// By Bekker and Wong, by Reece and Wong, and on columns of Bekker's soil (dynamic Bekker), which takes some seconds.
inline Predictions predict(const Constants& c, const rigid_wheel::Campaign& w, const rigid_wheel::Settings& s) {
  std::vector<rigid_wheel::Reference> on_columns{{.name = "", .soil = c.bekker_soil}};
  rigid_wheel::roll_on_columns(on_columns, w, s);
  Predictions list{{{"Bekker", {}}, {"Reece", {}}, {"dynamic Bekker", std::move(on_columns.front().on_columns)}}};
  for (const auto& r : w.slips) {
    list[0].at_runs.push_back(reference_at(c.bekker_soil, r.slip, s));
    list[1].at_runs.push_back(reference_at(c.reece_soil, r.slip, s));
  }
  return list;
}

/// A quantity of the wheel: of the grains, and as predicted.
struct Compared {
  const char* name;
  const char* unit;
  MeanAndDeviation rigid_wheel::SlipResult::*grains;
  double WheelForces::*predicted;
  double scale;
  const char* format;

  /// In its unit; NaN where the soil does not carry the wheel.
  [[nodiscard]] double of(const std::optional<WheelForces>& f) const {
    return f ? scale * (*f).*predicted : std::nan("");
  }
};
inline constexpr Compared compared[] = {
    {"pull", "N", &rigid_wheel::SlipResult::pull, &WheelForces::pull, 1.0, "{:.1f}"},
    {"torque", "N m", &rigid_wheel::SlipResult::torque, &WheelForces::torque, 1.0, "{:.2f}"},
    {"sinkage", "mm", &rigid_wheel::SlipResult::sinkage, &WheelForces::sinkage, 1e3, "{:.1f}"}};

/// The bed that the wheel rolls in, beside that of the plates.
inline std::string beds_text(const plate_sinkage::VariantResult& plates, const rigid_wheel::Campaign& w) {
  return text(
      "The wheel rolls in a bed of its own of the same grains: solid fraction {}, {} mm deep; that of the plates has "
      "{}, {} mm.",
      number(w.solid_fraction, "{:.3f}"), number(1e3 * w.level, "{:.1f}"), number(plates.solid_fraction, "{:.3f}"),
      number(1e3 * plates.level, "{:.1f}"));
}

/// Pull, torque and sinkage of the wheel in the grains, what is predicted, and by how much it errs, at each slip.
inline io::Table circle_table(const Predictions& predictions, const rigid_wheel::Campaign& w) {
  io::Table t{
      .caption =
          "The wheel in another bed of the same grains, and what the constants predict; slip s = 1 - v/(omega r)",
      .header = {"slip", "steady", "quantity", "grains", "± in time"}};
  for (const Prediction& p : predictions) t.header.insert(t.header.end(), {p.name, "error"});
  t.header.push_back("unit");
  for (std::size_t k = 0; k < w.slips.size(); ++k) {
    const auto& r = w.slips[k];
    for (const Compared& q : compared) {
      const double grains = q.scale * (r.*q.grains).mean, deviation = q.scale * (r.*q.grains).deviation;
      const bool first = &q == compared;
      std::vector<std::string> row{first ? number(r.slip) : "", first ? (r.is_steady ? "yes" : "no") : "", q.name,
                                   number(grains, q.format), number(deviation, q.format)};
      for (const Prediction& p : predictions) {
        const double value = q.of(p.at_runs[k]);
        row.push_back(number(value, q.format)), row.push_back(number(value - grains, q.format));
      }
      row.push_back(q.unit);
      t.rows.push_back(std::move(row));
    }
  }
  return t;
}

/// The same as a file.
inline void write_predicted(const std::filesystem::path& path, const Predictions& predictions,
                            const rigid_wheel::Campaign& w) {
  io::CsvWriter csv(
      path, {"slip_1-v/(omega*r)", "quantity", "grains", "deviation", "steady", "bekker", "reece", "dynamic_bekker"});
  for (std::size_t k = 0; k < w.slips.size(); ++k) {
    const auto& r = w.slips[k];
    for (const Compared& q : compared) {
      const auto of = [&](std::size_t p) { return q.of(predictions[p].at_runs[k]); };
      csv.row(r.slip, text("{} [{}]", q.name, q.unit), cell(q.scale * (r.*q.grains).mean),
              cell(q.scale * (r.*q.grains).deviation), r.is_steady, cell(of(0)), cell(of(1)), cell(of(2)));
    }
  }
  csv.flush();
}

/// One of these quantities over slip: Bekker's and Reece's as lines, dynamic Bekker at the slips of the runs.
inline io::Plot circle_plot(const Constants& c, const Predictions& predictions, const rigid_wheel::Campaign& w,
                            const rigid_wheel::Settings& s, const Compared& q) {
  io::Plot plot{.title = text("{} over slip", q.name),
                .x_label = "slip s = 1 - v/(ω r)",
                .y_label = text("{} [{}]", q.name, q.unit)};
  io::Series points{.name = "grains", .style = io::SeriesStyle::LinePoints, .color = 0};
  io::Series low{.name = "± standard deviation in time", .style = io::SeriesStyle::Dotted, .color = 0}, high = low;
  high.name = "";
  io::Series columns{.name = "dynamic Bekker", .style = io::SeriesStyle::Points, .color = 1};
  for (std::size_t k = 0; k < w.slips.size(); ++k) {
    const MeanAndDeviation& m = w.slips[k].*q.grains;
    if (!std::isfinite(m.mean)) continue;
    for (io::Series* line : {&points, &low, &high, &columns}) line->x.push_back(w.slips[k].slip);
    points.y.push_back(q.scale * m.mean);
    low.y.push_back(q.scale * (m.mean - m.deviation));
    high.y.push_back(q.scale * (m.mean + m.deviation));
    columns.y.push_back(q.of(predictions[2].at_runs[k]));
  }
  for (auto* line : {&points, &low, &high}) plot.series.push_back(*line);
  const double room = std::max(0.02, 0.05 * (s.slips.back() - s.slips.front()));  // so that no point lies on the frame
  plot.x_range = {.min = s.slips.front() - room, .max = s.slips.back() + room};
  int color = 1;
  for (const auto& [name, soil] :
       {std::pair{"Bekker and Wong", &c.bekker_soil}, std::pair{"Reece and Wong", &c.reece_soil}}) {
    io::Series line{.name = name, .style = io::SeriesStyle::Dashed, .color = color++};
    for (int k = 0; k <= 40; ++k) {
      const double slip = s.slips.front() + 0.025 * k * (s.slips.back() - s.slips.front());
      const auto f = reference_at(*soil, slip, s);
      if (!f) continue;
      line.x.push_back(slip);
      line.y.push_back(q.of(f));
    }
    plot.series.push_back(std::move(line));
  }
  plot.series.push_back(std::move(columns));
  return plot;
}

}  // namespace dem::rig::bevameter
