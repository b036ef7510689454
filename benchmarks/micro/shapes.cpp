// Narrow phase of each pair of shapes: pairs of grains that overlap a little at random orientations, and that go on
// touching as grains in a bed do.

#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/polyhedron/polyhedron_sphere.hpp>
#include <dem/geometry/superquadric/superquadric_polyhedron.hpp>

#include <benchmark/benchmark.h>

#include <random>

namespace {

using dem::Vec3;
using dem::shape::Polyhedron;
using dem::shape::Sphere;
using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;
using Cube = dem::shape::SphereCluster<8>;

Sphere sphere() { return Sphere(1e-3); }
Cube cube8() { return dem::shape::cube8(1e-3); }
Polyhedron cube() { return dem::shape::cube(1e-3); }
Polyhedron rock() { return dem::shape::rock({.length = 2.4e-3, .points = 24}); }
Superquadric rounded() { return {Vec3::Constant(1e-3), Vec3::Constant(8)}; }
Superquadric odd() { return {{1e-3, 1.2e-3, 0.8e-3}, {3, 4, 8}}; }
Superquadric fractional() { return {{1e-3, 1.2e-3, 0.8e-3}, {2.5, 3.7, 6.1}}; }
SuperquadricPoints points98() { return {Vec3::Constant(1e-3), Vec3::Constant(8), 4}; }
SuperquadricPoints points218() { return {Vec3::Constant(1e-3), Vec3::Constant(8), 6}; }

/// Touching pairs of a and b; `known`: each search takes up where the last one stopped. Counts contacts.
template <class A, class B>
void narrow_phase(benchmark::State& state, const A& a, const B& b, bool known) {
  constexpr std::size_t pairs = 256;
  using Start = typename dem::shape::WarmStartOf<A, B>::type;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  dem::AlignedVector<double> pose_a(pairs * (A::pose_size + 8)), pose_b(pairs * (B::pose_size + 8));
  const auto at = [](dem::AlignedVector<double>& poses, std::size_t k) { return &poses[k * (poses.size() / pairs)]; };
  std::vector<dem::Vector3<double>> separation(pairs);
  std::vector<Start> starts(pairs);
  const auto collide = [&](std::size_t k, Start& start) {
    std::int64_t contacts = 0;
    dem::shape::collide_pair(a, at(pose_a, k), b, at(pose_b, k), separation[k], start,
                             [&](std::uint32_t, const auto& point) {
                               benchmark::DoNotOptimize(point);
                               ++contacts;
                             });
    return contacts;
  };
  for (std::size_t k = 0; k < pairs; ++k) {
    const auto turn = [&] {
      const dem::Quaternion q(normal(random), normal(random), normal(random), normal(random));
      return dem::from_eigen(q.normalized().toRotationMatrix());
    };
    a.orient(turn(), at(pose_a, k));
    b.orient(turn(), at(pose_b, k));
    const Vec3 way = Vec3(normal(random), normal(random), normal(random)).normalized();
    // From apart to first contact, which is at most half a percent of the distance deep.
    for (double distance = a.bounding_radius() + b.bounding_radius(); distance > 0; distance *= 0.995) {
      separation[k] = dem::from_eigen(Vec3(distance * way));
      Start nothing{};
      if (collide(k, nothing) > 0) break;
    }
  }
  std::int64_t contacts = 0;
  for (auto _ : state) {
    for (std::size_t k = 0; k < pairs; ++k) {
      if (known) {
        contacts += collide(k, starts[k]);
      } else {
        Start nothing{};
        contacts += collide(k, nothing);
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs));
  state.counters["contacts/s"] = benchmark::Counter(static_cast<double>(contacts), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(narrow_phase, sphere_sphere, sphere(), sphere(), true);
BENCHMARK_CAPTURE(narrow_phase, sphere_cube8, sphere(), cube8(), true);
BENCHMARK_CAPTURE(narrow_phase, cube8_cube8, cube8(), cube8(), true);
BENCHMARK_CAPTURE(narrow_phase, superquadric_sphere, rounded(), sphere(), true);
BENCHMARK_CAPTURE(narrow_phase, superquadric_cube8, rounded(), cube8(), true);
BENCHMARK_CAPTURE(narrow_phase, superquadric_8_known, rounded(), rounded(), true);
BENCHMARK_CAPTURE(narrow_phase, superquadric_8_new, rounded(), rounded(), false);
BENCHMARK_CAPTURE(narrow_phase, superquadric_3_4_8_known, odd(), odd(), true);
BENCHMARK_CAPTURE(narrow_phase, superquadric_3_4_8_new, odd(), odd(), false);
BENCHMARK_CAPTURE(narrow_phase, superquadric_fractional_known, fractional(), fractional(), true);
BENCHMARK_CAPTURE(narrow_phase, superquadric_fractional_new, fractional(), fractional(), false);
BENCHMARK_CAPTURE(narrow_phase, points_98, points98(), points98(), true);
BENCHMARK_CAPTURE(narrow_phase, points_218, points218(), points218(), true);
BENCHMARK_CAPTURE(narrow_phase, points_98_sphere, points98(), sphere(), true);
BENCHMARK_CAPTURE(narrow_phase, points_98_cube8, points98(), cube8(), true);
BENCHMARK_CAPTURE(narrow_phase, polyhedron_cube_cube, cube(), cube(), true);
BENCHMARK_CAPTURE(narrow_phase, polyhedron_rock_rock, rock(), rock(), true);
BENCHMARK_CAPTURE(narrow_phase, polyhedron_cube_sphere, cube(), sphere(), true);
BENCHMARK_CAPTURE(narrow_phase, polyhedron_cube_cube8, cube(), cube8(), true);
BENCHMARK_CAPTURE(narrow_phase, polyhedron_cube_superquadric, cube(), rounded(), true);
BENCHMARK_CAPTURE(narrow_phase, polyhedron_cube_points_98, cube(), points98(), true);

}  // namespace
