#pragma once
// Tables of numbers as CSV files.

#include <dem/core/error.hpp>
#include <dem/io/duration.hpp>
#include <dem/io/file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

namespace dem::io {

struct CsvOptions {
  int digits = 0;      ///< significant digits; 0: as few as read back as the very same number
  double flush_s = 2;  ///< rows reach the disk at the latest so many seconds after being written; 0: at once
  char separator = ',';

  /// A file that is there goes on: its rows whose first cell, a time or another number that grows, is at most this
  /// stay, and later ones are dropped. `digits` must tell the times of rows apart. Not a number: the file is written
  /// anew.
  ///
  ///     dem::load(world, "half.h5");
  ///     io::CsvWriter csv("force.csv", {"time_s", "force_N"}, {.goes_on_after = world.time()});
  double goes_on_after = std::numeric_limits<double>::quiet_NaN();
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
/// Rows are flushed every few seconds, so that an interrupted run keeps its data. close() it at the end: a destructor
/// cannot throw, and only warns on stderr of a full disk.
///
///     CsvWriter csv("out/shear.csv", {"time_s", "displacement_m", "stress_Pa"});
///     csv.row(t, u, stress);
///     csv.close();
///
/// Everything throws dem::Error: a file that cannot be opened or written (the folder is made when missing), no
/// columns, an empty or repeated column name, a row whose length is not that of the header or that comes after close(),
/// a file to go on with that has other columns.
class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& path, std::vector<std::string> columns, CsvOptions options = {})
      : columns_((check_columns(path, columns), std::move(columns))), options_(options), file_(path, keep_rows(path)) {
    if (is_new_) file_.write(header());
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

  /// Ends the file: throws if not all rows could be written.
  void close() { file_.close(); }

  /// Rows in the file, without the header.
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

  [[nodiscard]] std::string header() const {
    std::string line;
    for (const auto& name : columns_) line += csv_quote(name, options_.separator) + options_.separator;
    line.back() = '\n';  // in place of the last separator
    return line;
  }

  /// Drops from an earlier file the rows that come again, and a last one that was cut off.
  WriteFrom keep_rows(const std::filesystem::path& path) {
    if (std::isnan(options_.goes_on_after) || !process_writes_files || !std::filesystem::exists(path)) {
      return WriteFrom::start;
    }
    const std::string old = read_file(path), names = header();
    if (old.empty()) return WriteFrom::start;
    if (old.starts_with(names.substr(0, names.size() - 1) + "\r\n")) {
      fail("csv file '{}' cannot go on: its lines end with CR LF, not LF; convert it, or give it another name",
           path.string());
    }
    if (!old.starts_with(names)) {
      fail("csv file '{}' cannot go on: its columns are '{}', not '{}'; give it another name, or move it away",
           path.string(), old.substr(0, old.find('\n')), names.substr(0, names.size() - 1));
    }
    std::size_t end = names.size();
    for (std::size_t next = 0; (next = end_of_row(old, end)) != old.npos; end = next + 1) {
      if (!comes_first(std::string_view(old).substr(end, next - end), path)) break;
      rows_ += 1;
    }
    write_file(path, std::string_view(old).substr(0, end));
    is_new_ = false;
    return WriteFrom::end;
  }

  /// Where the line ends that is not within quotes.
  [[nodiscard]] static std::size_t end_of_row(std::string_view text, std::size_t from) {
    bool is_quoted = false;
    for (; from < text.size(); ++from) {
      if (text[from] == '"') is_quoted = !is_quoted;
      if (text[from] == '\n' && !is_quoted) return from;
    }
    return text.npos;
  }
  /// Whether a row is of no later than goes_on_after; a cell may have been rounded up.
  [[nodiscard]] bool comes_first(std::string_view row, const std::filesystem::path& path) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(row.data(), row.data() + row.size(), value);
    if (error != std::errc() || std::isnan(value)) {
      fail("csv file '{}' cannot go on: its row '{}' does not begin with a number", path.string(), row);
    }
    return value <= options_.goes_on_after || std::string_view(row.data(), end) == text_of(options_.goes_on_after);
  }

  /// As a cell. Not fmt::format_to, which would have every program compile fmt's own formatting anew.
  template <std::floating_point T>
  [[nodiscard]] std::string text_of(T number) const {
    if (std::isnan(number)) return "nan";  // whatever its sign
    if (options_.digits > 0) return fmt::format("{:.{}g}", number, options_.digits);
    return fmt::format("{}", number);  // shortest text that reads back as the same number
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
    if constexpr (std::floating_point<T>) {
      line_ += text_of(cell);
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
  std::size_t rows_ = 0;
  bool is_new_ = true;
  OutputFile file_;
  std::string line_;
  double flush_time_ = 0;
};

}  // namespace dem::io
