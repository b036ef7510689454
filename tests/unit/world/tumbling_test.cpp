#include "scenes.hpp"

#include <array>

using Catch::Approx;

namespace {

/// A grain with three different inertias, spinning about none of its axes.
template <class Integrator>
struct Tumbler {
  dem::World<Grains<Cube8, Integrator>> world;
  GrainId grain;

  explicit Tumbler(double dt) : world(options({0, 0, 0}, dt)) {
    const std::array<dem::Ball, 2> balls = {{{{-0.1, 0, 0}, 0.1}, {{0.1, 0, 0}, 0.1}}};
    const auto species =
        world.add_species(Cube8(balls, dem::MassProperties{1.0, Vec3::Zero(), Vec3(1.0, 2.0, 2.5).asDiagonal()}));
    world.set_contact({{1e-6, 0, 1}, {0, 0, 0, 0}});  // nothing touches; so soft that it allows any step
    dem::NewGrain n;
    n.species = species;
    n.velocity = {1, 2, 3};
    n.angular_velocity = {1.0, 0.8, -0.6};
    grain = world.add_grain(n);
  }
  /// Of this grain alone, whatever else is in the world.
  double energy() const {
    const auto& s = world.species(SpeciesId(0));
    const Vec3 spin = world.rotation(grain).transpose() * world.angular_velocity(grain);
    return 0.5 * s.mass * world.velocity(grain).squaredNorm() + 0.5 * spin.dot(s.inertia.cwiseProduct(spin));
  }
  Vec3 spin_momentum() const {
    const auto& s = world.species(SpeciesId(0));
    return angular_momentum(world) - s.mass * world.position(grain).cross(world.velocity(grain));
  }
};

/// How far the spin momentum and orientation are from those of a run with far smaller steps, after t = 2.
template <class Integrator>
double measured_order() {
  Tumbler<dem::integrator::PredictorCorrector> exact(2.0 / 100000);  // error 1e-9
  REQUIRE(exact.world.run(100000));
  std::vector<double> errors;
  for (const int n : {400, 800}) {
    Tumbler<Integrator> t(2.0 / n);
    REQUIRE(t.world.run(static_cast<std::uint64_t>(n)));
    errors.push_back((t.world.rotation(t.grain) - exact.world.rotation(exact.grain)).norm() +
                     (t.world.angular_velocity(t.grain) - exact.world.angular_velocity(exact.grain)).norm());
  }
  return std::log2(errors[0] / errors[1]);
}

}  // namespace

TEMPLATE_TEST_CASE("a free body tumbles and stays what it is", "[slow]", dem::integrator::PredictorCorrector,
                   dem::integrator::VelocityVerlet, dem::integrator::SymplecticEuler) {
  // A step turns the body by 1.4e-3 rad; a million are 220 turns. The cheaper schemes run a fifth of that.
  Tumbler<TestType> t(1e-3);
  const int thousands = TestType::stages > 1 ? 1000 : 200;
  const double energy = t.energy();
  const Vec3 momentum = t.spin_momentum();
  double worst_rotation = 0.0;
  for (int k = 0; k < thousands; ++k) {
    REQUIRE(t.world.run(1000));
    worst_rotation = std::max(worst_rotation, not_a_rotation(t.world.rotation(t.grain)));
  }
  CHECK(worst_rotation < 1e-12);
  CHECK(std::abs(t.world.rotation(t.grain).determinant() - 1.0) < 1e-12);
  // A second-order scheme errs by (omega dt)^2 = 2e-6 in the path; in energy and momentum no more than that may gather
  // over all the turns. Translation must not leak in.
  CHECK(t.energy() == Approx(energy).epsilon(1e-5));
  // Symplectic Euler turns the body with the spin at the end of the step: a direction off by omega dt, which does not
  // grow.
  const double off = std::is_same_v<TestType, dem::integrator::SymplecticEuler> ? 1e-3 : 1e-4;
  CHECK((t.spin_momentum() - momentum).norm() < off * momentum.norm());
  CHECK((t.world.velocity(t.grain) - Vec3(1, 2, 3)).norm() == 0.0);
  CHECK((t.world.position(t.grain) - thousands * Vec3(1, 2, 3)).norm() < 1e-7);
}

TEST_CASE("order of accuracy of a tumbling grain") {
  CHECK(measured_order<dem::integrator::PredictorCorrector>() == Approx(2.0).margin(0.1));
  CHECK(measured_order<dem::integrator::VelocityVerlet>() > 1.9);
  CHECK(measured_order<dem::integrator::SymplecticEuler>() > 0.9);
}

TEST_CASE("a body that spins about its middle axis flips over and over") {
  Tumbler<dem::integrator::PredictorCorrector> t(1e-3);
  const double energy = t.energy();
  dem::World<Grains<Cube8, dem::integrator::PredictorCorrector>>& w = t.world;
  dem::NewGrain n;
  n.species = SpeciesId(0);
  n.position = {10, 0, 0};
  n.angular_velocity = {1e-6, 1.0, 0};
  const auto p = w.add_grain(n);
  int flips = 0;
  double last = 1.0;
  for (int k = 0; k < 500; ++k) {
    REQUIRE(w.run(500));
    const double along = (w.rotation(p).transpose() * w.angular_velocity(p)).y();
    if (along * last < 0.0) ++flips;
    if (along != 0.0) last = along;
  }
  // Perturbations grow as exp(t sqrt((I2 - I1)(I3 - I2)/(I1 I3))) = exp(0.447 t) from 1e-6: a flip in about 2 *
  // 14/0.447 s.
  CHECK(flips == Approx(250.0 / 65.0).margin(1.5));
  CHECK(t.energy() == Approx(energy).epsilon(1e-5));  // the first body tumbles on beside it, as it does alone
}
