// Andrews' squeezer at t = 0.03 s against the seven reference angles, and how the error falls with the time step and
// with the stiffness of the joints.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "../../examples/squeezer/squeezer.hpp"
#include "catch.hpp"

namespace {

using namespace dem;

struct SqueezerRun {
  double error, seconds, opening;
  double softest, stiffest;  ///< N/m, of the joints' points
};

/// dt: time step; designed: the time step that the joints' stiffness is derived from.
template <class I>
SqueezerRun squeeze(double dt, double designed) {
  auto s = squeezer::make<I>();
  s.machine.design_for(designed);
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(s.machine.run(0.03, dt));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  double opening = 0.0;
  for (const auto id : s.angles) opening = std::max(opening, s.machine.violation(id).displacement);
  const auto stiffness = [](const mbd::Joint& a, const mbd::Joint& b) { return a.k < b.k; };
  const auto [soft, stiff] = std::ranges::minmax_element(s.machine.parts().joints, stiffness);
  return {s.error(), seconds, opening, soft->k, stiff->k};
}

std::string line(const char* what, double dt, const SqueezerRun& o) {
  return fmt::format("\n{:<12}{:>7.1e}{:>9.1e}{:>8.1e}{:>9.1e}{:>6.1f}{:>8.0e}{:>7.2f}", what, dt, o.softest,
                     o.stiffest, o.error, -std::log10(o.error), o.opening, o.seconds);
}
// Lines short enough for the test runner not to break them. Stiffness is that of the softest and of the stiffest joint;
// opening is how far the joints stand open at the end.
constexpr const char* header = "\nintegrator     dt/s k/(N/m) softest, stiffest error digits open/m time/s";

}  // namespace

TEST_CASE("squeezer: the seven angles to 1e-4") {
  std::string table = header;
  const auto check = [&](const char* name, const SqueezerRun& o, double dt) {
    table += line(name, dt, o);
    CHECK(o.error < 1e-4);
  };
  check("pred.-corr.", squeeze<integrator::PredictorCorrector>(5e-8, 5e-8), 5e-8);
  check("Verlet", squeeze<integrator::VelocityVerlet>(5e-8, 5e-8), 5e-8);
  check("Euler", squeeze<integrator::SymplecticEuler>(5e-8, 5e-8), 5e-8);
  WARN(table);
}

TEST_CASE("squeezer: error over time step, stiffness derived from it") {
  std::string table = header;
  double last = 0.0;
  for (const double dt : {8e-7, 4e-7, 2e-7, 1e-7, 5e-8, 2.5e-8}) {
    const SqueezerRun o = squeeze<integrator::PredictorCorrector>(dt, dt);
    table += line("pred.-corr.", dt, o);
    // Both the rule and the give of the joints (1/k, k as 1/dt^2) are of second order.
    if (last > 0.0) CHECK(last / o.error == Approx(4.0).epsilon(0.1));
    last = o.error;
  }
  WARN(table);
}

TEST_CASE("squeezer: error over the stiffness of the joints, at one time step") {
  std::string table = header;
  double last = 0.0;
  for (const double designed : {1.6e-6, 8e-7, 4e-7, 2e-7, 1e-7}) {
    const SqueezerRun o = squeeze<integrator::VelocityVerlet>(5e-8, designed);
    table += line("Verlet", 5e-8, o);
    if (last > 0.0) CHECK(last / o.error == Approx(4.0).epsilon(0.1));
    last = o.error;
  }
  WARN(table);
}

TEST_CASE("squeezer: error over the time step, at one stiffness") {
  // The give of the joints is the same, so what changes is the rule's own error, against the finest time step.
  std::string table = "\ndt (s)    change of beta against dt = 2.5e-8 s (relative)";
  const double designed = 4e-7;
  const auto beta = [&](double dt) {
    auto s = squeezer::make<integrator::PredictorCorrector>();
    s.machine.design_for(designed);
    REQUIRE(s.machine.run(0.03, dt));
    return s.machine.coordinate(s.angles[0]);
  };
  const double fine = beta(2.5e-8);
  double last = 0.0;
  for (const double dt : {4e-7, 2e-7, 1e-7}) {
    const double change = std::abs(beta(dt) / fine - 1.0);
    table += fmt::format("\n{:.1e}   {:.2e}", dt, change);
    if (last > 0.0) CHECK(last / change == Approx(4.0).epsilon(0.1));  // second order; "fine" errs by 1/16 of the last
    last = change;
  }
  CHECK(last < 1e-9);  // measured: 5e-10, five digits below what the joints give
  WARN(table);
}
