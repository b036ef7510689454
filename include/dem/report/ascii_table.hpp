#pragma once
// Tables on a terminal.

#include <dem/io/text.hpp>
#include <dem/report/table.hpp>
#include <dem/report/terminal.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace dem::io {

namespace detail {

inline std::string align_cell(std::string_view text, int width, Align align) {
  if (align == Align::Right) return pad_left(text, width);
  if (align == Align::Center) return pad_right(pad_left(text, (width + display_width(text)) / 2), width);
  return pad_right(text, width);
}

}  // namespace detail

/// `table` as lines of text with aligned columns, a rule under the header, and the caption above:
///
///     angle [deg]  stress [kPa]  packing
///     -----------  ------------  -------
///            25.1         101.3  loose
///
/// No line ends in a space; every line ends in '\n'. Throws dem::Error for a row of wrong length.
[[nodiscard]] inline std::string to_text(const Table& table) {
  check_table(table);
  const std::size_t columns = table.header.size();
  std::vector<int> width(columns);
  std::vector<Align> align(columns);
  for (std::size_t c = 0; c < columns; ++c) {
    width[c] = display_width(table.header[c]);
    for (const auto& row : table.rows) width[c] = std::max(width[c], display_width(row[c]));
    align[c] = column_align(table, c);
  }

  std::string text;
  const auto add_line = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t c = 0; c < columns; ++c) {
      line += (c == 0 ? "" : "  ") + detail::align_cell(one_line(cells[c]), width[c], align[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  };

  if (!table.caption.empty()) text += one_line(table.caption) + '\n';
  add_line(table.header);
  std::vector<std::string> rule(columns);
  for (std::size_t c = 0; c < columns; ++c) rule[c].assign(static_cast<std::size_t>(width[c]), '-');
  add_line(rule);
  for (const auto& row : table.rows) add_line(row);
  return text;
}

/// Prints to_text(table) to `out`. Returns false if it could not be written, as show_text() does.
inline bool print(const Table& table, std::FILE* out = stdout) { return show_text(out, to_text(table)); }

}  // namespace dem::io
