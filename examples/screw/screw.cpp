// A screw conveyor: a helical blade, a mesh made by code, turns in a trough and carries grains of a sieve curve from
// under an inlet to the end of the trough. Out comes what goes in, as fast as the blade advances.
//
//   screw --seconds 5 --output out/screw
//
// Writes flow.gp (mass over time) and picture.gp, and draws them where gnuplot is installed.

#include "arguments.hpp"
#include "picture.hpp"

#include <dem/dem.hpp>
#include <dem/geometry/mesh/mesh_sweeps.hpp>
#include <dem/report/plot.hpp>
#include <dem/soil/averages.hpp>
#include <dem/soil/size_classes.hpp>

#include <numbers>

using namespace dem;

struct Gravel : Model {
  using Shape = shape::Sphere;
  using Normal = contact::LinearSpringDashpot;
  using Friction = friction::CundallStrack;
  using Integrator = integrator::VelocityVerlet;
};

int simulate(Arguments& arguments) {
  const double seconds = arguments.number("--seconds", 5.0, "to run [s]"), flow = 0.06;  // kg/s
  const std::string folder = arguments.take("--output", "screw_output", "folder for the results");
  arguments.check();
  const double outer = 24e-3, shaft = 8e-3, pitch = 40e-3, length = 4 * pitch, wall = outer + 0.6e-3;  // m
  const double turns = 2.0, pi = std::numbers::pi;                                                     // 1/s

  World<Gravel> world;
  world.set_contact({.normal = contact::LinearSpringDashpot::with_restitution(1000, 0.5), .friction = {0.4, 700, 0.1}});
  const auto curve = soil::SizeDistribution::sieve_curve({{3e-3, 0}, {4e-3, 60}, {6e-3, 100}});
  const Mixture gravel =
      soil::add_sizes(world, curve, 5, [](double d) { return shape::Sphere(0.5 * d); }, {.density = 2500});

  // Screw and trough lead along x. Their meshes lead along z, and what is -x of them is up.
  auto& machine = world.machine();
  const BodyId screw = machine.add_body(mbd::cylinder_body("screw", shaft, length, 7800));
  const JointId axle = machine.add_joint(mbd::revolute("axle", machine.ground(), screw, {0, 0, 0}, Vec3::UnitX()));
  machine.add_motion(mbd::prescribed_joint("motor", axle, mbd::Signal::ramp(0, -2 * pi * turns)));
  const SensorId load = machine.add_sensor(mbd::contact_sensor("grains on the screw", screw, 0.25 * seconds));
  const Vec3 middle(0.5 * length, 0, 0);
  const Mat3 along_x = rotation_between(Vec3::UnitZ(), Vec3::UnitX());
  world.add_surface(screw, surface::TriangleMesh(mesh::helix(0.9 * shaft, outer, pitch, length, 3e-3)),
                    {.name = "blade", .position = middle, .rotation = along_x});
  world.add_surface(screw, surface::Cylinder(shaft, length),
                    {.name = "shaft", .position = middle, .rotation = along_x});
  std::vector<std::array<double, 2>> profile = {{-2 * outer, -wall}};  // half a circle between straight sides
  for (int k = 0; k <= 32; ++k) profile.push_back({wall * std::sin(pi * k / 32), -wall * std::cos(pi * k / 32)});
  profile.push_back({-2 * outer, wall});
  const surface::TriangleMesh trough(mesh::sheet(profile, length), {.side = surface::MeshSide::two_sided});
  world.add_surface(world.ground(), trough, {.name = "trough", .position = middle, .rotation = along_x});
  world.add_surface(world.ground(), surface::Plane{}, {.name = "end", .rotation = along_x});

  const InletId in =
      world.add_inlet(InletRegion::box({5e-3, -0.7 * outer, 1.6 * outer}, {1.2 * pitch, 0.7 * outer, 2 * outer}),
                      {.name = "feed", .grains = gravel, .mass_flow = flow, .velocity = {0, 0, -0.5}});
  const OutletId out = world.add_outlet({Vec3(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL), Vec3(HUGE_VAL, HUGE_VAL, -2 * outer)},
                                        {.name = "end", .window = 0.25 * seconds});

  io::Series fed{.name = "fed"}, carried{.name = "carried"};
  // The grains in the third turn, over the last fifth of the time.
  soil::TimeAverages third({{{2 * pitch, -wall, -wall}, {3 * pitch, wall, 3 * wall}}});
  while (world.time() < seconds) {
    const auto report = world.run_for(0.05);
    if (!report) return fmt::print("{}\n", report.text), 1;
    if (!report.note.empty()) fmt::print("{}\n", report.note);
    fed.x.push_back(world.time()), carried.x.push_back(world.time());
    fed.y.push_back(1e3 * world.inlet(in).mass()), carried.y.push_back(1e3 * world.outlet(out).mass());
    if (world.time() > 0.8 * seconds) third.add(world);
  }
  const double speed = third.averages().values[0].velocity.x(), torque = machine.sensor(load).mean().torque.x;
  fmt::print("{} grains fed, {} on the way; fed {:.1f} g/s, carried {:.1f} g/s\n", world.inlet(in).grains(),
             world.grain_count(), 1e3 * flow, 1e3 * world.outlet(out).mass_flow());
  fmt::print("grains go at {:.3f} of the blade's advance of {:.0f} mm/s; torque {:.4f} N m, {:.1f} J/kg\n",
             speed / (pitch * turns), 1e3 * pitch * turns, torque, std::abs(torque) * 2 * pi * turns / flow);

  io::render_plot({.x_label = "time [s]", .y_label = "mass [g]", .series = {fed, carried}}, folder + "/flow");
  Picture picture({1, 0, 0}, Vec3(0, 0.5, 0.87));
  picture.grains(
      world, [&](GrainId p) { return Picture::heat(world.species(world.species_of(p)).shape.radius() / 1.5e-3 - 1); });
  std::vector<Vec3> edge;  // of the blade
  for (int k = 0; k <= 200; ++k) {
    const double x = length * k / 200, a = 2 * pi * x / pitch;
    edge.push_back(machine.body(screw).point({x, outer * std::sin(a), -outer * std::cos(a)}));
  }
  picture.line(edge);
  for (const double y : {-wall, wall}) picture.line({Vec3(0, y, 0), Vec3(length, y, 0)}, 0x909090);
  picture.save(folder + "/picture", "A screw conveyor from above and the side: gravel by size", 1200, 520);
  return 0;
}

int main(int argc, char** argv) {
  return run_example(argc, argv, "A screw conveyor carries grains of a sieve curve", simulate);
}
