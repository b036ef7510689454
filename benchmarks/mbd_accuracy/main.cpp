// Error over wall time for machines with known answers: each mechanism at five time steps with each integrator, joints
// with derived stiffness.
//
//   mbd_accuracy
//
// The order is the logarithm to base 2 of how much the error fell when the step was halved.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>

#include <fmt/format.h>

#include <chrono>

#include "mechanisms.hpp"

namespace {

template <class I, class Mechanism>
void measure(const char* integrator) {
  double last = 0.0;
  for (const double dt : Mechanism::steps) {
    const auto start = std::chrono::steady_clock::now();
    const accuracy::Outcome o = Mechanism::template run<I>(dt);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("| {} | {} | {:.1e} | {:.1e} | {} | {:.0e} | {:.2f} |\n", Mechanism::name, integrator, dt, o.error,
               last > 0.0 ? fmt::format("{:.1f}", std::log2(last / o.error)) : "", o.opening, seconds);
    last = o.error;
  }
}

template <class Mechanism>
void table() {
  measure<dem::integrator::PredictorCorrector, Mechanism>("predictor-corrector");
  measure<dem::integrator::VelocityVerlet, Mechanism>("velocity Verlet");
  measure<dem::integrator::SymplecticEuler, Mechanism>("symplectic Euler");
}

}  // namespace

int main() {
  fmt::print("| mechanism | integrator | time step (s) | error | order | opening (m) | run time (s) |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  table<accuracy::Squeezer>();
  table<accuracy::FourBar>();
  table<accuracy::Bricard>();
  table<accuracy::SliderCrank>();
  table<accuracy::Governor>();
  table<accuracy::HeavyTop>();
}
