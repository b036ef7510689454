// Static equilibrium of the machine of a world.

#include "catch.hpp"
#include "worlds.hpp"

#include <dem/dem.hpp>
#include <dem/world/rest.hpp>

#include "core/error_of.hpp"

namespace {

using models::Balls, models::VerletBalls;

}  // namespace

TEMPLATE_TEST_CASE("a plate on a spring comes to rest under its weight and a grain that is held", "", Balls,
                   VerletBalls) {
  // The grain of stiffness kn overlaps the plate by d. The plate gives way by x: k x = m g + kn (d - x).
  const double k = 5e3, kn = 2e3, mass = 2e-2, radius = 1e-3, d = 2e-5, g = 9.81;
  dem::World<TestType> world({.gravity = {0, 0, -g}, .time_step = 1e-6});
  world.set_contact({.normal = {.stiffness = kn, .damping = 0, .separation_factor = 1}, .friction = {}});
  const auto species = world.add_species(dem::shape::Sphere(radius));
  auto& machine = world.machine();
  const dem::Vec3 edges(4e-3, 4e-3, 1e-3);
  const dem::BodyId plate = machine.add_body(dem::mbd::box_body("plate", edges, mass / edges.prod()));
  const auto slide = machine.add_joint(dem::mbd::prismatic("slide", world.ground(), plate, {0, 0, 0}, {0, 0, 1}));
  const auto spring = machine.add_spring(dem::mbd::spring("spring", world.ground(), {0, 0, -0.1}, plate, {0, 0, 0}, k));
  world.add_surface(plate, dem::surface::Box(edges));
  const auto grain = world.add_grain({.species = species, .position = {0, 0, 0.5e-3 + radius - d}});

  const dem::mbd::RestReport before = find_rest(world);
  INFO(before.text);
  REQUIRE(before);
  const double x = (mass * g + kn * d) / (k + kn);
  REQUIRE(x > d);  // so the plate leaves the grain, and carries its weight alone
  CHECK(-machine.coordinate(slide) == Approx(mass * g / k).epsilon(1e-6));
  CHECK(machine.spring(spring).force == Approx(mass * g).epsilon(1e-6));

  // With a stiff spring it stays in contact.
  dem::World<TestType> stiff({.gravity = {0, 0, -g}, .time_step = 1e-6});
  stiff.set_contact({.normal = {.stiffness = kn, .damping = 0, .separation_factor = 1}, .friction = {}});
  const auto same = stiff.add_species(dem::shape::Sphere(radius));
  auto& m = stiff.machine();
  const dem::BodyId table = m.add_body(dem::mbd::box_body("table", edges, mass / edges.prod()));
  const auto guide = m.add_joint(dem::mbd::prismatic("guide", stiff.ground(), table, {0, 0, 0}, {0, 0, 1}));
  m.add_spring(dem::mbd::spring("leg", stiff.ground(), {0, 0, -0.1}, table, {0, 0, 0}, 10 * k));
  stiff.add_surface(table, dem::surface::Box(edges));
  (void)stiff.add_grain({.species = same, .position = {0, 0, 0.5e-3 + radius - d}});
  const dem::mbd::RestReport rest = find_rest(stiff);
  INFO(rest.text);
  REQUIRE(rest);
  CHECK(-m.coordinate(guide) == Approx((mass * g + kn * d) / (10 * k + kn)).epsilon(1e-5));
  CHECK(m.body(table).velocity().norm() == 0.0);
  CHECK(world.position(grain).z() == 0.5e-3 + radius - d);  // it was held
  REQUIRE(world.run(10));
}

TEMPLATE_TEST_CASE("velocities that a world's machine is given later move all that hangs together", "", Balls,
                   VerletBalls) {
  dem::World<TestType> world({.gravity = {0, 0, 0}, .time_step = 1e-4});
  auto& m = world.machine();
  const dem::Vec3 z(0, 0, 1);
  const dem::BodyId a = m.add_body(dem::mbd::given_body("a", 1.0, dem::Vec3(0.1, 0.1, 0.1)));
  const dem::BodyId b = m.add_body(dem::mbd::given_body("b", 1.0, dem::Vec3(0.2, 0.2, 0.2)).at({1, 0, 0}));
  const auto in = m.add_joint(dem::mbd::revolute("in", m.ground(), a, {0, 0, 0}, z));
  const auto out = m.add_joint(dem::mbd::revolute("out", m.ground(), b, {1, 0, 0}, z));
  m.add_coupling(dem::mbd::gear("gear", in, out, 2.0));
  REQUIRE(world.run(2));
  m.body(a).motion.angular_velocity = {0, 0, 3};
  CHECK(assemble(world).kinetic_before == Approx(0.5 * 0.1 * 9.0));
  // The change of least energy to speeds w and 2 w: 0.1 (3 - w) = 0.2 (2 w) 2.
  const double w = 1.0 / 3.0;
  CHECK(m.speed(in) == Approx(w).epsilon(1e-9));
  CHECK(m.speed(out) == Approx(2.0 * w).epsilon(1e-9));
  REQUIRE(world.run(2000));
  CHECK(m.speed(in) == Approx(w).epsilon(1e-6));
  CHECK(m.speed(out) == Approx(2.0 * w).epsilon(1e-6));
}

TEST_CASE("a search for rest that is refused leaves the machine as it was") {
  dem::World<Balls> world;
  world.set_contact("grain", "grain",
                    {.normal = {.stiffness = 2e3, .damping = 0, .separation_factor = 1}, .friction = {}});
  world.add_species(dem::shape::Sphere(1e-3));
  const dem::Vec3 edges(4e-3, 4e-3, 1e-3);
  const dem::BodyId block = world.machine().add_body(dem::mbd::box_body("block", edges, 1000).moving({3, 0, 0}));
  world.add_surface(block, dem::surface::Box(edges));
  check_refused([&] { (void)find_rest(world); }, "no contact constants");
  CHECK(world.machine().bodies()[block.index()].motion.velocity.x == 3.0);
}
