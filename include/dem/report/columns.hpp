#pragma once
// Rows of numbers under named columns, kept to be plotted: what a mbd::Recorder samples, or any other table.

#include <dem/core/error.hpp>
#include <dem/report/plot_data.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::io {

/// Keeps rows, and turns any two columns into a curve of a plot:
///
///     Columns rows(recorder.columns());
///     ... while running: if (recorder.is_due(machine.time(), 0.01)) rows.row(recorder.sample());
///     plot.series = {rows.series("time_s", "hinge_turn_rad"), rows.series("time_s", "hinge_force_z_N")};
class Columns {
 public:
  explicit Columns(std::vector<std::string> names) : names_(std::move(names)), values_(names_.size()) {}

  /// Adds a row. Throws dem::Error unless it has a number for each column.
  void row(std::span<const double> numbers) {
    if (numbers.size() != names_.size()) {
      fail("a row of {} numbers was given for {} columns; give one for each", numbers.size(), names_.size());
    }
    for (std::size_t k = 0; k < numbers.size(); ++k) values_[k].push_back(numbers[k]);
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::size_t rows() const { return values_.empty() ? 0 : values_.front().size(); }

  /// All numbers of a column. Throws dem::Error, with the columns that there are, for another name.
  [[nodiscard]] const std::vector<double>& column(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) return values_[static_cast<std::size_t>(found - names_.begin())];
    std::string known;
    for (const std::string& n : names_) known += (known.empty() ? "" : ", ") + n;
    fail("no column is named '{}'; there are: {}", name, known);
  }

  /// The curve of column y over column x; `look` gives its style, and its name in the legend (the column's if empty).
  [[nodiscard]] Series series(std::string_view x, std::string_view y, Series look = {}) const {
    look.x = column(x);
    look.y = column(y);
    if (look.name.empty()) look.name = std::string(y);
    return look;
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<double>> values_;
};

}  // namespace dem::io
