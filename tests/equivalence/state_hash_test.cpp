// The bits of three scenes. Whoever changes a sum, an order or a formula sees it here, and decides whether it was
// meant.
//
// If it was: run the test, look at what else changed (the other tests, settled_bed), write the hashes that it prints
// into the list below, and say in the commit why the bits are others. If it was not, find the change.
//
// The hashes hold for any number of threads, any width of a pack, and any degree of optimisation. They are those of
// sums and products that are not fused (-ffp-contract=off), on a processor with fused multiply-add, which libm's
// functions use.
//
// The skin of the neighbour lists is given: when lists are made anew, grains are sorted in space, and sums go in the
// order of rows. So whoever changes the rule by which the skin is chosen changes no hash.

#include "state_hash.hpp"
#include "catch.hpp"

#include <dem/dem.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>

#include <cstdint>

namespace {

constexpr const char* hash_of_spheres = "73bc636f971f6d70";
constexpr const char* hash_of_cubes = "cff38e1a82704f34";
constexpr const char* hash_of_superquadrics = "6608de9defffe28c";

/// Numbers from 0 to 1 that are the same with every library.
struct Numbers {
  std::uint64_t state = 7;
  double operator()() {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) * 0x1p-53;
  }
};

/// A rotation by Cayley's formula, which needs no function of libm.
dem::Mat3 turn(Numbers& number) {
  const double z = number() - 0.5, y = number() - 0.5, x = number() - 0.5;
  const double s = 2.0 / (1.0 + x * x + y * y + z * z);
  dem::Mat3 k;
  k << 0, -z, y, z, 0, -x, -y, x, 0;
  const dem::Mat3 k2 = k * k;
  dem::Mat3 r = dem::Mat3::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r(i, j) += s * k(i, j) + s * k2(i, j);
  }
  return r;
}

template <class World>
void add_box(World& world, double width, double depth) {
  const auto wall = [&](const dem::Vec3& middle, const dem::Vec3& edges) {
    world.add_surface(world.ground(), dem::surface::Box(edges), {.material = "wall", .position = middle});
  };
  const double t = 0.01, h = 0.08;
  wall({width / 2, depth / 2, -t / 2}, {width + 2 * t, depth + 2 * t, t});
  for (const double side : {0.0, 1.0}) {
    wall({side * width + (side - 0.5) * t, depth / 2, h / 2}, {t, depth + 2 * t, h});
    wall({width / 2, side * depth + (side - 0.5) * t, h / 2}, {width + 2 * t, t, h});
  }
}

template <class World>
void pour(World& world, dem::SpeciesId grain, int n, int per_row, double pitch, const dem::Vec3& corner) {
  Numbers number;
  for (int k = 0; k < n; ++k) {
    const double cell[] = {k % per_row + 0.5, k / per_row % per_row + 0.5, k / (per_row * per_row) + 0.5};
    dem::Vec3 x = corner;
    for (int i = 0; i < 3; ++i) x[i] += pitch * (cell[i] + 0.1 * (number() - 0.5));
    const dem::Mat3 r = turn(number);
    const double v = -0.1 * number(), u = 0.2 * number();
    world.add_grain({.species = grain, .position = x, .velocity = {u, v, 0}, .rotation = r});
  }
}

struct Spheres : dem::Model {
  using Integrator = dem::integrator::SymplecticEuler;
  using Normal = dem::contact::LinearSpringDashpot;
  using Friction = dem::friction::CundallStrack;
};
struct Cubes : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
};
struct Superquadrics : dem::Model {
  using Shape = dem::shape::Superquadric;
  using Integrator = dem::integrator::VelocityVerlet;
};

}  // namespace

TEST_CASE("the bits of spheres that fall into a box are those that they were") {
  const int threads = GENERATE(1, 2);
  const dem::shape::Sphere ball(1e-3);
  dem::World<Spheres> world({.time_step = 1e-5, .skin = 0.1 * ball.bounding_radius(), .threads = threads});
  world.set_contact({.normal = {2000, 0.3}, .friction = {0.4, 500.0, 0.2}});
  add_box(world, 0.02, 0.02);
  pour(world, world.add_species(ball), 800, 8, 2.4e-3, {0, 0, 0});
  REQUIRE(world.run(6000));
  CHECK(hash_of(world) == hash_of_spheres);
}

// A flap on a rail is pushed into cubes by an actuator, and a block of triangles falls on them.
TEST_CASE("the bits of cubes and a machine are those that they were") {
  const int threads = GENERATE(1, 2);
  const auto cube = dem::shape::cube8(1.2e-3);
  dem::World<Cubes> world({.time_step = 1e-5, .skin = 0.1 * cube.bounding_radius(), .threads = threads});
  world.set_contact({.normal = {2000, 0.015, 0.05}, .friction = {0.4, 2000, 0.015, 0.975}});
  world.set_contact("grain", "wall", {.normal = {2000, 0.015, 0.05}, .friction = {0.2, 2000, 0.015, 0.975}});
  add_box(world, 0.028, 0.020);
  pour(world, world.add_species(cube), 300, 5, 3.6e-3, {0.010, 0.001, 0.001});
  auto& m = world.machine();
  m.joint_tolerance = 1.0;  // m: no sub-steps, which would be other bits
  const dem::Vec3 edges(2e-3, 0.016, 0.022), top(5e-3, 0.010, 0.026);
  const auto slider = m.add_body(dem::mbd::box_body("slider", dem::Vec3::Constant(4e-3), 2650).at(top));
  const auto flap = m.add_body(dem::mbd::box_body("flap", edges, 2650).at(top - dem::Vec3(0, 0, 0.5 * edges.z())));
  const auto rail = m.add_joint(dem::mbd::prismatic("rail", m.ground(), slider, top, {1, 0, 0}));
  m.add_joint(dem::mbd::revolute("hinge", slider, flap, top, {0, 1, 0}));
  m.add_actuator(dem::mbd::joint_actuator("push", rail, 50, 0.5, dem::mbd::Signal::smooth_step(0, 8e-3, 0, 0.03)));
  world.add_surface(flap, dem::surface::Box(edges));
  const auto mesh = dem::mesh::box({6e-3, 6e-3, 6e-3});
  const auto block = m.add_body(dem::mbd::box_body("block", {6e-3, 6e-3, 6e-3}, 1000).at({0.019, 0.010, 0.055}));
  world.add_surface(block, dem::surface::TriangleMesh(mesh));
  REQUIRE(world.run(4000));
  CHECK(hash_of(world) == hash_of_cubes);
}

TEST_CASE("the bits of superquadrics that fall into a box are those that they were") {
  const int threads = GENERATE(1, 2);
  const dem::shape::Superquadric shape({1.2e-3, 1e-3, 0.8e-3}, {4, 4, 4});
  dem::World<Superquadrics> world({.time_step = 1e-5, .skin = 0.1 * shape.bounding_radius(), .threads = threads});
  world.set_contact({.normal = {2000, 0.015, 0.05}, .friction = {0.4, 2000, 0.015, 0.975}});
  add_box(world, 0.012, 0.012);
  const auto grain = world.add_species(shape);
  pour(world, grain, 100, 4, 2.9e-3, {0, 0, 0});
  REQUIRE(world.run(2500));
  CHECK(hash_of(world) == hash_of_superquadrics);
}
