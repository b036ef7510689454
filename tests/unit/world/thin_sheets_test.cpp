#include "core/error_of.hpp"
#include "scenes.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/polyhedron/polyhedron_sphere.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>

using dem::shape::Mixed;
using dem::shape::Polyhedron;
using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;
using dem::surface::MeshSide;
using dem::surface::TriangleMesh;

namespace {

constexpr double sheet_half_edge = 1e-3;

TriangleMesh sheet(MeshSide side) { return TriangleMesh(dem::mesh::rectangle(0.1, 0.1, 3, 3), {.side = side}); }

/// A grain on the middle of a level surface.
template <class S>
auto on_surface(const S& shape, const dem::Model::Surfaces& surface, double top = 0.0) {
  using M = Grains<S, dem::integrator::VelocityVerlet>;
  dem::World<M> w(options({0, 0, -g}, 1e-5));
  w.set_contact(sand<M>());
  w.add_surface(w.ground(), surface, {.name = "chute"});
  w.add_grain({w.add_species(shape), Vec3(1e-3, 2e-3, top + sheet_half_edge)});
  return w;
}

}  // namespace

TEST_CASE("grains with points are refused on two-sided sheets, and held on what the refusal names instead") {
  const auto check = [](const auto& shape) {
    check_refused([&] { (void)on_surface(shape, sheet(MeshSide::two_sided)).step(); }, "surface 'chute'",
                  "grains of species 0", "MeshSide::solid", "MeshSide::one_sided");
    const double top = 1e-4;
    for (const bool plate : {false, true}) {
      auto w = plate ? on_surface(shape, TriangleMesh(dem::mesh::box({0.1, 0.1, 2 * top}, 3)), top)
                     : on_surface(shape, sheet(MeshSide::one_sided));
      REQUIRE(w.run_for(0.02));  // free fall: 2 mm
      CHECK(std::abs(w.position(GrainId(0)).z() - (plate ? top : 0.0) - sheet_half_edge) < 0.01 * sheet_half_edge);
    }
  };
  check(dem::shape::cube(sheet_half_edge));
  check(Superquadric(Vec3::Constant(sheet_half_edge), Vec3::Constant(8)));
  check(SuperquadricPoints(Vec3::Constant(sheet_half_edge), Vec3::Constant(8)));
  check(Mixed<Sphere, Polyhedron>(dem::shape::cube(sheet_half_edge)));
}

TEST_CASE("balls of any kind lie on two-sided sheets") {
  const auto check = [](const auto& shape) {
    auto w = on_surface(shape, sheet(MeshSide::two_sided));
    REQUIRE(w.run_for(0.02));
    CHECK(std::abs(w.position(GrainId(0)).z() - sheet_half_edge) < 0.01 * sheet_half_edge);
  };
  check(Sphere(sheet_half_edge));
  check(dem::shape::cube8(sheet_half_edge));
  check(Superquadric(Vec3::Constant(sheet_half_edge), Vec3::Constant(2)));
  check(Mixed<Sphere, Polyhedron>(Sphere(sheet_half_edge)));
}

TEMPLATE_TEST_CASE(
    "a ball that is too fast for a soft sheet or a thin box is reported before it has passed where that is asked for",
    "", TriangleMesh, dem::surface::Box) {
  for (const double speed : {4.43, 6.0}) {  // at 3 m/s it is thrown back
    dem::World<Balls> w({.gravity = {0, 0, 0}, .overlap_limit = 0.4, .threads = 1});
    auto soft = sand<Balls>();
    soft.normal.stiffness = 100.0;
    w.set_contact(soft);
    const auto kind = w.add_species(Sphere(1e-3));
    if constexpr (std::is_same_v<TestType, TriangleMesh>) w.add_surface(w.ground(), sheet(MeshSide::two_sided));
    else w.add_surface(w.ground(), dem::surface::Box({0.1, 0.1, 1e-5}));
    w.add_grain({.species = kind, .position = {0, 0, 2e-3}, .velocity = {0, 0, -speed}});
    const auto report = w.run_for(0.01);
    REQUIRE(!report);
    CHECK(w.position(GrainId(0)).z() > 0.0);
    CHECK_THAT(report.text, Catch::Matchers::ContainsSubstring("overlap_limit 0.4"));
  }
}

TEST_CASE("bodies with points are refused on two-sided sheets; balls are held, and sheets lie on planes") {
  const auto body_on = [](const dem::Model::Surfaces& of_body, const dem::Model::Surfaces& of_ground) {
    dem::World<Balls> w(options({0, 0, -g}, 1e-5));
    w.set_contact({{1e4, 100.0, 1.0}, {0.5, 1e4, 50.0, 0.975}});
    const Vec3 size = Vec3::Constant(0.04);
    const auto body = w.machine().add_body(dem::mbd::box_body("crate", size, 1000.0).at({0, 0, 0.02}));
    w.add_body_contact(w.add_surface(body, of_body), w.add_surface(w.ground(), of_ground, {.name = "chute"}));
    if (const auto report = w.run_for(0.1); !report) FAIL(report.text);  // free fall: 5 cm
    return w.machine().body(body).position().z();
  };
  const dem::surface::Box crate(Vec3::Constant(0.04));
  check_refused([&] { body_on(crate, sheet(MeshSide::two_sided)); }, "surface 'chute'",
                "of body 'crate', which may touch it", "closed plate");
  check_refused([&] { body_on(TriangleMesh(dem::mesh::box(Vec3::Constant(0.04))), sheet(MeshSide::two_sided)); },
                "surface 'chute'", "'crate'");
  CHECK(body_on(dem::surface::Sphere(0.02), sheet(MeshSide::two_sided)) > 0.019);
  // A plane shows no points, so nothing is lost: the sheet's own vertices carry the body, 2 cm lower than before.
  CHECK(std::abs(body_on(sheet(MeshSide::two_sided), dem::surface::Plane{})) < 1e-3);
}
