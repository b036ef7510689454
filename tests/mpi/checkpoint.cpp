#include "box_of_spheres.hpp"

#include <dem/world/contacts.hpp>

namespace scenes {

namespace {

bool equal(const char* what, const dem::io::StateColumns& a, const dem::io::StateColumns& b) {
  const auto differences = dem::io::differences(a, b);
  for (const std::string& column : differences) std::printf("  %s: %s\n", what, column.c_str());
  return differences.empty();
}

}  // namespace

bool checkpoint() {
  auto shared = box_of_spheres<Shared>(1500);
  run(shared, 150);
  auto first = dem::io::columns_of(shared);
  const auto& d = shared.state().domain;

  // From ranks to one process, and from there to ranks; both run on to the same state.
  auto alone = box_of_spheres<Alone>(1500);
  run(alone, 150);
  bool same = equal("before", dem::io::columns_of(alone), first);
  auto alone_again = box_of_spheres<Alone>(10);
  dem::io::restore(alone_again, first);
  auto saved = dem::io::columns_of(alone);
  auto shared_again = box_of_spheres<Shared>(10);
  dem::io::restore(shared_again, saved);
  run(alone_again, 200), run(shared_again, 200), run(shared, 200);
  const auto last = dem::io::columns_of(shared), a = dem::io::columns_of(alone_again),
             b = dem::io::columns_of(shared_again);
  same = equal("as one process", a, last) && same;
  same = equal("as ranks again", b, last) && same;
  // What contacts feel is known to every rank, in the same order.
  const auto contacts = contacts_of(shared);
  const auto as_alone = contacts_of(alone_again);
  same = same && contacts.size() == as_alone.size() && contacts.size() > 100;
  for (std::size_t k = 0; same && k < contacts.size(); ++k) same = contacts[k].force == as_alone[k].force;
  std::printf("%-10s %d ranks: %s, %zu contacts\n", "checkpoint", d.ranks(), same ? "same bits" : "OTHER BITS",
              contacts.size());
  return d.all(same);
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
