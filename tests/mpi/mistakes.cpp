#include "box_of_spheres.hpp"

namespace scenes {

namespace {

bool is_last(const dem::World<Shared>& world) { return dem::processes.rank == world.state().domain.ranks() - 1; }

/// Ranks set up a world, which `change(world)` makes another one on the last rank: all are told in which part.
template <class Change>
bool told_of(const std::string& part, Change&& change) {
  auto world = box_of_spheres<Shared>(300);
  if (is_last(world)) change(world);
  std::string told;
  try {
    world.prepare();
  } catch (const dem::Error& e) {
    told = e.what();
  }
  const auto& d = world.state().domain;
  if (!d.is_shared() || d.all(told.find("they differ in " + part) != told.npos)) return true;
  std::printf("%s on one rank: all were to be told, but rank %d was told '%s'\n", part.c_str(), d.rank(), told.c_str());
  return false;
}

}  // namespace

bool differ() {
  bool told = told_of("materials or contact constants", [](auto& world) {
    world.set_contact({.normal = {2000, 0.015, 0.05}, .friction = {0.3, 2000, 0.015, 0.975}});
  });
  told = told_of("options", [](auto& world) { world.set_gravity({0, 0, -1.62}); }) && told;
  // As many as the others have, but other ones.
  const auto with_density = [](double density) {
    return [=](auto& world) { world.state().species[0].density = density; };
  };
  told = told_of("species", with_density(2000)) && told;
  told = told_of("surfaces", [](auto& world) { world.set_active(dem::SurfaceId(4), false); }) && told;
  told = told_of("grains", [](auto& world) { world.state().grains.position.set(7, {0.01, 0.01, 0.08}); }) && told;
  told = told_of("the machine", [](auto& world) { world.machine().largest_speed = 7.0; }) && told;
  return told;
}

void mistake() {
  auto world = box_of_spheres<Shared>(1500);
  const auto block =
      world.machine().add_body(dem::mbd::box_body("block", dem::Vec3::Constant(4e-3), 2650).at({1, 0, 0}));
  const int rank = world.state().domain.rank(), last = world.state().domain.ranks() - 1;
  world.machine().add_load(dem::mbd::custom_load("wind", block, [=](double t, const dem::Body&) {
    if (rank == last && t > 100 * dt) dem::fail("the wind broke off at t = {:g} s", t);
    return dem::Wrench{};
  }));
  (void)world.run(100000);
}

void disagree() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  if (world.state().domain.rank() == world.state().domain.ranks() - 1) {
    world.set_velocity(dem::GrainId(0), {0, 0, 1});
  }
  (void)world.run(10);
}

bool caught() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  try {
    if (is_last(world)) dem::fail("there is no file for this rank");
  } catch (const dem::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return false;
  }
  run(world, 10);
  return true;
}

void contacts_on_one() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  if (dem::processes.rank == 0) std::printf("%zu contacts\n", contacts_of(world).size());
  run(world, 10);
}

void columns_on_one() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  if (dem::processes.rank == 0) std::printf("%zu columns\n", dem::io::columns_of(world).size());
  run(world, 10);
}

void run_on_one() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  if (dem::processes.rank == 0) run(world, 10);
}

}  // namespace scenes
