#pragma once
// The table of what was tried, as a CSV file that a search goes on from.

#include <dem/io/csv_table.hpp>
#include <dem/rig/calibrate/trial.hpp>

#include <filesystem>
#include <string>
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
  const io::CsvTable table = io::read_csv(path);
  const std::string columns = fmt::format("{}", fmt::join(table.columns, ","));
  if (columns != tried_header(s)) {
    fail("'{}' has the columns {}, but this search has {}; give the settings that it was begun with", path.string(),
         columns, tried_header(s));
  }
  std::vector<Trial> trials;
  const auto constants = static_cast<std::ptrdiff_t>(constants_of(s).size());
  for (const auto& row : table.rows) {
    const auto values = row.begin() + 2, results = values + constants;
    trials.push_back({.point = static_cast<std::size_t>(row[0]),
                      .seed = static_cast<std::uint64_t>(row[1]),
                      .values = {values, results},
                      .results = {results, row.end()}});
  }
  return trials;
}

}  // namespace dem::rig::calibrate
