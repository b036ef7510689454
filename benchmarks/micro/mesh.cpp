// Contact search with meshes: building the tree, queries of spheres through it, and without it; a finely cut body that
// lies flat on another.

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/world/world.hpp>

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
    tyre.contacts(p, high, [&](std::uint32_t, const dem::Vector3<double>&, double g) { gap = std::min(gap, g); });
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
    tyre.contacts(centres[k], 8e-3, [&](std::uint32_t, const dem::Vector3<double>&, double gap) { sum += gap; });
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

struct Bodies : dem::Model {
  using Surfaces = dem::surface::Set<dem::surface::Box, dem::surface::TriangleMesh>;
  using Integrator = dem::integrator::SymplecticEuler;
};

/// A step of a slab whose underside of n x n squares lies on a block of triangles: items are its points that touch.
void bodies_face_on_face(benchmark::State& state) {
  using dem::surface::TriangleMesh;
  const int n = static_cast<int>(state.range(0));
  const dem::Vec3 edges(0.2, 0.2, 0.1);
  dem::World<Bodies> w({.gravity = {0, 0, -9.81}, .time_step = 1e-5, .threads = 1});
  w.set_contact({{4e5, 240.0, 1.0}, {0.5, 4e5, 400.0, 0.975}});
  const auto slab = w.machine().add_body(dem::mbd::box_body("slab", edges, 1000.0).at({0, 0, 0.05 - 1e-4}));
  w.add_body_contact(
      w.add_surface(slab, TriangleMesh(dem::mesh::box(edges, n))),
      w.add_surface(w.ground(), TriangleMesh(dem::mesh::box({1, 1, 0.2}, 3)), {.position = {0.03, 0.02, -0.1}}));
  w.run(10);
  for (auto _ : state) w.run(1);
  state.SetItemsProcessed(state.iterations() * (n + 1) * (n + 1));
}
BENCHMARK(bodies_face_on_face)->Arg(9)->Arg(31)->Arg(99)->Unit(benchmark::kMicrosecond);

/// A step of a rod of triangles with n facets that lies across another one: edges of one cross the other. Items are
/// steps.
void bodies_crossed(benchmark::State& state) {
  using dem::surface::TriangleMesh;
  const TriangleMesh rod(dem::mesh::cylinder(0.1, 2.0, static_cast<int>(state.range(0))));
  const auto along = [](const dem::Vec3& axis) { return dem::rotation_between(dem::Vec3::UnitZ(), axis); };
  dem::World<Bodies> w({.gravity = {0, 0, -9.81}, .time_step = 1e-5, .threads = 1});
  w.set_contact({{4e5, 240.0, 1.0}, {0.5, 4e5, 400.0, 0.975}});
  const auto upper =
      w.machine().add_body(dem::mbd::cylinder_body("rod", 0.1, 2.0, 1000.0).at({0, 0, 0.2 - 1e-3}, along({1, 0, 0})));
  w.add_body_contact(w.add_surface(upper, rod), w.add_surface(w.ground(), rod, {.rotation = along({0.2, 1, 0})}));
  w.run(10);
  for (auto _ : state) w.run(1);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(bodies_crossed)->Arg(48)->Arg(400)->Arg(2000)->Unit(benchmark::kMicrosecond);

}  // namespace
