// Large beds: making their grains, and a frame of them as rigs write it for ParaView.

#include <dem/dem.hpp>
#include <dem/rig/frames.hpp>

#include <benchmark/benchmark.h>

#include <filesystem>
#include <random>

namespace {

struct Cubes : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Integrator = dem::integrator::VelocityVerlet;
};

/// n cubes of half-edge 1 mm on a jittered lattice, that touch, turn and move.
dem::World<Cubes> cubes(int n) {
  dem::World<Cubes> world({.gravity = {0, 0, 0}, .time_step = 1e-6, .overlap_limit = 1e9, .threads = 1});
  world.set_contact({{2000, 0.015, 0.05}, {0.4, 2000, 0.015, 0.975}});
  const auto cube = world.add_species(dem::shape::cube8(1e-3));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto some = [&](double size) { return size * dem::Vec3(normal(random), normal(random), normal(random)); };
  const int edge = static_cast<int>(std::ceil(std::cbrt(n)));
  for (int k = 0; k < n; ++k) {
    const dem::Quaternion q(normal(random), normal(random), normal(random), normal(random));
    const dem::Vec3 cell(k % edge, k / edge % edge, k / edge / edge);
    world.add_grain({cube, 2.2e-3 * cell + some(1e-4), some(0.01), q.normalized().toRotationMatrix(), some(1.0)});
  }
  return world;
}

void make_grains(benchmark::State& state) {
  for (auto _ : state) {
    auto world = cubes(static_cast<int>(state.range(0)));
    benchmark::DoNotOptimize(world.grain_count());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(make_grains)->Arg(2'000'000)->Unit(benchmark::kSecond);

void frame_of_grains(benchmark::State& state) {
  auto world = cubes(static_cast<int>(state.range(0)));
  world.set_sleep(dem::SleepOptions{});
  if (const auto report = world.run(2); !report) return state.SkipWithError(report.text.c_str());
  const auto path = std::filesystem::temp_directory_path() / "dem_frame.vtp";
  for (auto _ : state) dem::rig::write_grain_points(path, world, {.single_precision = true});
  state.counters["MB"] = 1e-6 * static_cast<double>(std::filesystem::file_size(path));
  std::filesystem::remove(path);
}
BENCHMARK(frame_of_grains)->Arg(300'000)->Unit(benchmark::kSecond);

}  // namespace
