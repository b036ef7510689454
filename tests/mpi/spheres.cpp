#include "box_of_spheres.hpp"

namespace scenes {

namespace {

/// Grains come from an inlet, leave through an outlet and beyond a wall's end, and by hand.
constexpr auto changing = []<class Model>() {
  auto world = box_of_spheres<Model>(1500);
  world.add_outlet({{0.0, 0.0, 0.0}, {6e-3, 6e-3, 2e-3}});
  world.add_inlet(dem::InletRegion::box({0.004, 0.004, 0.04}, {0.026, 0.016, 0.06}),
                  {.grains = dem::SpeciesId(0), .grain_flow = 2e4, .velocity = {0, 0, -0.5}, .velocity_spread = 0.1});
  run(world, 200);
  for (std::uint32_t k = 3; k < 1500; k += 7) {
    const dem::GrainId p(k);
    if (world.state().grains.row_of[k] != world.state().grains.gone) world.remove_grain(p);
  }
  const auto ids = world.grains();
  for (std::size_t k = 0; k < ids.size(); k += 100) world.set_velocity(ids[k], {0, 0, 0.2});
  world.add_grain({.species = dem::SpeciesId(0), .position = {0.015, 0.01, 0.09}});
  world.set_grain_load(drag_of_air);
  run(world, 300);
  require(bool(world.run(1000, [left = 50]() mutable { return --left > 0; })), "the run did not end");
  for (int k = 0; k < 4; ++k) {  // each before a run, which lists it first
    world.add_grain({.species = dem::SpeciesId(0), .position = {0.006 + 0.005 * k, 0.01, 0.15}});
    run(world, 64);
  }
  require(world.outlet(dem::OutletId(0)).grains() > 0, "nothing left through the outlet");
  require(world.grain_count() > 1300, "nothing came through the inlet");
  return world;
};

/// Grains of two sizes float and fall asleep. A few are pushed, and wake others; some are taken out on the way. Later
/// all are gone within a run, and new ones come. Energy may be counted.
template <bool counts>
constexpr auto emptied = []<class Model>() {
  auto world = box_of_spheres<Model>(900, 0.0);
  const auto small = world.add_species(dem::shape::Sphere(0.7e-3));
  pour(world, small, 600, 14, 9, 2.1e-3, 0.0, 0.018);
  world.set_gravity({0, 0, 0});
  world.set_sleep(dem::SleepOptions{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.01, .window = 20});
  if (counts) count_energy(world);
  run(world, 100);
  require(world.asleep_count() > 1000, "hardly a grain sleeps");
  for (std::uint32_t k = 5; k < 1500; k += 100) world.set_velocity(dem::GrainId(k), {2, 1, k < 900 ? 1.0 : -3.0});
  world.add_outlet({{0.01, 0.005, -1}, {0.02, 0.015, 1}});
  run(world, 450);
  require(world.asleep_count() > 100, "none sleeps any more");
  const auto left = world.outlet(dem::OutletId(0)).grains();
  require(left > 20 && left < 1000, "none left, or too many");
  world.add_outlet({{-1, -1, -1}, {1, 1, 0.06}});
  run(world, 150);
  require(world.grain_count() == 0, "some grains are still there");
  pour(world, small, 600, 14, 9, 2.1e-3, 0.3, 0.07);
  run(world, 10);
  return world;
};

/// Small grains come into the gaps between sleepers and fly into some; neighbours are listed again as they do.
constexpr auto beside = []<class Model>() {
  const double pitch = 2.1e-3;
  auto world = box_of_spheres<Model>(900, 0.0);
  const auto small = world.add_species(dem::shape::Sphere(0.5e-3), {.density = 2e4});
  world.set_gravity({0, 0, 0});
  world.set_sleep(dem::SleepOptions{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.01, .window = 20});
  run(world, 100);
  const std::size_t asleep = world.asleep_count();
  require(asleep > 800, "hardly a grain sleeps");
  for (int k = 0; k < 20; ++k) {
    world.add_grain({.species = small,
                     .position = pitch * dem::Vec3(1 + k % 10, 2 + k / 10 * 4, 1 + k % 5),
                     .velocity = {1, 0.5, 0.5}});
  }
  const std::uint64_t lists = world.state().rebuilds;
  run(world, 300);
  require(world.state().rebuilds > lists + 1, "neighbours were not listed again");
  require(world.asleep_count() < asleep - 5, "no sleeper was woken");
  require(world.asleep_count() > 100, "none sleeps any more");
  return world;
};

/// Two grains leave the domain on different sides: what each run reports.
template <class Model>
std::string told_of_lost() {
  auto world = box_of_spheres<Model>(1500);
  world.add_grain({.species = dem::SpeciesId(0), .position = {0.015, 0.01, 0.9}, .velocity = {0, 0, 50}});
  world.add_grain({.species = dem::SpeciesId(0), .position = {-0.9, 0.01, 0.01}, .velocity = {-50, 0, 0}});
  std::string told;
  for (int k = 0; k < 4; ++k) {
    const dem::StepReport r = world.run(150);
    told += dem::text("{}: problem {}, grain {}, {}\n", r.step, int(r.problem), r.grain.value, r.text);
  }
  require(told.find("grain 1500 left") != told.npos && told.find("grain 1501 left") != told.npos, told);
  return told;
}

}  // namespace

bool reports() {
  const std::string told = told_of_lost<Shared>();
  const dem::domain::Messages ranks;
  const bool same = told == ranks.text_of(0, told) && (ranks.rank() != 0 || told == told_of_lost<Alone>());
  return ranks.all(same);
}

bool spheres() {
  const bool same = same_bits<Shared, Alone>("emptied", emptied<false>) && same_bits<Shared, Alone>("beside", beside) &&
                    same_bits<Shared, Alone>("counted", emptied<true>);
  return same_bits<Shared, Alone>("spheres", changing) && same;
}

}  // namespace scenes
