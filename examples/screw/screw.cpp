// A screw conveyor: a helical blade, a mesh made by code, turns in a trough and carries grains of a sieve curve from
// under an inlet to the end of the trough. Out comes what goes in, as fast as the blade advances.
//
//   screw --seconds 5 --output out/screw
//
// Writes flow.gp (mass over time) and picture.gp, and draws them where gnuplot is installed.

#include "arguments.hpp"
#include "picture.hpp"

#include <dem/dem.hpp>
#include <dem/report/plot.hpp>
#include <dem/soil/size_classes.hpp>

#include <algorithm>
#include <numbers>

using namespace dem;

struct Gravel : Model {
  using Shape = shape::Sphere;
  using Normal = contact::LinearSpringDashpot;
  using Friction = friction::CundallStrack;
  using Integrator = integrator::VelocityVerlet;
};

constexpr double pi = std::numbers::pi;

/// A blade that winds about x from 0 to `length`, as thick as `thickness` along x.
IndexedMesh helix(double inner, double outer, double pitch, double length, double thickness) {
  IndexedMesh m;
  const int steps = static_cast<int>(32 * length / pitch);
  for (int k = 0; k <= steps; ++k) {
    const double x = length * k / steps, a = 2 * pi * x / pitch;
    for (const auto& [r, dx] : {std::pair(inner, -0.5), {outer, -0.5}, {outer, 0.5}, {inner, 0.5}}) {
      m.vertices.emplace_back(x + dx * thickness, r * std::cos(a), r * std::sin(a));
    }
  }
  const auto at = [](int k, int corner) { return static_cast<std::uint32_t>(4 * k + corner % 4); };
  for (int k = 0; k < steps; ++k) {
    for (int c = 0; c < 4; ++c) m.add_quad(at(k, c), at(k, c + 1), at(k + 1, c + 1), at(k + 1, c));
  }
  m.add_quad(at(0, 3), at(0, 2), at(0, 1), at(0, 0));
  m.add_quad(at(steps, 0), at(steps, 1), at(steps, 2), at(steps, 3));
  return m;
}

/// The sheet of a trough along x: half a circle with straight sides up to `top`.
IndexedMesh trough(double radius, double top, double length) {
  IndexedMesh m;
  constexpr int arc = 32;
  for (int k = -1; k <= arc + 1; ++k) {
    const double a = pi * (1.0 + std::clamp(double(k) / arc, 0.0, 1.0)),
                 z = k < 0 || k > arc ? top : radius * std::sin(a);
    for (const double x : {0.0, length}) m.vertices.emplace_back(x, radius * std::cos(a), z);
    const auto n = static_cast<std::uint32_t>(m.vertices.size());
    if (k >= 0) m.add_quad(n - 4, n - 3, n - 1, n - 2);
  }
  return m;
}

int main(int argc, char** argv) {
  Arguments arguments(argc, argv);
  const double seconds = arguments.number("--seconds", 5.0);
  const std::string folder = arguments.take("--output", "screw");
  arguments.check();
  const double outer = 24e-3, shaft = 8e-3, pitch = 40e-3, length = 4 * pitch, turns = 2.0;  // m, 1/s
  const double flow = 0.06;                                                                  // kg/s

  World<Gravel> world;
  world.set_contact({.normal = contact::LinearSpringDashpot::with_restitution(1000, 0.5), .friction = {0.4, 700, 0.1}});
  const auto curve = soil::SizeDistribution::sieve_curve({{3e-3, 0}, {4e-3, 60}, {6e-3, 100}});
  const Mixture gravel =
      soil::add_sizes(world, curve, 5, [](double d) { return shape::Sphere(0.5 * d); }, {.density = 2500});

  auto& machine = world.machine();
  const BodyId screw = machine.add_body(mbd::cylinder_body("screw", shaft, length, 7800));
  const JointId axle = machine.add_joint(mbd::revolute("axle", machine.ground(), screw, {0, 0, 0}, Vec3::UnitX()));
  machine.add_motion(mbd::prescribed_joint("motor", axle, mbd::Signal::ramp(0, -2 * pi * turns)));
  const SensorId load = machine.add_sensor(mbd::contact_sensor("grains on the screw", screw, 0.25 * seconds));
  world.add_surface(screw, surface::TriangleMesh(helix(0.9 * shaft, outer, pitch, length, 3e-3)), {.name = "blade"});
  world.add_surface(
      screw, surface::Cylinder(shaft, length),
      {.name = "shaft", .position = {0.5 * length, 0, 0}, .rotation = rotation_between(Vec3::UnitZ(), Vec3::UnitX())});
  world.add_surface(
      world.ground(),
      surface::TriangleMesh(trough(outer + 0.6e-3, 2 * outer, length), {.side = surface::MeshSide::two_sided}),
      {.name = "trough"});
  world.add_surface(world.ground(), surface::Plane{},
                    {.name = "end", .rotation = rotation_between(Vec3::UnitZ(), Vec3::UnitX())});

  const InletId in =
      world.add_inlet(InletRegion::box({5e-3, -0.7 * outer, 1.6 * outer}, {1.2 * pitch, 0.7 * outer, 2 * outer}),
                      {.name = "feed", .grains = gravel, .mass_flow = flow, .velocity = {0, 0, -0.5}});
  const OutletId out = world.add_outlet({Vec3(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL), Vec3(HUGE_VAL, HUGE_VAL, -2 * outer)},
                                        {.name = "end", .window = 0.25 * seconds});

  io::Series fed{.name = "fed"}, carried{.name = "carried"};
  double mass = 0.0, momentum = 0.0;  // of the grains in the third turn, over the last fifth of the time
  while (world.time() < seconds) {
    const auto report = world.run_for(0.05);
    if (!report) return fmt::print("{}\n", report.text), 1;
    if (!report.note.empty()) fmt::print("{}\n", report.note);
    fed.x.push_back(world.time()), carried.x.push_back(world.time());
    fed.y.push_back(1e3 * world.inlet(in).mass()), carried.y.push_back(1e3 * world.outlet(out).mass());
    if (world.time() < 0.8 * seconds) continue;
    for (const ParticleId p : world.particles()) {
      if (const double x = world.position(p).x(); x < 2 * pitch || x > 3 * pitch) continue;
      const double m = world.species(world.species_of(p)).mass;
      mass += m, momentum += m * world.velocity(p).x();
    }
  }

  Picture picture({1, 0, 0}, Vec3(0, 0.5, 0.87));
  for (const ParticleId p : world.particles()) {
    const double radius = world.species(world.species_of(p)).shape.radius();
    picture.grain(world.position(p), radius, Picture::heat((radius - 1.5e-3) / 1.5e-3));
  }
  std::vector<Vec3> edge;
  for (int k = 0; k <= 200; ++k) {
    const double x = length * k / 200, a = 2 * pi * x / pitch;
    edge.push_back(machine.body(screw).point({x, outer * std::cos(a), outer * std::sin(a)}));
  }
  picture.line(edge);
  for (const double y : {-outer, outer}) picture.line({Vec3(0, y, 0), Vec3(length, y, 0)}, 0x909090);
  picture.save(folder + "/picture", "A screw conveyor from above and the side: gravel by size", 1200, 520);
  io::render_plot({.x_label = "time [s]", .y_label = "mass [g]", .series = {fed, carried}}, folder + "/flow");

  const double advance = pitch * turns, torque = machine.sensor(load).mean().torque.x;
  fmt::print("{} grains fed, {} on the way; fed {:.1f} g/s, carried {:.1f} g/s\n", world.inlet(in).grains(),
             world.particle_count(), 1e3 * flow, 1e3 * world.outlet(out).mass_flow());
  fmt::print("grains go at {:.3f} of the blade's advance of {:.0f} mm/s; torque {:.4f} N m, {:.1f} J/kg\n",
             momentum / mass / advance, 1e3 * advance, torque, std::abs(torque) * 2 * pi * turns / flow);
}
