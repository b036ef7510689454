#pragma once

#include <dem/io/vtk_file.hpp>
#include <dem/io/vtk_points.hpp>
#include <dem/soil/average.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace dem::soil {

/// Writes averages for ParaView with the arrays "density" [kg/m^3], "solid_fraction", "coordination", "velocity" [m/s],
/// "stress" [Pa] (nine numbers by rows), "pressure" [Pa] and "temperature" [(m/s)^2]: a file that ends in ".vti" has
/// the cells themselves (image data, which slices and volumes are drawn of), any other (.vtp) points, one in the middle
/// of each cell. Throws dem::Error as write_vtk_points does.
inline void write_vtk_averages(const std::filesystem::path& path, const Averages& field,
                               const io::VtkOptions& options = {}) {
  std::vector<double> places, density, solid, coordination, velocity, stress, pressure, temperature;
  for (int k = 0; k < field.grid.cells[2]; ++k) {
    for (int j = 0; j < field.grid.cells[1]; ++j) {
      for (int i = 0; i < field.grid.cells[0]; ++i) {
        const Average& a = field.at(i, j, k);
        const Vec3 x = field.grid.middle(i, j, k);
        const Mat3 s = a.stress();
        places.insert(places.end(), x.data(), x.data() + 3);
        velocity.insert(velocity.end(), a.velocity.data(), a.velocity.data() + 3);
        for (int n = 0; n < 9; ++n) stress.push_back(s(n / 3, n % 3));
        density.push_back(a.density);
        solid.push_back(a.solid_fraction);
        coordination.push_back(a.coordination);
        pressure.push_back(a.pressure());
        temperature.push_back(a.temperature());
      }
    }
  }
  const auto all = [](const std::vector<double>& v) { return std::span<const double>(v); };
  const std::vector<io::DataArray> arrays = {
      {"density", 1, all(density)},        {"solid_fraction", 1, all(solid)}, {"coordination", 1, all(coordination)},
      {"velocity", 3, all(velocity)},      {"stress", 9, all(stress)},        {"pressure", 1, all(pressure)},
      {"temperature", 1, all(temperature)}};
  if (path.extension() != ".vti") return io::write_vtk_points(path, places, arrays, options);
  const AverageGrid& g = field.grid;
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", g.cells[0], g.cells[1], g.cells[2]);
  io::detail::VtkFile file("ImageData", options,
                           fmt::format(" WholeExtent=\"{}\" Origin=\"{} {} {}\" Spacing=\"{} {} {}\"", extent,
                                       g.box.low.x(), g.box.low.y(), g.box.low.z(), g.edge(0), g.edge(1), g.edge(2)));
  file.xml(fmt::format("<Piece Extent=\"{}\">\n<CellData>\n", extent));
  for (const io::DataArray& array : arrays) file.array(array);
  file.xml("</CellData>\n</Piece>\n");
  file.save(path);
}

}  // namespace dem::soil
