#pragma once

#include <dem/io/csv_table.hpp>
#include <dem/vehicle/driver.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace dem::vehicle {

/// What a driver does as a table over time, whatever the car does: straight lines between the rows, the first and the
/// last row held before and after. Two rows of the same time are a step.
class OpenLoop {
 public:
  struct Row {
    double time = 0.0;                              ///< s
    double throttle = 0.0, brake = 0.0, steer = 0;  ///< 0 to 1, 0 to 1, rad to the left
  };

  OpenLoop() = default;  ///< no table
  /// Throws Error for no rows, times that fall, and values out of range.
  explicit OpenLoop(std::vector<Row> rows) : rows_(std::move(rows)) {
    if (rows_.empty()) fail("inputs of a driver have no rows, but need at least one");
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Row& row = rows_[k];
      if (const char* wrong = wrong_in(row)) fail("row {} of a driver's inputs: {}", k + 1, wrong);
      if (k > 0 && row.time < rows_[k - 1].time) {
        fail("row {} of a driver's inputs has the time {:g} s after {:g} s: times must not fall; sort the rows", k + 1,
             row.time, rows_[k - 1].time);
      }
    }
  }

  [[nodiscard]] bool empty() const { return rows_.empty(); }
  /// s, of the last row.
  [[nodiscard]] double end() const { return rows_.empty() ? 0.0 : rows_.back().time; }

  /// At a time (s).
  [[nodiscard]] Controls operator()(double time) const {
    const auto after =
        std::upper_bound(rows_.begin(), rows_.end(), time, [](double t, const Row& row) { return t < row.time; });
    const Row& q = after == rows_.end() ? rows_.back() : *after;
    const Row& p = after == rows_.begin() ? q : *std::prev(after);
    const double share = q.time > p.time ? std::clamp((time - p.time) / (q.time - p.time), 0.0, 1.0) : 1.0;
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    return {.throttle = between(p.throttle, q.throttle),
            .brake = between(p.brake, q.brake),
            .steer = between(p.steer, q.steer)};
  }

  /// A run that goes on must have the same table: throws Error for another one.
  template <class V>
  void fields(V& v) {
    std::vector<double> mine;
    for (const Row& r : rows_) mine.insert(mine.end(), {r.time, r.throttle, r.brake, r.steer});
    std::vector<double> saved = mine;
    v("rows", saved);
    if (saved != mine) fail("the inputs of the driver are others than those that the run began with; give these again");
  }

 private:
  static const char* wrong_in(const Row& row) {
    if (!std::isfinite(row.time)) return "its time is not finite";
    if (!(row.throttle >= 0.0 && row.throttle <= 1.0)) return "its throttle must be from 0 to 1";
    if (!(row.brake >= 0.0 && row.brake <= 1.0)) return "its brake must be from 0 to 1";
    if (!(std::abs(row.steer) <= 0.8)) return "its steer must be from -0.8 to 0.8 rad, positive to the left";
    return nullptr;
  }

  std::vector<Row> rows_;
};

/// Inputs from a CSV file with the columns time_s, throttle, brake and steer_rad, in any order and among others: the
/// telemetry of a drive drives another car the same way. A drive begins at the time 0 and ends with the last row.
/// Throws Error, with the file and what to mend.
[[nodiscard]] inline OpenLoop read_inputs(const std::filesystem::path& path) {
  const io::CsvTable table = io::read_csv(path);
  const std::size_t time = table.column("time_s"), throttle = table.column("throttle"), brake = table.column("brake"),
                    steer = table.column("steer_rad");
  std::vector<OpenLoop::Row> rows;
  for (const auto& r : table.rows) rows.push_back({r[time], r[throttle], r[brake], r[steer]});
  try {
    OpenLoop inputs(std::move(rows));
    if (!(inputs.end() > 0.0)) fail("inputs of a driver end at {:g} s, but a drive begins at 0 s", inputs.end());
    return inputs;
  } catch (const Error& e) {
    fail("'{}': {}", path.string(), e.what());
  }
}

}  // namespace dem::vehicle
