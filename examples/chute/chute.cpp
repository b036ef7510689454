// Steady flow of beads down a rough incline, in a cell that repeats itself along the flow and across it, after Silbert
// et al. (2001, doi:10.1103/PhysRevE.64.051302). Two things are known of it. Whatever the beads do, a steady flow
// carries its weight: the pressure grows with depth as rho g cos(a), and the shear stress is tan(a) of it. And by
// Bagnold's scaling the velocity falls with the depth y as 1 - (y/h)^(3/2).
//
//   chute --angle 24 --seconds 2 --output out/chute
//
// Writes profile.gp (velocity over height) and picture.gp, and draws them where gnuplot is installed.

#include "arguments.hpp"
#include "picture.hpp"

#include <dem/dem.hpp>
#include <dem/domain/periodic.hpp>
#include <dem/report/plot.hpp>
#include <dem/soil/averages.hpp>

#include <cstdlib>
#include <numbers>

using namespace dem;

struct Beads : Model {
  using Shape = shape::Sphere;
  using Normal = contact::LinearSpringDashpot;
  using Friction = friction::CundallStrack;
  using Integrator = integrator::VelocityVerlet;
  using Domain = domain::Periodic;
};

void simulate(Arguments& arguments) {
  const double angle = arguments.number("--angle", 24.0, "of the incline [deg]"),
               slope = angle * std::numbers::pi / 180;
  const double seconds = arguments.number("--seconds", 2.0, "to flow, and as long again to take means [s]");
  const std::string folder = arguments.take("--output", "chute_output", "folder for the results");
  arguments.check();

  // Beads of about 1 mm whose weight presses them in by d/20,000. x leads down the incline: it is gravity that is
  // tilted.
  const double d = 1e-3, g = 9.81, density = 2500, weight = density * std::numbers::pi / 6 * d * d * d * g;
  const double stiffness = 2e4 * weight / d, length = 12 * d, width = 8 * d;
  World<Beads> world({.gravity = {g * std::sin(slope), 0, -g * std::cos(slope)},
                      .domain = surface::Aabb{{0, 0, -2 * d}, {length, width, 60 * d}},
                      .periodic = {.x = true, .y = true}});
  world.set_contact({.normal = contact::LinearSpringDashpot::with_restitution(stiffness, 0.88),
                     .friction = {0.5, 2.0 / 7 * stiffness, 0.05}});
  std::vector<SpeciesId> beads;  // of several sizes, as beads of one would flow in layers
  for (const double size : {0.85, 0.95, 1.05, 1.15}) {
    beads.push_back(world.add_species(shape::Sphere(0.5 * size * d), {.density = density}));
  }
  const SpeciesId floor = world.add_species(shape::Sphere(0.5 * d), {.density = density, .held = true});

  // The floor: beads that are held, in two staggered layers at uneven heights. The rest is a loose lattice that falls.
  RandomStream random(1);
  for (int n = 0; n < 2 * 8 * 12; ++n) {
    const int i = n % 12, j = n / 12 % 8, k = n / 96;
    world.add_grain({floor, d * Vec3(i + 0.5 * k + 0.25, j + 0.5 * k + 0.25, -0.7 * k + random.between(-0.25, 0.25))});
  }
  for (int n = 0; n < 15 * 7 * 10; ++n) {
    const Vec3 x = d * Vec3(1.2 * (n % 10) + 0.6, 1.16 * (n / 10 % 7) + 0.5, 1.4 + 1.17 * (n / 70));
    world.add_grain({.species = beads[random.bits() % 4], .position = x, .velocity = {0.1, 0, 0}});
  }
  const auto run = [&](double time) {
    if (const auto report = world.run_for(time); !report) fmt::print("{}\n", report.text), std::exit(1);
  };
  run(seconds);

  // Means over as long again, in slices of a bead's size.
  constexpr int slices = 20, samples = 1000;
  const double top = slices * d;
  soil::TimeAverages over_time({{{0, 0, 0}, {length, width, top}}, {1, 1, slices}});
  for (int s = 0; s < samples; ++s) {
    run(seconds / samples);
    over_time.add(world);
  }
  const std::vector<soil::Average> mean = over_time.averages().values;
  double above = 0.0, height = 0.0;                   // kg/m^2, mass over a slice's middle; m, of the free surface
  double carried = 0.0, sheared = 0.0, inside = 0.0;  // over the slices between a quarter and 3/4 of the height
  io::Series measured{.name = "measured", .style = io::SeriesStyle::Points}, bagnold{.name = "Bagnold"};
  fmt::print("height  solid   velocity  pressure  weight above  shear/pressure (tan {:g} deg = {:.4f})\n", angle,
             std::tan(slope));
  for (int k = slices - 1; k >= 0; --k) {
    const soil::Average& a = mean[k];
    const double half = 0.5 * a.density * top / slices;
    above += half;
    const double z = (k + 0.5) * top / slices, pressure = a.stress()(2, 2), shear = -a.stress()(0, 2);
    if (a.solid_fraction > 0.3 && height == 0.0) height = z + 0.5 * d;
    if (a.solid_fraction > 0.02) {
      fmt::print("{:4.1f} mm  {:.3f}  {:.3f} m/s  {:6.1f} Pa     {:6.1f} Pa  {:.4f}\n", 1e3 * z, a.solid_fraction,
                 a.velocity.x(), pressure, above * g * std::cos(slope), shear / pressure);
      measured.x.push_back(a.velocity.x()), measured.y.push_back(1e3 * z);
      if (z > 0.25 * height && z < 0.75 * height) {
        carried += pressure / (above * g * std::cos(slope));
        sheared += shear / pressure / std::tan(slope);
        inside += 1.0;
      }
    }
    above += half;
  }
  fmt::print("inside, pressure is {:.3f} of the weight above, shear {:.3f} of tan {:g} deg of it\n", carried / inside,
             sheared / inside, angle);
  // Through the velocity at the free surface, where Bagnold's law has no more shear.
  const double fastest = mean[static_cast<std::size_t>(height / d) - 1].velocity.x();
  for (double z = 0.0; z <= height; z += 0.2 * d) {
    bagnold.x.push_back(fastest * (1 - std::pow(1 - z / height, 1.5))), bagnold.y.push_back(1e3 * z);
  }
  io::render_plot({.x_label = "velocity [m/s]", .y_label = "height [mm]", .series = {measured, bagnold}},
                  folder + "/profile");
  Picture picture({1, 0, 0}, {0, 0, 1});
  picture.grains(world, [&](GrainId p) {
    return world.species_of(p) == floor ? 0x808080u : Picture::heat(world.velocity(p).x() / fastest);
  });
  picture.save(folder + "/picture", "Beads flow down a rough incline, from left to right");
}

int main(int argc, char** argv) {
  return run_example(argc, argv, "Steady flow of beads down a rough incline, in a periodic cell", simulate);
}
