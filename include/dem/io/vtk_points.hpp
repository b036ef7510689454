#pragma once
// Points for ParaView (.vtp).

#include <dem/core/error.hpp>
#include <dem/io/vtk_data.hpp>
#include <dem/io/vtk_file.hpp>

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <span>
#include <vector>

namespace dem::io {

/// Writes points with data as PolyData, one vertex cell a point. `positions` [m] are x0 y0 z0 x1 y1 z1 ...
///
/// A grain made of N spheres is written as N points with an array "radius". ParaView then shows the true shape with
/// the representation Point Gaussian, Gaussian Radius 1, Scale By Array "radius" and Use Scale Function off. An array
/// of grain numbers, or of anything else, colours the grains.
///
/// The file appears complete or not at all. Throws dem::Error when it cannot be written, when `positions` is not a
/// whole number of points, and when an array has not one tuple a point, or an empty or repeated name.
inline void write_vtk_points(const std::filesystem::path& path, std::span<const double> positions,
                             const std::vector<PointData>& data = {}, const VtkOptions& options = {}) {
  if (positions.size() % 3 != 0) {
    fail("vtk file '{}': positions has {} values, which is no multiple of 3; give x y z of each point", path.string(),
         positions.size());
  }
  const std::size_t n = positions.size() / 3;
  detail::check_arrays(path, data, n, "points");
  detail::check_index_count(path, n);

  std::vector<std::int32_t> connectivity(n), offsets(n);
  std::iota(connectivity.begin(), connectivity.end(), 0);
  std::iota(offsets.begin(), offsets.end(), 1);

  detail::VtkFile file("PolyData", options);
  file.xml(
      fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" "
                  "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n",
                  n));
  for (const PointData& array : data) file.array(array);
  file.xml("</PointData>\n<Points>\n");
  file.array("Points", 3, positions, options.position_rounding);
  file.xml("</Points>\n<Verts>\n");
  file.array("connectivity", 1, connectivity);
  file.array("offsets", 1, offsets);
  file.xml("</Verts>\n</Piece>\n");
  file.save(path);
}

}  // namespace dem::io
