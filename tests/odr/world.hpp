#pragma once

#include <dem/dem.hpp>

/// Where a ball is that fell for ten steps.
inline double fallen() {
  dem::World<dem::Model> world;
  world.set_contact({{2000.0, 0.015, 0.05}, {0.4, 2000.0, 0.015, 0.975}});
  dem::NewGrain ball;
  ball.species = world.add_species(dem::shape::Sphere(1e-3));
  const auto grain = world.add_grain(ball);
  return world.run(10) ? world.position(grain).z() : 1.0;
}
