// How a world chooses and checks its time step where it has a machine, and that a refused motion leaves it as it was.

#include "catch.hpp"
#include "core/error_of.hpp"
#include "worlds.hpp"

#include <dem/dem.hpp>
#include <dem/mbd/mbd.hpp>

namespace {

using dem::BodyId;
using dem::Vec3;

using models::Balls, models::CorrectedBalls, models::VerletBalls;

template <class World>
void set_sand(World& world, double mu, double stiffness = 2000.0) {
  world.set_contact(
      {.normal = {.stiffness = stiffness, .damping = 0.015, .separation_factor = 0.05},
       .friction = {.coefficient = mu, .stiffness = stiffness, .velocity_stiffness = 0.015, .breaking_factor = 0.975}});
}

/// A rod of 10 kg that hangs from a hinge at the origin, released horizontal.
template <class Machine>
BodyId add_rod(Machine& m) {
  const BodyId rod = m.add_body(dem::mbd::box_body("rod", {1.0, 0.1, 0.1}, 1000.0).at({0.5, 0.0, 0.0}));
  m.add_joint(dem::mbd::revolute("hinge", m.ground(), rod, {0, 0, 0}, {0, 1, 0}));
  return rod;
}

}  // namespace

TEMPLATE_TEST_CASE("an automatic time step stays, whatever is changed that does not limit it", "", CorrectedBalls,
                   Balls, VerletBalls) {
  dem::World<TestType> world;
  set_sand(world, 0.4);
  const auto species = world.add_species(dem::shape::Sphere(1e-3));
  world.add_grain({.species = species, .position = {0, 0, 10}});
  const BodyId rod = add_rod(world.machine());
  const BodyId post = world.machine().add_body(dem::mbd::box_body("post", {0.1, 0.1, 0.1}, 1000.0).at({5, 0, 0}));
  REQUIRE(world.run(3));
  const double dt = world.time_step();
  // Of the grains alone: what is derived for the hinge fits whatever step is chosen.
  dem::World<TestType> grains;
  set_sand(grains, 0.4);
  grains.add_species(dem::shape::Sphere(1e-3));
  CHECK(dt == 0.5 * grains.stable_time_step().dt);
  set_sand(world, 0.3);
  REQUIRE(world.run(1));
  world.add_grain({.species = species, .position = {0, 0, 11}});
  REQUIRE(world.run(1));
  for (int k = 0; k < 10; ++k) {
    world.machine().set_fixed(k % 4 < 2 ? rod : post, k % 2 == 0);
    REQUIRE(world.run(2));
    CHECK(world.time_step() == dt);
  }
  // Four times as stiff grains halve it. The hinge stays as it was derived: strained joints that became stiffer at once
  // would jump. The rod has turned by less than 1e-6 rad meanwhile.
  const double k = world.machine().joint(dem::JointId(0)).k;
  set_sand(world, 0.3, 8000.0);
  REQUIRE(world.run(1));
  CHECK(world.time_step() < 0.6 * dt);
  CHECK(world.machine().joint(dem::JointId(0)).k == Catch::Approx(k).epsilon(1e-6));
}

TEST_CASE("a world's time step is changed between runs, and a strained joint bears what it bore") {
  dem::World<Balls> world;
  set_sand(world, 0.4);
  const auto grain = world.add_grain({.species = world.add_species(dem::shape::Sphere(1e-3)), .position = {0, 0, 10}});
  auto& m = world.machine();
  const BodyId bob = m.add_body(dem::mbd::box_body("bob", {0.1, 0.1, 0.1}, 1000.0).at({0, 0, -1}));
  const auto pin = m.add_joint(dem::mbd::fixed("pin", m.ground(), bob, {0, 0, -1}));
  const auto bears_the_weight = [&] { CHECK(m.reaction(pin).force.z == Approx(9.81).epsilon(1e-3)); };
  REQUIRE(world.run(1000));  // swings at omega dt = 0.7 of half critical damping have gone after 50
  bears_the_weight();
  const double chosen = world.time_step();

  world.set_time_step(0.05 * chosen);
  const double start = world.time(), height = world.position(grain).z(), speed = world.velocity(grain).z();
  for (int k = 0; k < 20; ++k) {
    REQUIRE(world.run(1));
    bears_the_weight();  // derived for this step the pin would be 400 times as stiff, and throw the bob
  }
  CHECK(world.time_step() == 0.05 * chosen);
  CHECK(world.time() - start == Approx(chosen).epsilon(1e-6));
  // Free fall, to less than what one long step would be off.
  const double fall = height - world.position(grain).z();
  CHECK(fall == Approx(-speed * chosen).margin(9.81 * chosen * chosen));
  check_refused([&] { world.set_time_step(-1e-5); }, "time step", "-1e-05", "(0 chooses one)");
  check_refused([&] { world.set_time_step(NAN); }, "time step");

  // What is added or changed meanwhile throws nothing either.
  double k = m.joint(pin).k;
  const BodyId post = m.add_body(dem::mbd::box_body("post", {0.1, 0.1, 0.1}, 1000.0).at({5, 0, 0}));
  REQUIRE(world.run(1));
  bears_the_weight();
  m.set_fixed(post);
  REQUIRE(world.run(1));
  bears_the_weight();
  CHECK(m.joint(pin).k == Approx(k).epsilon(1e-9));
  k = m.joint(pin).k;

  // One that is too large is refused, and leaves all as it was.
  const double before = world.time();
  for (const double share : {10.0, 100.0}) {
    world.set_time_step(share * chosen);
    check_refused([&] { (void)world.run(1); }, "is above the largest stable one",
                  "lower time_step (World::set_time_step)");
    CHECK(world.time() == before);
    CHECK(m.joint(pin).k == k);
    CHECK(m.substeps == 1);
  }
  world.set_time_step(0.0);
  for (int again = 0; again < 20; ++again) {
    REQUIRE(world.run(1));
    bears_the_weight();
  }
  CHECK(world.time_step() == chosen);
  CHECK(m.joint(pin).k == k);

  // Within a run it holds from the next step on.
  int steps = 0;
  REQUIRE(world.run_for(10.0 * chosen, [&] {
    if (++steps == 5) world.set_time_step(0.5 * chosen);
    return true;
  }));
  CHECK(steps == 5 + 10);

  // What a span leaves of a step is owed as time.
  world.set_time_step(chosen);
  const double from = world.time();
  REQUIRE(world.run_for(1.45 * chosen));
  world.set_time_step(0.05 * chosen);
  REQUIRE(world.run_for(0.55 * chosen));
  CHECK(world.time() - from == Approx(2.0 * chosen).epsilon(1e-9));
}

TEST_CASE("a time step that is refused before the first one leaves the machine as it was given") {
  dem::World<Balls> world({.time_step = 1e-2});
  set_sand(world, 0.4);
  world.add_grain({.species = world.add_species(dem::shape::Sphere(1e-3)), .position = {0, 0, 10}});
  add_rod(world.machine());
  check_refused([&] { world.prepare(); }, "time step 0.01 s is above", "lower time_step or the stiffness");
  CHECK(world.machine().substeps == 1);
  CHECK(world.machine().joint(dem::JointId(0)).k == 0.0);
  world.set_time_step(0.0);
  REQUIRE(world.run(1));
  dem::World<Balls> other;
  set_sand(other, 0.4);
  other.add_grain({.species = other.add_species(dem::shape::Sphere(1e-3)), .position = {0, 0, 10}});
  add_rod(other.machine());
  REQUIRE(other.run(1));
  CHECK(world.time_step() == other.time_step());
  CHECK(world.machine().joint(dem::JointId(0)).k == other.machine().joint(dem::JointId(0)).k);
}

TEST_CASE("the first joint of a world that has run is derived for the present time step") {
  dem::World<Balls> grains;
  set_sand(grains, 0.4);
  grains.add_grain({.species = grains.add_species(dem::shape::Sphere(1e-3)), .position = {0, 0, 10}});
  dem::World<Balls> world = grains;
  REQUIRE(world.run(2));
  world.set_time_step(0.01 * world.time_step());
  REQUIRE(world.run(2));
  grains.set_time_step(world.time_step());
  for (auto* w : {&world, &grains}) {
    add_rod(w->machine());
    REQUIRE(w->run(1));
  }
  CHECK(world.machine().joint(dem::JointId(0)).k == grains.machine().joint(dem::JointId(0)).k);
  CHECK(world.machine().substeps == grains.machine().substeps);
}

TEST_CASE("joints under load get stiffer by and by where parts that are added raise the sub-steps") {
  dem::World<Balls> world;
  set_sand(world, 0.4);
  world.add_grain({.species = world.add_species(dem::shape::Sphere(1e-3)), .position = {0, 0, 10}});
  auto& m = world.machine();
  m.joint_tolerance = 1e-4;
  const BodyId bob = m.add_body(dem::mbd::box_body("bob", {0.1, 0.1, 0.1}, 1000.0).at({0, 0, -1}));
  const auto pin = m.add_joint(dem::mbd::fixed("pin", m.ground(), bob, {0, 0, -1}));
  REQUIRE(world.run(1000));
  const double first = m.joint(pin).k;
  // A tonne that hangs from a hook of half a gram.
  const BodyId hook = m.add_body(dem::mbd::given_body("hook", 5e-4, Vec3::Constant(1e-6)).at({5, 0, 0}));
  m.add_joint(dem::mbd::fixed("eye", m.ground(), hook, {5, 0, 0}));
  const BodyId block = m.add_body(dem::mbd::box_body("block", {1, 1, 1}, 1000.0).at({5, 0, -2}));
  m.add_joint(dem::mbd::fixed("rope", hook, block, {5, 0, 0}));
  double before = first;
  for (int step = 0; step < 20; ++step) {
    REQUIRE(world.run(1));
    const double k = m.joint(pin).k;
    CHECK(k <= (step == 0 ? 16.0 : 4.0) * 1.001 * before);  // it grows before the first step, too
    // A spring that becomes four times as stiff pulls by three weights too much, until its body has moved. One that
    // becomes 256 times as stiff throws it: at the end of the first step it pushes by five weights.
    CHECK(std::abs(m.reaction(pin).force.z - 9.81) < 3.0 * 9.81);
    before = k;
  }
  CHECK(m.substeps > 10);
  CHECK(before > 100.0 * first);
  CHECK(m.reaction(pin).force.z == Approx(9.81).epsilon(1e-3));
}

TEST_CASE("a given stiffness limits the automatic time step, together with what is derived on the same body") {
  // A block on a bushing of 1e4 N/m, without any margin: alone the bushing would be stable up to 2/omega, but the joint
  // that is derived on the same body adds to it.
  dem::World<Balls> world({.time_step_safety = 1.0});
  auto& m = world.machine();
  const BodyId block = m.add_body(dem::mbd::given_body("block", 1.0, Vec3(0.1, 0.1, 0.1)).moving({1e-3, 0, 0}));
  m.add_joint(dem::mbd::bushing("mount", m.ground(), block, {0, 0, 0}, {0, 0, 1}, {1e4, 0, 0}, {0, 0, 0}, {0, 0, 0},
                                {0, 0, 0}));
  m.add_joint(dem::mbd::point_on_plane("slot", m.ground(), block, {0, 0, 0}, {1, 0, 0}));
  REQUIRE(world.run(2000));
  CHECK(world.time_step() < 2.0 / 100.0);
  CHECK(world.time_step() > 0.5 / 100.0);
  CHECK(world.stable_time_step().dt >= world.time_step());
  CHECK(std::abs(m.body(block).velocity().x()) <= 1e-3);  // the kick has not grown in 2000 steps
}

TEST_CASE("a world judges its machine with what is derived for the step, as a machine alone does") {
  // One direction of a body is held by a given bushing at omega dt = 1.9 and by a derived joint: each alone is stable,
  // both together are not (Euler: omega dt < 2).
  const double dt = 1e-3, k = std::pow(1.9 / dt, 2);
  const auto build = [&](auto& m) {
    const BodyId block = m.add_body(dem::mbd::given_body("block", 1.0, Vec3(0.1, 0.1, 0.1)));
    m.add_joint(dem::mbd::bushing("mount", m.ground(), block, {0, 0, 0}, {0, 0, 1}, {k, 0, 0}, {0, 0, 0}, {0, 0, 0},
                                  {0, 0, 0}));
    m.add_joint(dem::mbd::point_on_plane("slot", m.ground(), block, {0, 0, 0}, {1, 0, 0}));
  };
  dem::mbd::Machine<dem::integrator::SymplecticEuler> alone;
  build(alone);
  check_refused([&] { (void)alone.step(dt); }, "bushing 'mount'", "raise substeps (now 1)");
  dem::World<Balls> world({.time_step = dt});
  build(world.machine());
  check_refused([&] { (void)world.step(); }, "time step 0.001 s", "bushing 'mount'", "raise machine().substeps above 1",
                "allow_unstable_time_step");
  world.machine().substeps = 2;
  CHECK(world.run(100));
}

TEST_CASE("the stable step that a world's refusal names is accepted when it is taken") {
  const auto build = [](auto& m) {
    m.most_substeps = 1;  // or a world takes as many as the step needs
    const BodyId arm = m.add_body(dem::mbd::box_body("arm", {0.5, 0.05, 0.05}, 1000).at({0.25, 0, 0}));
    const BodyId wheel = m.add_body(dem::mbd::given_body("wheel", 0.5, Vec3(0.01, 0.01, 0.01)).at({0.5, 0, 0}));
    m.add_joint(dem::mbd::revolute("pivot", m.ground(), arm, {0, 0, 0}, {0, 1, 0}));
    m.add_joint(dem::mbd::revolute("axle", arm, wheel, {0.5, 0, 0}, {0, 1, 0}));
    m.add_spring(dem::mbd::spring("strut", m.ground(), {0.5, 0, 0.4}, wheel, {0.5, 0, 0.01}, 1e5, 800.0));
  };
  dem::World<Balls> world({.time_step = 5e-2});
  build(world.machine());
  const std::string text = message_of([&] { world.prepare(); });
  const std::string before = "largest stable one, ";
  const auto at = text.find(before);
  INFO(text);
  REQUIRE(at != std::string::npos);
  const double named = std::stod(text.substr(at + before.size()));
  for (const double share : {1.0, 1.01}) {  // a step that is 1 % longer is refused
    dem::World<Balls> again({.time_step = share * named});
    build(again.machine());
    if (share > 1.0) CHECK_THROWS_AS(again.prepare(), dem::Error);
    else CHECK_NOTHROW(again.prepare());
  }
}

TEST_CASE("a world that refuses its time step for a joint of given stiffness names the joint") {
  dem::World<Balls> world({.time_step = 1e-3});
  auto& m = world.machine();
  const BodyId block = m.add_body(dem::mbd::given_body("block", 1.0, Vec3(0.1, 0.1, 0.1)));
  m.add_joint(dem::mbd::spherical("pin", m.ground(), block, {0, 0, 0}).with_stiffness(1e8, 0).with_damping(0, 0));
  check_refused([&] { world.prepare(); }, "spherical joint 'pin'", "0.0001999 s", "raise machine().substeps");
  m.substeps = 8;
  CHECK(world.run(10));
}

TEMPLATE_TEST_CASE("a world survives a refused motion unchanged", "", CorrectedBalls, Balls, VerletBalls) {
  const int substeps = GENERATE(1, 3);
  const auto build = [&](dem::World<TestType>& world) {
    set_sand(world, 0.4);
    const auto species = world.add_species(dem::shape::Sphere(1e-3));
    world.add_grain({.species = species, .position = {0, 0, 1}, .velocity = {0.1, 0, 0}});
    auto& m = world.machine();
    m.substeps = substeps;
    const BodyId rod = add_rod(m);
    m.add_sensor(dem::mbd::total_force_sensor("on the rod", rod, 0.0));
    REQUIRE(world.run(10));
  };
  dem::World<TestType> world({.time_step = 1e-5}), other({.time_step = 1e-5});
  build(world);
  build(other);
  auto& m = world.machine();
  const auto motion = m.add_motion(dem::mbd::prescribed_joint("jump", dem::JointId(0), 0.3));
  const Vec3 grain = world.position(dem::GrainId(0)), rod = m.body(BodyId(0)).position();
  for (int again = 0; again < 2; ++again) {
    check_refused([&] { (void)world.run(5); }, "motion 'jump' is 0.3", "let its signal start there");
    CHECK(world.position(dem::GrainId(0)) == grain);
    CHECK(m.body(BodyId(0)).position() == rod);
    CHECK(m.parts().sensors.size() == 1);
  }
  // Switched off, it is as if it had never been there.
  m.switch_on(motion, false);
  REQUIRE(world.run(5));
  REQUIRE(other.run(5));
  CHECK(world.time() == other.time());
  CHECK(world.position(dem::GrainId(0)) == other.position(dem::GrainId(0)));
  CHECK(m.body(BodyId(0)).position() == other.machine().body(BodyId(0)).position());
  CHECK(m.sensor(dem::SensorId(0)).latest().force.z == other.machine().sensor(dem::SensorId(0)).latest().force.z);
}
