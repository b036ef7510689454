#pragma once
// The table of what was tried, as a CSV file that a search goes on from.

#include <dem/io/file.hpp>
#include <dem/rig/calibrate/trial.hpp>
#include <dem/rig/option_text.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dem::rig::calibrate {

/// The columns: point, seed, the constants and the quantities by their names.
inline std::string tried_header(const Settings& s) {
  std::string line = "point,seed";
  for (const Constant c : constants_of(s)) line += text(",{}", names_of_constants[static_cast<int>(c)]);
  for (const Quantity q : quantities_of(s)) line += text(",{}", names_of_quantities[static_cast<int>(q)]);
  return line;
}

/// Writes the table anew, so that a run that is killed leaves a whole one. Numbers read back the same.
inline void save_tried(const std::filesystem::path& path, const Settings& s, const std::vector<Trial>& trials) {
  std::string lines = tried_header(s) + "\n";
  for (const Trial& t : trials) {
    lines += text("{},{}", t.point, t.seed);
    for (const double v : t.values) lines += text(",{}", v);
    for (const double v : t.results) lines += text(",{}", v);
    lines += "\n";
  }
  io::write_file(path, lines);
}

/// Reads the table. Throws Error, with the line, for one of other columns, and for what is no number.
inline std::vector<Trial> load_tried(const std::filesystem::path& path, const Settings& s) {
  const std::string all = io::read_file(path);
  std::string_view rest = all;
  std::vector<Trial> trials;
  const std::size_t constants = constants_of(s).size(), columns = 2 + constants + quantities_of(s).size();
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (number == 1) {
      if (line != tried_header(s)) {
        fail("'{}' has the columns {}, but this search has {}; give the settings that it was begun with", path.string(),
             line, tried_header(s));
      }
      continue;
    }
    std::vector<double> cells;
    for (std::size_t from = 0; from <= line.size();) {
      const std::size_t to = std::min(line.find(',', from), line.size());
      double value = 0.0;
      if (!rig::detail::read_number(line.substr(from, to - from), value)) {
        fail("'{}', line {}: '{}' is no number; mend or remove the line", path.string(), number,
             line.substr(from, to - from));
      }
      cells.push_back(value);
      from = to + 1;
    }
    if (cells.size() != columns) {
      fail("'{}', line {}: {} numbers, but there are {} columns; mend or remove the line", path.string(), number,
           cells.size(), columns);
    }
    Trial t;
    t.point = static_cast<std::size_t>(cells[0]);
    t.seed = static_cast<std::uint64_t>(cells[1]);
    t.values.assign(cells.begin() + 2, cells.begin() + 2 + static_cast<std::ptrdiff_t>(constants));
    t.results.assign(cells.begin() + 2 + static_cast<std::ptrdiff_t>(constants), cells.end());
    trials.push_back(std::move(t));
  }
  return trials;
}

}  // namespace dem::rig::calibrate
