#pragma once

#include "checkpoint/folder.hpp"
#include "world/laws.hpp"

#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/polyhedron/polyhedron_sphere.hpp>
#include <dem/geometry/superquadric/superquadric_polyhedron.hpp>
#include <dem/io/checkpoint.hpp>
#include <dem/law/cohesion/dmt.hpp>

// Every kind of grain under laws that it was not made for: laws are those of a whole contact, shapes hand over points
// of patches, and a run shows whether the two fit.

namespace combinations {

using shape::Polyhedron;
using shape::Superquadric;
using shape::SuperquadricPoints;
using SeveralKinds = shape::Mixed<Sphere, Cube8, Polyhedron, Superquadric>;
using SeveralOfPoints = shape::Mixed<Cube8, Polyhedron, SuperquadricPoints>;

/// Laws of choice on any number of threads.
template <class N, class F, class R, class C, class S>
struct OnThreads : Laws<N, F, R, C, S> {
  using Executor = exec::Threads;
};
template <class S>
using ElasticGrains = OnThreads<contact::Hertz, friction::Mindlin,
                                rolling::Sum<rolling::ElasticPlastic, rolling::Torsion>, cohesion::None, S>;
template <class S>
using StickyGrains = OnThreads<Linear, friction::CundallStrack, rolling::None, cohesion::Constant, S>;
template <class S>
using PlasticGrains = OnThreads<contact::Hysteretic, friction::CoulombViscous, rolling::None, cohesion::DMT, S>;

inline constexpr double half = 1e-3;                           // m, of the cubes' edges
inline constexpr double spring = 500.0, constant_pull = 4e-4;  // N/m, N: twice the weight of a grain

/// The constants of a model, with a restitution of 0.3.
template <class Model>
ContactParameters<Model> constants_of() {
  using Normal = typename Model::Normal;
  if constexpr (std::is_same_v<Normal, contact::Hertz>) {
    const auto pair = contact::elastic_pair({3e6, 0.3});
    return {contact::Hertz::with_restitution(pair, 0.3),
            friction::Mindlin::with(pair, 0.4, 0.3),
            {{0.1, spring, 0.3}, {0.05, spring, 0.3}}};
  } else if constexpr (std::is_same_v<Normal, Linear>) {
    return {Linear::with_restitution(spring, 0.3), {0.4, spring, 0.3}, {}, {constant_pull}};
  } else {
    // 2 pi w R* with the largest effective radius, that of a cube on a plane.
    return {contact::Hysteretic::with_restitution(spring, 0.3), {0.4, 0.05}, {}, {constant_pull / (2 * M_PI * half)}};
  }
}

/// The kinds of grain that a shape stands for, all near a cube of edge 2 half.
template <class S>
std::vector<S> kinds_of() {
  const Vec3 radii(half, 0.9 * half, 1.1 * half), exponents(8, 4, 3);
  const shape::RockOptions rock = {.length = 3 * half, .points = 14};
  if constexpr (std::is_same_v<S, Cube8>) return {shape::cube8(half)};
  if constexpr (std::is_same_v<S, Polyhedron>) return {shape::cube(half), shape::rock(rock)};
  if constexpr (std::is_same_v<S, Superquadric>) return {S(Vec3::Constant(half), {8, 8, 8}), S(radii, exponents)};
  if constexpr (std::is_same_v<S, SuperquadricPoints>)
    return {S(Vec3::Constant(half), {8, 8, 8}, 4), S(radii, exponents, 4)};
  if constexpr (std::is_same_v<S, SeveralKinds>)
    return {Sphere(half), shape::cube8(half), shape::cube(half), Superquadric(radii, exponents)};
  if constexpr (std::is_same_v<S, SeveralOfPoints>)
    return {shape::cube8(half), shape::cube(half), SuperquadricPoints(radii, exponents, 4)};
}

/// A box and the kinds of grain that fall into it.
template <class Model>
struct Pouring {
  static constexpr double pitch = 4.1 * half;
  World<Model> w;
  std::vector<SpeciesId> species;
  std::vector<SurfaceSensorId> scales;

  /// `across`: how many grains lie beside each other along x.
  explicit Pouring(int threads = 1, int across = 2)
      : w([threads] {
          WorldOptions o = options({0, 0, -g});
          o.overlap_limit = 0.2;
          o.threads = threads;
          o.time_step_safety = 0.8;
          return o;
        }()) {
    w.set_contact(constants_of<Model>());
    for (const auto& kind : kinds_of<typename Model::Shape>()) species.push_back(w.add_species(kind));
    for (const SurfaceId wall : add_open_box(w, {across * pitch, (across - 1) * pitch, 0}))
      scales.push_back(w.add_surface_sensor(wall, 0.05));
  }
};

/// From a file a world goes on in the same bits.
template <class Model>
void check_goes_on(World<Model> whole) {
  const Folder folder;
  save(whole, folder / "state.h5");
  Pouring<Model> other;
  load(other.w, folder / "state.h5");
  for (auto* w : {&whole, &other.w}) REQUIRE(w->run(300));
  CHECK(difference(whole, other.w) == "");
  CHECK(io::columns_of(whole).at("contacts/surfaces/key").rows() > 0);
}

/// n steps on two threads, a file, and n steps on three are 2n steps on one in every bit: two chunks of grains that fly
/// at each other.
template <class Model>
void check_threads() {
  constexpr int across = 7, grains = across * (across - 1) * 7;
  constexpr double pitch = 3.6 * half;  // no grain is wider
  const auto poured = [&](int threads) {
    Pouring<Model> box(threads, across);
    Random random(5);
    for (int k = 0; k < grains; ++k) {
      NewGrain p;
      p.species = box.species[static_cast<std::size_t>(k) % box.species.size()];
      p.position = pitch * (Vec3(k % across, k / across % (across - 1), k / (across * (across - 1))) + filled(0.5));
      p.rotation = random.rotation();
      p.velocity = random.vector(0.3);
      box.w.add_grain(p);
    }
    return std::move(box.w);
  };
  const Folder folder;
  auto whole = poured(1), first = poured(2);
  whole.prepare();
  const auto n = static_cast<std::uint64_t>(0.015 / whole.time_step());
  REQUIRE(whole.run(2 * n));
  REQUIRE(first.run(n));
  save(first, folder / "state.h5");
  Pouring<Model> second(3, across);
  load(second.w, folder / "state.h5");
  CHECK(difference(first, second.w) == "");
  REQUIRE(second.w.run(n));
  CHECK(difference(whole, second.w) == "");
  const auto columns = io::columns_of(first);
  CHECK(columns.at("contacts/pairs/key").rows() > 5);
  CHECK(columns.at("contacts/surfaces/key").rows() > 5);
}

/// Grains fall into a box: the energy that they have never grows, they come to rest, and their weight arrives. On the
/// way their state is saved, and they go on from it.
template <class Model>
void pour() {
  constexpr double pitch = Pouring<Model>::pitch;
  Pouring<Model> box;
  auto& [w, species, scales] = box;
  Random random(3);
  for (std::size_t k = 0; k < 8; ++k) {
    NewGrain n;
    n.species = species[k % species.size()];
    n.position = pitch * Vec3(static_cast<double>(k % 2) + 0.5, 0.5, static_cast<double>(k / 2) + 0.5);
    n.rotation = random.rotation();
    n.velocity = random.vector(0.1);
    w.add_grain(n);
  }
  const auto energy = [&] {
    double sum = kinetic_energy(w);
    for_each_grain(w, [&](GrainId p) { sum += mass_of(w, p) * g * w.position(p).z(); });
    return sum;
  };
  const double weight = total_mass(w) * g, start = energy();
  double least = start, gain = 0.0, late_gain = 0.0, late_motion = 0.0;
  for (int k = 0; k < 100; ++k) {
    const auto report = w.run_for(0.002);
    INFO(report.text);
    REQUIRE(report);
    if (k == 30) check_goes_on(w);
    const double now = energy();
    gain = std::max(gain, now - least);
    if (k >= 75) {
      late_gain = std::max(late_gain, now - least);
      late_motion = std::max(late_motion, kinetic_energy(w));
    }
    least = std::min(least, now);
  }
  // A grain that hits gives back e^2 = 0.09 of its energy: of the highest one that is 3.5/16 of all (two grains in each
  // of the layers 0.5, 1.5, 2.5 and 3.5).
  CHECK(gain < 0.09 * 3.5 / 16 * start);
  // Later on at most one grain of the eight still falls from an edge on its face: 0.05 weights times half an edge, of
  // which springs give back e^2. Cohesion gives F^2/(2 k) = 1e-4 of that unit for each of some 50 contacts.
  CHECK(late_motion < 0.05 * weight * half);
  CHECK(late_gain < 5e-3 * weight * half);
  Vec3 load = Vec3::Zero();
  for (const SurfaceSensorId scale : scales) load += to_eigen(w.surface_sensor(scale).mean().force);
  // The mean of 0.05 s errs by the momentum that comes and goes meanwhile: that of such a grain is 0.02 of the weight.
  CHECK((load - Vec3(0, 0, -weight)).norm() < 0.02 * weight);
}

}  // namespace combinations
