#include "world/scenes.hpp"

#include <dem/geometry/cylinder/cylinder.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>
#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/superquadric/superquadric_surface.hpp>

using Catch::Approx;
using dem::shape::Polyhedron;
using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;
using dem::surface::Box;
using dem::surface::Cylinder;
using dem::surface::TriangleMesh;

namespace {

template <class S>
struct OnParts : Grains<S, dem::integrator::VelocityVerlet> {
  using Surfaces = dem::surface::Set<dem::surface::Plane, Box, Cylinder, dem::surface::Sphere,
                                     dem::surface::Superquadric, TriangleMesh>;
};

constexpr double h = 1e-3, K = 1000.0, depth = 1e-5;

/// A cube of half-edge h with sharp or nearly sharp edges.
template <class S>
S cube() {
  if constexpr (std::is_same_v<S, Polyhedron>) {
    return dem::shape::cube(h);
  } else {
    return S(Vec3::Constant(h), Vec3::Constant(32), 4);
  }
}

/// The force of a surface on a cube at a place, over K: m.
template <class S>
Vec3 push(const typename OnParts<S>::Surfaces& geometry, const Vec3& at, const Mat3& turned = Mat3::Identity()) {
  dem::World<OnParts<S>> w(options(Vec3::Zero(), 1e-8));
  w.set_contact({{K, 0.0, 1.0}, {0.0, K, 0.0, 0.0}});
  const auto species = w.add_species(cube<S>());
  const SurfaceId part = w.add_surface(w.ground(), geometry);
  dem::NewGrain n;
  n.species = species;
  n.position = at;
  n.rotation = turned;
  w.add_grain(n);
  w.prepare();
  return -w.surface_force(part) / K;
}

}  // namespace

TEMPLATE_TEST_CASE("a face is pushed by parts that are smaller than it, where neither shows a corner", "", Polyhedron,
                   Superquadric, SuperquadricPoints) {
  // The faces of the superquadric of exponent 32 bend by 2e-6 h at half the way to the edge.
  const double tolerance = 0.02;
  SECTION("a ball, anywhere under the face") {
    for (const Vec3& off : {Vec3(0, 0, 0), Vec3(0.61 * h, 0.2 * h, 0), Vec3(-0.4 * h, 0.55 * h, 0)}) {
      const Vec3 force = push<TestType>(dem::surface::Sphere(0.1 * h), Vec3(0, 0, 1.1 * h - depth) + off);
      CHECK(force.z() == Approx(depth).epsilon(tolerance));
      CHECK(force.head<2>().norm() < 0.01 * depth);
    }
    CHECK(push<TestType>(dem::surface::Sphere(0.1 * h), Vec3(0, 0, 1.1 * h + depth)).norm() == 0.0);
    // A large ball is touched once as well, although corners of a face that is pressed on it might be inside.
    CHECK(push<TestType>(dem::surface::Sphere(100 * h), Vec3(0, 0, 101 * h - depth)).z() ==
          Approx(depth).epsilon(tolerance));
  }
  SECTION("the lateral surface of a cylinder") {
    for (const double across : {0.0, 0.5 * h}) {
      const Mat3 lying = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();
      dem::World<OnParts<TestType>> w(options(Vec3::Zero(), 1e-8));
      w.set_contact({{K, 0.0, 1.0}, {0.0, K, 0.0, 0.0}});
      dem::NewGrain n;
      n.species = w.add_species(cube<TestType>());
      n.position = Vec3(across, 0, 1.3 * h - depth);
      dem::SurfaceOptions o;
      o.rotation = lying;
      const SurfaceId part = w.add_surface(w.ground(), Cylinder(0.3 * h, 20 * h), o);
      w.add_grain(n);
      w.prepare();
      CHECK(-w.surface_force(part).z() / K == Approx(depth).epsilon(tolerance));
      // Three points carry it along the lateral surface, so it does not rock: no torque about the grain's centre on
      // axis y.
      CHECK(std::abs(w.torque(dem::GrainId(0)).x()) < 0.01 * K * depth * h);
    }
  }
  SECTION("the edge of a box, or of a mesh, of triangles that are far larger or a little smaller than the cube") {
    // Standing on an edge along y that is far longer than the cube.
    const Vec3 edges(4 * h, 40 * h, 4 * h);
    for (const typename OnParts<TestType>::Surfaces& blade : {typename OnParts<TestType>::Surfaces(Box(edges)),
                                                              {TriangleMesh(dem::mesh::box(edges))},
                                                              {TriangleMesh(dem::mesh::box(edges, 31))}}) {
      CAPTURE(blade.index());
      dem::World<OnParts<TestType>> w(options(Vec3::Zero(), 1e-8));
      w.set_contact({{K, 0.0, 1.0}, {0.0, K, 0.0, 0.0}});
      dem::NewGrain n;
      n.species = w.add_species(cube<TestType>());
      n.position = Vec3(0.2 * h, 0.3 * h, h + 2 * h * std::sqrt(2.0) - depth);
      dem::SurfaceOptions o;
      o.rotation = Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitY()).toRotationMatrix();
      const SurfaceId part = w.add_surface(w.ground(), blade, o);
      w.add_grain(n);
      w.prepare();
      const double force = -w.surface_force(part).z() / K;
      // Points of the edge weigh as the cube's own points do: three quarters of a contact with a cube of sharp corners,
      // up to a whole one where vertices come to them. Towards its ends, 0.95 h from the middle, the face of the
      // superquadric is bent by h/32 0.95^32 = 6e-6 m.
      const double least = std::is_same_v<TestType, Polyhedron> ? 0.75 : 0.9;
      CHECK(force > (1.0 - tolerance) * least * depth);
      CHECK(force < (1.0 + tolerance) * depth);
    }
  }
  SECTION("long edges that no point of a face comes near to") {
    // Flat on a roof whose sides fall away by 10 degrees, along a ridge that ends far outside.
    const double ten = std::tan(10 * std::numbers::pi / 180);
    const dem::IndexedMesh roof = {{{0, -50 * h, 0},
                                    {0, 50 * h, 0},
                                    {50 * h, 50 * h, -50 * h * ten},
                                    {50 * h, -50 * h, -50 * h * ten},
                                    {-50 * h, 50 * h, -50 * h * ten},
                                    {-50 * h, -50 * h, -50 * h * ten}},
                                   {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {0, 4, 5}}};
    const TriangleMesh ridge(roof, {.side = dem::surface::MeshSide::one_sided, .facing = dem::MeshFacing::as_given});
    const double on_ridge = push<TestType>(ridge, Vec3(0.3 * h, 3.7 * h, h - depth)).z();
    CHECK(on_ridge > (1.0 - tolerance) * 0.75 * depth);
    CHECK(on_ridge < (1.0 + tolerance) * depth);
    // Half over the edge of a slab: the same as on a box, and never more than one contact.
    const Vec3 slab(40 * h, 40 * h, 4 * h), over(20.2 * h, 0.3 * h, 3 * h - depth);
    const Vec3 force = push<TestType>(TriangleMesh(dem::mesh::box(slab)), over);
    CHECK((force - push<TestType>(Box(slab), over)).norm() < 1e-9 * depth);
    CHECK(force.z() > 0.45 * depth);
    CHECK(force.z() < (1.0 + tolerance) * depth);
  }
  SECTION("a corner of a mesh, a fine ball of triangles, a superquadric") {
    // Points of a round boundary share the contact by their depths d, evenly spread over a cap of depth D: sum d^2/sum
    // d is 2/3 D. The caps have 30 vertices and 9 points.
    const TriangleMesh ball(dem::mesh::sphere(0.1 * h, 3));
    CHECK(push<TestType>(ball, Vec3(0.3 * h, 0.2 * h, 1.1 * h - depth)).z() == Approx(2.0 / 3 * depth).epsilon(0.03));
    const dem::surface::Superquadric egg(Vec3(0.1 * h, 0.1 * h, 0.2 * h));
    CHECK(push<TestType>(egg, Vec3(0.3 * h, 0.2 * h, 1.2 * h - depth)).z() == Approx(2.0 / 3 * depth).epsilon(0.1));
  }
}

TEMPLATE_TEST_CASE("a cube lies on a plane as one contact, and on a finely cut mesh as deep as on a coarse one", "",
                   Polyhedron, Superquadric, SuperquadricPoints) {
  const double on_plane = push<TestType>(dem::surface::Plane{}, Vec3(0, 0, h - depth)).z();
  CHECK(on_plane == Approx(depth).epsilon(0.02));
  // A flat mesh has no edges but its rim: it is the plane.
  const TriangleMesh flat(dem::mesh::rectangle(9 * h, 9 * h, 7, 5), {.side = dem::surface::MeshSide::one_sided});
  CHECK(push<TestType>(flat, Vec3(0.3 * h, 0.2 * h, h - depth)).z() == Approx(on_plane).epsilon(1e-12));
  // Triangles of a tenth of the cube; pressed in by a fifth of its half-edge, far more than a triangle's edge.
  const TriangleMesh fine(dem::mesh::box({6 * h, 6 * h, 6 * h}, 60)), coarse(dem::mesh::box({6 * h, 6 * h, 6 * h}, 1));
  const Vec3 at(0.01 * h, 0.02 * h, 3 * h + 0.8 * h);
  CHECK(push<TestType>(fine, at).z() == Approx(push<TestType>(coarse, at).z()).epsilon(1e-9));
  CHECK(push<TestType>(fine, at).z() > 0.1 * h);
}

TEMPLATE_TEST_CASE("sharp grains in and around a tube, and over the ends of a cylinder", "", Polyhedron, Superquadric) {
  const Cylinder tube = Cylinder::tube(10 * h, 12 * h, 40 * h), rod(12 * h, 40 * h);
  CHECK(push<TestType>(tube, Vec3(8.5 * h, 0, 0)).norm() == 0.0);  // in the hole, half a half-edge off the wall
  CHECK(push<TestType>(tube, Vec3(0, 0, 0)).norm() == 0.0);
  CHECK(push<TestType>(tube, Vec3(13 * h - depth, 0, 0)).x() == Approx(depth).epsilon(0.02));  // outside, face on
  CHECK(push<TestType>(rod, Vec3(13 * h - depth, 0, 0)).x() == Approx(depth).epsilon(0.02));
  CHECK(push<TestType>(rod, Vec3(3 * h, 0, 21 * h - depth)).z() == Approx(depth).epsilon(0.02));
  CHECK(push<TestType>(rod, Vec3(3 * h, 0, 21 * h + depth)).norm() == 0.0);
  // A flat plate's centre is much nearer to the end than its bounding radius.
  dem::World<OnParts<Polyhedron>> w(options(Vec3::Zero(), 1e-8));
  w.set_contact({{K, 0.0, 1.0}, {0.0, K, 0.0, 0.0}});
  const auto plate = w.add_species(dem::shape::box({4 * h, 4 * h, 0.2 * h}));
  const SurfaceId part = w.add_surface(w.ground(), rod);
  w.add_grain({plate, Vec3(0, 0, 20.1 * h - depth)});
  w.prepare();
  CHECK(-w.surface_force(part).z() / K == Approx(depth).epsilon(1e-6));
}

TEMPLATE_TEST_CASE("a face is pushed by the inner edge of an outlet", "", Polyhedron, Superquadric) {
  // A face that looks down and outward at 45 degrees, over the hole's edge, by which alone it is touched. Half the
  // grain's bounding radius aside, 0.87 h, the edge has come nearer by 0.75 h^2/(2 R) sqrt(1/2): 2.7e-3 of the depth.
  const double R = 1000 * h, deep = 0.1 * h;
  const Cylinder outlet = Cylinder::tube(R, 2 * R, R);
  const Mat3 tilted = Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitY()).toRotationMatrix();
  const Vec3 out = Vec3(1, 0, -1).normalized();
  const Vec3 force = push<TestType>(outlet, Vec3(R, 0, 0.5 * R) - (h - deep) * out, tilted);
  // Three points and a fixed one. The superquadric's support point lies in the edge too, and is pushed out through one
  // of its sides, at 45 degrees.
  const bool exact = std::is_same_v<TestType, Polyhedron>;
  CHECK(force.norm() == Approx(deep).epsilon(exact ? 0.02 : 0.15));
  CHECK((force.normalized() + out).norm() < (exact ? 0.01 : 0.15));
  CHECK(push<TestType>(outlet, Vec3(R, 0, 0.5 * R) - 1.01 * h * out, tilted).norm() == 0.0);
}

TEST_CASE("a superquadric in a corner of a mesh is carried by each wall as by a plane of its own") {
  const TriangleMesh room(dem::mesh::box({10 * h, 10 * h, 10 * h}), {.facing = dem::MeshFacing::inward});
  const Vec3 force = push<Superquadric>(room, Vec3(-4 * h - depth, 0, -4 * h - 2 * depth));
  CHECK(force.x() == Approx(depth).epsilon(0.03));
  CHECK(force.z() == Approx(2 * depth).epsilon(0.03));
}

TEST_CASE("a cube that slides off the end of a box's edge is let go of steadily") {
  // The edge along y ends under the cube; from step to step the force changes by a little.
  double last = -1.0;
  for (double y = 0.0; y < 1.4 * h; y += 0.02 * h) {
    dem::World<OnParts<Polyhedron>> w(options(Vec3::Zero(), 1e-8));
    w.set_contact({{K, 0.0, 1.0}, {0.0, K, 0.0, 0.0}});
    const auto species = w.add_species(cube<Polyhedron>());
    dem::SurfaceOptions o;
    o.rotation = Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitY()).toRotationMatrix();
    const SurfaceId part = w.add_surface(w.ground(), Box({4 * h, 4 * h, 4 * h}), o);
    w.add_grain({species, Vec3(0, 2 * h + y, h + 2 * h * std::sqrt(2.0) - depth)});
    w.prepare();
    const double force = -w.surface_force(part).z() / K;
    if (last >= 0.0 && y < 0.97 * h) CHECK(std::abs(force - last) < 0.1 * depth);
    last = force;
  }
  CHECK(last == 0.0);
}

TEST_CASE("grains on a ball feel the ball's curvature in laws that ask for a radius") {
  // 1/(1/r + 1/R).
  CHECK(dem::surface::radius_on(dem::surface::Sphere(3.0), 1.0) == Approx(0.75));
  CHECK(dem::surface::radius_on(dem::surface::Sphere(3.0, dem::surface::Side::inside), 1.0) == 1.0);  // as if flat
  CHECK(dem::surface::radius_on(dem::surface::Plane{}, 1.0) == 1.0);
}
