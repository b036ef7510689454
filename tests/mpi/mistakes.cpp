#include "box_of_spheres.hpp"

namespace scenes {

namespace {

bool is_last(const dem::World<Shared>& world) { return dem::processes.rank == world.state().domain.ranks() - 1; }

/// A world, which `change(world)` makes another one on the last rank: all are told in which part.
template <class Change>
bool told_of(const std::string& part, dem::World<Shared>& world, Change&& change) {
  if (is_last(world)) change(world);
  std::string told;
  try {
    world.prepare();
  } catch (const dem::Error& e) {
    told = e.what();
  }
  const auto& d = world.state().domain;
  if (!d.is_shared() || d.all(told.find("they differ in " + part) != told.npos)) return true;
  std::printf("%s on one rank: all were to be told, but rank %d was told '%s'\n", part.c_str(), d.rank(), told.c_str());
  return false;
}
/// The same of a world that was just set up.
template <class Change>
bool told_of(const std::string& part, Change&& change) {
  auto world = box_of_spheres<Shared>(300);
  return told_of(part, world, change);
}

/// A shaft that turns above the spheres, by a motor that holds its speed, and by a throttle.
struct Drives {
  dem::BodyId shaft;
  dem::JointId hinge;
  dem::ActuatorId motor, engine;
  dem::InletId inlet;
};
Drives add_drives(dem::World<Shared>& world) {
  using namespace dem::mbd;
  auto& m = world.machine();
  const auto shaft = m.add_body(box_body("shaft", dem::Vec3::Constant(4e-3), 2650).at({0, 0, 0.3}));
  const auto hinge = m.add_joint(revolute("hinge", m.ground(), shaft, {0, 0, 0.3}, {0, 0, 1}));
  const auto motor = m.add_actuator(joint_actuator("motor", hinge, 0.0, 1e-6, Signal::held(0.0, 2.0)));
  const auto engine = m.add_actuator(dem::mbd::motor("engine", hinge, {{{-10, 1e-6}, {10, 1e-6}}}));
  const auto beads = world.add_species(dem::shape::Sphere(1e-3));
  const auto inlet = world.add_inlet(dem::InletRegion::disc({0.015, 0.01, 0.09}, {0, 0, -1}, 5e-3),
                                     {.grains = beads, .grain_flow = 1e4});
  return {shaft, hinge, motor, engine, inlet};
}
/// The same of a world with drives that has taken steps.
template <class Change>
bool told_later(const std::string& part, Change&& change) {
  auto world = box_of_spheres<Shared>(300);
  const Drives drives = add_drives(world);
  run(world, 10);
  return told_of(part, world, [&](auto& w) { change(w, drives); });
}

}  // namespace

bool differ_later() {
  bool told = told_later("the time, how many", [](auto& w, const Drives& d) { w.set_open(d.inlet, false); });
  const auto steer = [&](void (*change)(dem::mbd::Mechanism&, const Drives&)) {
    told = told_later("the machine", [&](auto& w, const Drives& d) { change(w.machine(), d); }) && told;
  };
  steer([](auto& m, const Drives& d) { m.set_target(d.motor, 0.0, 2.5); });
  steer([](auto& m, const Drives& d) { m.switch_on(d.motor, false); });
  steer([](auto& m, const Drives& d) { m.switch_on(d.hinge, false); });
  steer([](auto& m, const Drives& d) { m.set_throttle(d.engine, 0.1); });
  steer([](auto& m, const Drives& d) { m.body(d.shaft).motion.velocity.x = 1e-9; });
  // Functions cannot be compared; what they did to the machine is.
  auto turning = box_of_spheres<Shared>(300);
  const Drives drives = add_drives(turning);
  run(turning, 10);
  turning.machine().set_target(drives.motor, dem::mbd::Signal::function([last = is_last(turning)](double t) {
                                 return last ? 2.5 * t : 2.0 * t;
                               }));
  (void)turning.run(10);
  told = told_of("the machine", turning, [](auto&) {}) && told;
  // As many as the others have, but another one.
  auto world = box_of_spheres<Shared>(300);
  const auto beads = world.add_species(dem::shape::Sphere(1e-3));
  run(world, 10);
  const double flow = is_last(world) ? 2e4 : 1e4;
  world.add_inlet(dem::InletRegion::disc({0.015, 0.01, 0.09}, {0, 0, -1}, 5e-3), {.grains = beads, .grain_flow = flow});
  told = told_of("the machine (its parts, set points, switches, or how it moves), an outlet or an inlet", world,
                 [](auto&) {}) &&
         told;
  return told;
}

void steered() {
  auto world = box_of_spheres<Shared>(300);
  const Drives drives = add_drives(world);
  run(world, 10);
  if (is_last(world)) world.machine().set_target(drives.motor, 0.0, 2.5);
  run(world, 10);
}

bool differ() {
  bool told = told_of("materials or contact constants", [](auto& world) {
    world.set_contact({.normal = {2000, 0.015, 0.05}, .friction = {0.3, 2000, 0.015, 0.975}});
  });
  told = told_of("options", [](auto& world) { world.set_gravity({0, 0, -1.62}); }) && told;
  // As many as the others have, but other ones.
  const auto with_density = [](double density) {
    return [=](auto& world) { world.state().species[0].density = density; };
  };
  told = told_of("species", with_density(2000)) && told;
  told = told_of("surfaces", [](auto& world) { world.set_active(dem::SurfaceId(4), false); }) && told;
  told = told_of("grains", [](auto& world) { world.state().grains.position.set(7, {0.01, 0.01, 0.08}); }) && told;
  told = told_of("the machine", [](auto& world) { world.machine().largest_speed = 7.0; }) && told;
  return told;
}

void mistake() {
  auto world = box_of_spheres<Shared>(1500);
  const auto block =
      world.machine().add_body(dem::mbd::box_body("block", dem::Vec3::Constant(4e-3), 2650).at({1, 0, 0}));
  const int rank = world.state().domain.rank(), last = world.state().domain.ranks() - 1;
  world.machine().add_load(dem::mbd::custom_load("wind", block, [=](double t, const dem::Body&) {
    if (rank == last && t > 100 * dt) dem::fail("the wind broke off at t = {:g} s", t);
    return dem::Wrench{};
  }));
  (void)world.run(100000);
}

void disagree() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  if (world.state().domain.rank() == world.state().domain.ranks() - 1) {
    world.set_velocity(dem::GrainId(0), {0, 0, 1});
  }
  (void)world.run(10);
}

bool caught() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  try {
    if (is_last(world)) dem::fail("there is no file for this rank");
  } catch (const dem::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return false;
  }
  run(world, 10);
  return true;
}

void contacts_on_one() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  if (dem::processes.rank == 0) std::printf("%zu contacts\n", contacts_of(world).size());
  run(world, 10);
}

void columns_on_one() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  if (dem::processes.rank == 0) std::printf("%zu columns\n", dem::io::columns_of(world).size());
  run(world, 10);
}

void run_on_one() {
  auto world = box_of_spheres<Shared>(1500);
  run(world, 10);
  if (dem::processes.rank == 0) run(world, 10);
}

}  // namespace scenes
