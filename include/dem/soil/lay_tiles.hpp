#pragma once

#include <dem/soil/tile_layer.hpp>

#include <numbers>

namespace dem::soil {

/// A bed of tiles.
struct TileLayout {
  int along_x = 1, along_y = 1;  ///< how many; 1 where the tile does not repeat itself
  Vec3 corner = Vec3::Zero();    ///< m, lower corner of the bed; z is added to the heights of the tile
  double turn = 0.0;             ///< rad, about z: see lay_tiles
  double rim = 0.0;              ///< m, width of the border whose grains are held where the bed ends; 0: there is none
};

/// What was laid.
struct LaidTiles {
  std::size_t grains = 0;                 ///< all that were laid
  std::size_t held = 0;                   ///< of these, in the rim
  std::size_t left_out = 0;               ///< those that would have reached over a border
  std::size_t histories = 0;              ///< contacts that go on: points between grains
  std::size_t surface_histories = 0;      ///< and on surfaces
  std::vector<std::string> missing = {};  ///< surfaces that grains of the tile lie on and the world does not have
};

namespace detail {

/// How tiles lie in a world. Throws Error where they do not fit.
template <class Model>
TileLayer<Model> layer_of(World<Model>& world, const Tile& tile, const TileLayout& o) {
  check_species(world.state(), tile);
  if (!is_finite(o.corner)) fail("the corner of a bed of tiles is not finite");
  require_non_negative(o.rim, "rim of a bed of tiles", "m");
  TileLayer<Model> l{world.state(), tile, from_eigen(o.corner), o.turn, {}, {}, {o.along_x, o.along_y}, {}};
  const double corner[] = {o.corner.x(), o.corner.y()};
  for (std::size_t k = 0; k < 2; ++k) {
    const char axis = "xy"[k];
    const int n = l.cells[k];
    const double period = tile.period[k], length = n * period;
    if (n < 1 || n > 1'000'000) fail("a bed has {} tiles along {}, but must have 1 to 1,000,000", n, axis);
    if (period == 0.0) {
      if (n != 1) fail("a bed has {} tiles along {}, but the tile does not repeat itself there: lay 1", n, axis);
      continue;
    }
    l.ground.low[k] = corner[k], l.ground.high[k] = corner[k] + length;
    l.ground.is_open[k] = true;
    if constexpr (Model::Domain::has_images) {
      const double of_world = world.state().domain.period()[k];
      if (of_world > 0.0 && !(std::abs(of_world - length) <= 1e-9 * length)) {
        fail("{} tiles of {:g} m are {:g} m long in {}, but the world repeats itself every {:g} m there", n, period,
             length, axis, of_world);
      }
      l.wraps[k] = of_world > 0.0;
      l.ground.is_open[k] = !l.wraps[k];
    }
  }
  if (o.turn != 0.0) {
    if (!(std::abs(o.turn) <= 2.0 * std::numbers::pi)) fail("a bed is turned by {:g} rad, but by 2 pi at most", o.turn);
    if (!(tile.period[0] > 0.0 && tile.period[1] > 0.0) || l.wraps[0] || l.wraps[1]) {
      fail(
          "a bed is turned by {:g} rad, but only a tile that repeats itself along x and y can be turned, in a world "
          "that does along neither",
          o.turn);
    }
  }
  double radius = 0.0;
  for (const TileSpecies& s : tile.species) radius = std::max(radius, s.radius);
  const double least = 2.0 * radius;  // what touches a grain beyond the border is held
  l.ground.rim = o.rim;
  if (o.rim > 0.0 && (l.ground.is_open[0] || l.ground.is_open[1])) {
    if (o.rim < least) fail("the rim of a bed of tiles is {:g} m, but must be at least {:g} m, a grain", o.rim, least);
    for (std::size_t k = 0; k < tile.species.size(); ++k) l.twins.push_back(held_twin(world, SpeciesId(k)));
  }
  return l;
}

}  // namespace detail

/// Lays a bed of tiles in a world: along_x times along_y copies, each in its place, with what their contacts remember,
/// those across the seams too. So the bed is at rest at once. To be called when species, surfaces and contact constants
/// are there, before or between steps; grains and machine that are there already go on as they were.
///
/// Where the world repeats itself, the bed must be as long as the cell. Where the tile has walls, the world needs the
/// same, of the same names. Elsewhere the bed ends in the open: grains of the rim are held, so that it stands by itself
/// and nothing has to settle; without a rim, grains that reach over the border are left out, so that walls fit there,
/// and the border settles a little.
///
/// Copies of a tile that are turned or mirrored one by one do not fit each other. What fits is the whole bed turned
/// about z, cut by the ground along x and y: a lane along x then meets the tile again only after sqrt(p^2 + q^2)
/// periods of a square tile, with tan(turn) = p/q, or never.
///
/// Where ranks share the grains, all ranks call it at once, between runs (not in goes_on() of one). A bed that was laid
/// and saved is loaded by a program that adds the held species of its rim as well: held_twin().
///
/// Takes 40 bytes and a history a contact while it runs. Throws Error where tile, world and layout do not go together.
template <class Model>
LaidTiles lay_tiles(World<Model>& world, const Tile& tile, const TileLayout& o = {}) {
  auto layer = detail::layer_of(world, tile, o);
  WorldState<Model>& w = world.state();
  int a0 = 0, a1 = o.along_x, b0 = 0, b1 = o.along_y;
  if (o.turn != 0.0) {  // the cells that the ground meets
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    const double c = std::cos(o.turn), s = std::sin(o.turn);
    for (const double x : {0.0, o.along_x * tile.period[0]}) {
      for (const double y : {0.0, o.along_y * tile.period[1]}) {
        const double in_bed[2] = {(c * x + s * y) / tile.period[0], (c * y - s * x) / tile.period[1]};
        for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], in_bed[k]), high[k] = std::max(high[k], in_bed[k]);
      }
    }
    const auto down = [](double x) { return static_cast<int>(std::floor(x)); };
    a0 = down(low[0]), a1 = down(high[0]) + 1, b0 = down(low[1]), b1 = down(high[1]) + 1;
  }
  const double most = static_cast<double>(a1 - a0) * (b1 - b0) * static_cast<double>(tile.grains.size());
  if (most > 4e9) fail("a bed of {:g} grains is more than ids can name, 4e9; lay fewer tiles", most);
  w.materials.find_range(w.largest_radius);
  check_period(w);
  detail::TileIds ids(a0, a1 - a0, b0, b1 - b0, tile.grains.size());
  const auto asked = [&] { return detail::asked_of(tile, o.along_x, o.along_y, o.corner, o.turn, o.rim); };
  relist(w, asked, [&](grain::HistoryCarrier<Model>& histories) {
    layer.lay(ids, a0, a1);
    layer.remember(ids, histories);
  });
  LaidTiles result{layer.laid, layer.held, layer.left_out, layer.histories, layer.surface_histories, {}};
  for (std::size_t s = 0; s < tile.surfaces.size(); ++s) {
    const bool used = std::any_of(tile.on_surfaces.begin(), tile.on_surfaces.end(),
                                  [&](const TileSurfaceContact& c) { return c.surface == s; });
    if (used && layer.find_surface(tile.surfaces[s]) < 0) result.missing.push_back(tile.surfaces[s]);
  }
  return result;
}

}  // namespace dem::soil
