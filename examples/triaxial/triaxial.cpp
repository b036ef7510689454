// Drained triaxial compression of a dense and a loose specimen of beads. Six smooth walls slide on joints. A servo
// holds the pressure on the lateral ones, and the lower and the upper one are driven together. Two things are known of
// it. The stress by the contacts within is that on the walls. And both specimens come to the same strength and density,
// the critical state: the dense one over a peak as it dilates, the loose one from below (Casagrande 1936; Roscoe,
// Schofield and Wroth 1958).
//
//   triaxial --pressure 10000 --side 10 --strain 0.4 --output out/triaxial
//
// Writes curves.csv, strength.gp (ratio of the stresses over the strain) and density.gp, and draws them where gnuplot
// is installed.

#include "arguments.hpp"

#include <dem/dem.hpp>
#include <dem/io/csv.hpp>
#include <dem/report/plot.hpp>
#include <dem/soil/coordination.hpp>
#include <dem/soil/solid_layers.hpp>
#include <dem/world/query.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

using namespace dem;

struct Beads : Model {
  using Shape = shape::Sphere;
  using Normal = contact::LinearSpringDashpot;
  using Friction = friction::CundallStrack;
  using Integrator = integrator::VelocityVerlet;
};

/// Beads between six walls, two across each of x, y and z.
class Specimen {
 public:
  Specimen(double pressure, int side, double friction) : world_({.gravity = {0, 0, 0}}), pressure_(pressure) {
    set_friction(friction);
    std::vector<SpeciesId> sizes;
    for (const double size : {0.8, 0.9, 1.0, 1.1, 1.2}) {
      sizes.push_back(world_.add_species(shape::Sphere(size * radius), {.density = 2650}));
    }
    RandomStream random(1);
    const double pitch = 2.5 * radius, edge = pitch * side;
    const auto jolt = [&] { return random.between(-0.1, 0.1); };  // m/s: beads on a lattice would be pressed into one
    for (int k = 0; k < side * side * side; ++k) {
      const Vec3 place(k % side + 0.5, k / side % side + 0.5, k / (side * side) + 0.5);
      world_.add_grain({sizes[random.bits() % 5], pitch * place - filled(0.5 * edge), Vec3(jolt(), jolt(), jolt())});
    }
    auto& m = world_.machine();
    for (std::size_t k = 0; k < 6; ++k) {
      Vec3 inward = Vec3::Zero();
      inward[axis(k)] = k % 2 == 0 ? 1.0 : -1.0;
      const Vec3 middle = -0.5 * edge * inward;
      Wall& wall = walls_[k];
      wall.body = m.add_body(mbd::box_body(fmt::format("wall {}", k), filled(0.02), 2500).at(middle));
      wall.surface = world_.add_surface(wall.body, surface::Plane{},
                                        {.material = "wall", .rotation = rotation_between(Vec3::UnitZ(), inward)});
      wall.slide = m.add_joint(mbd::prismatic("", m.ground(), wall.body, middle, inward));
      wall.servo = m.add_load(mbd::applied_force("", wall.body, middle, inward, 0.0));
      wall.brake = m.add_actuator(mbd::joint_actuator("", wall.slide, 0.0, 100.0, mbd::Signal(0.0)));
    }
  }
  void set_friction(double coefficient) {
    const double stiffness = 1e3 * pressure_ * radius;  // beads overlap by some 0.4 % of their radius
    const auto normal = contact::LinearSpringDashpot::with_restitution(stiffness, 0.5);
    world_.set_contact({.normal = normal, .friction = {coefficient, 0.8 * stiffness, 0.05}});
    world_.set_contact("grain", "wall", {.normal = normal, .friction = {0.0, 0.8 * stiffness, 0.05}});
  }
  /// Whole runs are made with the servo; `seconds` of them.
  void run(double seconds) {
    const auto servo = [&] {
      for (std::size_t k = 0; k < 6; ++k) world_.machine().set_load(walls_[k].servo, pressure_ * area(axis(k)));
      return true;
    };
    servo();
    if (const auto report = world_.run_for(seconds, servo); !report) fail("{}", report.text);
  }
  /// Lets the walls go, and drives the lower and the upper one at such a strain a second.
  void drive(double rate) {
    auto& m = world_.machine();
    for (Wall& wall : walls_) m.switch_on(wall.brake, false);
    for (const std::size_t k : {4, 5}) {
      m.switch_on(walls_[k].servo, false);
      const double from = m.coordinate(walls_[k].slide);
      m.add_motion(
          mbd::prescribed_joint("", walls_[k].slide, mbd::Signal::ramp(from, 0.5 * rate * edges().z(), world_.time())));
    }
  }

  Vec3 edges() const {
    Vec3 e;
    for (std::size_t k = 0; k < 6; k += 2) e[axis(k)] = place(k + 1) - place(k);
    return e;
  }
  double volume() const { return edges().prod(); }
  double solid_fraction() const { return soil::solid_volume(world_) / volume(); }
  double coordination() const { return soil::coordination(world_).mean(); }
  /// Pa, on the walls: compression is positive.
  Vec3 wall_stress() const {
    Vec3 s;
    for (std::size_t k = 0; k < 6; k += 2) {
      const int a = axis(k);
      s[a] =
          0.5 * (world_.surface_force(walls_[k + 1].surface)[a] - world_.surface_force(walls_[k].surface)[a]) / area(a);
    }
    return s;
  }
  /// Pa, by the contacts within.
  Mat3 stress() const { return stress_of(contacts_of(world_), volume()); }

 private:
  struct Wall {
    BodyId body;
    SurfaceId surface;
    JointId slide;
    LoadId servo;
    ActuatorId brake;
  };
  static constexpr double radius = 1e-3;  // m, of the middle size
  static int axis(std::size_t wall) { return static_cast<int>(wall / 2); }
  double place(std::size_t wall) const { return world_.machine().body(walls_[wall].body).position()[axis(wall)]; }
  double area(int a) const { return volume() / edges()[a]; }

  World<Beads> world_;
  double pressure_;  // Pa
  std::array<Wall, 6> walls_;
};

void simulate(Arguments& arguments) {
  const double pressure = arguments.number("--pressure", 1e4, "that the servo holds on the lateral walls [Pa]");
  const double side = arguments.number("--side", 10.0, "beads along an edge of the specimen");
  const double strain = arguments.number("--strain", 0.4, "to which it is compressed");
  const double friction = arguments.number("--friction", 0.5, "coefficient while it is sheared");
  const std::string folder = arguments.take("--output", "triaxial_output", "folder for the results");
  arguments.check();
  require_positive(pressure, "--pressure", "Pa");
  require_within(side, 4.0, 60.0, "--side");
  if (side != std::floor(side)) fail("--side is {:g}, but must be a whole number of beads", side);
  require_within(strain, 0.01, 0.6, "--strain");
  require_non_negative(friction, "--friction", "(no unit)");

  io::Plot strength{.title = "Triaxial compression: strength",
                    .x_label = "axial strain",
                    .y_label = "ratio of axial to lateral stress"};
  io::Plot density{.title = "Triaxial compression: density", .x_label = "axial strain", .y_label = "solid fraction"};
  io::CsvWriter csv(folder + "/curves.csv", {"loose", "strain", "axial_stress_Pa", "lateral_stress_Pa", "stress_ratio",
                                             "solid_fraction", "coordination"});
  for (const bool loose : {false, true}) {
    Specimen specimen(pressure, static_cast<int>(side), loose ? friction : 0.0);
    specimen.run(0.15);
    specimen.set_friction(friction);
    specimen.run(0.05);
    const Vec3 walls = specimen.wall_stress();
    fmt::print("{}: {:.0f}, {:.0f}, {:.0f} Pa on the walls, solid fraction {:.3f}\n", loose ? "loose" : "dense",
               walls.x(), walls.y(), walls.z(), specimen.solid_fraction());

    io::Series ratio{.name = loose ? "loose" : "dense"}, solid = ratio;
    const double height = specimen.edges().z();
    constexpr double rate = 1.0;  // 1/s: an inertial number of rate d sqrt(density/pressure), 1e-3 at 10 kPa
    specimen.drive(rate);
    double peak = 0.0, off = 0.0, last = 0.0;  // off: the worst of contacts against walls
    int counted = 0;
    while (1.0 - specimen.edges().z() / height < strain) {
      specimen.run(0.005 / rate);
      const Vec3 on = specimen.wall_stress();
      const Mat3 within = specimen.stress();
      const double e = 1.0 - specimen.edges().z() / height, lateral = 0.5 * (on.x() + on.y());
      csv.row(loose ? 1.0 : 0.0, e, on.z(), lateral, on.z() / lateral, specimen.solid_fraction(),
              specimen.coordination());
      ratio.x.push_back(e), ratio.y.push_back(on.z() / lateral);
      solid.x.push_back(e), solid.y.push_back(specimen.solid_fraction());
      peak = std::max(peak, on.z() / lateral);
      off = std::max(off, std::abs(within(2, 2) / on.z() - 1.0));
      if (e > 0.75 * strain) last += on.z() / lateral, ++counted;
    }
    const auto angle = [](double k) { return std::asin((k - 1.0) / (k + 1.0)) * 180.0 / std::numbers::pi; };
    last /= std::max(1, counted);
    fmt::print(
        "  stress ratio at most {:.2f} ({:.1f} deg), at the end {:.2f} ({:.1f} deg), solid fraction {:.3f}; contacts "
        "within {:.1f} % of the walls\n",
        peak, angle(peak), last, angle(last), specimen.solid_fraction(), 100.0 * off);
    strength.series.push_back(ratio), density.series.push_back(solid);
  }
  csv.flush();
  io::render_plot(strength, folder + "/strength");
  io::render_plot(density, folder + "/density");
}

int main(int argc, char** argv) {
  return run_example(argc, argv, "Triaxial compression of dense and loose sand, with a servo on the walls", simulate);
}
