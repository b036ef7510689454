// Beds of tiles: copies of a settled cell fit each other, and go on as the cell would.

#include "tile_beds.hpp"

#include <dem/soil/averages.hpp>
#include <dem/soil/coordination.hpp>
#include <dem/soil/lay_tiles.hpp>

#include "core/error_of.hpp"

using dem::soil::lay_tiles;
using dem::soil::take_tile;
using dem::soil::Tile;
using dem::soil::TileLayout;

namespace {

/// The most kinetic energy (J) of a grain in the mean, within 60 steps.
template <class World>
double unrest(World& w) {
  double most = 0.0;
  for (int k = 0; k < 6; ++k) {
    REQUIRE(w.run(10));
    most = std::max(most, kinetic_energy_of_a_grain(w));
  }
  return most;
}
void stop_grains(dem::World<TiledCubes>& w) {
  for (const GrainId p : w.grains()) {
    w.set_velocity(p, Vec3::Zero());
    w.set_angular_velocity(p, Vec3::Zero());
  }
}
/// The same of the cell itself, whose grains were stopped: what is left of its own settling.
double unrest_of_the_cell() {
  dem::World<TiledCubes> w = settled_cell();
  stop_grains(w);
  return unrest(w);
}

}  // namespace

TEST_CASE("a tile that is laid in a cell of its own size goes on as the bed that it was taken from") {
  dem::World<TiledCubes> from = settled_cell(), to = tiled_cell();
  Random random(7);  // it is not at rest: what it remembers has to do with where it goes
  for (const GrainId p : from.grains()) from.set_velocity(p, random.vector(0.02));
  const Tile moving = take_tile(from, {.stopped = false});
  const auto laid = lay_tiles(to, moving);
  CHECK(laid.grains == 120);
  CHECK(laid.held + laid.left_out == 0);
  CHECK(laid.histories == moving.contacts.size());
  CHECK(laid.surface_histories == moving.on_surfaces.size());
  CHECK(laid.missing.empty());
  REQUIRE(from.run(100));
  REQUIRE(to.run(100));
  // Its grains have other ids and rows: each of them is where one of the cell is. They go 20 um in that time. Sums of
  // forces are rounded in another order, places by 1e-18 m a step, which contacts enlarge.
  double farthest = 0.0;
  for (const GrainId p : to.grains()) {
    double nearest = 1.0;
    for (const GrainId q : from.grains()) {
      Vec3 apart = to.position(p) - from.position(q);
      apart.x() -= tile_length * std::round(apart.x() / tile_length);
      apart.y() -= tile_width * std::round(apart.y() / tile_width);
      nearest = std::min(nearest, apart.norm() + half_edge * (to.rotation(p) - from.rotation(q)).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  CHECK(farthest < 1e-11);
}

TEST_CASE("a bed of tiles rests as the tile itself does, with every contact's history and none without") {
  const double itself = unrest_of_the_cell();
  const Tile& tile = settled_tile();
  dem::World<TiledCubes> repeated = tiled_cell(3, 2);
  const auto laid = lay_tiles(repeated, tile, {.along_x = 3, .along_y = 2});
  CHECK(laid.histories == 6 * tile.contacts.size());
  // The same forces on each grain, but for rounding.
  CHECK(unrest(repeated) == Catch::Approx(itself).epsilon(1e-3));

  const TileLayout layout{.along_x = 3, .along_y = 3, .corner = {0.1, -0.2, 0}, .rim = 3e-3};
  dem::World<OpenCubes> open = open_ground();
  const auto in_open = lay_tiles(open, tile, layout);
  CHECK(in_open.held > 100);
  CHECK(in_open.grains == 9 * 120);
  // Those that are free have the neighbours that they have in the cell, so that no more moves than there: the share of
  // grains that are held is left out of the mean, and rounding.
  CHECK(unrest(open) < 1.2 * itself);
  for (const GrainId p : open.grains()) CHECK(open.position(p).x() > 0.1 - 1e-9);

  // Without what the contacts remember, friction has to be stretched anew.
  Tile forgetful = tile;
  forgetful.laws = "others";
  dem::World<OpenCubes> bare = open_ground();
  CHECK(lay_tiles(bare, forgetful, layout).histories == 0);
  CHECK(unrest(bare) > 20.0 * itself);
}

TEST_CASE("density, contacts and stress by place are those of the cell, at seams too") {
  const Tile& tile = settled_tile();
  dem::World<OpenCubes> w = open_ground();
  lay_tiles(w, tile, {.along_x = 4, .along_y = 4, .rim = 3e-3});
  dem::World<TiledCubes> cell = settled_cell();
  stop_grains(cell);
  REQUIRE(w.run(1));
  REQUIRE(cell.run(1));
  // Slices of an eighth of a tile, over the four inner tiles, beside those of the cell.
  const double x = tile_length, y = tile_width, top = 8e-3;
  double coordination = 0.0;
  for (const int axis : {0, 1}) {
    const auto laid = dem::soil::average_slices(w, {{x, y, 0}, {3 * x, 3 * y, top}}, axis, 16);
    const auto settled = dem::soil::average_slices(cell, {{0, 0, 0}, {x, y, top}}, axis, 8);
    for (std::size_t k = 0; k < 16; ++k) {
      CAPTURE(axis, k);
      const dem::soil::Average &a = laid[k], &b = settled[k % 8];
      CHECK(b.solid_fraction > 0.3);
      CHECK(a.solid_fraction == Catch::Approx(b.solid_fraction).epsilon(1e-12));
      CHECK(a.coordination == Catch::Approx(b.coordination).epsilon(1e-12));
      CHECK((a.stress() - b.stress()).norm() < 1e-6 * b.stress().norm());
      coordination += a.coordination / 32;
    }
  }
  // What the tile says of itself; the slices leave out the uppermost grains.
  CHECK(coordination == Catch::Approx(tile.coordination).epsilon(0.1));
  const double by_search = dem::soil::coordination(settled_cell()).mean();
  CHECK(tile.coordination == Catch::Approx(by_search));
  CHECK(tile.fabric.trace() == Catch::Approx(1.0));
  CHECK(tile.solid_fraction > 0.5);
  CHECK(tile.solid_fraction < 1.0);
}

TEST_CASE("a bed that is turned as a whole rests too, and has the tile's density everywhere") {
  const Tile& tile = settled_tile();
  const double itself = unrest_of_the_cell();
  dem::World<OpenCubes> w = open_ground();
  const auto laid = lay_tiles(w, tile, {.along_x = 4, .along_y = 4, .turn = 0.7, .rim = 3e-3});
  // As many grains as on as much ground; those of the ground's border count at random: some tenth of them is there,
  // 200, whose square root is 14.
  CHECK(std::abs(static_cast<double>(laid.grains) - 16 * 120) < 3 * 14);
  CHECK(unrest(w) < 1.2 * itself);

  Tile forgetful = tile;  // that friction is turned with it is no matter of rounding
  for (double& x : forgetful.histories) x = -x;
  dem::World<OpenCubes> wrong = open_ground();
  lay_tiles(wrong, forgetful, {.along_x = 4, .along_y = 4, .turn = 0.7, .rim = 3e-3});
  CHECK(unrest(wrong) > 20.0 * itself);
}

TEST_CASE("without a rim no grain reaches over the border of the bed") {
  dem::World<OpenCubes> w = open_ground();
  const auto laid = lay_tiles(w, settled_tile(), {.along_x = 2, .along_y = 2});
  CHECK(laid.held == 0);
  CHECK(laid.left_out > 20);
  CHECK(laid.grains + laid.left_out == 4 * 120);
  const double r = w.species(SpeciesId(0)).shape.bounding_radius();
  for (const GrainId p : w.grains()) {
    CHECK(w.position(p).x() >= r);
    CHECK(w.position(p).x() <= 2 * tile_length - r);
    CHECK(w.position(p).y() >= r);
    CHECK(w.position(p).y() <= 2 * tile_width - r);
  }
}

TEST_CASE("tiles that are laid between two steps leave the other grains as they were, for any number of threads") {
  const auto run = [](int threads, bool lays) {
    dem::World<OpenCubes> w = open_ground(threads);
    add_block(w, SpeciesId(0), Vec3(0.2, 0.2, 2e-3), 2.5e-3, 4, 4, 4, 0.3);
    REQUIRE(w.run(500));
    if (lays) {
      lay_tiles(w, settled_tile(), {.along_x = 3, .along_y = 2, .rim = 3e-3});
      CHECK(w.is_prepared() == false);  // the rim is a species more: constants are looked at again, nothing else
    }
    REQUIRE(w.run(500));
    return w;
  };
  const auto with = run(1, true), threads = run(3, true), without = run(1, false);
  for (const GrainId p : with.grains()) {
    CHECK(with.position(p) == threads.position(p));
    CHECK(with.velocity(p) == threads.velocity(p));
  }
  for (const GrainId p : without.grains()) {
    CAPTURE(p.value);
    CHECK((with.position(p) - without.position(p)).norm() < 1e-12);  // sums are in the order of rows, which changed
  }
}

TEST_CASE("tiles that do not fit are refused in words") {
  const Tile& tile = settled_tile();
  dem::World<OpenCubes> open = open_ground();
  check_refused([&] { lay_tiles(open, tile, {.along_x = 0}); }, "0 tiles along x");
  check_refused([&] { lay_tiles(open, tile, {.rim = 1e-3}); }, "rim", "0.001 m", "at least");
  check_refused([&] { lay_tiles(open, tile, {.corner = {HUGE_VAL, 0, 0}}); }, "corner");
  dem::World<TiledCubes> cell = tiled_cell(2, 1);
  check_refused([&] { lay_tiles(cell, tile, {.along_x = 3}); }, "3 tiles of 0.016 m are 0.048 m long in x", "0.032 m");
  check_refused([&] { lay_tiles(cell, tile, {.along_x = 2, .turn = 0.1}); }, "turned by 0.1 rad");
  dem::World<OpenCubes> other(options({0, 0, -g}));
  check_refused([&] { lay_tiles(other, tile); }, "1 species, but the world 0");
  other.add_species(dem::shape::cube8(2 * half_edge));
  check_refused([&] { lay_tiles(other, tile); }, "species 0 of a tile", "kg");
  CHECK(open.grain_count() + cell.grain_count() + other.grain_count() == 0);
  check_refused([&] { take_tile(cell); }, "without grains");
  Tile broken = tile;
  broken.contacts[0].j = 120;
  check_refused([&] { lay_tiles(open, broken); }, "no tile", "contact");

  // A floor of another name takes no part in it, and the report says so.
  dem::World<OpenCubes> renamed(options({0, 0, -g}, 1e-5));
  set_up_tiled(renamed, "base");
  const auto laid = lay_tiles(renamed, tile, {.rim = 3e-3});
  CHECK(laid.missing == std::vector<std::string>{"floor"});
  CHECK(laid.surface_histories == 0);
}
