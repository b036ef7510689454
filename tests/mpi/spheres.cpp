#include "scenes.hpp"

#include <dem/world/contacts.hpp>

namespace scenes {

namespace {

struct Alone : dem::Model {};
struct Shared : dem::Model {
  using Domain = dem::domain::Ranks;
};

template <class Model>
dem::World<Model> box_of_spheres(int n) {
  dem::World<Model> world({.time_step = dt, .domain = {{{-1, -1, -0.5}, {1, 1, 1}}}, .threads = 2});
  world.set_contact({.normal = {2000, 0.015, 0.05}, .friction = {0.4, 2000, 0.015, 0.975}});
  add_box(world, 0.03, 0.02, 0.1);
  pour(world, world.add_species(dem::shape::Sphere(1e-3)), n, 14, 9, 2.1e-3, 0.3);
  return world;
}

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

bool checkpoint() {
  auto shared = box_of_spheres<Shared>(1500);
  run(shared, 150);
  auto first = dem::io::columns_of(shared);
  const auto& d = shared.state().domain;

  // From ranks to one process, and from there to ranks; both run on to the same state.
  auto alone = box_of_spheres<Alone>(1500);
  run(alone, 150);
  bool same = dem::io::differences(dem::io::columns_of(alone), first).empty();
  auto alone_again = box_of_spheres<Alone>(10);
  dem::io::restore(alone_again, first);
  auto saved = dem::io::columns_of(alone);
  auto shared_again = box_of_spheres<Shared>(10);
  dem::io::restore(shared_again, saved);
  run(alone_again, 200), run(shared_again, 200), run(shared, 200);
  const auto last = dem::io::columns_of(shared), a = dem::io::columns_of(alone_again),
             b = dem::io::columns_of(shared_again);
  same = same && dem::io::differences(a, last).empty() && dem::io::differences(b, last).empty();
  // What contacts feel is known to every rank, in the same order.
  const auto contacts = contacts_of(shared);
  const auto as_alone = contacts_of(alone_again);
  same = same && contacts.size() == as_alone.size() && contacts.size() > 1000;
  for (std::size_t k = 0; same && k < contacts.size(); ++k) same = contacts[k].force == as_alone[k].force;
  std::printf("%-10s %d ranks: %s, %zu contacts\n", "checkpoint", d.ranks(), same ? "same bits" : "OTHER BITS",
              contacts.size());
  return d.all(same);
}

void mistake() {
  auto world = box_of_spheres<Shared>(1500);
  const auto block = world.machine().add_body(dem::mbd::box_body("block", dem::Vec3::Constant(4e-3), 2650).at({1, 0, 0}));
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
