#include "box_of_spheres.hpp"

namespace scenes {

bool checkpoint() {
  return goes_on<Shared, Alone>("checkpoint", []<class Model>(int n) { return box_of_spheres<Model>(n); });
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
    world.set_velocity(dem::ParticleId(0), {0, 0, 1});
  }
  (void)world.run(10);
}

}  // namespace scenes
