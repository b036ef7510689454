// Contact search between spheres and a mesh: building the tree, queries through it, and without it.

#include <dem/math/mesh_shapes.hpp>
#include <dem/surface/triangle_mesh.hpp>

#include <benchmark/benchmark.h>

#include <random>

namespace {

/// Centres of spheres of 8 mm that are between `low` and `high` (m) away from the tyre's tread or walls.
std::vector<dem::Vector3<double>> places(const dem::surface::TriangleMesh& tyre, double low, double high) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> place(-0.52, 0.52);
  std::vector<dem::Vector3<double>> result;
  while (result.size() < 1000) {
    const dem::Vector3<double> p = {place(engine), place(engine), 0.35 * place(engine)};
    double gap = 1e300;
    tyre.touch(p, high, [&](std::uint32_t, const dem::Vector3<double>&, double g) { gap = std::min(gap, g); });
    if (gap > low && gap < high) result.push_back(p);
  }
  return result;
}

void mesh_build(benchmark::State& state) {
  const auto mesh = dem::mesh::tyre(0.97, 0.254, static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(dem::surface::TriangleMesh(mesh).bounds());
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(mesh_build)->Arg(1000)->Arg(6662)->Arg(100000)->Unit(benchmark::kMillisecond);

void query(benchmark::State& state, double low, double high) {
  const dem::surface::TriangleMesh tyre(dem::mesh::tyre(0.97, 0.254, static_cast<int>(state.range(0))));
  const auto centres = places(tyre, low, high);
  double sum = 0.0;
  std::size_t k = 0;
  for (auto _ : state) {
    tyre.touch(centres[k], 8e-3, [&](std::uint32_t, const dem::Vector3<double>&, double gap) { sum += gap; });
    k = (k + 1) % centres.size();
  }
  benchmark::DoNotOptimize(sum);
}
void mesh_touching(benchmark::State& state) { query(state, 0.0, 8e-3); }
void mesh_near_miss(benchmark::State& state) { query(state, 8e-3, 3e-2); }
BENCHMARK(mesh_touching)->Arg(1000)->Arg(6662)->Arg(100000);
BENCHMARK(mesh_near_miss)->Arg(1000)->Arg(6662)->Arg(100000);

void mesh_brute_force(benchmark::State& state) {
  const dem::surface::TriangleMesh tyre(dem::mesh::tyre(0.97, 0.254, static_cast<int>(state.range(0))));
  const auto centres = places(tyre, 0.0, 8e-3);
  std::size_t k = 0;
  for (auto _ : state) {
    double nearest = 1e300;
    for (const dem::surface::Face& face : tyre.data().faces) {
      const auto d = centres[k] - face.nearest(centres[k]).point;
      nearest = std::min(nearest, dot(d, d));
    }
    benchmark::DoNotOptimize(nearest);
    k = (k + 1) % centres.size();
  }
}
BENCHMARK(mesh_brute_force)->Arg(6662);

}  // namespace
