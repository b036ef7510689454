#pragma once

// Worlds with everything in them that a state may hold: grains in a box that is shaken, and a machine whose flap stirs
// them.

#include "checkpoint/folder.hpp"
#include "world/scenes.hpp"

#include <dem/io/checkpoint.hpp>

/// What a scene is set up with; tests change one thing.
struct SceneOptions {
  int threads = 1;
  int substeps = 1;
  double hinge_stiffness = 0.0;  ///< N/m; 0: derived
  double flap_density = 2650.0;
  double spring_stiffness = 20.0;
  double hinge_friction = 0.3;
  double rubber = 100.0;                                         ///< N/m, of the second piece of a bushing's table
  Vec3 left_axle = Vec3::Zero();                                 ///< m, from the middle of the left disc
  Vec3 end_of_arm = Vec3::Zero(), end_of_spring = Vec3::Zero();  ///< m, from where they are
  const char* hinge_name = "hinge";
  bool has_block = true;
};

template <class World>
void add_machine(World& world, const SceneOptions& o) {
  using namespace dem::mbd;
  auto& m = world.machine();
  m.substeps = o.substeps;
  m.joint_tolerance = 1.0;  // m: accuracy is not what is asked here, and sub-steps stay as they are
  const Vec3 edges(2e-3, 0.016, 0.018), top(4e-3, 0.010, 0.022);
  const auto slider = m.add_body(box_body("slider", Vec3::Constant(4e-3), 2650).at(top));
  const auto flap = m.add_body(box_body("flap", edges, o.flap_density).at(top - Vec3(0, 0, 0.5 * edges.z())));
  const auto slide = m.add_joint(prismatic("slide", world.ground(), slider, top, Vec3::UnitX()));
  auto hinge_spec = revolute(o.hinge_name, slider, flap, top, Vec3::UnitY())
                        .with_limits(-0.05, 0.05)
                        .with_friction({.coefficient = o.hinge_friction, .radius = 1e-3});
  if (o.hinge_stiffness > 0.0) hinge_spec = hinge_spec.with_stiffness(o.hinge_stiffness, 1e-3 * o.hinge_stiffness);
  const auto hinge = m.add_joint(hinge_spec);
  const auto stirring = m.add_motion(prescribed_joint(
      "stirring", slide, Signal::function([](double t) { return 1e-3 * (1.0 - std::cos(400.0 * t)); })));
  world.add_surface(flap, dem::surface::Box(edges), {.name = "flap"});
  m.add_sensor(contact_sensor("grains on the flap", flap, 1e-3));
  m.add_sensor(total_force_sensor("all on the flap", flap, 2e-3));
  m.add_sensor(joint_sensor("in the hinge", hinge, 1e-3));
  m.add_sensor(drive_sensor("of the drive", stirring, 1e-3));

  // Two discs beside the box, geared, one driven by a motor, and hung from each other.
  const Vec3 left(0, -0.03, 0.03), right(0.02, -0.03, 0.03);
  const auto a = m.add_body(cylinder_body("left disc", 5e-3, 2e-3, 2650).at(left));
  const auto b = m.add_body(cylinder_body("right disc", 5e-3, 2e-3, 2650).at(right));
  const auto axle_a = m.add_joint(revolute("left axle", world.ground(), a, left + o.left_axle, Vec3::UnitZ()));
  const auto axle_b = m.add_joint(revolute("right axle", world.ground(), b, right, Vec3::UnitZ()));
  m.add_coupling(gear("gears", axle_a, axle_b, -1.5));
  m.add_actuator(motor("motor", axle_a, Curve{{0.0, 2e-5}, {400.0, 0.0}}, 0.7));
  const auto arm = m.add_actuator(linear_actuator("arm", world.ground(), left + Vec3(4e-3, 0.01, 0), b,
                                                  right + Vec3(4e-3, 0, 0) + o.end_of_arm, 2.0, 1e-3,
                                                  Signal::sine(1e-3, 50.0, 0, 0.02)));
  m.add_sensor(actuator_sensor("of the arm", arm, 1e-3));
  m.add_spring(spring("spring", a, left + Vec3(4e-3, 0, 0), b, right - Vec3(4e-3, 0, 0) + o.end_of_spring,
                      o.spring_stiffness, 1e-3));
  m.add_load(applied_force("push", b, right, {1, 0, 0}, Signal::ramp(0.0, 1e-3)));
  m.add_load(custom_load("drag", a, [](double, const dem::Body& body) {
    return dem::Wrench{dem::from_eigen(Vec3(-1e-3 * body.velocity())), {0, 0, 0}};
  }));

  // A bushing holds a plate, on which a block falls that would else fall for ever.
  if (o.has_block) {
    const Vec3 place(0.05, 0, 0.01);
    const auto plate = m.add_body(box_body("plate", {0.01, 0.01, 2e-3}, 2650).at(place));
    m.add_joint(bushing("mount", world.ground(), plate, place, Vec3::UnitZ(), Vec3::Constant(500), Vec3::Constant(0.05),
                        Vec3::Constant(0.1), Vec3::Constant(1e-5)));
    m.add_joint(bushing("rubber", world.ground(), plate, place, Vec3::UnitZ(),
                        {.z = {{0.0, 0.0}, {1e-4, 1e-3}, {2e-4, 1e-3 + 1e-4 * o.rubber}}}, Vec3::Constant(0.01),
                        Vec3::Zero()));
    const auto block = m.add_body(box_body("block", Vec3::Constant(4e-3), 1000).at(place + Vec3(0, 0, 3.01e-3)));
    const auto s1 = world.add_surface(plate, dem::surface::Box({0.01, 0.01, 2e-3}), {.name = "plate"});
    const auto s2 = world.add_surface(block, dem::surface::Box(Vec3::Constant(4e-3)), {.name = "block"});
    world.add_body_contact(s1, s2);
    world.add_surface_sensor(s1, 1e-3);
  }
}

/// Grains of two sizes in a box with a machine.
template <class Model>
struct Scene {
  dem::World<Model> world;
  int contacts_of_bodies = 0;  ///< seen at the ends of pieces of run()

  explicit Scene(const SceneOptions& o, const dem::ContactParameters<Model>& contact,
                 const std::vector<typename Model::Shape>& shapes, bool has_grains = true)
      : world([&] {
          dem::WorldOptions w = options({0, 0, -9.81}, 1e-5);
          w.threads = o.threads;
          return w;
        }()) {
    world.set_contact(contact);
    world.set_contact("grain", "wall", contact);
    std::vector<SpeciesId> kinds;
    for (const auto& shape : shapes) kinds.push_back(world.add_species(shape));
    add_open_box(world, {0.020, 0.020, 0});
    add_machine(world, o);
    if (!has_grains) return;
    const double pitch = 2.04 * world.state().largest_radius, start = 0.9 * pitch;
    const int n = static_cast<int>((0.020 - 2 * start) / pitch) + 1, nx = n - 2;
    Random random(3);
    for (int k = 0; k < 320; ++k) {
      dem::NewGrain p;
      p.species = kinds[static_cast<std::size_t>(k) % kinds.size()];
      p.position = Vec3(8e-3 + start, start, start) + pitch * Vec3(k % nx, k / nx % n, k / (nx * n));
      if (p.position.x() > 0.020 - start) continue;
      p.rotation = random.rotation();
      p.velocity = random.vector(0.5);
      world.add_grain(p);
    }
  }

  /// The box is shaken: gravity swings, and is ten times the earth's, so that grains lie on each other soon.
  void run(std::uint64_t steps) {
    for (std::uint64_t k = 0; k < steps; k += 10) {
      world.set_gravity({world.steps() / 100 % 2 == 0 ? 40.0 : -40.0, 0, -98.1});
      const auto report = world.run(std::min<std::uint64_t>(10, steps - k));
      INFO(report.text);
      REQUIRE(report);
      for (const auto& pair : world.state().body_contacts.pairs) contacts_of_bodies += pair.contacts;
    }
  }
};

/// The text of the error that `f` throws, or "no error".
template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const dem::Error& error) {
    return error.what();
  }
  return "no error";
}
