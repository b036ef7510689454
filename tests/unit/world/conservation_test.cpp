#include "scenes.hpp"

using Catch::Approx;

namespace {

/// Some hundred grains that fly at each other, without walls and weight.
template <class World>
void add_swarm(World& w) {
  const auto large = w.add_species(dem::shape::cube8(1.2e-3)), small = w.add_species(dem::shape::cube8(0.8e-3));
  Random random(5);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      for (int k = 0; k < 6; ++k) {
        dem::NewGrain p;
        p.species = (i + j + k) % 2 == 0 ? large : small;
        p.position = 2.6e-3 * Vec3(i, j, k);
        p.rotation = random.rotation();
        p.velocity = -40.0 * (p.position - Vec3::Constant(6.5e-3)) + random.vector(0.1);
        p.angular_velocity = random.vector(50.0);
        w.add_grain(p);
      }
    }
  }
}

/// Two turning cubes that meet off centre, with springs alone.
template <class World>
void add_pair(World& w) {
  w.set_contact({{2000.0, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
  const auto cube = w.add_species(dem::shape::cube8(1.2e-3));
  Random random(2);
  dem::NewGrain n;
  n.species = cube;
  for (const double side : {-1.0, 1.0}) {
    n.position = {side * 2.1e-3, side * 3e-4, side * 1e-4};
    n.velocity = {-side * 0.2, 0, 0};
    n.rotation = random.rotation();
    n.angular_velocity = random.vector(20.0);
    w.add_grain(n);
  }
}

template <class World>
std::size_t contacts(const World& w) {
  std::size_t n = 0;
  for_each_grain(w, [&](GrainId p) { n += w.force(p).norm() > 0.0; });
  return n;
}

template <class Integrator>
void check_conserved(double angular_tolerance) {
  dem::World<Grains<Cube8, Integrator>> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Grains<Cube8, Integrator>>());
  add_swarm(w);
  const Vec3 p0 = momentum(w), l0 = angular_momentum(w);
  const double e0 = kinetic_energy(w);
  // The sizes that the sums are made of, against which they round.
  double p_size = 0.0, l_size = 0.0;
  for_each_grain(w, [&](GrainId p) {
    p_size += mass_of(w, p) * w.velocity(p).norm();
    l_size += mass_of(w, p) * w.velocity(p).norm() * w.position(p).norm();
  });
  std::size_t most = 0;
  for (int k = 0; k < 40; ++k) {
    REQUIRE(w.run(100));
    most = std::max(most, contacts(w));
  }
  CHECK(most > 30);                     // at one instant; over the run all of them collide
  CHECK(kinetic_energy(w) < 0.8 * e0);  // dampers and friction took some
  // Each of 4,000 steps rounds by 1e-16 of each of the grains' own share.
  CHECK((momentum(w) - p0).norm() < 1e-12 * p_size);
  CHECK((angular_momentum(w) - l0).norm() < angular_tolerance * l_size);
}

}  // namespace

TEST_CASE("momentum and angular momentum are kept to rounding", "[slow]") {
  // These schemes apply each force where the grain is when it is evaluated: angular momentum too is kept exactly (for
  // bodies whose inertia is the same about all axes, like cubes).
  check_conserved<dem::integrator::SymplecticEuler>(1e-12);
  check_conserved<dem::integrator::VelocityVerlet>(1e-12);
}

TEST_CASE("the predictor-corrector keeps momentum to rounding and angular momentum to its order", "[slow]") {
  // Measured with three swarms: 0.5 to 1.2e-7, and up to 1.6e-7 on the way. Another swarm, or another processor's
  // rounding, may do three times worse.
  check_conserved<dem::integrator::PredictorCorrector>(5e-7);
}

TEST_CASE("the predictor-corrector's error of angular momentum falls with the square of the time step") {
  // One collision, so that all steps see the same motion. The remainder is of third order, 10 and 5 % of the error at
  // these steps: an order of 2.08 and 2.02 was measured.
  const auto error = [](double dt) {
    dem::World<Grains<Cube8, dem::integrator::PredictorCorrector>> w(options({0, 0, 0}, dt));
    add_pair(w);
    const Vec3 before = angular_momentum(w);
    REQUIRE(w.run_for(0.02));
    REQUIRE(w.force(GrainId(0)).norm() == 0.0);
    return (angular_momentum(w) - before).norm();
  };
  const double coarse = error(4e-6), middle = error(2e-6), fine = error(1e-6);
  CHECK(std::log2(coarse / middle) == Approx(2.0).margin(0.2));
  CHECK(std::log2(middle / fine) == Approx(2.0).margin(0.1));
}

TEST_CASE("without dampers and friction the energy comes back after a collision") {
  dem::World<Grains<Cube8, dem::integrator::VelocityVerlet>> w(options({0, 0, 0}, 1e-6));
  add_pair(w);
  const double e0 = kinetic_energy(w);
  double least = e0;
  for (int k = 0; k < 500; ++k) {
    REQUIRE(w.run(40));
    least = std::min(least, kinetic_energy(w));
  }
  REQUIRE(w.force(GrainId(0)).norm() == 0.0);
  CHECK(least < 0.9 * e0);  // they did collide
  // (omega dt)^2 = 2e-4 of the energy stored in the springs, for each of a few contacts.
  CHECK(kinetic_energy(w) == Approx(e0).epsilon(1e-3));
}
