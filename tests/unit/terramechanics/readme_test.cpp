// The blocks of include/dem/terramechanics/README.md.

#include "catch.hpp"
#include "io/files.hpp"

#include <dem/integrator/velocity_verlet.hpp>
#include <dem/mbd/machine.hpp>
#include <dem/terramechanics/bevameter_fit.hpp>
#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/machine_columns.hpp>
#include <dem/terramechanics/named_soils.hpp>
#include <dem/terramechanics/shear_fit.hpp>
#include <dem/terramechanics/soil_reader.hpp>
#include <dem/terramechanics/wheel_load.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace dem::terramechanics;
using Catch::Approx;

/// What plates and a shear box would show in dry sand.
void measure(std::vector<PlateCurve>& plates, std::vector<ShearCurve>& shear) {
  const Soil sand = known_soil("dry-sand").soil;
  for (const double width : {0.03, 0.07}) {
    PlateCurve& c = plates.emplace_back(PlateCurve{.width = width, .sinkage = {}, .pressure = {}});
    for (int k = 1; k <= 20; ++k) {
      c.sinkage.push_back(1e-3 * k);
      c.pressure.push_back(under(sand.pressure, width).pressure(1e-3 * k));
    }
  }
  for (const double sigma : {5e3, 10e3, 20e3}) {
    ShearCurve& c = shear.emplace_back(ShearCurve{.normal_stress = sigma, .displacement = {}, .stress = {}});
    for (int k = 1; k <= 60; ++k) {
      c.displacement.push_back(3e-3 * k);
      c.stress.push_back((sand.shear.cohesion + sigma * std::tan(sand.shear.friction_angle)) *
                         (1.0 - std::exp(-3e-3 * k / sand.shear.displacement)));
    }
  }
}

}  // namespace

TEST_CASE("a wheel by equations, as the page has it") {
  // clang-format off
const Wheel wheel{.radius = 0.13, .width = 0.16};                     // m
const Soil sand = known_soil("dry-sand").soil;                        // or load_soil("sand.toml").soil
const double slips[] = {-0.2, 0.0, 0.2, 0.5};                         // s = 1 - v/(omega r)
for (const WheelForces& f : slip_sweep(wheel, sand, slips, SlipDefinition::wheel_speed, 130.0)) {
  fmt::print("{:6.1f} N {:6.2f} N m {:5.1f} mm\n", f.pull, f.torque, 1e3 * f.sinkage);
}
const Slip by_speed{0.25, SlipDefinition::travel_speed};              // omega r/v - 1, the same as 0.2 above
const double efficiency = wheel_under_load(wheel, sand, by_speed, 130.0).efficiency();
  // clang-format on
  const WheelForces same = wheel_under_load(wheel, sand, {0.2}, 130.0);
  CHECK(efficiency == Approx(same.pull * 0.8 * 0.13 / same.torque));
  CHECK(same.load == Approx(130.0));
}

TEST_CASE("constants from measurements, as the page has them") {
  const TempFolder temporary;
  const std::string folder = temporary.path().string();
  // clang-format off
std::vector<PlateCurve> plates;   // width, sinkages (m) and pressures (Pa) of each plate
std::vector<ShearCurve> shear;    // normal stress (Pa), displacements (m) and stresses (Pa) of each load
measure(plates, shear);
const BekkerFit pressure = fit_bekker(plates, PlateFit::weighted_logarithms);
const ShearConstants strength = fit_shear(shear);
const Soil found{.pressure = pressure.law, .shear = strength.law};
save_soil(folder + "/found.toml", {"found", "plates and shear box", found});
  // clang-format on
  const Soil sand = known_soil("dry-sand").soil, back = load_soil(folder + "/found.toml").soil;
  CHECK(std::get<Bekker>(back.pressure).k_phi == Approx(std::get<Bekker>(sand.pressure).k_phi).epsilon(1e-6));
  CHECK(back.shear.friction_angle == Approx(sand.shear.friction_angle).epsilon(1e-6));
  CHECK(back.shear.displacement == Approx(sand.shear.displacement).epsilon(1e-6));
}

TEST_CASE("a foot on columns of soil, as the page has it") {
  using namespace dem;
  // clang-format off
mbd::Machine<integrator::VelocityVerlet> machine;  // in a world: world.machine(), and world.add_soil_columns(...)
const BodyId foot = machine.add_body(mbd::box_body("foot", {0.3, 0.1, 0.05}, 8000.0).at({1, 0.5, 0.025}));
MachineColumns ground(machine, {.length_x = 2, .length_y = 1, .soil = known_soil("dry-sand").soil, .damping = 1.2e4});
ground.add(foot, std::make_shared<ColumnBox>(Vector3<double>{0.3, 0.1, 0.05}), machine.body(foot).position());
if (const auto report = machine.run(1.0, 2.5e-4); !report) fmt::print("{}\n", report.text);
const double sinkage = 0.025 - machine.body(foot).position().z();  // m
  // clang-format on
  // 118 N on 0.03 m^2. Set down at once, it falls until the soil has taken up its fall: deeper than at rest, and not
  // more than by (n + 1)^(1/n).
  const double n = 1.1, at_rest = std::pow(8000.0 * 0.05 * 9.81 / (990.0 / 0.1 + 1528430.0), 1.0 / n);
  CHECK(sinkage > at_rest);
  CHECK(sinkage < std::pow(n + 1.0, 1.0 / n) * at_rest);
}
