#pragma once

#include <dem/io/csv.hpp>
#include <dem/io/file.hpp>
#include <dem/terramechanics/column_field.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

namespace dem::terramechanics {

/// Writes the soil's surface as a table, a row each column: x_m, y_m, height_m (of the surface without load), sunk_m
/// (what stays of the sinkage), heap_m (loose soil on top), pressure_Pa and shear_share (of the strength) when it was
/// touched last. Throws dem::Error when the file cannot be written.
inline void write_rut_csv(const std::filesystem::path& path, const ColumnField& field) {
  io::CsvWriter csv(path, {"x_m", "y_m", "height_m", "sunk_m", "heap_m", "pressure_Pa", "shear_share"}, {.digits = 7});
  const ColumnGrid& g = field.grid;
  for (std::size_t iy = 0; iy < g.ny; ++iy) {
    for (std::size_t ix = 0; ix < g.nx; ++ix) {
      const std::size_t row = g.row(ix, iy);
      csv.row(g.x(ix), g.y(iy), field.surface(row), field.sunk[row], field.heap[row], field.pressure[row],
              norm(field.shear[row].mobilised));
    }
  }
  csv.close();
}

/// Writes the soil's surface as a grey picture (PGM, 16 bits a pixel, one pixel a column, y upwards): black at the
/// lowest and white at the highest column; the heights are told in its comment. Throws dem::Error when the file cannot
/// be written.
inline void write_rut_pgm(const std::filesystem::path& path, const ColumnField& field) {
  const ColumnGrid& g = field.grid;
  double low = 1e300, high = -1e300;
  for (std::size_t row = 0; row < g.size(); ++row) {
    low = std::min(low, field.surface(row));
    high = std::max(high, field.surface(row));
  }
  const double scale = high > low ? 65535.0 / (high - low) : 0.0;
  io::AtomicFile file(path);
  file.write(fmt::format("P5\n# height in m: black {:.9g}, white {:.9g}; {:g} m a pixel\n{} {}\n65535\n", low, high,
                         g.spacing, g.nx, g.ny));
  std::string line(2 * g.nx, '\0');
  for (std::size_t iy = g.ny; iy-- > 0;) {
    for (std::size_t ix = 0; ix < g.nx; ++ix) {
      const auto grey = static_cast<unsigned>(std::lround(scale * (field.surface(g.row(ix, iy)) - low)));
      line[2 * ix] = static_cast<char>(grey >> 8);
      line[2 * ix + 1] = static_cast<char>(grey & 255u);
    }
    file.write(line);
  }
  file.commit();
}

}  // namespace dem::terramechanics
