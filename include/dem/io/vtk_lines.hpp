#pragma once
// Straight lines for ParaView (.vtp).

#include <dem/core/error.hpp>
#include <dem/io/vtk_data.hpp>
#include <dem/io/vtk_file.hpp>

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace dem::io {

/// Writes straight lines with data as PolyData. `ends` [m] are the two ends of each line, x0 y0 z0 x1 y1 z1 ... Arrays
/// of `data` have one tuple a line. They are written for both ends, as ParaView's filter Tube asks: Vary Radius By
/// Absolute Scalar and an array draws lines as thick as its numbers.
///
/// The file appears complete or not at all. Throws dem::Error when it cannot be written, when `ends` is not a whole
/// number of lines, and when an array has not one tuple a line, or an empty or repeated name.
inline void write_vtk_lines(const std::filesystem::path& path, std::span<const double> ends,
                            const std::vector<DataArray>& data = {}, const VtkOptions& options = {}) {
  if (ends.size() % 6 != 0) {
    fail("vtk file '{}': ends has {} values, which is no multiple of 6; give x y z of both ends of each line",
         path.string(), ends.size());
  }
  const std::size_t n = ends.size() / 6;
  detail::check_arrays(path, data, n, "lines");
  detail::check_index_count(path, 2 * n);
  std::vector<std::int32_t> connectivity(2 * n), offsets(n);
  std::iota(connectivity.begin(), connectivity.end(), 0);
  for (std::size_t k = 0; k < n; ++k) offsets[k] = static_cast<std::int32_t>(2 * k + 2);

  detail::VtkFile file("PolyData", options);
  file.xml(
      fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" "
                  "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n",
                  2 * n, n));
  for (const DataArray& array : data) {
    std::visit(
        [&]<class T>(std::span<const T> values) {
          const auto width = static_cast<std::size_t>(array.components);
          std::vector<T> twice;
          twice.reserve(2 * values.size());
          for (std::size_t k = 0; k < 2 * n; ++k) {
            const auto tuple = values.subspan(k / 2 * width, width);
            twice.insert(twice.end(), tuple.begin(), tuple.end());
          }
          file.array(array.name, array.components, std::move(twice));
        },
        array.values);
  }
  file.xml("</PointData>\n<Points>\n");
  file.array("Points", 3, ends);
  file.xml("</Points>\n<Lines>\n");
  file.array("connectivity", 1, std::move(connectivity));
  file.array("offsets", 1, std::move(offsets));
  file.xml("</Lines>\n</Piece>\n");
  file.save(path);
}

}  // namespace dem::io
