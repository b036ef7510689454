// Pendulum of 1 kg and 1 m, released horizontal, 10 s: energy and turning point, over the time step and the stiffness.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/mbd/mbd.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "catch.hpp"

namespace {

using namespace dem;
using namespace dem::mbd;

struct PendulumRun {
  double energy, period, opening, seconds;
};

/// Largest change of energy (J), relative error of the period, largest opening of the pivot (m), run time (s).
template <class I>
PendulumRun swing(double dt, double designed) {
  Machine<I> m;
  m.joint_tolerance = 1.0;  // m: how far the pivot opens is what is measured
  const double inertia = 0.05;
  const BodyId bob = m.add_body(given_body("bob", 1.0, Vec3::Constant(inertia)).at({1, 0, 0}));
  const JointId pivot = m.add_joint(revolute("pivot", m.ground(), bob, {0, 0, 0}, Vec3::UnitY()));
  m.design_for(designed);
  const auto energy = [&] { return energy_of(m.parts(), m.gravity).sum(); };
  const double start = energy();
  const double exact = 4.0 * std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt((1.0 + inertia) / 9.81);
  PendulumRun o{};
  double last = 0.0, turned = 0.0;
  int turns = 0;
  const auto clock = std::chrono::steady_clock::now();
  REQUIRE(m.run(10.0, dt, [&] {
    o.energy = std::max(o.energy, std::abs(energy() - start));
    o.opening = std::max(o.opening, m.violation(pivot).displacement);
    const double speed = m.speed(pivot);
    if (m.time() > 0.1 && last * speed < 0.0) {
      turned = m.time() - dt * speed / (speed - last);
      ++turns;
    }
    last = speed;
  }));
  o.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  o.period = std::abs(turned / (0.5 * exact * turns) - 1.0);
  return o;
}

}  // namespace

TEMPLATE_TEST_CASE("pendulum: energy and period over the time step", "", integrator::PredictorCorrector,
                   integrator::VelocityVerlet, integrator::SymplecticEuler) {
  std::string table = "\n    dt (s)  energy (J)     period  digits  opening (m)  time (s)";
  double last = 0.0;
  for (const double dt : {4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5}) {
    const PendulumRun o = swing<TestType>(dt, dt);
    table += fmt::format("\n{:>10.2e}{:>12.2e}{:>11.2e}{:>8.1f}{:>13.1e}{:>10.2f}", dt, o.energy, o.period,
                         -std::log10(o.period), o.opening, o.seconds);
    if (last > 0.0) CHECK(o.period < last / 3.0);  // second order: the joint gives way as 1/k, that is as dt^2
    last = o.period;
  }
  WARN(table);
}

TEST_CASE("pendulum: energy drift under 5e-5 J in 10 s") {
  CHECK(swing<integrator::PredictorCorrector>(2e-5, 2e-5).energy < 5e-5);
  CHECK(swing<integrator::VelocityVerlet>(2e-5, 2e-5).energy < 5e-5);
}

TEST_CASE("pendulum: period over the stiffness of the pivot") {
  std::string table = "\nstiffness (1 = derived for the step of 2e-5 s)     period  opening (m)";
  double last = 0.0;
  for (const double factor : {16.0, 8.0, 4.0, 2.0, 1.0}) {
    const PendulumRun o = swing<integrator::VelocityVerlet>(2e-5, 2e-5 * factor);
    table += fmt::format("\n{:>46.4f}{:>11.2e}{:>13.1e}", 1.0 / (factor * factor), o.period, o.opening);
    if (last > 0.0) CHECK(last / o.period == Approx(4.0).epsilon(0.1));
    last = o.period;
  }
  WARN(table);
}
