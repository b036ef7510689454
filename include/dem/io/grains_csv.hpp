#pragma once
// All grains of a world as a table.

#include <dem/core/ids.hpp>
#include <dem/io/csv.hpp>
#include <dem/math/vector.hpp>

#include <filesystem>

namespace dem::io {

/// Writes a row for each grain of a world, in the order of world.grains(): its number, its species, mass, centre of
/// mass, velocity, angular velocity (global axes) and the radius of the sphere around its centre that it lies in. As
/// many digits as read back as the very same numbers; fewer by options.digits. Throws dem::Error as CsvWriter does.
///
///     write_grains_csv("bed.csv", world);
template <class World>
void write_grains_csv(const std::filesystem::path& path, const World& world, const CsvOptions& options = {}) {
  CsvWriter csv(path,
                {"grain", "species", "mass_kg", "x_m", "y_m", "z_m", "velocity_x_m_per_s", "velocity_y_m_per_s",
                 "velocity_z_m_per_s", "angular_velocity_x_rad_per_s", "angular_velocity_y_rad_per_s",
                 "angular_velocity_z_rad_per_s", "bounding_radius_m"},
                options);
  for (const GrainId p : world.grains()) {
    const SpeciesId kind = world.species_of(p);
    const auto& species = world.species(kind);
    const Vec3 x = world.position(p), v = world.velocity(p), w = world.angular_velocity(p);
    csv.row(p.value, kind.value, species.mass, x.x(), x.y(), x.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z(),
            species.shape.bounding_radius());
  }
  csv.close();
}

}  // namespace dem::io
