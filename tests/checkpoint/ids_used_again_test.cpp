#include "world/scenes.hpp"

#include <dem/io/checkpoint/world_columns.hpp>

TEST_CASE("a world whose ids were used again goes on from its state in every bit") {
  const auto build = [] {
    dem::World<models::VerletCubes> w(options({0, 0, -g}));
    w.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
    const auto cube = w.add_species(dem::shape::cube8(1e-3));
    w.add_inlet(dem::InletRegion::box({0, 0, 0.05}, {0.02, 0.02, 0.06}),
                {.grains = cube, .grain_flow = 2000, .velocity = {0, 0, -2}});
    w.add_outlet({{-1, -1, -HUGE_VAL}, {1, 1, 0}});
    return w;
  };
  auto a = build(), b = build();
  REQUIRE(a.run_for(0.1));
  CHECK(!a.state().grains.number.empty());
  auto columns = dem::io::columns_of(a);
  dem::io::restore(b, columns);
  CHECK(a.grains() == b.grains());
  REQUIRE(a.run_for(0.05));
  REQUIRE(b.run_for(0.05));
  REQUIRE(a.grains() == b.grains());
  CHECK(a.grains().size() > 10);
  for (const auto p : a.grains()) REQUIRE(a.position(p) == b.position(p));
}
