// A rotating drum with a rough lining: the slope of the flowing grains over the Froude number w^2 R/g. The drum's
// torque is set beside the weight of the grains times the lever of their centre of mass, which it lifts.
//
//   drum --froude 0.001,0.01,0.05,0.2 --seconds 1 --turns 0.25 --threads 2 --output out/drum
//   drum --friction 0.3 --diameter 0.004 --radius 0.06 --length 0.03 --filled 0.4
//
// At each speed the drum runs in for this many seconds, and is then measured for half as long; either takes at least so
// many turns.
//
// Writes drum.csv, slope.gp (slope over Froude number) and picture.gp, and draws them where gnuplot is installed.

#include "arguments.hpp"
#include "picture.hpp"

#include <dem/dem.hpp>
#include <dem/io/csv.hpp>
#include <dem/report/plot.hpp>

#include <numbers>

using namespace dem;

struct Beads : Model {
  using Shape = shape::Sphere;
  using Normal = contact::LinearSpringDashpot;
  using Friction = friction::CundallStrack;
  using Integrator = integrator::VelocityVerlet;
};

void simulate(Arguments& arguments) {
  const double seconds = arguments.number("--seconds", 1.0, "to run in at each speed, and half as long to measure [s]"),
               turns = arguments.number("--turns", 0.25, "of the drum at least, to run in and to measure");
  const std::vector<double> froude_numbers =
      arguments.numbers("--froude", {1e-3, 1e-2, 5e-2, 0.2}, "Froude numbers w^2 R/g of the speeds");
  const double d = arguments.number("--diameter", 3e-3, "of a bead [m]"),
               radius = arguments.number("--radius", 0.042, "of the circle of the lining's beads [m]"),
               length = arguments.number("--length", 0.018, "of the drum [m]"),
               share = arguments.number("--filled", 0.5, "share of the drum's volume, at a solid fraction of 0.58"),
               friction = arguments.number("--friction", 0.5, "mu of beads on beads"),
               restitution = arguments.number("--restitution", 0.6, "of beads"),
               given_stiffness =
                   arguments.number("--stiffness", 0, "of beads [N/m]; 0: 500 for 3 mm in 84 mm, more for larger ones");
  const std::string folder = arguments.take("--output", "drum_output", "folder for the results");
  const double given_threads = arguments.number("--threads", 1, "that share the work");
  arguments.check();
  require_non_negative(seconds, "--seconds", "s");
  const int threads = static_cast<int>(require_within(given_threads, 1, 1000, "--threads"));
  require_non_negative(turns, "--turns", "turns");
  if (seconds + turns == 0.0) fail("--seconds and --turns are 0, but one of them must be above 0");
  for (const double froude : froude_numbers) require_positive(froude, "a number of --froude", "(no unit)");
  require_positive(d, "--diameter", "m");
  require_within(radius, (4 - 1e-9) * d, 1000 * d, "--radius (m; 4 to 1000 beads)");
  require_within(length, (3 - 1e-9) * d, 1000 * d, "--length (m; 3 to 1000 beads)");
  require_within(share, 0.05, 0.6, "--filled");
  require_non_negative(friction, "--friction", "(no unit)");
  require_within(restitution, 0.05, 0.99, "--restitution");
  require_non_negative(given_stiffness, "--stiffness", "N/m");
  // The weight of a layer as deep as the drum presses beads in by as large a share of their size in any drum.
  const double stiffness = given_stiffness > 0 ? given_stiffness : 500 * (radius * d / (0.042 * 3e-3));  // N/m
  const double g = 9.81, pi = std::numbers::pi;                                                          // m/s^2

  World<Beads> world({.threads = threads});
  const ContactParameters<Beads> rough = {
      .normal = contact::LinearSpringDashpot::with_restitution(stiffness, restitution),
      .friction = {friction, 0.7 * stiffness, 0.1}};
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
  const auto speed_at = [&](double froude) { return std::sqrt(froude * g / radius); };  // rad/s
  double speed = speed_at(froude_numbers[0]);
  machine.add_motion(mbd::prescribed_speed("turning", axle, mbd::Signal::function([&](double) { return speed; })));
  const auto measured_for = [&](double froude) {  // s
    return std::max(0.5 * seconds, 2 * pi * turns / speed_at(froude));
  };
  std::vector<SensorId> loads;
  for (const double froude : froude_numbers) {
    const std::string name = fmt::format("grains on the drum, {}", loads.size());
    loads.push_back(machine.add_sensor(mbd::contact_sensor(name, drum, measured_for(froude))));
  }
  const int around = static_cast<int>(2 * pi * radius / d), across = static_cast<int>(length / d + 1e-9);
  for (int k = 0; k < around; ++k) {
    const double a = 2 * pi * k / around;
    for (int j = 0; j < across; ++j) {
      const double y = (j + 0.5 - 0.5 * across) * d;
      world.attach(world.add_grain({lining, {radius * std::cos(a), y, radius * std::sin(a)}}), drum);
    }
  }
  // It is filled by a rain.
  const double inner = radius - 0.5 * d, filled = share * pi * inner * inner * length * 0.58 * 2650;  // kg
  const InletId rain = world.add_inlet(
      InletRegion::box({-0.6 * inner, -0.4 * length, 0.3 * inner}, {0.6 * inner, 0.4 * length, 0.6 * inner}),
      {.name = "rain", .grains = bead, .mass_flow = filled / 0.5, .total_mass = filled, .velocity = {0, 0, -1}});
  const auto run = [&](double time) {
    if (const auto report = world.run_for(time); !report) fail("{}", report.text);
  };
  const double bead_mass = world.species(bead).mass;
  while (world.inlet(rain).mass() + 0.6 * bead_mass < filled) {
    if (world.time() > 10) fail("the drum is not filled after 10 s: {}; lower --filled", world.inlet(rain).note());
    run(0.05);
  }
  io::CsvWriter csv(folder + "/drum.csv", {"froude_number", "speed_rad_per_s", "slope_deg", "deviation_deg",
                                           "measured_for_s", "turns", "torque_Nm", "torque_over_weight_times_lever"});
  fmt::print("{} beads of {:g} mm in a drum of {:.0f} mm\n", world.inlet(rain).grains(), 1e3 * d, 2e3 * radius);

  io::Series slope{.name = "of the line through the centre of mass", .style = io::SeriesStyle::LinePoints, .color = 0};
  io::Series low{.name = "± standard deviation in time", .style = io::SeriesStyle::Dotted, .color = 0}, high = low;
  high.name = "";
  const auto slope_of = [&](const Vec3& centre) { return std::atan2(std::abs(centre.x()), -centre.z()) * 180 / pi; };
  for (std::size_t k = 0; k < froude_numbers.size(); ++k) {
    const double froude = froude_numbers[k], measured = measured_for(froude);
    speed = speed_at(froude);
    run(std::max(seconds, measured));
    constexpr int samples = 40;
    Vec3 mean = Vec3::Zero();
    double mass = 0.0, sum = 0.0, squares = 0.0;
    for (int s = 0; s < samples; ++s) {
      run(measured / samples);
      Vec3 centre = Vec3::Zero();
      mass = 0.0;
      for (const GrainId p : world.grains()) {
        if (world.species_of(p) == lining) continue;
        centre += world.species(bead).mass * world.position(p), mass += world.species(bead).mass;
      }
      centre /= mass;
      mean += centre / samples;
      const double angle = slope_of(centre);
      sum += angle, squares += angle * angle;
    }
    const double angle = slope_of(mean), deviation = std::sqrt((squares - sum * sum / samples) / (samples - 1));
    const double torque = machine.sensor(loads[k]).mean().torque.y, lever = -mean.x() * g * mass;
    fmt::print(
        "Froude number {:7.4f}: slope {:4.1f} deg, ± {:.1f} deg in {:.2f} s, {:.2f} turns; torque {:8.5f} N m, {:.3f} "
        "of "
        "weight times lever\n",
        froude, angle, deviation, measured, measured * speed / (2 * pi), torque, torque / -lever);
    csv.row(froude, speed, angle, deviation, measured, measured * speed / (2 * pi), torque, torque / -lever);
    for (io::Series* series : {&slope, &low, &high}) series->x.push_back(froude);
    slope.y.push_back(angle), low.y.push_back(angle - deviation), high.y.push_back(angle + deviation);
    if (froude == froude_numbers[froude_numbers.size() / 2]) {
      Picture picture({1, 0, 0}, {0, 0, 1});
      picture.grains(world, [&](GrainId p) {
        return world.species_of(p) == lining ? 0x808080u : Picture::heat(world.velocity(p).norm() / 0.5);
      });
      picture.save(folder + "/picture",
                   fmt::format("A drum at Froude number {:g}: beads from blue (at rest) to red (0.5 m/s)", froude));
    }
  }
  csv.flush();
  io::render_plot({.title = "Slope of the beads in a rotating drum",
                   .x_label = "Froude number",
                   .y_label = "slope [deg]",
                   .series = {slope, low, high},
                   .log_x = true},
                  folder + "/slope");
}

int main(int argc, char** argv) {
  return run_example(argc, argv, "A rotating drum: the slope of the flowing grains over the Froude number", simulate);
}
