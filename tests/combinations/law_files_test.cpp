// Contacts that remember what few laws do go on from a file in every bit: bridges and bonds across gaps, friction that
// varies with the speed, torque against rolling, and grids of several levels.

#include "checkpoint/folder.hpp"
#include "world/laws.hpp"

#include <dem/grain/broadphase/hierarchical_grid.hpp>
#include <dem/io/checkpoint.hpp>
#include <dem/world/contacts.hpp>

namespace law_files_test {

namespace {

struct WetBalls
    : Laws<Linear, friction::Varying<friction::CundallStrack>, rolling::ConstantTorque, cohesion::LiquidBridge> {
  using BroadPhase = broadphase::HierarchicalGrid;
  using Executor = exec::Threads;
};
struct SoftBalls : Laws<contact::Hertz, friction::CundallStrack, rolling::None, cohesion::JKR> {
  using Executor = exec::Threads;
};

template <class Model>
ContactParameters<Model> constants() {
  if constexpr (std::is_same_v<Model, WetBalls>) {
    return {Linear::with_restitution(500.0, 0.5),
            {.law = {0.4, 500.0, 0.3}, .kinetic_ratio = 0.6, .decay_speed = 0.05},
            {0.1},
            cohesion::LiquidBridge::of(0.072, 0.3, 2e-11)};
  } else {
    const auto pair = contact::elastic_pair({.young = 2e5, .poisson = 0.3});
    return {contact::Hertz::with_restitution(pair, 0.5), {0.4, 500.0, 0.3}, {}, cohesion::JKR::with(pair, 0.5)};
  }
}

/// Balls of two sizes, 1 : 3, that fly at each other in a box.
template <class Model>
World<Model> cloud(int threads, bool has_grains = true) {
  constexpr double radius = 1e-3, pitch = 2.1e-3;
  WorldOptions o = options({0, 0, -g}, 5e-6);
  o.threads = threads;
  o.overlap_limit = 0.3;
  World<Model> w(o);
  w.set_contact(constants<Model>());
  const SpeciesId large = w.add_species(Sphere(radius)), small = w.add_species(Sphere(radius / 3));
  add_open_box(w, {8 * pitch, 8 * pitch, 0});
  if (!has_grains) return w;
  Random random(2);
  for (int k = 0; k < 320; ++k) {
    NewGrain p;
    p.species = k % 3 == 0 ? small : large;
    p.position = pitch * (Vec3(k % 8, k / 8 % 8, k / 64) + filled(0.5));
    p.velocity = random.vector(0.15);
    p.angular_velocity = random.vector(50.0);
    w.add_grain(p);
  }
  return w;
}

/// Contacts that hold across a gap.
template <class Model>
int count_across(const World<Model>& w) {
  int count = 0;
  for (const auto& contact : contacts_of(w)) {
    double held = 0.0;
    if constexpr (std::is_same_v<Model, WetBalls>) held = contact.last.cohesion.formed;
    else held = contact.last.cohesion.joined;
    count += contact.overlap < 0.0 && held == 1.0 ? 1 : 0;
  }
  return count;
}

}  // namespace

TEMPLATE_TEST_CASE("contacts across gaps go on from a file on other threads in every bit", "", WetBalls, SoftBalls) {
  const Folder folder;
  auto whole = cloud<TestType>(1), first = cloud<TestType>(2);
  int across = 0;
  for (int k = 0; k < 200 && across < 3; ++k) {
    REQUIRE(first.run(10));
    across = count_across(first);
  }
  CHECK(across >= 3);
  const std::uint64_t n = first.steps();
  REQUIRE(whole.run(n + 500));
  save(first, folder / "state.h5");
  auto second = cloud<TestType>(3, false);
  load(second, folder / "state.h5");
  CHECK(difference(first, second) == "");
  REQUIRE(second.run(500));
  CHECK(difference(whole, second) == "");
  CHECK(io::columns_of(first).at("contacts/pairs/key").rows() > 20);
}

}  // namespace law_files_test
