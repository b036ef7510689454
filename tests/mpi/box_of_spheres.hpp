#pragma once

#include "scenes.hpp"

namespace scenes {

struct Alone : dem::Model {};
struct Shared : dem::Model {
  using Domain = dem::domain::Ranks;
};

template <class Model>
dem::World<Model> box_of_spheres(int n, double speed = 0.3) {
  dem::World<Model> world({.time_step = dt, .domain = {{{-1, -1, -0.5}, {1, 1, 1}}}, .threads = threads_of<Model>()});
  world.set_contact({.normal = {2000, 0.015, 0.05}, .friction = {0.4, 2000, 0.015, 0.975}});
  add_box(world, 0.03, 0.02, 0.1);
  pour(world, world.add_species(dem::shape::Sphere(1e-3)), n, 14, 9, 2.1e-3, speed);
  return world;
}

}  // namespace scenes
