// Phases of a step on a loose cloud of grains: grid, neighbour lists, sums, integrators.

#include <dem/dem.hpp>

#include <benchmark/benchmark.h>

#include <random>

namespace {

template <class I>
struct Cloud : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Integrator = I;
};

/// n cubes of half-edge 1 mm, some of them touching, on a jittered lattice.
template <class Model>
dem::World<Model> cloud(int n) {
  dem::World<Model> world({.gravity = {0, 0, 0}, .time_step = 1e-6, .overlap_limit = 1e9, .threads = 1});
  world.set_contact({{2000, 0.015, 0.05}, {0.4, 2000, 0.015, 0.975}});
  const auto cube = world.add_species(dem::shape::cube8(1e-3));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const int edge = static_cast<int>(std::ceil(std::cbrt(n)));
  for (int k = 0; k < n; ++k) {
    const dem::Quaternion q(normal(random), normal(random), normal(random), normal(random));
    world.add_grain({cube,
                     2.2e-3 * dem::Vec3(k % edge, k / edge % edge, k / edge / edge),
                     {0, 0, 0},
                     q.normalized().toRotationMatrix()});
  }
  world.prepare();
  return world;
}

using Euler = Cloud<dem::integrator::SymplecticEuler>;

void grid_build(benchmark::State& state) {
  auto world = cloud<Euler>(static_cast<int>(state.range(0)));
  const auto& p = world.state().grains;
  dem::broadphase::UniformGrid grid;
  for (auto _ : state) {
    grid.build({p.position.x.data(), p.position.y.data(), p.position.z.data(), p.count}, 3e-3);
    benchmark::DoNotOptimize(grid.order().data());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(grid_build)->Arg(1000)->Arg(10000)->Arg(100000);

void rebuild_neighbours(benchmark::State& state) {
  auto world = cloud<Euler>(static_cast<int>(state.range(0)));
  for (auto _ : state) dem::rebuild_neighbours(world.state());
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(rebuild_neighbours)->Arg(10000);

/// Sums of the loads that contacts hold for partners in other chunks.
void gather_forces(benchmark::State& state) {
  auto world = cloud<Euler>(10000);
  auto& w = world.state();
  std::size_t loads = 0;
  for (const auto& chunk : w.chunks) loads += chunk.partner_load_first.back();
  state.counters["loads a grain"] = static_cast<double>(loads) / 10000;
  for (auto _ : state) {
    for (std::size_t c = 0; c < w.chunks.size(); ++c) {
      dem::grain::gather_forces<Euler>(c, w.chunks, w.grains, w.incoming_first, w.incoming);
    }
  }
  state.SetItemsProcessed(state.iterations() * 10000);
}
BENCHMARK(gather_forces);

template <class I>
void integrator(benchmark::State& state) {
  using Model = Cloud<I>;
  auto world = cloud<Model>(10000);
  auto& w = world.state();
  for (auto _ : state) {
    for (std::size_t c = 0; c < w.chunks.size(); ++c) {
      for (int stage = 0; stage < I::stages; ++stage) {
        const dem::grain::MovingStage<typename Model::Shape> moving = {
            .species = w.species, .inertia = w.inertia, .gravity = w.options.gravity, .stage = stage};
        if constexpr (I::predicts_before_forces) {
          dem::grain::predict_chunk<Model>(c, w.chunks[c], w.grains, moving);
        }
        dem::grain::move_chunk<Model>(c, w.chunks[c], w.grains, moving);
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * 10000);
}
BENCHMARK_TEMPLATE(integrator, dem::integrator::SymplecticEuler);
BENCHMARK_TEMPLATE(integrator, dem::integrator::VelocityVerlet);
BENCHMARK_TEMPLATE(integrator, dem::integrator::PredictorCorrector);

}  // namespace
