// Where a surface sits on a body whose drawing has its own origin and axes.

#include "catch.hpp"
#include "worlds.hpp"

#include <dem/dem.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/mbd/mbd.hpp>

using dem::BodyId;
using dem::Mat3;
using dem::Vec3;

namespace {

Mat3 turned_by(double angle, const Vec3& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// A brick that is drawn off the origin and askew.
dem::IndexedMesh skewed_brick() {
  dem::IndexedMesh mesh = dem::mesh::box({0.4, 0.2, 0.1});
  for (Vec3& v : mesh.vertices) v = Vec3(0.056, 0, 0.213) + turned_by(0.4, {1, 2, 3}) * v;
  return mesh;
}

/// The corners of a body's mesh surface as they are now, global.
template <class World>
std::vector<Vec3> corners(World& world, dem::SurfaceId s) {
  const auto& surface = world.state().surfaces[s.index()];
  const dem::Body& body = world.machine().body(surface.body);
  std::vector<Vec3> points;
  for (const Vec3& v : std::get<dem::surface::TriangleMesh>(surface.geometry).mesh().vertices) {
    points.push_back(body.point(surface.position + surface.rotation * v));
  }
  return points;
}
/// The same as they were drawn; a surface sorts its vertices.
template <class World>
const std::vector<Vec3>& drawn_corners(World& world, dem::SurfaceId s) {
  return std::get<dem::surface::TriangleMesh>(world.state().surfaces[s.index()].geometry).mesh().vertices;
}

}  // namespace

TEST_CASE("a surface sits where it was drawn, whatever the body's centre of mass and principal axes are") {
  const dem::IndexedMesh brick = skewed_brick();
  const Vec3 at(1, 2, 3);
  const Mat3 pose = turned_by(-0.7, {0, 1, 1});
  dem::World<models::CorrectedBalls> world({.gravity = {0, 0, 0}, .time_step = 1e-4});
  world.set_contact({{2000.0, 0.015, 0.05}, {0.4, 2000.0, 0.015, 0.975}});
  auto& m = world.machine();
  const BodyId body = m.add_body(dem::mbd::mesh_body("brick", brick, 1000.0).at(at, pose));
  // The frames differ, or there would be nothing to test.
  CHECK((m.body(body).position() - at).norm() > 0.2);
  CHECK((m.body(body).rotation() - pose).norm() > 0.1);
  const auto drawn = world.add_surface(body, dem::surface::TriangleMesh(brick));
  const auto corner_points = corners(world, drawn);
  REQUIRE(corner_points.size() == brick.vertices.size());
  for (std::size_t k = 0; k < corner_points.size(); ++k) {
    CHECK((corner_points[k] - (at + pose * drawn_corners(world, drawn)[k])).norm() < 1e-14);
  }
  CHECK((m.reference_position(body) - at).norm() < 1e-14);

  // The same surface in the frame of the centre of mass and the principal axes: the brick as it is in itself.
  const auto in_principal =
      world.add_surface(body, dem::surface::Box({0.4, 0.2, 0.1}), {.frame = dem::BodyFrame::principal});
  const auto in_reference = world.add_surface(body, dem::surface::Box({0.4, 0.2, 0.1}),
                                              {.position = {0.056, 0, 0.213}, .rotation = turned_by(0.4, {1, 2, 3})});
  const auto& a = world.state().surfaces[in_principal.index()];
  const auto& b = world.state().surfaces[in_reference.index()];
  CHECK(a.position == Vec3::Zero());
  CHECK(a.rotation == Mat3::Identity());
  // Principal axes of a solid that is summed from triangles: good to 1e-15 of the moments over their differences.
  CHECK(b.position.norm() < 1e-14);
  CHECK((b.rotation - Mat3::Identity()).norm() < 1e-13);

  // And it goes along with the body.
  m.body(body).motion.angular_velocity = {3, 2, 1};
  REQUIRE(world.run(500));
  const auto moved = corners(world, drawn);
  for (std::size_t k = 0; k < moved.size(); ++k) {
    CHECK((moved[k] - m.reference_point(body, drawn_corners(world, drawn)[k])).norm() < 1e-14);
  }
}

TEST_CASE("frames that coincide leave a surface's place as given") {
  dem::World<models::CorrectedBalls> world;
  const BodyId box =
      world.machine().add_body(dem::mbd::box_body("box", {1, 2, 3}, 100.0).at({5, 6, 7}, turned_by(1, {1, 1, 0})));
  const Vec3 position(0.1, -0.2, 0.3);
  const Mat3 rotation = turned_by(0.3, {3, 1, 2});
  for (const BodyId body : {box, world.ground()}) {
    for (const auto frame : {dem::BodyFrame::reference, dem::BodyFrame::principal}) {
      const auto s = world.add_surface(body, dem::surface::Box({1, 1, 1}),
                                       {.position = position, .rotation = rotation, .frame = frame});
      CHECK(world.state().surfaces[s.index()].position == position);
      CHECK(world.state().surfaces[s.index()].rotation == rotation);
    }
  }
}

TEST_CASE("a grain rests on a body that is drawn off its centre of mass as high as the drawing says") {
  // A tray whose floor is drawn at z = 0 while its reference frame is 0.02 m up; its mass is elsewhere.
  dem::World<models::CorrectedBalls> world({.gravity = {0, 0, -9.81}});
  world.set_contact({{2000.0, 0.5, 1.0}, {0.4, 2000.0, 0.015, 0.975}});
  const auto species = world.add_species(dem::shape::Sphere(1e-3));
  auto& m = world.machine();
  dem::mbd::BodySpec spec = dem::mbd::given_body("tray", 2.0, Vec3(0.02, 0.03, 0.04), Vec3(0.056, 0, 0.213));
  const BodyId tray = m.add_body(spec.at({0, 0, 0.02}));
  m.add_joint(dem::mbd::fixed("weld", m.ground(), tray, {0, 0, 0}));
  const auto floor = world.add_surface(tray, dem::surface::Box({0.1, 0.1, 0.01}), {.position = {0, 0, -0.005}});
  const auto ball = world.add_grain({.species = species, .position = {0, 0, 0.021}});
  REQUIRE(world.run_for(0.1));
  const double weight = 9.81 * world.species(species).mass;
  CHECK(world.surface_force(floor).z() == Catch::Approx(-weight).epsilon(1e-3));
  // The ball sinks in by m g / k = 5e-8 m, the joint sags by less.
  CHECK(world.position(ball).z() == Catch::Approx(0.021).margin(1e-6));
}
