// Cubes of polygons rebound as the laws of a whole contact were asked to.

#include "world/scenes.hpp"

#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/law/friction/none.hpp>
#include <dem/law/normal/hertz.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>

#include <numbers>

namespace rebound_test {

using Catch::Approx;

namespace {

template <class Law>
struct Rebounding : Grains<dem::shape::Polyhedron, dem::integrator::VelocityVerlet> {
  using Normal = Law;
  using Friction = dem::friction::None;
};
constexpr double half_edge = 1.2e-3;

Mat3 about(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(axis.normalized())).toRotationMatrix();
}

}  // namespace

TEST_CASE("a cube that falls flat rebounds with the restitution that was asked for") {
  // Four corners touch, each with a quarter of the contact: together they are the one spring and dashpot whose
  // restitution is known. The damped swing lasts about 300 steps: 1e-4.
  using dem::contact::LinearSpringDashpot;
  const double e = 0.6, v = 0.1;
  dem::World<Rebounding<LinearSpringDashpot>> w(options({0, 0, 0}, 2e-6));
  w.set_contact({LinearSpringDashpot::with_restitution(2000.0, e), {}});
  const auto cube = w.add_species(dem::shape::cube(half_edge));
  w.add_surface(w.ground(), dem::surface::Plane{});
  dem::NewGrain n;
  n.species = cube;
  n.position = {0, 0, half_edge + 1e-7};
  n.velocity = {0, 0, -v};
  const auto block = w.add_grain(n);
  REQUIRE(w.run_for(0.01));
  CHECK(w.velocity(block).z() == Approx(e * v).epsilon(1e-3));
  CHECK(w.angular_velocity(block).norm() < 1e-9);
}

TEMPLATE_TEST_CASE("cubes rebound as asked, whichever of their faces, edges and corners meet", "",
                   dem::contact::LinearSpringDashpot, dem::contact::Hertz) {
  // Central impacts in which all points are equally deep; overlaps are below 1e-2 of an edge. The spring is a share S
  // of the law's (1, 1/2 of an edge, 1/3 of a corner, 1/4 of a cube's corner on a plane), and the damping ratio is to
  // be that which was asked for. Were the damper S times that of a whole contact, 0.5 would come out as 0.60 to 0.71. A
  // contact has 500 steps or more, and the damper is of first order: 2e-3.
  using Elastic = Rebounding<TestType>;
  const Mat3 flat = Mat3::Identity(), on_edge = about(Vec3::UnitX(), 0.25 * std::numbers::pi),
             across = about(Vec3::UnitY(), 0.25 * std::numbers::pi),
             on_corner = dem::rotation_between(Vec3(1, 1, 1).normalized(), Vec3::UnitZ());
  const auto constants = [](double e) {
    if constexpr (std::is_same_v<TestType, dem::contact::Hertz>) {
      return TestType::with_restitution({5e9, 1e9}, e);
    } else {
      return TestType::with_restitution(2e6, e);
    }
  };
  const double v = 1.0;
  for (const double e : {0.2, 0.5, 0.8}) {
    const auto world = [&] {
      dem::World<Elastic> w(options({0, 0, 0}, 1e-8));
      w.set_contact({constants(e), {}});
      w.add_species(dem::shape::cube(half_edge));
      return w;
    };
    const auto add = [&](dem::World<Elastic>& w, const Mat3& turn, double side, double way) {
      dem::NewGrain n;
      n.species = SpeciesId(0);
      n.rotation = turn;
      const double low = half_edge * turn.row(2).cwiseAbs().sum();  // from the centre to the lowest corner
      n.position = {0, 0, side * (low + 1e-9)};
      n.velocity = {0, 0, way * v};
      return w.add_grain(n);
    };
    for (const Mat3& turn : {flat, on_edge, on_corner}) {
      auto w = world();
      w.add_surface(w.ground(), dem::surface::Plane{});
      const GrainId cube = add(w, turn, 1.0, -1.0);
      REQUIRE(w.run_for(8e-5));
      REQUIRE(w.force(cube).norm() == 0.0);
      CHECK(w.velocity(cube).z() == Approx(e * v).epsilon(2e-3));
    }
    for (const auto& [lower, upper] :
         {std::pair(flat, flat), std::pair(flat, on_edge), std::pair(flat, on_corner), std::pair(across, on_edge)}) {
      auto w = world();
      add(w, lower, -1.0, 0.5);
      const GrainId cube = add(w, upper, 1.0, -0.5);
      REQUIRE(w.run_for(8e-5));
      REQUIRE(w.force(cube).norm() == 0.0);
      CHECK(w.velocity(cube).z() == Approx(0.5 * e * v).epsilon(2e-3));
    }
  }
}

}  // namespace rebound_test
