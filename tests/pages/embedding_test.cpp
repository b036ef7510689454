// The pieces of code of include/dem/README.md, letter by letter (cmake/check_pages.sh compares them).

#include "catch.hpp"
#include "soil.hpp"
#include "worlds.hpp"

#include <dem/io/checkpoint/world_columns.hpp>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

using Catch::Approx;

namespace {

using Model = models::VerletBalls;
using World = dem::World<Model>;

struct Bed {
  World world{{.time_step = 5e-6}};
  dem::SurfaceId floor = world.add_surface(world.ground(), dem::surface::Plane{});
  dem::SpeciesId ball = world.add_species(dem::shape::Sphere{1e-3});

  explicit Bed(int grains = 60) {
    world.set_contact(
        {.normal = {.stiffness = 2000, .damping = 0.05, .separation_factor = 1},
         .friction = {.coefficient = 0.4, .stiffness = 2000, .velocity_stiffness = 0.015, .breaking_factor = 0.975}});
    for (int k = 0; k < grains; ++k) {
      world.add_grain({ball, {2.1e-3 * (k % 5), 2.1e-3 * (k / 5 % 4), 1e-3 + 2.05e-3 * (k / 20)}, {0.01 * k, 0, 0}});
    }
  }
};

std::string run_of_page(World& world, std::uint64_t n, dem::SurfaceId floor, const bool& stop, double& floor_force) {
  // clang-format off
const dem::StepReport report = world.run(n, [&] {  // called after each step
  floor_force = -world.surface_force(floor).z();   // N
  return !stop;                                    // false ends the run, with all well
});
if (!report) return report.text;
  // clang-format on
  return report.note;
}

dem::Vec3 momentum_of_page(const World& world) {
  // clang-format off
dem::Vec3 momentum(0, 0, 0);
const auto& p = world.state().grains;
for (std::size_t i = 0; i < p.count; ++i) {
  if (p.row_of[p.id[i]] != i) continue;  // the grain of this row was removed
  momentum += world.species(dem::SpeciesId(p.species[i])).mass * dem::to_eigen(p.velocity[i]);
}
  // clang-format on
  return momentum;
}

void load_of_page(World& world, double drag, const dem::Vec3& wind, const dem::Vec3& buoyancy, double spin_drag) {
  // clang-format off
world.set_grain_load([=](const dem::GrainNow& grain) {
  return dem::GrainLoad{.force = drag * (wind - grain.velocity) + buoyancy, .torque = -spin_drag * grain.angular_velocity};
});
  // clang-format on
}

auto machine_of_page(World& world, dem::BodyId ball, dem::BodyId plate) {
  // clang-format off
using namespace dem::mbd;
struct Host {  // what your program knows, and changes between steps
  dem::Vec3 force{0, 0, 0}, position{0, 0, 0.1}, velocity{0, 0, 0};  // N on the ball; m and m/s of the plate
  double time = 0;                                                   // s, of that position
};
const auto host = std::make_shared<Host>();
world.machine().add_load(custom_load("host", ball, [host](double, const dem::Body&) {
  return dem::Wrench{dem::from_eigen(host->force), {}};
}));
world.machine().add_motion(prescribed_pose("plate", plate, [host](double t) {
  return Pose{.position = host->position + (t - host->time) * host->velocity, .velocity = host->velocity};
}));
  // clang-format on
  return host;
}

dem::io::StateColumns state_of_page(const World& world) {
  // clang-format off
dem::io::StateColumns state = dem::io::columns_of(world);
for (auto& [name, column] : state) {
  if (column.borrowed.empty()) continue;
  column.own.assign(column.borrowed.begin(), column.borrowed.end());
  column.borrowed = {};
}
  // clang-format on
  return state;
}

bool are_equal(const World& a, const World& b) {
  return dem::io::differences(dem::io::columns_of(a), dem::io::columns_of(b)).empty();
}

}  // namespace

TEST_CASE("a hidden world runs, and weighs its grains") {
  Soil soil(0.4);
  for (int k = 0; k < 4; ++k) soil.add_grain(3e-3 * k, 0, 1e-3);
  CHECK(soil.run_for(0.2) == "");
  const double mass = 2650.0 * 4.0 / 3.0 * std::numbers::pi * 1e-9;
  CHECK(soil.weight_on_floor() == Approx(4 * mass * 9.81).epsilon(1e-3));
}

TEST_CASE("a run that is looked at after each step has the bits of one that is not, and ends where it is told to") {
  Bed a, b;
  double force = 0;
  bool stop = false;
  CHECK(run_of_page(a.world, 300, a.floor, stop, force) == "");
  REQUIRE(b.world.run(300));
  CHECK(are_equal(a.world, b.world));
  CHECK(force == -b.world.surface_force(b.floor).z());
  stop = true;
  run_of_page(a.world, 300, a.floor, stop, force);
  CHECK(a.world.steps() == 301);
}

TEST_CASE("columns have the rows of removed grains until the next list, and row_of tells which") {
  Bed bed;
  auto& world = bed.world;
  REQUIRE(world.run(20));
  for (std::size_t k = 0; k < 30; ++k) world.remove_grain(world.grains()[k]);
  dem::Vec3 momentum(0, 0, 0);
  for (const auto grain : world.grains()) momentum += world.species(bed.ball).mass * world.velocity(grain);
  CHECK(world.grain_count() == 30);
  CHECK(world.state().grains.count == 60);
  CHECK((momentum_of_page(world) - momentum).norm() <= 1e-12 * momentum.norm());
  REQUIRE(world.run(200));
  CHECK(world.state().grains.count == 30);
}

TEST_CASE("a host's forces and poses arrive in the machine step by step") {
  using namespace dem::mbd;
  World world({.gravity = {0, 0, 0}, .time_step = 1e-4});
  auto& machine = world.machine();
  const dem::BodyId ball = machine.add_body(sphere_body("ball", 0.05, 1000).at({1, 0, 0}));
  const dem::BodyId plate = machine.add_body(box_body("plate", {0.1, 0.1, 0.02}, 7800).at({0, 0, 0.1}));
  const auto host = machine_of_page(world, ball, plate);
  for (int k = 0; k < 1000; ++k) {
    const double t = world.time();
    host->force = {machine.body(ball).mass * 2.0, 0, 0};
    host->time = t;
    host->position = {0, 0, 0.1 + 0.05 * std::sin(6 * t)};
    host->velocity = {0, 0, 0.3 * std::cos(6 * t)};
    REQUIRE(world.step());
  }
  CHECK(machine.body(ball).velocity().x() == Approx(0.2).epsilon(1e-3));
  CHECK(machine.body(plate).position().z() == Approx(0.1 + 0.05 * std::sin(0.6)).margin(1e-7));
}

TEST_CASE("a state that was kept in memory goes on with the same bits, as often as it is asked to") {
  Bed bed;
  REQUIRE(bed.world.run(100));
  dem::io::StateColumns state = state_of_page(bed.world);
  REQUIRE(bed.world.run(200));
  for (int time = 0; time < 2; ++time) {
    Bed again(0);
    dem::io::restore(again.world, state);
    REQUIRE(again.world.run(200));
    CHECK(are_equal(again.world, bed.world));
  }
}

TEST_CASE("an exception in a step leaves a world that can be assigned to, one between steps leaves it whole") {
  Bed bed(0);
  auto& world = bed.world;
  bool throws = false;
  const auto body = world.machine().add_body(dem::mbd::sphere_body("b", 1e-3, 1000).at({0, 0, 1}));
  world.machine().add_load(dem::mbd::custom_load("l", body, [&](double, const dem::Body&) -> dem::Wrench {
    if (throws) throw std::runtime_error("host");
    return {};
  }));
  REQUIRE(world.run(10));
  CHECK_THROWS_WITH(world.run(10, []() -> bool { throw std::runtime_error("between"); }), "between");
  CHECK(world.steps() == 11);
  const World kept = world;
  throws = true;
  CHECK_THROWS_WITH(world.run(10), "host");
  throws = false;
  CHECK_THROWS_AS(world.run(10), dem::Error);
  world = kept;
  REQUIRE(world.run(10));
  CHECK(world.steps() == 21);
  World other = std::move(world);
  world = kept;
  REQUIRE(world.run(1));
}

TEST_CASE("grains in the fluid of the page drift with it once they are lifted by their weight") {
  Bed bed(1);
  const double mass = bed.world.species(bed.ball).mass, tau = 2e-3;  // kg, s
  bed.world.set_position(bed.world.grains()[0], {0, 0, 0.1});
  load_of_page(bed.world, mass / tau, {0.3, 0, 0}, {0, 0, 9.81 * mass}, 1e-12);
  REQUIRE(bed.world.run_for(10 * tau));
  const dem::Vec3 v = bed.world.velocity(bed.world.grains()[0]);
  CHECK(v.x() == Approx(0.3).epsilon(1e-4));  // but for e^-10
  CHECK(std::abs(v.z()) < 1e-12);
}
