#pragma once
// A table of results, to be shown on a terminal (ascii_table.hpp) or in a report (html_report.hpp).

#include <dem/core/error.hpp>
#include <dem/io/number.hpp>

#include <fmt/format.h>

#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace dem::io {

/// Where the text of a column stands. Auto: right when all cells read as numbers, else left.
enum class Align { Auto, Left, Right, Center };

/// What a cell can be made from: text, a number, or a bool ("yes", "no").
template <class T>
concept TableCell = std::is_arithmetic_v<T> || std::convertible_to<T, std::string_view>;

/// Rows of text under a header; units belong into the header ("stress [kPa]").
///
///     Table table{.header = {"angle [deg]", "stress [kPa]", "packing"}};
///     table.row(25.1, 101.325, "loose");
struct Table {
  std::string caption = {};
  std::vector<std::string> header = {};
  std::vector<Align> align = {};  ///< one a column; missing ones are Auto
  int digits = 4;                 ///< significant digits that row() keeps of a floating-point cell
  std::vector<std::vector<std::string>> rows = {};

  /// Adds a row, one cell a column. Throws dem::Error when the number of cells is not that of the header.
  template <TableCell... Cells>
  Table& row(const Cells&... cells) {
    if (sizeof...(cells) != header.size()) {
      fail("table '{}': a row has {} cells, but the header has {}; give one cell a column", caption, sizeof...(cells),
           header.size());
    }
    rows.push_back({cell_text(cells)...});
    return *this;
  }

 private:
  template <class T>
  [[nodiscard]] std::string cell_text(const T& cell) const {
    if constexpr (std::same_as<T, bool>) {
      return cell ? "yes" : "no";
    } else if constexpr (std::floating_point<T>) {
      return format_number(static_cast<double>(cell), digits);
    } else if constexpr (std::is_arithmetic_v<T>) {
      return fmt::format("{}", cell);
    } else {
      return std::string(std::string_view(cell));
    }
  }
};

/// Throws dem::Error when a row of `table` has not one cell a column.
inline void check_table(const Table& table) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].size() != table.header.size()) {
      fail("table '{}': row {} has {} cells, but the header has {}; give one cell a column", table.caption, i,
           table.rows[i].size(), table.header.size());
    }
  }
}

/// The alignment of a column with Auto resolved: Left, Right or Center.
[[nodiscard]] inline Align column_align(const Table& table, std::size_t column) {
  if (column < table.align.size() && table.align[column] != Align::Auto) return table.align[column];
  bool any_number = false;
  for (const auto& row : table.rows) {
    const std::string& cell = row[column];
    const bool blank = cell.empty() || cell == "-" || cell == "\xE2\x80\x93" || cell == "\xE2\x80\x94";  // – and —
    if (blank) continue;
    if (!looks_numeric(cell)) return Align::Left;
    any_number = true;
  }
  return any_number ? Align::Right : Align::Left;
}

}  // namespace dem::io
