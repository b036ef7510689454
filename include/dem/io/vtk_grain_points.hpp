#pragma once
// Grains as points for ParaView (.vtp): what is known of each, in little room.

#include <dem/core/ids.hpp>
#include <dem/io/vtk_points.hpp>
#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace dem::io {

/// Writes every grain of a world as a point at its centre of mass, in the order of world.grains(). Arrays: "grain" (its
/// number, as in write_vtk_grains and write_vtk_contacts), "species", "mass_kg", "bounding_radius_m" (of the sphere
/// around its centre that it lies in), "velocity_m_s", "angular_velocity_rad_s", "quaternion_wxyz" (from the grain's
/// axes to global ones), "net_contact_force_N" and, where grains may sleep, "asleep" (1 or 0). `more` are arrays of
/// your own, one tuple a grain in the same order.
///
/// In single precision positions are good to a two-thousandth of the largest radius, turns to 0.06 degrees, speeds and
/// forces to three digits: as much as is seen. Quaternions are to be normalised by who reads them. Throws dem::Error as
/// write_vtk_points does.
template <class World>
void write_vtk_grain_points(const std::filesystem::path& path, const World& world, const VtkOptions& options = {},
                            const std::vector<PointData>& more = {}) {
  const auto grains = world.grains();
  const std::size_t n = grains.size();
  std::vector<Vec3> position(n), velocity(n), spin(n), force(n);
  std::vector<double> quaternion, mass(n), radius(n);
  std::vector<std::uint32_t> number(n);
  std::vector<std::int32_t> kind(n);
  std::vector<std::uint8_t> asleep;
  quaternion.reserve(4 * n);
  double largest = 1e-300;
  for (std::size_t i = 0; i < n; ++i) {
    const GrainId p = grains[i];
    const SpeciesId species = world.species_of(p);
    const Quaternion q(world.rotation(p));
    number[i] = p.value;
    kind[i] = static_cast<std::int32_t>(species.value);
    mass[i] = world.species(species).mass;
    radius[i] = world.species(species).shape.bounding_radius();
    position[i] = world.position(p);
    velocity[i] = world.velocity(p);
    spin[i] = world.angular_velocity(p);
    force[i] = world.force(p);
    largest = std::max(largest, radius[i]);
    quaternion.insert(quaternion.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  constexpr Rounding three_digits = {.bits = 10}, of_turn = {.step = 0x1p-11};
  std::vector<PointData> data = {{"grain", 1, number},
                                 {"species", 1, kind},
                                 {"mass_kg", 1, mass},
                                 {"bounding_radius_m", 1, radius},
                                 {"velocity_m_s", 3, flat(velocity), three_digits},
                                 {"angular_velocity_rad_s", 3, flat(spin), three_digits},
                                 {"quaternion_wxyz", 4, quaternion, of_turn},
                                 {"net_contact_force_N", 3, flat(force), three_digits}};
  if constexpr (requires(GrainId p) { world.is_asleep(p); }) {
    if (world.state().options.sleep) {
      for (const GrainId p : grains) asleep.push_back(world.is_asleep(p) ? 1 : 0);
      data.push_back({"asleep", 1, asleep});
    }
  }
  data.insert(data.end(), more.begin(), more.end());
  VtkOptions own = options;
  own.position_rounding.step = std::exp2(std::floor(std::log2(largest)) - 11.0);
  write_vtk_points(path, flat(position), data, own);
}

}  // namespace dem::io
