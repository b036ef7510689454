// Saved states of worlds in which grains come, go, and are carried.

#include "scenes_to_save.hpp"

namespace {

struct StreamOptions {
  int threads = 1;
  double flow = 2e4;
  bool has_held = true;
  bool has_grains = true;  // else those of the file are awaited
};

/// A drum with rough ribs turns under a rain, beside an outlet.
template <class M>
dem::World<M> stream(const StreamOptions& o) {
  dem::WorldOptions w = options({0, 0, -9.81}, 1e-5);
  w.threads = o.threads;
  dem::World<M> world(w);
  world.set_contact(sand<M>());
  const auto shape = [](double size) {
    if constexpr (std::is_same_v<typename M::Shape, Sphere>) return Sphere(size);
    else return dem::shape::cube8(size);
  };
  const SpeciesId large = world.add_species(shape(1e-3)), small = world.add_species(shape(0.7e-3)),
                  held = world.add_species(shape(1.5e-3), {.held = o.has_held});
  add_open_box(world, {0.02, 0.02, 0});
  auto& m = world.machine();
  const dem::BodyId drum = m.add_fixed_body("drum", {0.01, 0.01, 6e-3});
  m.add_motion(dem::mbd::prescribed_rotation("turn", drum, Vec3::UnitY(), dem::mbd::Signal::ramp(0, 20.0)));
  m.add_sensor(dem::mbd::contact_sensor("drum", drum, 1e-3));
  world.add_inlet(dem::InletRegion::box({3e-3, 3e-3, 0.02}, {0.017, 0.017, 0.025}),
                  {.name = "rain",
                   .grains = {{{large, 0.5}, {small, 0.5}}},
                   .grain_flow = o.flow,
                   .velocity = {0, 0, -0.5},
                   .velocity_spread = 0.1,
                   .seed = 4});
  world.add_outlet({Vec3(0.014, -1, -1), Vec3(1, 1, 5e-3)});
  if (o.has_held && o.has_grains) {
    for (int k = 0; k < 6; ++k) {
      world.attach(world.add_grain({held, {0.01 + 4e-3 * std::cos(k), 0.003 * k, 6e-3 + 4e-3 * std::sin(k)}}), drum);
    }
  }
  return world;
}

}  // namespace

TEMPLATE_TEST_CASE("a world with inlets and attached grains goes on from a file in every bit", "",
                   models::CorrectedBalls, models::VerletCubes) {
  const Folder folder;
  constexpr std::uint64_t n = 1500;
  auto whole = stream<TestType>({}), first = stream<TestType>({.threads = 2});
  REQUIRE(whole.run(2 * n));
  REQUIRE(first.run(n));
  CHECK(first.inlet(dem::InletId(0)).owed() > 1.0);  // the file holds what is owed
  dem::save(first, folder / "state.h5");
  auto second = stream<TestType>({.threads = 3, .has_grains = false});
  dem::load(second, folder / "state.h5");
  CHECK(difference(first, second) == "");
  CHECK(second.inlet(dem::InletId(0)).grains() == first.inlet(dem::InletId(0)).grains());
  REQUIRE(second.run(n));
  CHECK(difference(whole, second) == "");
  CHECK(whole.grain_count() > 100);
  CHECK(whole.outlet(dem::OutletId(0)).grains() > 0);
}

TEST_CASE("a rain goes on from a file whatever is due in the step of the file") {
  using World = dem::World<models::CorrectedBalls>;
  const Folder folder;
  auto world = stream<models::CorrectedBalls>({});
  REQUIRE(world.run(2500));
  int lists_due = 0;
  for (int k = 0; k < 40; ++k) {
    REQUIRE(world.run(7));
    lists_due += world.state().list_valid ? 0 : 1;
    dem::save(world, folder / "state.h5");
    auto again = stream<models::CorrectedBalls>({.has_grains = false});
    dem::load(again, folder / "state.h5");
    World copy = world;
    REQUIRE(copy.run(70));
    REQUIRE(again.run(70));
    REQUIRE(difference(copy, again) == "");
  }
  CHECK(lists_due > 0);
  CHECK(world.outlet(dem::OutletId(0)).grains() > 0);
}

TEST_CASE("another inlet, and another species of held grains, are told") {
  const Folder folder;
  auto saved = stream<models::CorrectedBalls>({});
  REQUIRE(saved.run(10));
  dem::save(saved, folder / "state.h5");
  auto other = stream<models::CorrectedBalls>({.flow = 100});
  CHECK(error_of([&] { dem::load(other, folder / "state.h5"); }).find("inlet 'rain': grain flow is 20000 1/s") !=
        std::string::npos);
  auto free = stream<models::CorrectedBalls>({.has_held = false});
  CHECK(error_of([&] { dem::load(free, folder / "state.h5"); }).find("held is yes in the saved state, but no") !=
        std::string::npos);
}
