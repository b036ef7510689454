// Tiles in files, and patches of them that go on from a file.

#include "scenes_to_save.hpp"
#include "soil/tile_beds.hpp"

#include <dem/soil/moving_patch.hpp>
#include <dem/soil/tile_file.hpp>

#include "core/error_of.hpp"

#include <cstring>
#include <fstream>

using dem::soil::MovingPatch;
using dem::soil::Tile;

namespace {

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("a tile comes back from its file in every bit") {
  const Folder folder;
  const Tile& tile = settled_tile();
  dem::soil::save_tile(tile, folder / "tile.h5");
  const Tile back = dem::soil::load_tile(folder / "tile.h5");
  CHECK(back.period == tile.period);
  REQUIRE(back.grains.size() == tile.grains.size());
  CHECK(std::memcmp(back.grains.data(), tile.grains.data(), tile.grains.size() * sizeof(tile.grains[0])) == 0);
  REQUIRE(back.contacts.size() == tile.contacts.size());
  CHECK(std::memcmp(back.contacts.data(), tile.contacts.data(), tile.contacts.size() * sizeof(tile.contacts[0])) == 0);
  CHECK(back.on_surfaces.size() == tile.on_surfaces.size());
  CHECK(same_bits(back.histories, tile.histories));
  CHECK(same_bits(back.surface_histories, tile.surface_histories));
  CHECK(back.surfaces == tile.surfaces);
  CHECK(back.laws == tile.laws);
  CHECK(back.fabric == tile.fabric);
  CHECK(back.in_words() == tile.in_words());

  // A saved world is no tile.
  dem::save(settled_cell(), folder / "world.h5");
  check_refused([&] { dem::soil::load_tile(folder / "world.h5"); }, "cannot load the tile", "tile");
  check_refused([&] { dem::soil::load_tile(folder / "none.h5"); }, "no such file");
}

TEST_CASE("a patch goes on from a file in every bit") {
  const Folder folder;
  const dem::soil::PatchOptions o{
      .tiles = 4, .along_y = 1, .rim = 3e-3, .ahead = 1.2 * tile_length, .rut_cell = half_edge};
  const auto go = [](auto& world, auto& patch, int from, int to) {
    for (int k = from; k < to; ++k) {
      if (k == 5) patch.double_length();
      patch.follow(world, 1.5 * tile_length + 0.6 * k * tile_length);
      patch.note(k);
      REQUIRE(world.run(15));
    }
  };
  dem::World<OpenCubes> whole = open_ground(1), first = open_ground(2), second = open_ground(3);
  MovingPatch<OpenCubes> of_whole(whole, settled_tile(), o), of_first(first, settled_tile(), o),
      of_second(second, settled_tile(), o);
  go(whole, of_whole, 0, 14);
  go(first, of_first, 0, 7);
  dem::save(first, folder / "state.h5", of_first);
  dem::load(second, folder / "state.h5", of_second);
  Tile other = settled_tile();
  other.grains.back().position.z += 1e-9;
  dem::World<OpenCubes> third = open_ground(1);
  MovingPatch<OpenCubes> of_third(third, other, o);
  check_refused([&] { dem::load(third, folder / "state.h5", of_third); }, "its tile in this program differs");
  CHECK(difference(first, second) == "");
  go(second, of_second, 7, 14);
  CHECK(difference(whole, second) == "");
  CHECK(of_second.front() == of_whole.front());
  CHECK(of_second.back() == of_whole.back());
  CHECK(of_second.shifts() == of_whole.shifts());
  CHECK(of_second.rut().z.size() == of_whole.rut().z.size());
  CHECK(std::memcmp(of_second.rut().z.data(), of_whole.rut().z.data(), of_whole.rut().z.size() * sizeof(double)) == 0);
  CHECK(of_second.length_effect().shift() == of_whole.length_effect().shift());
}
