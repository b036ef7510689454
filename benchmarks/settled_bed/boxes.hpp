#pragma once

// Beds that differ in nothing but their number of grains: boxes beside each other, filled alike.

#include "works.hpp"

#include <cmath>

namespace bench {

inline constexpr int grains_a_box = 4000, per_row = 10;

/// Gravity that makes a bed slide to a corner of its box.
inline dem::Vec3 tilted() { return 9.81 * dem::Vec3(0.5, 0.5, -std::sqrt(0.5)); }

/// Boxes that share their walls, filled one after the other until there are so many grains.
template <class Model>
dem::World<Model> boxes(const dem::World<Model>& one, std::size_t grains, double width, const Settings& settings) {
  dem::World<Model> world = empty_world<Model>(settings);
  if (settings.flow) world.set_gravity(tilted());
  const std::vector<dem::GrainId> ids = one.grains();
  const auto count = static_cast<double>((grains + ids.size() - 1) / ids.size());
  const double nx = std::ceil(std::sqrt(count)), ny = std::ceil(count / nx);
  const double thick = 0.02, high = 0.3, pitch = width + thick;
  const auto wall = [&](const dem::Vec3& middle, const dem::Vec3& edges) {
    world.add_surface(world.ground(), dem::surface::Box(edges), {.position = middle});
  };
  const double lx = nx * pitch + thick, ly = ny * pitch + thick;  // walls included; the first box begins at 0
  const dem::Vec3 middle(lx / 2 - thick, ly / 2 - thick, 0);
  wall(middle - dem::Vec3(0, 0, thick / 2), {lx, ly, thick});
  for (double k = 0; k <= nx; ++k) wall({k * pitch - thick / 2, middle.y(), high / 2}, {thick, ly, high});
  for (double k = 0; k <= ny; ++k) wall({middle.x(), k * pitch - thick / 2, high / 2}, {lx, thick, high});
  for (std::size_t k = 0; k < grains; ++k) {
    const dem::GrainId from = ids[k % ids.size()];
    const auto box = static_cast<double>(k / ids.size());
    const dem::Vec3 corner(pitch * std::fmod(box, nx), pitch * std::floor(box / nx), 0);
    world.add_grain({.species = dem::SpeciesId(0),
                     .position = one.position(from) + corner,
                     .velocity = one.velocity(from),
                     .rotation = one.rotation(from),
                     .angular_velocity = one.angular_velocity(from)});
  }
  return world;
}

}  // namespace bench
