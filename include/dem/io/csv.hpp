#pragma once
// Tables of numbers as CSV files.

#include <dem/core/error.hpp>
#include <dem/io/duration.hpp>
#include <dem/io/file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace dem::io {

struct CsvOptions {
  int digits = 0;      ///< significant digits; 0: as few as read back as the very same number
  double flush_s = 2;  ///< rows reach the disk at the latest so many seconds after being written; 0: at once
  char separator = ',';
};

/// `text` as one CSV cell (RFC 4180): in quotes when it holds a separator, a quote, a line end or outer spaces.
[[nodiscard]] inline std::string csv_quote(std::string_view text, char separator = ',') {
  const bool outer_space = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  const bool special = text.find_first_of("\"\r\n") != std::string_view::npos || text.find(separator) != text.npos;
  if (!special && !outer_space) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

/// What a CSV cell can be made from: a number, a bool (1, 0), or text.
template <class T>
concept CsvCell = std::is_arithmetic_v<T> || std::convertible_to<T, std::string_view>;

/// Writes a CSV file row by row: a header line, '\n' as line end, '.' as decimal point, "nan" and "inf" as they are.
/// Rows are flushed every few seconds, so that an interrupted run keeps its data.
///
///     CsvWriter csv("out/shear.csv", {"time_s", "displacement_m", "stress_Pa"});
///     csv.row(t, u, stress);
///
/// Everything throws dem::Error: a file that cannot be opened or written (the folder is made when missing), no
/// columns, an empty or repeated column name, a row whose length is not that of the header.
class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& path, std::vector<std::string> columns, CsvOptions options = {})
      : columns_((check_columns(path, columns), std::move(columns))), options_(options), file_(path) {
    begin_row(columns_.size());
    for (const auto& name : columns_) add_cell(name);
    end_row();
    flush();
  }

  /// One row of numbers and texts.
  template <CsvCell... Cells>
  void row(const Cells&... cells) {
    begin_row(sizeof...(cells));
    (add_cell(cells), ...);
    end_row();
    rows_ += 1;
  }

  /// One row of numbers, e.g. of a std::vector or std::array.
  void row(std::span<const double> cells) {
    begin_row(cells.size());
    for (const double cell : cells) add_cell(cell);
    end_row();
    rows_ += 1;
  }

  /// Hands all rows to the system now.
  void flush() {
    file_.flush();
    flush_time_ = steady_seconds();
  }

  /// Rows written, without the header.
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  static void check_columns(const std::filesystem::path& path, const std::vector<std::string>& columns) {
    if (columns.empty()) fail("csv file '{}': no columns; name at least one, e.g. \"time_s\"", path.string());
    for (auto name = columns.begin(); name != columns.end(); ++name) {
      if (name->empty()) {
        fail("csv file '{}': column {} has an empty name; name it, with its unit", path.string(),
             name - columns.begin());
      }
      if (std::find(columns.begin(), name, *name) != name) {
        fail("csv file '{}': the column '{}' is named twice; rename one", path.string(), *name);
      }
    }
  }

  void begin_row(std::size_t cells) {
    line_.clear();
    if (cells != columns_.size()) {
      std::string names;
      for (const auto& name : columns_) names += (names.empty() ? "" : ", ") + name;
      fail("csv file '{}': a row has {} cells, but there are {} columns ({}); give one cell a column", path().string(),
           cells, columns_.size(), names);
    }
  }

  template <CsvCell T>
  void add_cell(const T& cell) {
    // Not fmt::format_to, which would have every program compile fmt's own formatting anew.
    if constexpr (std::floating_point<T>) {
      if (options_.digits > 0) {
        line_ += fmt::format("{:.{}g}", cell, options_.digits);
      } else {
        line_ += fmt::format("{}", cell);  // shortest text that reads back as the same number
      }
    } else if constexpr (std::same_as<T, bool>) {
      line_ += cell ? '1' : '0';
    } else if constexpr (std::is_arithmetic_v<T>) {
      line_ += fmt::format("{}", cell);
    } else {
      line_ += csv_quote(cell, options_.separator);
    }
    line_ += options_.separator;
  }

  void end_row() {
    line_.back() = '\n';  // in place of the last separator
    file_.write(line_);
    if (steady_seconds() - flush_time_ >= options_.flush_s) flush();
  }

  std::vector<std::string> columns_;
  CsvOptions options_;
  OutputFile file_;
  std::string line_;
  std::size_t rows_ = 0;
  double flush_time_ = 0;
};

}  // namespace dem::io
