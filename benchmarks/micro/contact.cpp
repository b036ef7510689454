// Contact kernels: the laws, one pack of contacts at a time, and the narrow phase of two cubes of eight spheres.

#include <dem/dem.hpp>

#include <benchmark/benchmark.h>

#include <random>

namespace {

using dem::Pack;
using dem::Vector3;

/// Numbers in [low, high), one a lane.
Pack random_pack(std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  return dem::generate([&](int) { return uniform(random); });
}

void normal_law(benchmark::State& state) {
  std::mt19937 random(1);
  dem::contact::Penalty::Parameters<Pack> p{Pack(2000.0), Pack(0.015), Pack(0.05)};
  dem::contact::NormalState<Pack> s{
      random_pack(random, 0, 1e-5), random_pack(random, -0.1, 0.1), Pack(1.0), Pack(1e-3), Pack(1e-5), Pack(1e-5)};
  dem::contact::Penalty::History<Pack> h;
  for (auto _ : state) {
    benchmark::DoNotOptimize(s);
    benchmark::DoNotOptimize(dem::contact::Penalty::force(p, s, h));
  }
  state.SetItemsProcessed(state.iterations() * dem::pack_width);
}
BENCHMARK(normal_law);

void friction_law(benchmark::State& state) {
  std::mt19937 random(1);
  dem::friction::AsperitySpring::Parameters<Pack> p{Pack(0.4), Pack(2000.0), Pack(0.015), Pack(0.975)};
  dem::contact::TangentialState<Pack> s{
      {random_pack(random, -0.1, 0.1), random_pack(random, -0.1, 0.1), random_pack(random, -0.1, 0.1)},
      random_pack(random, 0, 1e-2),
      Pack(1e-5),
      Pack(1.0),
      Pack(1e-3),
      Pack(1e-5),
      Pack(1e-5)};
  dem::friction::AsperitySpring::History<Pack> h{{Pack(0.0), Pack(0.0), Pack(0.0)}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(s);
    benchmark::DoNotOptimize(dem::friction::AsperitySpring::force(p, s, h));
    benchmark::DoNotOptimize(h);
  }
  state.SetItemsProcessed(state.iterations() * dem::pack_width);
}
BENCHMARK(friction_law);

/// Two cubes that just overlap at corners, in random orientations.
void narrow_phase_cube8(benchmark::State& state) {
  using Cube = dem::shape::SphereCluster<8>;
  const Cube cube = dem::shape::cube8(1.2e-3);
  constexpr std::size_t pairs = 256;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  dem::AlignedVector<double> poses(2 * pairs * Cube::pose_size);
  std::vector<Vector3<double>> separations;
  for (std::size_t k = 0; k < pairs; ++k) {
    for (const std::size_t side : {2 * k, 2 * k + 1}) {
      const dem::Quaternion q(normal(random), normal(random), normal(random), normal(random));
      cube.orient(dem::from_eigen(q.normalized().toRotationMatrix()), poses.data() + side * Cube::pose_size);
    }
    separations.push_back({2.5e-3, 0.4e-3 * normal(random), 0.4e-3 * normal(random)});
  }
  for (auto _ : state) {
    for (std::size_t k = 0; k < pairs; ++k) {
      const double* pose = poses.data() + 2 * k * Cube::pose_size;
      benchmark::DoNotOptimize(Cube::touching(cube, pose, cube, pose + Cube::pose_size, separations[k]));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs));
}
BENCHMARK(narrow_phase_cube8);

}  // namespace
