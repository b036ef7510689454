// Error over processor time for machines with known answers: each mechanism at five time steps with each integrator,
// with joints of derived stiffness (penalty) and with joints that are held exactly (projected).
//
//   mbd_accuracy
//
// The order is the logarithm to base 2 of how much the error fell when the step was halved.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>

#include <fmt/format.h>

#include <ctime>

#include "mechanisms.hpp"

namespace {

template <class I, class Joints, class Mechanism>
void measure(const char* integrator) {
  constexpr bool projects = Joints::projects;
  double last = 0.0;
  for (const double dt : projects ? Mechanism::projected_steps : Mechanism::steps) {
    const std::clock_t start = std::clock();  // of the program, which has one thread
    const accuracy::Outcome o = Mechanism::template run<I, Joints>(dt);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    fmt::print("| {} | {} | {} | {:.3g} | {:.1e} | {} | {:.0e} | {:.2f} |\n", Mechanism::name,
               projects ? "projected" : "penalty", integrator, dt, o.error,
               last > 0.0 ? fmt::format("{:.1f}", std::log2(last / o.error)) : "", o.opening, seconds);
    std::fflush(stdout);
    last = o.error;
  }
}

template <class Joints, class Mechanism>
void all_integrators() {
  measure<dem::integrator::PredictorCorrector, Joints, Mechanism>("predictor-corrector");
  measure<dem::integrator::VelocityVerlet, Joints, Mechanism>("velocity Verlet");
  measure<dem::integrator::SymplecticEuler, Joints, Mechanism>("symplectic Euler");
}

template <class Mechanism>
void table() {
  all_integrators<dem::mbd::Penalty, Mechanism>();
  all_integrators<dem::mbd::Projected, Mechanism>();
}

}  // namespace

int main() {
  fmt::print(
      "| mechanism | joints | integrator | time step (s) | error | order | opening (m) | processor time (s) |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  table<accuracy::Squeezer>();
  table<accuracy::FourBar>();
  table<accuracy::Bricard>();
  table<accuracy::SliderCrank>();
  table<accuracy::Governor>();
  table<accuracy::HeavyTop>();
}
