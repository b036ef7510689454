// A silo with a flat bottom and a round hole: filled by an inlet, emptied through an outlet. The mass flow is set
// beside Beverloo's law, W = C rho sqrt(g) (D - k d)^(5/2), with C = 0.58, k = 1.4 and the bulk density rho at rest.
//
// C and k are fits to seeds and sands, and the ratio tells what they hide. Friction: 0.1, 0.5 and 1 give 1.06, 0.82 and
// 0.79 through a hole of 6 d, as beads that rub more lean on the bottom more. Loosening: in the middle of that hole
// beads are 0.64 times as dense as at rest (0.73 in one of 8 d, which gives 0.86), and the law takes the density at
// rest (Mankoc et al. 2007, doi 10.1007/s10035-007-0062-2).
//
//   silo --hole 6 --friction 0.5 --output out/silo       (the hole in grain diameters)
//
// Writes flow.gp (flow over time) and picture.gp, and draws them where gnuplot is installed.

#include "arguments.hpp"
#include "picture.hpp"

#include <dem/dem.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
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

void simulate(Arguments& arguments) {
  const double wide = arguments.number("--hole", 6.0, "width, in grain diameters"),
               mu = arguments.number("--friction", 0.5, "coefficient of the beads"),
               beads = arguments.number("--beads", 3200, "how many fill it");
  const std::string folder = arguments.take("--output", "silo_output", "folder for the results");
  arguments.check();
  const double d = 5e-3, density = 2500;                                                    // m, kg/m^3
  const double hole = wide * d, radius = 7.5 * d, high = 24 * d, bottom = 2 * d, g = 9.81;  // m; m/s^2

  World<Beads> world;
  world.set_contact({.normal = contact::LinearSpringDashpot::with_restitution(1000, 0.7), .friction = {mu, 700, 0.1}});
  const SpeciesId bead = world.add_species(shape::Sphere(0.5 * d), {.density = density});
  world.add_surface(world.ground(), surface::Cylinder::tube(radius, radius + d, high),
                    {.position = {0, 0, 0.5 * high}});
  const auto ring =
      mesh::revolved({{0.5 * hole + bottom, -bottom}, {radius + d, -bottom}, {radius + d, 0}, {0.5 * hole, 0}}, 64);
  world.add_surface(world.ground(), surface::TriangleMesh(ring));
  const SurfaceId plug =
      world.add_surface(world.ground(), surface::Cylinder(0.6 * hole, bottom), {.position = {0, 0, -0.5 * bottom}});

  // Rain until the silo is full, and let it settle.
  const double mass = beads * world.species(bead).mass;
  const auto rain = world.add_inlet(
      InletRegion::disc({0, 0, high - 2 * d}, {0, 0, -1}, radius - 0.5 * d, 2 * d),
      {.name = "rain", .grains = bead, .mass_flow = mass / 1.0, .total_mass = mass, .velocity = {0, 0, -1.5}});
  const auto run = [&](double seconds) {
    if (const auto report = world.run_for(seconds); !report) fmt::print("{}\n", report.text), std::exit(1);
  };
  while (world.inlet(rain).mass() < 0.999 * mass && world.time() < 5.0) run(0.05);
  run(0.3);
  double low = 0.0;  // kg, of the grains from 2 d to 6 d
  for (const GrainId p : world.grains()) {
    if (const double z = world.position(p).z(); z > 2 * d && z < 6 * d) low += world.species(bead).mass;
  }
  const double bulk = low / (std::numbers::pi * radius * radius * 4 * d);

  // Open it. What falls out is counted and gone.
  world.set_active(plug, false);
  const auto out = world.add_outlet({Vec3(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL), Vec3(HUGE_VAL, HUGE_VAL, -4 * d)},
                                    {.name = "hole", .window = 0.1});
  io::Series flow{.name = "through the hole"};
  const double start = world.time();
  double first = 0.0, last = 0.0, gone = 0.0;  // s, s, kg
  double inside = 0.0;                         // kg, in the middle of the hole, half as wide and a grain high
  int looks = 0;
  bool is_drawn = false;
  while (world.time() < start + 60.0) {
    run(0.02);
    const Outlet& o = world.outlet(out);
    flow.x.push_back(world.time() - start), flow.y.push_back(1e3 * o.mass_flow());
    if (o.mass() < 0.1 * mass) first = world.time(), gone = o.mass(), inside = 0.0, looks = 0;
    for (const GrainId p : world.grains()) {
      const Vec3 x = world.position(p);
      if (std::abs(x.z()) < 0.5 * d && std::hypot(x.x(), x.y()) < 0.25 * hole) inside += world.species(bead).mass;
    }
    ++looks;
    if (o.mass() > 0.3 * mass && !is_drawn) {
      is_drawn = true;
      Picture picture({1, 0, 0}, {0, 0, 1});
      for (const GrainId p : world.grains()) {  // the half behind the axis
        if (world.position(p).y() > 0)
          picture.grain(world.position(p), 0.5 * d, Picture::heat(world.velocity(p).norm() / 0.4));
      }
      for (const double s : {-1.0, 1.0}) {
        picture.line({Vec3(s * radius, 0, high), Vec3(s * radius, 0, 0), Vec3(s * 0.5 * hole, 0, 0),
                      Vec3(s * (0.5 * hole + bottom), 0, -bottom)});
      }
      picture.save(folder + "/picture", "Half a silo: beads at rest (blue) to 0.4 m/s (red)", 620, 1000);
    }
    last = world.time();
    if (o.mass() >= 0.5 * mass) break;
  }
  const double measured = (world.outlet(out).mass() - gone) / (last - first);
  const double beverloo = 0.58 * bulk * std::sqrt(g) * std::pow(hole - 1.4 * d, 2.5);
  const io::Series law{.name = "Beverloo",
                       .x = {flow.x.front(), flow.x.back()},
                       .y = {1e3 * beverloo, 1e3 * beverloo},
                       .style = io::SeriesStyle::Dashed};
  io::render_plot({.x_label = "time [s]", .y_label = "mass flow [g/s]", .series = {flow, law}, .y_range = {0.0, {}}},
                  folder + "/flow");
  fmt::print("{} beads of {:g} mm, hole {:g} d, friction {:g}: bulk density {:.0f} kg/m^3\n",
             world.inlet(rain).grains(), 1e3 * d, wide, mu, bulk);
  fmt::print("mass flow {:.1f} g/s, Beverloo {:.1f} g/s, ratio {:.3f}\n", 1e3 * measured, 1e3 * beverloo,
             measured / beverloo);
  const double middle = inside / looks / (std::numbers::pi * 0.0625 * hole * hole * d);
  fmt::print("in the middle of the hole {:.0f} kg/m^3, {:.3f} of what it is at rest\n", middle, middle / bulk);
}

int main(int argc, char** argv) {
  return run_example(argc, argv, "A silo runs out: its mass flow beside Beverloo's law", simulate);
}
