#include "scenes.hpp"

#include <dem/geometry/mixed.hpp>

using Catch::Approx;
using dem::shape::Mixed;
using dem::shape::PointArea;
using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;

namespace {

using Smooth = Grains<Superquadric, dem::integrator::VelocityVerlet>;
using Pointed = Grains<SuperquadricPoints, dem::integrator::VelocityVerlet>;
using Any = Mixed<Sphere, Cube8, Superquadric>;
using AnyShapes = Grains<Any, dem::integrator::VelocityVerlet>;

/// Grains that fly at each other from a lattice, without walls and weight.
template <class World>
void add_swarm(World& w, const std::vector<SpeciesId>& species, int n, double pitch) {
  Random random(5);
  const Vec3 middle = 0.5 * pitch * (n - 1) * Vec3::Ones();
  for (int k = 0; k < n * n * n; ++k) {
    dem::NewGrain p;
    p.species = species[static_cast<std::size_t>(k) % species.size()];
    p.position = pitch * Vec3(k % n, k / n % n, k / (n * n));
    p.rotation = random.rotation();
    p.velocity = -60.0 * (p.position - middle) + random.vector(0.1);
    p.angular_velocity = random.vector(50.0);
    w.add_grain(p);
  }
}

/// Momentum is kept, and what dampers and friction take never comes back.
template <class World>
void check_swarm(World& w) {
  const Vec3 p0 = momentum(w), l0 = angular_momentum(w);
  const double e0 = kinetic_energy(w);
  double p_size = 0.0, l_size = 0.0;
  EnergyWatch watch;
  for_each_grain(w, [&](GrainId p) {
    p_size += mass_of(w, p) * w.velocity(p).norm();
    l_size += mass_of(w, p) * w.velocity(p).norm() * w.position(p).norm();
  });
  std::size_t most = 0;
  for (int k = 0; k < 60; ++k) {
    REQUIRE(w.run_for(2.5e-4));
    std::size_t touching = 0;
    for_each_grain(w, [&](GrainId p) { touching += w.force(p).norm() > 0.0; });
    most = std::max(most, touching);
    double held = 0.0;
    for_each_pair_contact(w, [&](const auto& geometry) { held += spring_energy(w, geometry); });
    watch.look(kinetic_energy(w), held);
  }
  CHECK(most > w.grain_count() / 4);
  CHECK(watch.gains() == 0);
  CHECK(kinetic_energy(w) < 0.8 * e0);
  // Each of up to 3,000 steps rounds by 1e-16 of each of the grains' own share.
  CHECK((momentum(w) - p0).norm() < 1e-12 * p_size);
  // Forces act where the grains are when they are evaluated, and at one point for both partners. Velocity Verlet takes
  // the gyroscopic torque of grains with three inertias to second order: (w dt)^2 = (100 / s * 1e-5 s)^2.
  CHECK((angular_momentum(w) - l0).norm() < 1e-5 * l_size);
}

/// A tower of rounded cubes on a plane, a little askew. Dampers are strong, as the tower rocks on springs that yield
/// slowly; the ramp of friction is not, as it is no part of the time step's limit.
template <class Model>
dem::World<Model> tower(const typename Model::Shape& cube, double half, double stiffness) {
  dem::World<Model> w(options({0, 0, -9.81}, 5e-6));
  w.set_contact({{stiffness, 2e-3 * stiffness, 1.0}, {0.5, stiffness, 5e-4 * stiffness, 1.0}});
  const auto species = w.add_species(cube);
  w.add_surface(w.ground(), dem::surface::Plane{});
  for (int k = 0; k < 3; ++k) {
    dem::NewGrain p;
    p.species = species;
    p.position = {0.08 * half * k, -0.06 * half * k, half * (2 * k + 1)};
    p.rotation = Eigen::AngleAxisd(0.2 * k, Vec3::UnitZ()).toRotationMatrix();
    w.add_grain(p);
  }
  return w;
}

template <class World>
void check_stands(World& w, double half, double stiffness) {
  // At rest the middle of the tower sinks by weight over stiffness; three contacts in line, each of one contact at
  // least, and points that rest on slopes sink a little deeper.
  REQUIRE(w.run_for(0.4));
  const double sink = 6 * mass_of(w, GrainId(0)) * 9.81 / stiffness, energy = kinetic_energy(w);
  CHECK(energy < 1e-3 * mass_of(w, GrainId(0)) * 9.81 * sink);
  for_each_grain(w, [&](GrainId p) {
    const double k = static_cast<double>(p.index());
    CHECK((w.position(p) - Vec3(0.08 * half * k, -0.06 * half * k, half * (2 * k + 1))).norm() <
          2 * sink + 0.01 * half);
    CHECK(w.rotation(p)(2, 2) > 1 - 1e-4);
  });
}

}  // namespace

TEST_CASE("the contact of superquadrics has a potential: without dampers and friction the energy comes back") {
  dem::World<Smooth> w(options({0, 0, 0}, 1e-6));
  w.set_contact({{2000.0, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
  const auto species = w.add_species(Superquadric({1.2e-3, 1e-3, 0.8e-3}, {4, 6, 3}, 1));
  Random random(2);
  for (const double side : {-1.0, 1.0}) {
    dem::NewGrain n;
    n.species = species;
    n.position = {side * 1.7e-3, side * 3e-4, side * 1e-4};
    n.velocity = {-side * 0.2, 0, 0};
    n.rotation = random.rotation();
    n.angular_velocity = random.vector(20.0);
    w.add_grain(n);
  }
  const double e0 = kinetic_energy(w);
  double least = e0;
  for (int k = 0; k < 400; ++k) {
    REQUIRE(w.run(40));
    least = std::min(least, kinetic_energy(w));
  }
  REQUIRE(w.force(GrainId(0)).norm() == 0.0);
  CHECK(least < 0.9 * e0);  // they did collide
  // (omega dt)^2 = k/m dt^2 is 1e-4 for a point contact with lever arms, over a smooth bounce.
  CHECK(kinetic_energy(w) == Approx(e0).epsilon(1e-4));
}

TEST_CASE("a superquadric tumbles with the inertia of its own shape") {
  dem::World<Smooth> w(options({0, 0, 0}, 2e-5));
  w.set_contact(sand<Smooth>());
  const Superquadric shape({2e-3, 1.2e-3, 0.7e-3}, {2, 4, 7}, 1);
  dem::NewGrain n;
  n.species = w.add_species(shape);
  n.angular_velocity = {0.5, 100.0, 0.3};  // about the middle axis: it turns over again and again
  const GrainId p = w.add_grain(n);
  const Vec3 moments = w.species(n.species).inertia, l0 = angular_momentum(w);
  CHECK(moments.x() < moments.y());
  CHECK(moments.y() < moments.z());
  const double e0 = kinetic_energy(w);
  double least = 1.0;
  for (int k = 0; k < 50; ++k) {
    REQUIRE(w.run(200));
    least = std::min(least, w.rotation(p).col(1).dot(l0.normalized()));
    // Second order: (omega dt)^2 = 4e-6, and what it adds up to over twenty turns.
    CHECK((angular_momentum(w) - l0).norm() < 1e-4 * l0.norm());
    CHECK(kinetic_energy(w) == Approx(e0).epsilon(1e-4));
  }
  CHECK(least < -0.9);  // it did turn over
}

TEST_CASE("superquadrics keep momentum and lose energy") {
  dem::World<Smooth> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Smooth>());
  add_swarm(w,
            {w.add_species(Superquadric({1.2e-3, 1.2e-3, 1.2e-3}, {8, 8, 8}, 1)),
             w.add_species(Superquadric({0.8e-3, 1.3e-3, 1e-3}, {2, 3, 5.5}, 1))},
            5, 4e-3);
  check_swarm(w);
}

TEST_CASE("superquadrics of points keep momentum and lose energy, whatever their points weigh", "[slow]") {
  for (const PointArea area : {PointArea::share, PointArea::relative}) {
    dem::World<Pointed> w(options({0, 0, 0}, 5e-6));
    if (area == PointArea::share) {
      w.set_contact(sand<Pointed>());
    } else {
      w.set_contact({{500, 0.004, 0.05}, {0.4, 500, 0.004, 0.975}});
    }
    add_swarm(w,
              {w.add_species(SuperquadricPoints({1.2e-3, 1.2e-3, 1.2e-3}, {8, 8, 8}, 4, area)),
               w.add_species(SuperquadricPoints({0.8e-3, 1.3e-3, 1e-3}, {2, 3, 5.5}, 4, area))},
              5, 4e-3);
    check_swarm(w);
  }
}

TEST_CASE("spheres, clusters and superquadrics in one world keep momentum and lose energy") {
  dem::World<AnyShapes> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<AnyShapes>());
  add_swarm(w,
            {w.add_species(Sphere(1.2e-3)), w.add_species(dem::shape::cube8(1.1e-3)),
             w.add_species(Superquadric({1.2e-3, 1.1e-3, 1e-3}, {8, 4, 3}, 1))},
            5, 4e-3);
  check_swarm(w);
}

TEST_CASE("a mixed world with grains of one kind does what that kind's own world does, bit by bit") {
  const auto run = [](auto& w) {
    using Model = typename std::remove_reference_t<decltype(w)>::Model;
    w.set_contact(sand<Model>());
    const Superquadric shape({1.2e-3, 1.1e-3, 1e-3}, {6, 6, 6}, 2);
    add_open_box(w, Vec3::Constant(12e-3));
    add_block(w, w.add_species(shape), Vec3::Constant(2.1e-3), 3.8e-3, 3, 3, 30, 0.4);  // two chunks
    REQUIRE(w.run(600));
    std::vector<Vec3> positions;
    for_each_grain(w, [&](GrainId p) { positions.push_back(w.position(p)); });
    return positions;
  };
  dem::World<Smooth> plain(options({0, 0, -9.81}, 1e-5)), again(options({0, 0, -9.81}, 1e-5));
  dem::World<AnyShapes> mixed(options({0, 0, -9.81}, 1e-5));
  again.set_threads(3);
  const auto expected = run(plain);
  CHECK(run(mixed) == expected);
  CHECK(run(again) == expected);  // what a search keeps belongs to the pair, so threads change nothing
}

TEST_CASE("towers of rounded cubes stand, with a contact a pair and with points", "[slow]") {
  const double half = 5e-3;
  auto smooth = tower<Smooth>(Superquadric(Vec3::Constant(half), Vec3::Constant(8)), half, 2e4);
  check_stands(smooth, half, 2e4);
  auto points = tower<Pointed>(SuperquadricPoints(Vec3::Constant(half), Vec3::Constant(8)), half, 2e4);
  check_stands(points, half, 2e4);
  auto areas =
      tower<Pointed>(SuperquadricPoints(Vec3::Constant(half), Vec3::Constant(8), 6, PointArea::relative), half, 300);
  check_stands(areas, half, 300);
}
