#pragma once

#include <dem/io/vtk_data.hpp>
#include <dem/io/vtk_file.hpp>
#include <dem/io/vtk_series.hpp>
#include <dem/terramechanics/column_field.hpp>

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::terramechanics {

/// Writes the soil's surface for ParaView (.vtp): a point in the middle of each column and squares between them, with
/// sunk_m, heap_m, pressure_Pa and shear_share (of the strength) when it was touched last. Throws dem::Error when the
/// file cannot be written.
inline void write_rut_vtk(const std::filesystem::path& path, const ColumnField& field,
                          const io::VtkOptions& options = {.single_precision = true}) {
  const ColumnGrid& g = field.grid;
  if (g.nx < 2 || g.ny < 2)
    fail("vtk file '{}': {} x {} columns make no surface; at least 2 x 2 do", path.string(), g.nx, g.ny);
  io::detail::check_index_count(path, 4 * g.size());
  std::vector<double> points, share;
  points.reserve(3 * g.size());
  share.reserve(g.size());
  std::vector<std::int32_t> corners, ends;
  for (std::size_t iy = 0; iy < g.ny; ++iy) {
    for (std::size_t ix = 0; ix < g.nx; ++ix) {
      const std::size_t row = g.row(ix, iy);
      points.insert(points.end(), {g.x(ix), g.y(iy), field.surface(row)});
      share.push_back(norm(field.shear[row].mobilised));
      if (ix + 1 == g.nx || iy + 1 == g.ny) continue;
      for (const std::size_t corner : {row, row + 1, row + g.nx + 1, row + g.nx}) {
        corners.push_back(static_cast<std::int32_t>(corner));
      }
      ends.push_back(static_cast<std::int32_t>(corners.size()));
    }
  }
  io::detail::VtkFile file("PolyData", options);
  file.xml(
      fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                  "NumberOfPolys=\"{}\">\n"
                  "<PointData>\n",
                  g.size(), ends.size()));
  file.array(io::PointData{"sunk_m", 1, field.sunk});
  file.array(io::PointData{"heap_m", 1, field.heap});
  file.array(io::PointData{"pressure_Pa", 1, field.pressure});
  file.array("shear_share", 1, std::move(share));
  file.xml("</PointData>\n<Points>\n");
  file.array("Points", 3, std::move(points));
  file.xml("</Points>\n<Polys>\n");
  file.array("connectivity", 1, std::move(corners));
  file.array("offsets", 1, std::move(ends));
  file.xml("</Polys>\n</Piece>\n");
  file.save(path);
}

/// Adds the soil as it is at a time (s) to a series, as `part`: beside the frames of its world and machine.
inline void add_vtk_frame(io::VtkSeries& series, double time, const ColumnField& field,
                          std::string_view part = "soil") {
  const auto path = series.next_path(part);
  write_rut_vtk(path, field, {.single_precision = true, .time_s = time});
  series.add(time, path, part);
}

}  // namespace dem::terramechanics
