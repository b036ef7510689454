#pragma once

#include <dem/io/file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::io {

/// A CSV file of numbers under a line of names, as CsvWriter makes it.
struct CsvTable {
  std::filesystem::path path;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< as many cells as there are columns

  /// Index of the column of this name. Throws Error, with the names that there are.
  [[nodiscard]] std::size_t column(std::string_view name) const {
    const auto found = std::find(columns.begin(), columns.end(), name);
    if (found == columns.end()) {
      fail("'{}' has no column '{}', but has {}", path.string(), name, fmt::format("{}", fmt::join(columns, ", ")));
    }
    return static_cast<std::size_t>(found - columns.begin());
  }
};

namespace detail {

inline std::string_view without_spaces(std::string_view cell) {
  constexpr std::string_view spaces = " \t\r";
  const std::size_t first = cell.find_first_not_of(spaces);
  return first == cell.npos ? std::string_view() : cell.substr(first, cell.find_last_not_of(spaces) - first + 1);
}

/// f(cell, index) for the cells of a line, without outer spaces.
template <class F>
void each_cell(std::string_view line, F&& f) {
  for (std::size_t from = 0, index = 0; from <= line.size(); ++index) {
    const std::size_t to = std::min(line.find(',', from), line.size());
    f(without_spaces(line.substr(from, to - from)), index);
    from = to + 1;
  }
}

/// Where the first such character stands that is not within quotes; the length of the text if there is none. Quotes
/// begin where a cell does; elsewhere they are as other characters.
inline std::size_t find_unquoted(std::string_view text, char wanted) {
  bool is_quoted = false, may_begin = true;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == wanted && !is_quoted) return k;
    if (c == '"' && (is_quoted || may_begin)) {
      is_quoted = !is_quoted;
      may_begin = true;  // again, where it is twice
    } else if (c != ' ' && c != '\t') {
      may_begin = c == ',';
    }
  }
  return text.size();
}

/// The names in a header line, some of which may be in quotes. Throws Error where quotes do not end.
inline std::vector<std::string> split_header(std::string_view line, const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (bool goes_on = true; goes_on;) {
    const std::size_t end = find_unquoted(line, ',');
    std::string_view cell = without_spaces(line.substr(0, end));
    goes_on = end < line.size();
    line.remove_prefix(goes_on ? end + 1 : end);
    std::string name(cell);
    if (cell.starts_with('"')) {
      if (cell.size() < 2 || !cell.ends_with('"')) {
        fail("'{}': the name of a column begins with a quote, but does not end with one: {}", path.string(),
             cell.substr(0, 40));
      }
      name.clear();
      for (std::size_t k = 1; k + 1 < cell.size(); ++k) {
        name += cell[k];
        if (cell[k] == '"') ++k;  // it is twice there
      }
    }
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace detail

/// Reads a table of numbers. Cells are divided by commas; only names of columns may be in quotes. Empty lines are
/// passed over; "nan" and "inf" are numbers. Throws Error, with the line, for a cell that is no number and a row of
/// another length.
[[nodiscard]] inline CsvTable read_csv(const std::filesystem::path& path) {
  const std::string all = read_file(path);
  std::string_view rest = all;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // a byte order mark, as spreadsheets write it
  CsvTable table{.path = path, .columns = {}, .rows = {}};
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const bool is_header = table.columns.empty();
    const std::string_view line = rest.substr(0, is_header ? detail::find_unquoted(rest, '\n') : rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (detail::without_spaces(line).empty()) continue;
    if (is_header) {
      for (std::string& name : detail::split_header(line, path)) {
        if (std::find(table.columns.begin(), table.columns.end(), name) != table.columns.end()) {
          fail("'{}' has two columns '{}'", path.string(), name);
        }
        table.columns.push_back(std::move(name));
      }
      continue;
    }
    std::vector<double> row;
    detail::each_cell(line, [&](std::string_view cell, std::size_t index) {
      double value = 0.0;
      const std::string_view digits = cell.substr(cell.starts_with('+') ? 1 : 0);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) {
        fail("'{}', line {}, column {}: '{}' is no number", path.string(), number,
             index < table.columns.size() ? table.columns[index] : fmt::format("{}", index + 1), cell);
      }
      row.push_back(value);
    });
    if (row.size() != table.columns.size()) {
      fail("'{}', line {}: {} numbers, but there are {} columns", path.string(), number, row.size(),
           table.columns.size());
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace dem::io
