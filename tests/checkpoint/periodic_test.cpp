// A periodic bed goes on from a file as if there had been none: images of grains are part of its state.

#include "scenes_to_save.hpp"

#include <dem/domain/sheared.hpp>

namespace {

using models::PeriodicCubes;

struct ShearedCubes : models::Cubes {
  using Domain = dem::domain::Sheared;
};

dem::World<PeriodicCubes> bed(int threads, int layers) {
  dem::WorldOptions o = options({2.0, 0, -9.81}, 1e-5);
  o.domain = dem::surface::Aabb{{0, 0, -1}, {0.03, 0.03, 1}};
  o.periodic = {.x = true, .y = true};
  o.threads = threads;
  dem::World<PeriodicCubes> w(o);
  w.set_contact(sand<PeriodicCubes>(0.4));
  w.add_species(dem::shape::cube8(1e-3));
  w.add_surface(w.ground(), dem::surface::Plane{});
  add_block(w, SpeciesId(0), Vec3(1.5e-3, 1.5e-3, 2e-3), 3e-3, 10, 10, layers, 0.3);
  return w;
}

}  // namespace

TEST_CASE("a periodic bed goes on from a file in every bit") {
  const Folder folder;
  auto whole = bed(1, 4), first = bed(2, 4);
  REQUIRE(whole.run(1400));
  REQUIRE(first.run(700));
  dem::save(first, folder / "state.h5");
  auto second = bed(3, 0);
  dem::load(second, folder / "state.h5");
  CHECK(difference(first, second) == "");
  REQUIRE(second.run(700));
  CHECK(difference(whole, second) == "");
  CHECK(whole.state().images.grain.size() > 50);
  CHECK(whole.state().rebuilds > 3);
}

TEST_CASE("a sheared cell goes on from a file in every bit, with the cells around where they were") {
  const Folder folder;
  const auto cell = [](int threads, int layers) {
    dem::WorldOptions o = options(Vec3::Zero(), 1e-5);
    o.domain = dem::surface::Aabb{{0, 0, 0}, {0.03, 0.03, 0.012}};
    o.periodic = {.x = true, .y = true, .z = true};
    o.shear_rate = 40.0;
    o.threads = threads;
    dem::World<ShearedCubes> w(o);
    w.set_contact(sand<ShearedCubes>(0.4));
    w.add_species(dem::shape::cube8(1e-3));
    add_block(w, SpeciesId(0), Vec3(1.5e-3, 1.5e-3, 1.5e-3), 3e-3, 10, 10, layers, 0.3);
    return w;
  };
  auto whole = cell(1, 4), first = cell(2, 4);
  REQUIRE(whole.run(1000));
  REQUIRE(first.run(500));
  dem::save(first, folder / "state.h5");
  auto second = cell(3, 0);
  dem::load(second, folder / "state.h5");
  CHECK(difference(first, second) == "");
  REQUIRE(second.run(500));
  CHECK(difference(whole, second) == "");
  CHECK(whole.state().domain.offset() > 4e-3);
  CHECK(whole.state().rebuilds > 3);
}
