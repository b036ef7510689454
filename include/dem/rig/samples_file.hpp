#pragma once

#include <dem/io/csv.hpp>
#include <dem/rig/samples.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace dem::rig {

/// Writes rows to a CSV file, with so many significant digits (0: as many as read back the same). Throws Error if it
/// cannot be written.
template <class Row>
void save_samples(const std::filesystem::path& path, std::span<const Row> rows, std::span<const Column<Row>> columns,
                  int digits = 7) {
  std::vector<std::string> names;
  for (const Column<Row>& c : columns) names.emplace_back(c.name);
  io::CsvWriter csv(path, names, {.digits = digits});
  std::vector<double> cells(columns.size());
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < columns.size(); ++k) cells[k] = row.*columns[k].value;
    csv.row(cells);
  }
  csv.flush();  // so that a full disk is noticed
}

}  // namespace dem::rig
