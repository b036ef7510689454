// A rotating drum with a rough lining: the slope of the flowing grains over the Froude number w^2 R/g. The drum's
// torque is set beside the weight of the grains times the lever of their centre of mass, which it lifts.
//
//   drum --froude 0.001,0.01,0.05,0.2 --seconds 1 --threads 2 --output out/drum       (seconds for each speed)
//
// Writes slope.gp (slope over Froude number) and picture.gp, and draws them where gnuplot is installed.

#include "arguments.hpp"
#include "picture.hpp"

#include <dem/dem.hpp>
#include <dem/report/plot.hpp>

#include <cstdlib>
#include <numbers>

using namespace dem;

struct Beads : Model {
  using Shape = shape::Sphere;
  using Normal = contact::LinearSpringDashpot;
  using Friction = friction::CundallStrack;
  using Integrator = integrator::VelocityVerlet;
};

int main(int argc, char** argv) {
  Arguments arguments(argc, argv);
  const double seconds = arguments.number("--seconds", 1.0);
  const std::vector<double> froude_numbers = arguments.numbers("--froude", {1e-3, 1e-2, 5e-2, 0.2});
  const std::string folder = arguments.take("--output", "drum");
  const int threads = static_cast<int>(arguments.number("--threads", 1));
  arguments.check();
  const double d = 3e-3, radius = 14 * d, length = 6 * d, g = 9.81, pi = std::numbers::pi;  // m; m/s^2

  World<Beads> world({.threads = threads});
  const ContactParameters<Beads> rough = {.normal = contact::LinearSpringDashpot::with_restitution(500, 0.6),
                                          .friction = {0.5, 350, 0.1}};
  ContactParameters<Beads> smooth = rough;
  smooth.friction.coefficient = 0.0;
  world.set_contact(rough);
  world.set_contact("grain", "glass", smooth);  // the ends of the drum
  const SpeciesId bead = world.add_species(shape::Sphere(0.5 * d)),
                  lining = world.add_species(shape::Sphere(0.5 * d), {.held = true});
  for (const double side : {-1.0, 1.0}) {
    world.add_surface(world.ground(), surface::Plane{},
                      {.material = "glass",
                       .position = {0, side * 0.5 * length, 0},
                       .rotation = rotation_between(Vec3::UnitZ(), Vec3(0, -side, 0))});
  }

  // The drum turns about y, and carries its lining: beads that are glued to the inside of its lateral surface.
  auto& machine = world.machine();
  const BodyId drum = machine.add_body(mbd::cylinder_body("drum", radius, length, 1000));
  const JointId axle = machine.add_joint(mbd::revolute("axle", machine.ground(), drum, {0, 0, 0}, Vec3::UnitY()));
  double speed = std::sqrt(froude_numbers[0] * g / radius);  // rad/s
  machine.add_motion(mbd::prescribed_speed("turning", axle, mbd::Signal::function([&](double) { return speed; })));
  const SensorId load = machine.add_sensor(mbd::contact_sensor("grains on the drum", drum, 0.5 * seconds));
  const int around = static_cast<int>(2 * pi * radius / d), across = static_cast<int>(length / d);
  for (int k = 0; k < around; ++k) {
    const double a = 2 * pi * k / around;
    for (int j = 0; j < across; ++j) {
      const double y = (j + 0.5 - 0.5 * across) * d;
      world.attach(world.add_particle({lining, {radius * std::cos(a), y, radius * std::sin(a)}}), drum);
    }
  }
  // Half of it is filled by a rain.
  const double inner = radius - 0.5 * d, filled = 0.5 * pi * inner * inner * length * 0.58 * 2650;  // kg
  const InletId rain = world.add_inlet(
      InletRegion::box({-0.6 * inner, -0.4 * length, 0.3 * inner}, {0.6 * inner, 0.4 * length, 0.6 * inner}),
      {.name = "rain", .grains = bead, .mass_flow = filled / 0.5, .total_mass = filled, .velocity = {0, 0, -1}});
  const auto run = [&](double time) {
    if (const auto report = world.run_for(time); !report) fmt::print("{}\n", report.text), std::exit(1);
  };
  while (world.inlet(rain).mass() < 0.999 * filled && world.time() < 10) run(0.05);
  fmt::print("{} beads of {:g} mm in a drum of {:.0f} mm\n", world.inlet(rain).grains(), 1e3 * d, 2e3 * radius);

  io::Series slope{.name = "of the line through the centre of mass", .style = io::SeriesStyle::LinePoints};
  for (const double froude : froude_numbers) {
    speed = std::sqrt(froude * g / radius);
    run(seconds);
    Vec3 centre = Vec3::Zero();  // mean over the second half
    constexpr int samples = 40;
    double mass = 0.0;
    for (int s = 0; s < samples; ++s) {
      run(0.5 * seconds / samples);
      for (const ParticleId p : world.particles()) {
        if (world.species_of(p) == lining) continue;
        centre += world.species(bead).mass * world.position(p), mass += world.species(bead).mass;
      }
    }
    centre /= mass;
    const double angle = std::atan2(std::abs(centre.x()), -centre.z()) * 180 / pi;
    const double torque = machine.sensor(load).mean().torque.y, lever = -centre.x() * g * mass / samples;
    fmt::print("Froude number {:7.4f}: slope {:4.1f} deg, torque {:8.5f} N m, {:.3f} of weight times lever\n", froude,
               angle, torque, torque / -lever);
    slope.x.push_back(froude), slope.y.push_back(angle);
    if (froude == froude_numbers[froude_numbers.size() / 2]) {
      Picture picture({1, 0, 0}, {0, 0, 1});
      picture.grains(world, [&](ParticleId p) {
        return world.species_of(p) == lining ? 0x808080u : Picture::heat(world.velocity(p).norm() / 0.5);
      });
      picture.save(folder + "/picture",
                   fmt::format("A drum at Froude number {:g}: beads from blue (at rest) to red (0.5 m/s)", froude));
    }
  }
  io::render_plot({.x_label = "Froude number", .y_label = "slope [deg]", .series = {slope}, .log_x = true},
                  folder + "/slope");
}
