#pragma once
// Grains of any shape for ParaView (.vtp): each drawn with the mesh of its species.

#include <dem/core/ids.hpp>
#include <dem/io/grain_mesh.hpp>
#include <dem/io/vtk_bodies.hpp>

namespace dem::io {

/// Writes all grains of a world as meshes, `divisions` cells along an edge (each ball or superquadric has 6 n^2 quads:
/// mind the size of the file), with the cell arrays "body" (index in world.grains()), "grain" (the grain's number, as
/// in write_vtk_contacts), "species", "speed" [m/s] and, where grains may sleep, "asleep" (1 or 0). Shapes of your own
/// need a grain_mesh(shape, divisions) beside them. Throws dem::Error as write_vtk_bodies does.
template <class World>
void write_vtk_grains(const std::filesystem::path& path, const World& world, int divisions = 4,
                      const VtkOptions& options = {}) {
  require_within(divisions, 1, 26, "number of divisions that grains are drawn with");
  std::vector<SurfaceMesh> meshes;
  for (const auto& species : world.state().species) meshes.push_back(grain_mesh(species.shape, divisions));
  std::vector<BodyMesh> grains;
  std::vector<std::uint32_t> numbers;
  std::vector<std::int32_t> kinds, asleep;
  std::vector<double> speeds;
  for (const GrainId p : world.grains()) {
    const std::size_t species = world.species_of(p).index();
    grains.push_back({&meshes[species], world.position(p), world.rotation(p)});
    numbers.push_back(p.value);
    kinds.push_back(static_cast<std::int32_t>(species));
    speeds.push_back(world.velocity(p).norm());
    if constexpr (requires { world.is_asleep(p); }) asleep.push_back(world.is_asleep(p) ? 1 : 0);
  }
  std::vector<BodyData> arrays = {{"grain", 1, std::span<const std::uint32_t>(numbers)},
                                  {"species", 1, std::span<const std::int32_t>(kinds)},
                                  {"speed", 1, std::span<const double>(speeds)}};
  if constexpr (requires { world.state().options.sleep; }) {
    if (world.state().options.sleep) arrays.push_back({"asleep", 1, std::span<const std::int32_t>(asleep)});
  }
  write_vtk_bodies(path, grains, arrays, options);
}

}  // namespace dem::io
