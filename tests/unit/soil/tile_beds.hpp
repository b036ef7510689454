#pragma once

// What the tests of tiles share: a small bed of cubes that settled in a cell which repeats itself.

#include "world/scenes.hpp"

#include <dem/soil/tile.hpp>

using TiledCubes = models::PeriodicVerletCubes;
using OpenCubes = models::VerletCubes;

inline constexpr double tile_length = 16e-3, tile_width = 12e-3, half_edge = 1e-3;  // m

template <class World>
void set_up_tiled(World& w, const char* floor = "floor") {
  w.set_contact(sand<typename World::Model>());
  w.add_species(dem::shape::cube8(half_edge));
  w.add_surface(w.ground(), dem::surface::Plane{}, {.name = floor});
}
/// A cell of so many tiles, without grains.
inline dem::World<TiledCubes> tiled_cell(int along_x = 1, int along_y = 1, int threads = 1) {
  dem::WorldOptions o = options({0, 0, -g}, 1e-5);
  o.domain = dem::surface::Aabb{{0, 0, -1}, {along_x * tile_length, along_y * tile_width, 1}};
  o.periodic = {.x = true, .y = true};
  o.threads = threads;
  dem::World<TiledCubes> w(o);
  set_up_tiled(w);
  return w;
}
inline dem::World<OpenCubes> open_ground(int threads = 1) {
  dem::WorldOptions o = options({0, 0, -g}, 1e-5);
  o.threads = threads;
  dem::World<OpenCubes> w(o);
  set_up_tiled(w);
  return w;
}
/// 120 cubes that have come to rest.
inline const dem::World<TiledCubes>& settled_cell() {
  static const dem::World<TiledCubes> settled = [] {
    dem::World<TiledCubes> w = tiled_cell();
    add_block(w, SpeciesId(0), Vec3(1.3e-3, 1.2e-3, 1.5e-3), 2.6e-3, 6, 4, 5, 0.1);
    for (int k = 0; k < 200; ++k) REQUIRE(w.run(100));
    return w;
  }();
  return settled;
}
inline const dem::soil::Tile& settled_tile() {
  static const dem::soil::Tile tile = dem::soil::take_tile(settled_cell());
  return tile;
}
/// J, mean over the grains that are free to move.
template <class World>
double kinetic_energy_of_a_grain(const World& w) {
  double sum = 0.0, count = 0.0;
  for (const GrainId p : w.grains()) {
    if (w.species(w.species_of(p)).is_held()) continue;
    sum += 0.5 * mass_of(w, p) * w.velocity(p).squaredNorm();
    count += 1.0;
  }
  return sum / count;
}
