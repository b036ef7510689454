// The machine's step: of the squeezer, of a machine as large as a vehicle, and of single joints.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>

#include <benchmark/benchmark.h>

#include "../../examples/squeezer/squeezer.hpp"
#include "../mbd_chain/chain.hpp"

namespace {

using namespace dem;
using namespace dem::mbd;

template <class I>
void squeezer_step(benchmark::State& state) {
  auto s = squeezer::make<I>();
  for (auto _ : state) (void)s.machine.step(1e-7);
  state.counters["steps/s"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(squeezer_step<integrator::SymplecticEuler>);
BENCHMARK(squeezer_step<integrator::VelocityVerlet>);
BENCHMARK(squeezer_step<integrator::PredictorCorrector>);

template <class I>
void chain_step(benchmark::State& state) {
  auto m = bench::make_chain<I>();
  for (auto _ : state) (void)m.step(1e-4);
  state.counters["steps/s"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(chain_step<integrator::SymplecticEuler>);
BENCHMARK(chain_step<integrator::VelocityVerlet>);
BENCHMARK(chain_step<integrator::PredictorCorrector>);

void joint_force(benchmark::State& state) {
  constexpr JointKind kinds[] = {JointKind::fixed,         JointKind::spherical,         JointKind::revolute,
                                 JointKind::cylindrical,   JointKind::prismatic,         JointKind::planar,
                                 JointKind::universal,     JointKind::constant_velocity, JointKind::point_on_line,
                                 JointKind::point_on_plane};
  const JointKind kind = kinds[state.range(0)];
  Machine<integrator::SymplecticEuler> m;
  const BodyId a = m.add_body(given_body("a", 1.0, Vec3(1, 1, 1)));
  const BodyId b = m.add_body(given_body("b", 1.0, Vec3(1, 1, 1)).at({1, 0, 0}));
  m.add_joint(joint(kind, "joint", a, b, {0.5, 0, 0}));
  m.design_for(1e-3);
  Joint j = m.parts().joints[0];
  const Vector3<double> w = {0.1, 0.2, 0.3};
  for (auto _ : state) {
    traits_of(kind).force(j, m.body(a), m.body(b), w, w, 1e-3);
    benchmark::DoNotOptimize(m.body(b).force);
  }
  state.SetLabel(name_of(kind));
}
BENCHMARK(joint_force)->DenseRange(0, 9);

}  // namespace
