#include "catch.hpp"
#include "worlds.hpp"

#include <dem/dem.hpp>
#include <dem/mbd/mbd.hpp>

namespace {

using models::Balls, models::CorrectedBalls, models::VerletBalls;

/// A rod that hangs from a hinge at the origin, released horizontal.
template <class Machine>
dem::BodyId add_pendulum(Machine& m) {
  const dem::BodyId rod = m.add_body(dem::mbd::box_body("rod", {1.0, 0.1, 0.1}, 100.0).at({0.5, 0.0, 0.0}));
  m.add_joint(dem::mbd::revolute("hinge", m.ground(), rod, {0, 0, 0}, {0, 1, 0}));
  return rod;
}

}  // namespace

TEST_CASE("a world without grains moves its machine as the machine does alone") {
  dem::World<CorrectedBalls> world({.time_step = 1e-4});
  const dem::BodyId in_world = add_pendulum(world.machine());
  REQUIRE(world.run(2000));

  dem::mbd::Machine<dem::integrator::PredictorCorrector> alone;
  const dem::BodyId rod = add_pendulum(alone);
  REQUIRE(alone.run(0.2, 1e-4));

  // The same operations in the same order.
  CHECK((world.machine().body(in_world).position() - alone.body(rod).position()).norm() == 0.0);
  CHECK(alone.body(rod).position().z() < -0.05);  // it did fall
}

TEMPLATE_TEST_CASE("a machine that is first asked for while a world runs goes on as one that was asked for before", "",
                   CorrectedBalls, Balls, VerletBalls) {
  // Until it is asked for, the world's ground is moved by the functions for a bare ground.
  const auto make = [] {
    dem::World<TestType> world({.time_step = 1e-5});
    world.set_contact({.normal = {2000, 0.01, 1}, .friction = {0.4, 500, 0.01, 0.9}});
    const auto species = world.add_species(dem::shape::Sphere(1e-3));
    world.add_surface(world.ground(), dem::surface::Plane{});
    world.add_grain({.species = species, .position = {0, 0, 1.01e-3}, .velocity = {0.1, 0, -0.1}});
    return world;
  };
  dem::World<TestType> early = make(), late = make();
  early.machine();
  REQUIRE(early.run(300));
  REQUIRE(late.run(300));
  late.machine();
  REQUIRE(early.run(300));
  REQUIRE(late.run(300));
  const dem::GrainId ball(0);
  CHECK(late.position(ball) == early.position(ball));
  CHECK(late.angular_velocity(ball) == early.angular_velocity(ball));
  CHECK(early.velocity(ball).x() < 0.09);  // it did touch

  const dem::BodyId rod = add_pendulum(early.machine());
  REQUIRE(add_pendulum(late.machine()) == rod);
  REQUIRE(early.run(2000));
  REQUIRE(late.run(2000));
  CHECK(late.machine().body(rod).position() == early.machine().body(rod).position());
  CHECK(late.position(ball) == early.position(ball));
  CHECK(early.machine().body(rod).position().z() < -1e-4);  // it did fall

  // Who holds the machine of a world that becomes another one adds to that.
  auto& machine = early.machine();
  early = make();
  const dem::BodyId another = add_pendulum(machine);
  REQUIRE(early.run(2000));
  CHECK(early.machine().body(another).position().z() < -1e-4);
}

TEMPLATE_TEST_CASE("a ball that bounces off a sprung plate leaves the energy in the plate", "", CorrectedBalls, Balls,
                   VerletBalls) {
  const int substeps = GENERATE(1, 8);
  // Plate: omega = sqrt(50/2e-5) = 1.6e3/s; contact: sqrt(2000/0.7e-5) = 1.7e4/s. A step of 1e-6 s has omega dt < 0.02.
  dem::World<TestType> world({.gravity = {0, 0, 0}, .time_step = 1e-6});
  world.set_contact({.normal = {.stiffness = 2000, .damping = 0, .separation_factor = 1}, .friction = {}});
  const auto species = world.add_species(dem::shape::Sphere(1e-3));
  const double mass = world.species(species).mass, speed = 0.1, plate_mass = 2e-5, stiffness = 50.0;

  auto& machine = world.machine();
  machine.substeps = substeps;
  const dem::Vec3 edges(4e-3, 4e-3, 1e-3);
  const dem::BodyId plate = machine.add_body(dem::mbd::box_body("plate", edges, plate_mass / edges.prod()));
  const auto slide = machine.add_joint(dem::mbd::prismatic("slide", world.ground(), plate, {0, 0, 0}, {0, 0, 1}));
  machine.add_spring(dem::mbd::spring("spring", world.ground(), {0, 0, -0.1}, plate, {0, 0, 0}, stiffness));
  world.add_surface(plate, dem::surface::Box(edges));
  const auto ball = world.add_grain({.species = species, .position = {0, 0, 1.6e-3}, .velocity = {0, 0, -speed}});

  REQUIRE(world.run(4000));
  REQUIRE(world.velocity(ball).z() > 0.0);  // it did bounce, and has left
  const double x = machine.coordinate(slide), v = machine.speed(slide);
  const double before = 0.5 * mass * speed * speed;
  const double in_plate = 0.5 * plate_mass * v * v + 0.5 * stiffness * x * x;
  const double after = 0.5 * mass * world.velocity(ball).squaredNorm() + in_plate;
  CHECK(in_plate > 0.2 * before);  // something was handed over
  // Schemes of first order are off by omega dt/2 = 1 % of the contact's share; the rest by its square.
  CHECK(after == Catch::Approx(before).epsilon(0.01));
}

TEST_CASE("sensors tell the walls of one body apart, and average each over its window") {
  // A tray with a floor and a wall at x = 0, both on one body that is tipped by an angle about Y, so that a ball of 1
  // mm lies in its corner: the floor carries m g cos(angle), the wall m g sin(angle).
  const double angle = 0.3, radius = 1e-3;
  const dem::Vec3 down = 9.81 * dem::Vec3(-std::sin(angle), 0, -std::cos(angle));
  dem::World<CorrectedBalls> world({.gravity = down});
  world.set_contact({.normal = {.stiffness = 1000, .damping = 0.05, .separation_factor = 1}, .friction = {}});
  const auto species = world.add_species(dem::shape::Sphere(radius));
  const double weight = 9.81 * world.species(species).mass;
  const dem::BodyId tray = world.machine().add_fixed_body("tray");
  const auto floor = world.add_surface(tray, dem::surface::Box({0.1, 0.1, 0.01}), {.position = {0, 0, -0.005}});
  const auto wall = world.add_surface(tray, dem::surface::Box({0.01, 0.1, 0.1}), {.position = {-0.055, 0, 0.05}});
  const double window = 0.05;
  const auto on_floor = world.add_surface_sensor(floor, window), on_wall = world.add_surface_sensor(wall, window);
  world.add_grain({.species = species, .position = {-0.05 + radius, 0, radius}});
  REQUIRE(world.run_for(0.3));
  // At rest: what the damper has left after 0.25 s is nothing.
  const dem::Vec3 f = dem::to_eigen(world.surface_sensor(on_floor).mean().force);
  const dem::Vec3 w = dem::to_eigen(world.surface_sensor(on_wall).mean().force);
  CHECK((f + weight * std::cos(angle) * dem::Vec3::UnitZ()).norm() < 1e-6 * weight);
  CHECK((w + weight * std::sin(angle) * dem::Vec3::UnitX()).norm() < 1e-6 * weight);
  CHECK(world.surface_sensor(on_floor).latest().force.z == world.surface_force(floor).z());
  CHECK_THROWS_AS(world.add_surface_sensor(dem::SurfaceId(7), window), dem::Error);
  // A grain that flies away leaves half a window without force.
  const auto ball = dem::GrainId(0);
  world.set_velocity(ball, {1.0, 0, 1.0});
  REQUIRE(world.run_for(0.5 * window));
  // The window's oldest edge is one of 64 bins coarse.
  CHECK(world.surface_sensor(on_floor).mean().force.z == Catch::Approx(0.5 * f.z()).epsilon(0.05));
}

TEST_CASE("what a machine derived stays while grains come and go, and follows when a part is added") {
  dem::World<CorrectedBalls> world({.time_step = 1e-4});
  world.set_contact({.normal = {.stiffness = 10, .damping = 0, .separation_factor = 1}, .friction = {}});
  const auto species = world.add_species(dem::shape::Sphere(1e-3));
  auto& machine = world.machine();
  const dem::BodyId rod = add_pendulum(machine);
  // Two links, so that the inverse mass at the second hinge depends on the pose.
  const dem::BodyId second = machine.add_body(dem::mbd::box_body("second", {1.0, 0.1, 0.1}, 100.0).at({1.5, 0.0, 0.0}));
  const auto hinge = machine.add_joint(dem::mbd::revolute("elbow", rod, second, {1, 0, 0}, {0, 1, 0}));
  REQUIRE(world.run(3000));
  const double k = machine.joint(hinge).k;
  world.add_grain({.species = species, .position = {0, 0, 10}});
  world.set_gravity({0, 0, -9.0});
  REQUIRE(world.run(1));
  CHECK(machine.joint(hinge).k == k);
  machine.add_spring(dem::mbd::spring("spring", world.ground(), {5, 0, 0}, second, {2, 0, 0}, 1.0));
  REQUIRE(world.run(1));
  const double shared = machine.joint(hinge).k;
  CHECK(shared < 0.9 * k);  // one more part shares the body
  // Steps of the machine that are four times as short let it be 16 times as stiff; back again, it is as it was. The
  // pose changes between the two by what moves in a step or two.
  machine.substeps = 4;
  REQUIRE(world.run(1));
  CHECK(machine.joint(hinge).k == Catch::Approx(16.0 * shared).epsilon(1e-2));
  machine.substeps = 1;
  REQUIRE(world.run(1));
  CHECK(machine.joint(hinge).k == Catch::Approx(shared).epsilon(1e-2));
}

TEST_CASE("bodies that only a measuring joint connects may touch each other") {
  for (const bool measures : {true, false}) {
    dem::World<CorrectedBalls> world;
    auto& m = world.machine();
    dem::BodyId bodies[2];
    for (int k = 0; k < 2; ++k) {
      bodies[k] = m.add_body(dem::mbd::box_body(k == 0 ? "a" : "b", {1, 1, 1}, 100.0).at({2.0 * k, 0, 0}));
      world.add_surface(bodies[k], dem::surface::Box({1, 1, 1}));
    }
    const auto kind = measures ? dem::mbd::JointKind::free : dem::mbd::JointKind::point_on_plane;
    m.add_joint(dem::mbd::joint(kind, "joint", bodies[0], bodies[1], {1, 0, 0}));
    CHECK(world.add_body_contacts() == (measures ? 1 : 0));
  }
}

TEST_CASE("surface sensors feel other machine parts, too", "[slow]") {
  // A ball body rests on a table, a grain beside it: each sensor sums what touches its surface.
  dem::World<VerletBalls> world;
  world.set_contact({.normal = {.stiffness = 1000, .damping = 1.0, .separation_factor = 1}, .friction = {}});
  const auto table = world.add_surface(world.ground(), dem::surface::Plane{});
  const dem::BodyId body = world.machine().add_body(dem::mbd::sphere_body("ball", 5e-3, 2000.0).at({0.02, 0, 5e-3}));
  const auto ball = world.add_surface(body, dem::surface::Sphere(5e-3));
  world.add_body_contact(ball, table);
  const auto grain = world.add_species(dem::shape::Sphere(1e-3));
  world.add_grain({.species = grain, .position = {0, 0, 1e-3}});
  const auto on_table = world.add_surface_sensor(table, 0.01), on_ball = world.add_surface_sensor(ball, 0.01);
  REQUIRE(world.run_for(0.5));
  const double weight = 9.81 * world.machine().body(body).mass, grains = 9.81 * world.species(grain).mass;
  // At rest: what the dampers leave after 0.5 s is nothing.
  CHECK(world.surface_sensor(on_table).mean().force.z == Catch::Approx(-weight - grains).epsilon(1e-9));
  CHECK(world.surface_sensor(on_ball).mean().force.z == Catch::Approx(weight).epsilon(1e-9));
  CHECK(world.surface_force(table).z() == Catch::Approx(-grains).epsilon(1e-9));
}
