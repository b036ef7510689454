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
    const dem::ParticleId p(k);
    if (world.state().particles.row_of[k] != world.state().particles.gone) world.remove_particle(p);
  }
  const auto ids = world.particles();
  for (std::size_t k = 0; k < ids.size(); k += 100) world.set_velocity(ids[k], {0, 0, 0.2});
  world.add_particle({.species = dem::SpeciesId(0), .position = {0.015, 0.01, 0.09}});
  run(world, 300);
  require(bool(world.run(1000, [left = 50]() mutable { return --left > 0; })), "the run did not end");
  require(world.outlet(dem::OutletId(0)).grains() > 0, "nothing left through the outlet");
  require(world.particle_count() > 1300, "nothing came through the inlet");
  return world;
};

}  // namespace

bool spheres() { return same_bits<Shared, Alone>("spheres", changing); }

}  // namespace scenes
