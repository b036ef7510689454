// Contact kernels: the laws, one pack of contacts at a time, and the narrow phase of two cubes of eight spheres.

#include <dem/dem.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/shapes.hpp>

#include <benchmark/benchmark.h>

#include <array>
#include <bit>
#include <random>

namespace {

using dem::Pack;
using dem::Vector3;

/// Numbers in [low, high), one a lane.
Pack random_pack(std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  return dem::generate([&](int) { return uniform(random); });
}

/// A struct of packs that holds the fields of `value` in every lane.
template <class Packed, class Value>
Packed broadcast(const Value& value) {
  Packed result{};
  if constexpr (!std::is_empty_v<Packed>) {
    std::array<Pack, sizeof(Packed) / sizeof(Pack)> packs;
    const auto fields = std::bit_cast<std::array<double, sizeof(Value) / sizeof(double)>>(value);
    for (std::size_t k = 0; k < packs.size(); ++k) packs[k] = Pack(fields[k]);
    result = std::bit_cast<Packed>(packs);
  }
  return result;
}

/// Runs call(parameters, state, history) on one pack of contacts; flattened, as the contact loop of a world is in
/// effect.
template <class Law, class State, class Call>
DEM_FLATTEN void run_law(benchmark::State& state, const typename Law::template Parameters<double>& constants, State s,
                         Call&& call) {
  const auto p = broadcast<typename Law::template Parameters<Pack>>(constants);
  typename Law::template History<Pack> h{};
  for (auto _ : state) {
    benchmark::DoNotOptimize(s);
    benchmark::DoNotOptimize(call(p, s, h));
    benchmark::DoNotOptimize(h);
  }
  state.SetItemsProcessed(state.iterations() * dem::pack_width);
}

dem::contact::NormalState<Pack> normal_state(double low, double high) {
  std::mt19937 random(1);
  return {random_pack(random, low, high), random_pack(random, -0.1, 0.1), Pack(1e-3), Pack(1e-5), Pack(1e-5)};
}
Vector3<Pack> random_vector(std::mt19937& random) {
  return {random_pack(random, -0.1, 0.1), random_pack(random, -0.1, 0.1), random_pack(random, -0.1, 0.1)};
}

const dem::contact::ElasticPair soft = {1e7, 3e6};

template <class Law>
void normal_law(benchmark::State& state, const typename Law::template Parameters<double>& p) {
  run_law<Law>(state, p, normal_state(0, 1e-5),
               [](const auto& q, const auto& s, auto& h) { return Law::force(q, s, h); });
}
template <class Law>
void cohesion_law(benchmark::State& state, const typename Law::template Parameters<double>& p) {
  run_law<Law>(state, p, normal_state(-1e-6, 1e-5), [](const auto& q, const auto& s, auto& h) {
    const auto a = Law::force(q, s, h);
    return a.pull + a.grip;
  });
}
template <class Law>
void friction_law(benchmark::State& state, const typename Law::template Parameters<double>& p) {
  std::mt19937 random(1);
  const dem::contact::TangentialState<Pack> s{
      random_vector(random), random_pack(random, 0, 1e-2), Pack(1e-5), Pack(1e-3), Pack(1e-5), Pack(1e-5)};
  run_law<Law>(state, p, s, [](const auto& q, const auto& t, auto& h) { return Law::force(q, t, h); });
}
template <class Law>
void rolling_law(benchmark::State& state, const typename Law::template Parameters<double>& p) {
  std::mt19937 random(1);
  const dem::rolling::RollingState<Pack> s{{Pack(0.0), Pack(0.0), Pack(1.0)},
                                           random_vector(random),
                                           random_pack(random, -9, 9),
                                           random_pack(random, 0, 1e-2),
                                           Pack(1e-3),
                                           Pack(1e-5),
                                           Pack(1e-5)};
  run_law<Law>(state, p, s, [](const auto& q, const auto& t, auto& h) { return Law::torque(q, t, h); });
}

using namespace dem::contact;
using namespace dem::friction;
using namespace dem::rolling;
using namespace dem::cohesion;
using Rolling = Sum<ElasticPlastic, Torsion>;
const AsperitySpring::Parameters<double> asperities = {0.4, 2000.0, 0.015, 0.975};

/// Puts one of the functions above on the list of benchmarks.
template <class Law>
void add(const char* name, void (*run)(benchmark::State&, const typename Law::template Parameters<double>&),
         const typename Law::template Parameters<double>& p) {
  benchmark::RegisterBenchmark(name, [=](benchmark::State& state) { run(state, p); });
}

const bool laws_are_listed = [] {
  add<Penalty>("normal_law/Penalty", normal_law<Penalty>, {2000.0, 0.015, 0.05});
  add<LinearSpringDashpot>("normal_law/LinearSpringDashpot", normal_law<LinearSpringDashpot>, {2000.0, 0.2});
  add<Hertz>("normal_law/Hertz", normal_law<Hertz>, {1e7, 0.2});
  add<Hysteretic>("normal_law/Hysteretic", normal_law<Hysteretic>, {2000.0, 4000.0});
  add<AsperitySpring>("friction_law/AsperitySpring", friction_law<AsperitySpring>, asperities);
  add<CoulombViscous>("friction_law/CoulombViscous", friction_law<CoulombViscous>, {0.4, 0.1});
  add<CundallStrack>("friction_law/CundallStrack", friction_law<CundallStrack>, {0.4, 2000.0, 0.1});
  add<Mindlin>("friction_law/Mindlin", friction_law<Mindlin>, {0.4, 3e6, 0.1});
  add<Varying<AsperitySpring>>("friction_law/Varying<AsperitySpring>", friction_law<Varying<AsperitySpring>>,
                               {asperities, 0.5, 0.1, 0.5, 1e-3});
  add<ConstantTorque>("rolling_law/ConstantTorque", rolling_law<ConstantTorque>, {0.1});
  add<ElasticPlastic>("rolling_law/ElasticPlastic", rolling_law<ElasticPlastic>, {0.1, 2000.0, 0.3});
  add<Rolling>("rolling_law/ElasticPlastic and Torsion", rolling_law<Rolling>,
               {{0.1, 2000.0, 0.3}, {0.1, 2000.0, 0.3}});
  add<Constant>("cohesion_law/Constant", cohesion_law<Constant>, {1e-3, 1e-6});
  add<DMT>("cohesion_law/DMT", cohesion_law<DMT>, {0.1});
  add<JKR>("cohesion_law/JKR", cohesion_law<JKR>, JKR::with(soft, 0.1));
  add<LiquidBridge>("cohesion_law/LiquidBridge", cohesion_law<LiquidBridge>, LiquidBridge::of(0.072, 0.0, 1e-12));
  return true;
}();

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
      benchmark::DoNotOptimize(Cube::contact_bits(cube, pose, cube, pose + Cube::pose_size, separations[k]));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs));
}
BENCHMARK(narrow_phase_cube8);

/// Polyhedra in random orientations: pairs whose bounding spheres overlap but that do not touch (argument 0), that
/// overlap by some percent (1), or that lie flat on each other (2).
void narrow_phase_polyhedra(benchmark::State& state, const dem::shape::Polyhedron& body) {
  using dem::shape::PolyhedronContact;
  constexpr std::size_t pairs = 256;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto turn = [&] {
    const dem::Quaternion q(normal(random), normal(random), normal(random), normal(random));
    return dem::from_eigen(q.normalized().toRotationMatrix());
  };
  const auto contact = [&](const auto& a, const auto& b, const auto& separation) {
    return PolyhedronContact(body.tables(), a, body.tables(), b, separation);
  };
  std::vector<dem::Matrix3<double>> a, b;
  std::vector<Vector3<double>> separation;
  const auto kind = state.range(0);
  while (separation.size() < pairs) {
    auto one = turn(), other = turn();
    const dem::Vec3 way = dem::Vec3(normal(random), normal(random), normal(random)).normalized();
    const double reach = std::uniform_real_distribution<double>(0.9, 1.0)(random) * 2.0 * body.bounding_radius();
    Vector3<double> link = dem::from_eigen(dem::Vec3((kind == 0 ? reach : 2.05 * body.radius()) * way));
    if (kind == 2) {
      // Each face of these bodies has one opposite to it, so that a face lies on a face.
      const auto& mesh = body.mesh();
      one = other = dem::Matrix3<double>::identity();
      link = dem::from_eigen(dem::Vec3(1.99 * mesh.offsets[0] * mesh.normals[0] + 0.1 * body.radius() * way));
    }
    const auto found = contact(one, other, link);
    if ((found.count() > 0) != (kind > 0) || (kind == 1 && found.least_overlap() > 0.05 * body.radius())) continue;
    a.push_back(one);
    b.push_back(other);
    separation.push_back(link);
  }
  for (auto _ : state) {
    for (std::size_t k = 0; k < pairs; ++k) benchmark::DoNotOptimize(contact(a[k], b[k], separation[k]).count());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs));
}
BENCHMARK_CAPTURE(narrow_phase_polyhedra, cubes, dem::shape::cube(1.2e-3))->Arg(0)->Arg(1)->Arg(2);
BENCHMARK_CAPTURE(narrow_phase_polyhedra, icosahedra, dem::shape::icosahedron(1.5e-3))->Arg(0)->Arg(1)->Arg(2);
BENCHMARK_CAPTURE(narrow_phase_polyhedra, rocks_of_24_corners, dem::shape::rock({.length = 3e-3}))->Arg(0)->Arg(1);

}  // namespace
