#include "cubes.hpp"

#include <vector>

namespace scenes {

namespace {

/// Cubes float and fall asleep. A block of triangles, which may have grains glued to it, flies into them, and a flap is
/// pushed. Without glued grains chunks are moved in turn. Energy may be counted.
template <bool is_glued, bool counts = false>
constexpr auto machine_on_cubes = []<class Model>() {
  dem::World<Model> world(
      {.gravity = {0, 0, 0},
       .sleep = dem::SleepOptions{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.01, .window = 20}});
  world.set_contact({.normal = {2000, 0.05, 0.05}, .friction = {0.4, 2000, 0.015, 0.975}});
  const double width = 0.15, depth = 0.01;
  add_box(world, width, depth, 0.05);
  const auto cube = world.add_species(dem::shape::cube8(0.7e-3));
  const auto held = world.add_species(dem::shape::cube8(0.7e-3), {.held = true});
  pour(world, cube, 1500, 60, 4, 2.5e-3, 0.0);
  auto& m = world.machine();
  const dem::Vec3 edges(2e-3, 0.008, 0.012), top(5e-3, depth / 2, 0.0245);
  const auto flap = m.add_body(dem::mbd::box_body("flap", edges, 2650).at(top));
  const auto rail = m.add_joint(dem::mbd::prismatic("rail", m.ground(), flap, top, {0, 0, 1}));
  m.add_actuator(dem::mbd::joint_actuator("push", rail, 50, 0.5, dem::mbd::Signal::smooth_step(0, -6e-3, 0, 3e-3)));
  world.add_surface(flap, dem::surface::Box(edges));
  const auto block = m.add_body(
      dem::mbd::box_body("block", {8e-3, 8e-3, 8e-3}, 2650).at({0.03, depth / 2, 0.0235}).moving({0, 0, -1}));
  world.add_surface(block, dem::surface::TriangleMesh(dem::mesh::box({8e-3, 8e-3, 8e-3})));
  for (const double x : is_glued ? std::vector{0.027, 0.033} : std::vector<double>{})
    world.attach(world.add_grain({held, {x, depth / 2, 0.0195}}), block);
  if (counts) count_energy(world);
  run(world, 900);
  if (counts) {
    const dem::GrainEnergy e = energy_of(world);
    require(e.by_surfaces > 0.0 && e.dissipated() > 0.0,
            dem::text("energy was not counted: {:g} {:g} {:g} J", e.by_surfaces, e.dissipated(), e.dissipated_asleep));
  }
  require(world.asleep_count() > 0, "no grain sleeps");
  require(world.asleep_count() < world.grain_count(), "all grains sleep");
  return world;
};

/// Cubes fall into a box, fast enough for grains to go from one rank to another.
constexpr auto rain_of_cubes = []<class Model>() {
  dem::World<Model> world;
  world.set_contact({.normal = {2000, 0.05, 0.05}, .friction = {0.4, 2000, 0.015, 0.975}});
  add_box(world, 0.02, 0.02, 0.1);
  pour(world, world.add_species(dem::shape::cube8(0.7e-3)), 900, 8, 8, 2.5e-3, 1.0);
  run(world, 900);
  return world;
};

}  // namespace

bool cubes() {
  const bool glued = same_bits<CubesShared, CubesAlone>("glued", machine_on_cubes<true>);
  const bool free = same_bits<CubesShared, CubesAlone>("free", machine_on_cubes<false>);
  const bool counted = same_bits<CubesShared, CubesAlone>("counted", machine_on_cubes<true, true>);
  return same_bits<CubesShared, CubesAlone>("rain", rain_of_cubes) && glued && free && counted;
}

}  // namespace scenes
