#include "cubes.hpp"

#include <dem/domain/periodic_ranks.hpp>
#include <dem/soil/moving_patch.hpp>

#include <type_traits>
#include <vector>

namespace scenes {

namespace {

constexpr double tile_length = 16e-3, tile_width = 12e-3;  // m

template <class Model>
struct Repeated : Model {
  using Domain = std::conditional_t<Model::Domain::has_ranks, dem::domain::PeriodicRanks, dem::domain::Periodic>;
};

template <class World>
void set_up(World& world) {
  world.set_contact({.normal = {2000, 0.05, 0.05}, .friction = {0.4, 2000, 0.015, 0.975}});
  world.add_species(dem::shape::cube8(1e-3));
  world.add_surface(world.ground(), dem::surface::Plane{}, {.name = "floor"});
}

/// Of 300 cubes, which ranks share, and which still move.
template <class Model>
dem::soil::Tile tile_of_cubes() {
  dem::World<Repeated<Model>> cell(
      {.domain = {{{0, 0, -1}, {tile_length, tile_width, 1}}}, .periodic = {.x = true, .y = true}, .threads = 2});
  set_up(cell);
  pour(cell, dem::SpeciesId(0), 300, 6, 4, 2.6e-3, 0.3, 1e-3);
  run(cell, 3000);
  return dem::soil::take_tile(cell, {.stopped = false});
}

/// The rut of each patch: of the ranks, then of one process.
std::vector<double> ruts;

/// A plough flies through the bed, tiles come and go, and half-way all goes on from a state in another world.
constexpr auto flies_along = []<class Model>(std::optional<dem::SleepOptions> sleep) {
  const dem::soil::Tile tile = tile_of_cubes<Model>();
  dem::BodyId plough{};
  const auto make = [&] {
    dem::World<Model> world({.threads = threads_of<Model>(), .sleep = sleep});
    set_up(world);
    const dem::Vec3 edges(2e-3, 14e-3, 8e-3);
    plough = world.machine().add_body(
        dem::mbd::box_body("plough", edges, 8000).at({tile_length, tile_width, 36e-3}).moving({1.6, 0, -0.7}));
    world.add_surface(plough, dem::surface::Box(edges));
    return world;
  };
  const dem::soil::PatchOptions options{
      .tiles = 4, .along_y = 2, .rim = 4e-3, .ahead = 2 * tile_length, .rut_cell = 1e-3};
  dem::World<Model> first = make(), world = make();
  dem::soil::MovingPatch<Model> first_patch(first, tile, options), patch(world, tile, options);
  const auto fly = [&](auto& through, auto& with) {
    for (int k = 0; k < 16; ++k) {
      run(through, 101);
      with.follow(through, through.machine().body(plough).position().x());
    }
  };
  fly(first, first_patch);
  require(first_patch.shifts() > 0, "the patch did not go along");
  auto columns = dem::io::columns_of(first, first_patch);
  dem::io::restore(world, columns, patch);
  fly(world, patch);
  require(patch.shifts() > first_patch.shifts(), "the patch did not go on");
  double rut = 0.0;
  for (const double z : patch.surface(world).z) rut += std::isfinite(z) ? z : 0.0;
  require(rut > 0.0, "there is no rut");
  ruts.push_back(rut);
  require(!sleep || (world.asleep_count() > 0 && world.asleep_count() < world.grain_count()), "all sleep, or none");
  return world;
};

constexpr auto awake = []<class Model>() { return flies_along.template operator()<Model>({}); };
constexpr auto sleeping = []<class Model>() {
  return flies_along.template operator()<Model>(
      dem::SleepOptions{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.1, .window = 20});
};

/// A bed with turned tiles, and a drop of grains on it.
constexpr auto turned = []<class Model>() {
  dem::World<Model> world({.threads = threads_of<Model>()});
  set_up(world);
  const auto laid =
      dem::soil::lay_tiles(world, tile_of_cubes<Model>(), {.along_x = 4, .along_y = 3, .turn = 0.7, .rim = 4e-3});
  require(laid.histories > 2000 && laid.surface_histories > 100, "hardly any contact goes on");
  run(world, 50);
  dem::soil::lay_tiles(world, tile_of_cubes<Model>(), {.corner = {0.02, 0.02, 0.06}, .rim = 4e-3});  // between steps
  run(world, 500);
  return world;
};

}  // namespace

void tiles_on_one() {
  const dem::soil::Tile tile = tile_of_cubes<CubesShared>();
  dem::World<CubesShared> world;
  set_up(world);
  if (dem::processes.rank == 0) dem::soil::lay_tiles(world, tile, {.along_x = 4, .along_y = 4, .rim = 4e-3});
  run(world, 10);
}

void other_tiles() {
  const dem::soil::Tile tile = tile_of_cubes<CubesShared>();
  dem::World<CubesShared> world;
  set_up(world);
  dem::soil::lay_tiles(world, tile, {.along_x = 4, .along_y = dem::processes.rank == 0 ? 3 : 4, .rim = 4e-3});
}

void added_before_tiles() {
  const dem::soil::Tile tile = tile_of_cubes<CubesShared>();
  dem::World<CubesShared> world;
  set_up(world);
  world.add_grain({.species = dem::SpeciesId(0), .position = {0, 0, 0.1}});
  run(world, 1);
  world.add_grain({.species = dem::SpeciesId(0), .position = {0, 0, dem::processes.rank == 0 ? 0.2 : 0.21}});
  dem::soil::lay_tiles(world, tile, {.along_x = 4, .along_y = 4, .rim = 4e-3});
}

bool tiles() {
  ruts.clear();
  const bool goes = same_bits<CubesShared, CubesAlone>("patch", awake);
  const bool rests = same_bits<CubesShared, CubesAlone>("sleepers", sleeping);
  if (dem::processes.rank == 0) {
    require(ruts[0] == ruts[1] && ruts[2] == ruts[3], "the rut of ranks is not that of one process");
  }
  return same_bits<CubesShared, CubesAlone>("turned", turned) && goes && rests;
}

}  // namespace scenes
