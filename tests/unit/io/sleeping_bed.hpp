#pragma once

// A small bed of cubes of which all but one sleep.

#include "catch.hpp"
#include "worlds.hpp"

#include <vector>

struct SleepingBed {
  dem::World<models::VerletCubes> world;
  dem::GrainId flier;

  /// Four towers of two cubes, which are put in one after the other, and one that falls all the while. `sleep`: they
  /// may.
  explicit SleepingBed(bool sleep = true)
      : world({.gravity = {0, 0, -9.81},
               .threads = 1,
               .sleep = sleep ? std::optional(dem::SleepOptions{}) : std::nullopt}) {
    world.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
    const auto cube = world.add_species(dem::shape::cube8(1e-3));
    world.add_surface(world.ground(), dem::surface::Plane{});
    const auto tower = [&](int k) {
      for (const double z : {1e-3, 3e-3}) world.add_grain({cube, {4e-3 * k, 0, z}});
    };
    tower(0), tower(1);
    flier = world.add_grain({cube, {0, 0, 0.5}});
    const auto gone = world.add_grain({cube, {0, 0.1, 1e-3}});
    tower(2), tower(3);
    world.remove_grain(gone);  // numbers of grains are not those of rows any more
    for (int k = 0; k < 200 && world.asleep_count() < 8; ++k) REQUIRE(world.run_for(1e-3));
    if (sleep) REQUIRE(world.asleep_count() == 8);
    if (sleep) REQUIRE(!world.is_asleep(flier));
  }
};
