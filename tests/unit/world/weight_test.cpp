#include "scenes.hpp"

namespace weight_test {

using Catch::Approx;

namespace {
constexpr double half_edge = 1.2e-3;
}

TEMPLATE_TEST_CASE("a cube that came to rest weighs m g", "", dem::integrator::PredictorCorrector,
                   dem::integrator::VelocityVerlet, dem::integrator::SymplecticEuler) {
  dem::World<Grains<Cube8, TestType>> w(options({0, 0, -g}, 5e-6));
  w.set_contact(sand<Grains<Cube8, TestType>>());
  const auto cube = w.add_species(dem::shape::cube8(half_edge));
  const auto scale = w.machine().add_fixed_body("scale", {0, 0, -0.005});
  const auto plate = w.add_surface(scale, dem::surface::Box({0.02, 0.02, 0.01}));
  const auto sensor = w.machine().add_sensor(dem::mbd::contact_sensor("weight", scale, 0.0));
  const double weight = w.species(cube).mass * g;
  dem::NewGrain n;
  n.species = cube;
  n.position = {1e-3, 2e-3, 1.5 * half_edge};
  const auto p = w.add_grain(n);
  // It bounces for 0.25 s (each time to 0.9 of the speed), and then the dampers take the swing away with exp(-430/s t).
  // What is left is the rounding of the position, 2e-19 m of an overlap of 4.5e-8 m. All tolerances are relative to the
  // weight of 3.6e-4 N, which is stricter than the same number of newtons.
  REQUIRE(w.run_for(0.4));
  CHECK(std::abs(-w.surface_force(plate).z() - weight) < 1e-9 * weight);
  CHECK(w.surface_force(plate).head(2).norm() < 1e-9 * weight);
  CHECK(std::abs(w.force(p).z() - weight) < 1e-9 * weight);
  CHECK(std::abs(w.machine().sensor(sensor).latest().force.z + weight) < 1e-9 * weight);
  CHECK(w.velocity(p).norm() < 1e-12);
  // The torque about the middle of the scale is that of the weight where the cube stands.
  const Vec3 torque = Vec3(1e-3, 2e-3, 0).cross(Vec3(0, 0, -weight));
  CHECK((w.surface_torque(plate) - torque).norm() < 1e-8 * torque.norm());
}

TEST_CASE("a cube that fell on its corner weighs m g when it lies") {
  dem::World<Cubes> w(options({0, 0, -g}, 5e-6));
  w.set_contact(sand<Cubes>());
  const auto cube = w.add_species(dem::shape::cube8(half_edge));
  const auto plate = w.add_surface(w.ground(), dem::surface::Plane{});
  dem::NewGrain n;
  n.species = cube;
  n.position = {0, 0, 2 * half_edge};
  n.rotation = Random(3).rotation();
  const auto p = w.add_grain(n);
  REQUIRE(w.run_for(1.0));  // it rocks for 0.3 s, and settles with exp(-60/s t)
  const double weight = w.species(cube).mass * g;
  CHECK(w.position(p).z() == Approx(half_edge).epsilon(1e-3));  // it lies on a face
  CHECK((w.surface_force(plate) - Vec3(0, 0, -weight)).norm() < 1e-9 * weight);
}

TEST_CASE("every force of a pile arrives in the walls", "[slow]") {
  dem::World<Cubes> w(options({0, 0, -g}, 1e-5));
  w.set_contact(sand<Cubes>());
  const auto cube = w.add_species(dem::shape::cube8(half_edge));
  const auto walls = add_open_box(w, {0.016, 0.016, 0});
  add_block(w, cube, {2.5e-3, 2.5e-3, 2.5e-3}, 3.6e-3, 4, 4, 13, 0.1);
  const double mass = total_mass(w);
  const Vec3 weight = {0, 0, -mass * g};
  const auto on_walls = [&] {
    Vec3 sum = Vec3::Zero();
    for (const SurfaceId s : walls) sum += w.surface_force(s);
    return sum;
  };
  REQUIRE(w.grain_count() > 200);

  // While they pour: gravity less what the walls take is the rate of the momentum, step by step and to rounding, as the
  // forces between grains cancel. A contact force may be 100 weights, and its rounding counts.
  REQUIRE(w.run(2000));
  double worst = 0.0, largest = 0.0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 before = momentum(w);
    REQUIRE(w.step());
    const Vec3 rate = (momentum(w) - before) / w.time_step();
    worst = std::max(worst, (weight - on_walls() - rate).norm());
    largest = std::max(largest, on_walls().norm());
  }
  CHECK(largest > 0.1 * weight.norm());
  CHECK(worst < 1e-9 * weight.norm());

  // At rest: what is left of the momentum, over the time of the average.
  REQUIRE(w.run_for(0.4));
  const Vec3 before = momentum(w);
  Vec3 mean = Vec3::Zero();
  const int steps = 2000;
  for (int k = 0; k < steps; ++k) {
    REQUIRE(w.step());
    mean += on_walls() / steps;
  }
  const Vec3 residual = (momentum(w) - before) / (steps * w.time_step());
  CHECK((mean - weight + residual).norm() < 1e-9 * weight.norm());
  CHECK((on_walls() - weight).norm() < 0.01 * weight.norm());
  CHECK(w.surface_force(walls[0]).z() < -0.5 * weight.norm());  // walls with friction carry some of it
  CHECK(kinetic_energy(w) < 1e-6 * mass * g * half_edge);
}

}  // namespace weight_test
