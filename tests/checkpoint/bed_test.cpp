// A bed that was made and saved is loaded in place of being made, as soil::Bed promises.

#include "scenes_to_save.hpp"

#include <dem/soil/bed.hpp>

namespace {

using models::Balls;

struct BedOfBalls {
  dem::World<Balls> world;
  SpeciesId ball;
  dem::soil::Bed<Balls> bed;

  explicit BedOfBalls(int threads)
      : world({.time_step = 1.5e-5, .threads = threads}),
        ball([this] {
          world.set_contact({{2000.0, 0.05, 1.0}, {0.5, 1000.0, 0.02, 1.0}});
          return world.add_species(Sphere(1e-3));
        }()),
        bed(world, dem::soil::Container::cylinder(0.0085), ball,
            {.height = 0.01, .lid_pressure = 100.0, .lid_speed = 0.2, .time_limit = 2.0}) {}
  /// A ball is dropped on it.
  void drop() {
    world.add_grain({.species = ball, .position = {1e-3, 0, 0.012}, .velocity = {0.05, 0, -0.3}});
    REQUIRE(world.run(1500));
  }
};

}  // namespace

TEST_CASE("a bed that was saved is loaded in place of being made, and goes on in the same bits") {
  const Folder folder;
  BedOfBalls made(2), loaded(3);
  made.bed.make();
  dem::save(made.world, folder / "bed.h5");
  dem::load(loaded.world, folder / "bed.h5");
  CHECK(difference(made.world, loaded.world) == "");
  CHECK(loaded.bed.solid_fraction() == made.bed.solid_fraction());
  for (auto* bed : {&made, &loaded}) bed->drop();
  CHECK(difference(made.world, loaded.world) == "");
  CHECK(made.world.grain_count() > 200);
}
