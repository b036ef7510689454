#include "scenes.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/superquadric/superquadric_polyhedron.hpp>

namespace superquadric_ball_test {

using Catch::Approx;
using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;

namespace {

constexpr double ball_radius = 5e-3;

template <class Shape>
Shape ball() {
  if constexpr (std::same_as<Shape, Sphere>) {
    return Sphere(ball_radius);
  } else {
    // An exact ball is touched as a sphere; this one, a picometre longer, with points and support points.
    return Shape({ball_radius, ball_radius, (1 + 1e-10) * ball_radius}, {2, 2, 2});
  }
}

/// Floors whose top is z = 0, under the origin.
struct Floor {
  const char* name;
  Balls::Surfaces geometry;
  Vec3 place;
};
std::vector<Floor> floors() {
  return {{"plane", dem::surface::Plane{}, {0, 0, 0}},
          {"box", dem::surface::Box({2, 0.5, 0.1}), {0, 0, -0.05}},
          {"mesh", dem::surface::TriangleMesh(dem::mesh::box({2, 0.5, 0.1}, 13)), {0, 0, -0.05}}};
}

template <class Shape>
struct OnFloor {
  dem::World<Grains<Shape, dem::integrator::VelocityVerlet>> world;
  GrainId grain;

  OnFloor(const Floor& floor, const Vec3& gravity, double k) : world(options(gravity, 1e-5)) {
    world.set_contact({{k, 0.2, 1.0}, {0.5, k, 0.05, 0.975}});
    dem::SurfaceOptions o;
    o.position = floor.place;
    world.add_surface(world.ground(), floor.geometry, o);
    dem::NewGrain n;
    n.species = world.add_species(ball<Shape>());
    n.position = {0.003, 0.001, ball_radius};
    n.rotation = Random(3).rotation();
    grain = world.add_grain(n);
  }
};

}  // namespace

TEMPLATE_TEST_CASE("a superquadric ball rests on a floor as a sphere does", "[slow]", Superquadric,
                   SuperquadricPoints) {
  for (const Floor& floor : floors()) {
    CAPTURE(floor.name);
    OnFloor<TestType> scene(floor, {0, 0, -g}, 2000.0);
    auto& w = scene.world;
    REQUIRE(w.run_for(0.3));  // its swing dies out as exp(-72 t)
    const double weight = mass_of(w, scene.grain) * g;
    // It lies m g/K = 7e-6 m deep, over a spot of sqrt(2 r 7e-6) = r/19 radius; what other points of the boundary are
    // in there weighs (3/19)^4 = 6e-4 at most.
    CHECK(ball_radius - w.position(scene.grain).z() == Approx(weight / 2000.0).epsilon(2e-3));
    CHECK(w.force(scene.grain).z() == Approx(weight).epsilon(1e-6));
  }
}

TEMPLATE_TEST_CASE("a superquadric ball rolls down a slope as a sphere does", "[slow]", Sphere, Superquadric,
                   SuperquadricPoints) {
  const double angle = 0.2;
  for (const Floor& floor : floors()) {
    CAPTURE(floor.name);
    OnFloor<TestType> scene(floor, g * Vec3(std::sin(angle), 0, -std::cos(angle)), 20000.0);
    auto& w = scene.world;
    REQUIRE(w.run_for(0.1));
    const double v = w.velocity(scene.grain).x();
    REQUIRE(w.run_for(0.3));
    // Without slip 5/7 g sin. Points of the boundary that pass the spot of contact push with an arm of r/60 and a
    // weight of 6e-6, forwards and back.
    CHECK((w.velocity(scene.grain).x() - v) / 0.3 == Approx(5.0 / 7.0 * g * std::sin(angle)).epsilon(2e-3));
    CHECK(w.angular_velocity(scene.grain).y() == Approx(w.velocity(scene.grain).x() / ball_radius).epsilon(2e-3));
    CHECK(std::abs(w.position(scene.grain).y() - 0.001) < 1e-2 * w.position(scene.grain).x());
  }
}

TEMPLATE_TEST_CASE("an exact superquadric ball and a cluster of one ball go the way of a sphere", "", Superquadric,
                   SuperquadricPoints, Cube8) {
  // Over the edge of a slab, over the rim of a post, down in a tube, and along a slab of triangles.
  struct Place {
    Balls::Surfaces geometry;
    Vec3 place;
  };
  const std::vector<Place> scenes = {{dem::surface::Box({0.02, 0.5, 0.1}), {-0.0095, 0, -0.0505}},
                                     {dem::surface::Cylinder(0.006, 0.1), {-0.002, 0, -0.0505}},
                                     {dem::surface::Cylinder::tube(0.006, 0.008, 0.5), {0, 0, 0}},
                                     {dem::surface::TriangleMesh(dem::mesh::box({2, 0.5, 0.1}, 13)), {0, 0, -0.0505}}};
  const auto ends = [&](const auto& shape) {
    using Shape = std::remove_cvref_t<decltype(shape)>;
    std::vector<Vec3> result;
    for (const Place& p : scenes) {
      dem::World<Grains<Shape, dem::integrator::VelocityVerlet>> w(options({1.0, 0.3, -g}, 1e-5));
      w.set_contact({{2000.0, 0.05, 1.0}, {0.5, 2000.0, 0.05, 0.975}});
      dem::SurfaceOptions o;
      o.position = p.place;
      w.add_surface(w.ground(), p.geometry, o);
      dem::NewGrain n;
      n.species = w.add_species(shape);
      n.position = {0, 0, ball_radius};
      n.velocity = {0.05, 0, 0};
      const auto grain = w.add_grain(n);
      REQUIRE(w.run_for(0.2));
      result.push_back(w.position(grain));
      result.push_back(w.velocity(grain));
      result.push_back(ball_radius * w.angular_velocity(grain));
    }
    return result;
  };
  const auto shape = [] {
    if constexpr (std::is_same_v<TestType, Cube8>) {
      const dem::Ball one = {Vec3::Zero(), ball_radius};
      return TestType({&one, 1});
    } else {
      return TestType(Vec3::Constant(ball_radius), {2, 2, 2});
    }
  }();
  const auto expected = ends(Sphere(ball_radius)), found = ends(shape);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    CAPTURE(k, expected[k].transpose(), found[k].transpose());
    // The same contacts; inertias from other formulas, which agree to rounding, and 20,000 steps.
    CHECK((found[k] - expected[k]).norm() < 1e-9 * (1.0 + expected[k].norm()));
  }
}

TEST_CASE("a superquadric ball touches the face of a polyhedron as a plane") {
  const auto cube = dem::shape::cube(0.05);
  const Superquadric ball({ball_radius, ball_radius, ball_radius}, {2, 2, 2});
  double pose_a[9], pose_b[9];
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    ball.orient(dem::from_eigen(random.rotation()), pose_a);
    cube.orient(dem::Matrix3<double>::identity(), pose_b);
    const double overlap = 1e-5;
    double force = 0.0;
    dem::shape::PairContact<Superquadric, dem::shape::Polyhedron>::collide(
        ball, pose_a, cube, pose_b, {0.013, 0.004, -(0.05 + ball_radius - overlap)},
        [&](std::uint32_t, const auto& point) {
          CHECK(point.normal.z == Approx(-1.0));
          force += point.weight * point.overlap;
        });
    // As above: the spot's radius is r/15.
    CHECK(force == Approx(overlap).epsilon(3e-3));
  }
}

}  // namespace superquadric_ball_test
