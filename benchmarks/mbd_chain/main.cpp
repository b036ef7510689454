// Steps per second of a machine as large as a vehicle (34 moving bodies, 35 joints) and of the squeezer, on one core.
//
//   mbd_chain [seconds per row, default 1]
//
// Each row is the median, the slowest and the fastest of five runs.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>

#include "../../examples/squeezer/squeezer.hpp"
#include "chain.hpp"

namespace {

using namespace dem;

template <class Machine>
void measure(const char* what, const char* integrator, Machine& machine, double dt, double seconds) {
  using Clock = std::chrono::steady_clock;
  std::array<double, 5> rates{};
  machine.most_substeps = machine.substeps;  // steps are counted as they are given
  (void)machine.run(100 * dt, dt);
  for (double& rate : rates) {
    const auto start = Clock::now();
    long steps = 0;
    double passed = 0.0;
    while (passed < seconds / rates.size()) {
      if (!machine.run(1000 * dt, dt)) {
        fmt::print("{}\n", machine.report().text);
        std::exit(1);
      }
      steps += 1000;
      passed = std::chrono::duration<double>(Clock::now() - start).count();
    }
    rate = static_cast<double>(steps) / passed;
  }
  std::sort(rates.begin(), rates.end());
  fmt::print("{:<10}{:<22}{:>12.0f}{:>12.0f}{:>12.0f}\n", what, integrator, rates[2], rates.front(), rates.back());
}

template <class I>
void measure_both(const char* integrator, double seconds) {
  auto chain = bench::make_chain<I>();
  measure("chain", integrator, chain, 1e-4, seconds);
  auto squeezer = squeezer::make<I>();
  measure("squeezer", integrator, squeezer.machine, 1e-7, seconds);
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 1.0;
  fmt::print("steps per second                      median     slowest     fastest\n");
  measure_both<integrator::SymplecticEuler>("symplectic Euler", seconds);
  measure_both<integrator::VelocityVerlet>("velocity Verlet", seconds);
  measure_both<integrator::PredictorCorrector>("predictor-corrector", seconds);
}
