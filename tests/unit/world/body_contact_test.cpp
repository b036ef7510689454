#include "core/error_of.hpp"
#include "scenes.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/superquadric/superquadric_surface.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/mbd/body/mesh_body.hpp>

using Catch::Approx;
using dem::BodyId;
using dem::mbd::box_body;
using dem::surface::Box;
using dem::surface::Plane;
using dem::surface::TriangleMesh;
namespace mesh = dem::mesh;

namespace {

const Vec3 edges(0.2, 0.1, 0.08);

/// A block of 1.6 kg on a floor, of which either may be a box, triangles or a plane.
struct Block {
  dem::World<Balls> world;
  BodyId block;
  dem::BodyContactId contact;

  Block(const Balls::Surfaces& of_block, const Balls::Surfaces& of_floor, double floor_top, const Vec3& gravity,
        double height, double mu)
      : world(options(gravity, 5e-5)) {
    world.set_contact({{4e5, 240.0, 1.0}, {mu, 4e5, 400.0, 0.975}});
    block = world.machine().add_body(box_body("block", edges, 1000.0).at({0, 0, 0.04 + height}));
    const auto upper = world.add_surface(block, of_block);
    dem::SurfaceOptions o;
    o.position = {0.013, 0.017, -floor_top};  // no point of the block above a vertex of the floor
    contact = world.add_body_contact(upper, world.add_surface(world.ground(), of_floor, o));
  }
  const dem::Body& body() const { return world.machine().body(block); }
};

struct Pairing {
  const char* name;
  Balls::Surfaces block, floor;
  double floor_top;
};
std::vector<Pairing> pairings() {
  const Box box(edges), ground({4, 4, 0.4});
  const TriangleMesh cut(mesh::box(edges, 2)), ground_cut(mesh::box({4, 4, 0.4}, 3));
  return {{"box on plane", box, Plane{}, 0.0}, {"mesh on plane", cut, Plane{}, 0.0},
          {"box on box", box, ground, 0.2},    {"box on mesh", box, ground_cut, 0.2},
          {"mesh on box", cut, ground, 0.2},   {"mesh on mesh", cut, ground_cut, 0.2}};
}

}  // namespace

TEST_CASE("a body dropped on the ground rests with m g and stays where it is") {
  for (const Pairing& p : pairings()) {
    CAPTURE(p.name);
    Block scene(p.block, p.floor, p.floor_top, {0, 0, -g}, 2e-4, 0.5);
    auto& w = scene.world;
    const auto sensor = w.machine().add_sensor(dem::mbd::contact_sensor("floor", scene.block, 0.0));
    // Damped with exp(-C/(2 m) t) = exp(-75/s t), and its friction springs as well.
    REQUIRE(w.run_for(1.0));
    const double weight = 1.6 * g;
    CHECK((w.body_contact_force(scene.contact) - Vec3(0, 0, weight)).norm() < 1e-9 * weight);
    CHECK(w.machine().sensor(sensor).latest().force.z == Approx(weight).epsilon(1e-9));
    const Vec3 settled = scene.body().position();
    CHECK(settled.head(2).norm() < 1e-9);
    REQUIRE(w.run_for(0.5));
    CHECK((scene.body().position() - settled).norm() < 1e-14);  // rounding of 1e-17 m a step at the most
    CHECK((scene.body().rotation() - Mat3::Identity()).norm() < 1e-9);
  }
}

TEST_CASE("a body is one contact on the ground, however finely it is cut") {
  // It sinks by m g/K, and its corners share what it rests on.
  const auto depth = [](const Balls::Surfaces& block, const Balls::Surfaces& floor, double top) {
    Block scene(block, floor, top, {0, 0, -g}, 1e-5, 0.5);
    REQUIRE(scene.world.run_for(1.0));
    return 0.04 - scene.body().position().z();
  };
  const double expected = 1.6 * g / 4e5;
  for (const int pieces : {1, 2, 8}) {
    CAPTURE(pieces);
    CHECK(depth(TriangleMesh(mesh::box(edges, pieces)), Plane{}, 0.0) == Approx(expected).epsilon(1e-6));
    CHECK(depth(Box(edges, pieces), Box({4, 4, 0.4}), 0.2) == Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("a body that falls flat rebounds with the restitution that was asked for") {
  const double e = 0.7;
  for (const Balls::Surfaces& surface :
       {Balls::Surfaces(Box(edges, 3)), Balls::Surfaces(TriangleMesh(mesh::box(edges, 4)))}) {
    dem::World<models::LinearModel> w(options({0, 0, 0}, 5e-6));
    w.set_contact({dem::contact::LinearSpringDashpot::with_restitution(4e5, e), {0.5, 4e5, 0.0}});
    const auto block = w.machine().add_body(box_body("block", edges, 1000.0).at({0, 0, 0.041}).moving({0, 0, -0.5}));
    w.add_body_contact(w.add_surface(block, surface), w.add_surface(w.ground(), Plane{}));
    REQUIRE(w.run_for(0.02));
    // The contact lasts 1,200 steps: 1e-3.
    CHECK(w.machine().body(block).velocity().z() == Approx(0.5 * e).epsilon(2e-3));
    CHECK(w.machine().body(block).angular_velocity().norm() < 1e-9);
  }
}

TEST_CASE("planks laid across each other touch where their edges cross", "[long]") {
  // No corner of either lies in the other: what touches are the edges, flat on flat or edge on edge.
  const Vec3 plank(1.0, 0.06, 0.03);
  for (const double roll : {0.0, 0.25 * std::numbers::pi}) {
    for (const double yaw : {0.5 * std::numbers::pi, 1.0}) {
      for (const auto& [upper_cut, lower_cut] : {std::pair(false, false), {true, false}, {false, true}, {true, true}}) {
        CAPTURE(roll, yaw, upper_cut, lower_cut);
        dem::World<Balls> w(options({0, 0, -g}, 1e-5));
        w.set_contact({{1e4, 60.0, 1.0}, {0.5, 1e4, 60.0, 0.975}});
        const auto turned = [&](double about_z) -> Mat3 {
          return (Eigen::AngleAxisd(about_z, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
              .toRotationMatrix();
        };
        const double half = roll == 0.0 ? 0.015 : 0.5 * (0.06 + 0.03) / std::sqrt(2.0);  // height of the middle
        const auto lower = w.machine().add_fixed_body("lower");
        const auto upper = w.machine().add_body(box_body("upper", plank, 500.0).at({0, 0, 2.0 * half}, turned(yaw)));
        // On its edge it would fall over: it slides down a rail.
        if (roll > 0.0)
          w.machine().add_joint(dem::mbd::prismatic("rail", upper, w.ground(), {0, 0, 2.0 * half}, {0, 0, 1}));
        const auto surface = [&](bool cut) {
          return cut ? Balls::Surfaces(TriangleMesh(mesh::box(plank, 1))) : Balls::Surfaces(Box(plank));
        };
        dem::SurfaceOptions rolled;
        rolled.rotation = turned(0.0);
        const auto contact = w.add_body_contact(w.add_surface(upper, surface(upper_cut)),
                                                w.add_surface(lower, surface(lower_cut), rolled));
        REQUIRE(w.run_for(0.8));
        const double weight = 0.9 * g;
        // Edge on edge, two faces are as near, and the normal changes between them.
        CHECK(w.body_contact_force(contact).z() == Approx(weight).epsilon(roll > 0.0 ? 1e-4 : 1e-6));
        // As deep as the spring says: m g/K = 9e-4 m, flat on flat; edge on edge the normal is a face's, at 45
        // degrees.
        const double sunk = 2.0 * half - w.machine().body(upper).position().z();
        CHECK(sunk > 0.9 * weight / 1e4);
        CHECK(sunk < 3.0 * weight / 1e4);
      }
    }
  }
}

TEST_CASE(
    "a blade of triangles lies across the prongs of a fork of triangles, and slides along them as friction lets it") {
  // Edges cross edges in three places; no vertex of either is in the other.
  dem::IndexedMesh fork;
  for (const double x : {-0.3, 0.05, 0.3}) fork += mesh::box({0.05, 2.0, 0.05}, 1).moved({x, 0, 0});
  dem::World<Balls> w(options({0, 0, -g}, 1e-5));
  w.set_contact({{1e4, 60.0, 1.0}, {0.3, 1e4, 60.0, 1.0}});
  const Vec3 blade(1.0, 0.1, 0.03);
  const auto body =
      w.machine().add_body(box_body("blade", blade, 300.0).at({0, -0.5, 0.04 + 1e-4}).moving({0, 1.0, 0}));
  const auto contact = w.add_body_contact(w.add_surface(body, TriangleMesh(mesh::box(blade, 1))),
                                          w.add_surface(w.ground(), TriangleMesh(fork)));
  const double weight = 0.9 * g;
  double pushed = 0.0, braked = 0.0;
  int samples = 0;
  REQUIRE(w.run_for(0.05));
  const double start = w.machine().body(body).velocity().y(), from = w.time();
  while (w.time() < 0.25) {
    REQUIRE(w.run_for(0.005));
    pushed += w.body_contact_force(contact).z();
    braked -= w.body_contact_force(contact).y();
    ++samples;
  }
  const dem::Body& b = w.machine().body(body);
  // Bounces of the landing are damped with exp(-C/(2 m) t) = exp(-33/s t); their mean counts.
  CHECK(pushed / samples == Approx(weight).epsilon(0.05));
  CHECK((b.velocity().y() - start) / (w.time() - from) == Approx(-0.3 * g).epsilon(0.05));
  CHECK(braked / samples == Approx(0.3 * weight).epsilon(0.05));
  REQUIRE(w.run_for(1.0));
  CHECK(w.body_contact_force(contact).z() == Approx(weight).epsilon(1e-6));
  CHECK(b.velocity().norm() < 1e-6);
  CHECK((b.rotation() - Mat3::Identity()).norm() < 0.01);  // all three prongs bear it: no turn but what friction did
}

TEST_CASE("a wheel rolls evenly on a plane, a slab, and on a rail narrower than itself") {
  const double R = 0.15, slope = 0.2, angle = std::atan(slope);
  const std::vector<std::pair<const char*, Balls::Surfaces>> grounds = {
      {"plane", Plane{}}, {"slab", Box({8, 1, 0.1})}, {"rail", Box({8, 0.03, 0.1})}};
  for (const auto& [name, ground] : grounds) {
    CAPTURE(name);
    dem::World<Balls> w(options({g * std::sin(angle), 0, -g * std::cos(angle)}, 5e-5));
    w.set_contact({{4e5, 100.0, 1.0}, {0.8, 4e5, 50.0, 1.0}});
    const Mat3 lie = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const double top = std::holds_alternative<Plane>(ground) ? 0.0 : 0.05;
    const auto body =
        w.machine().add_body(dem::mbd::cylinder_body("wheel", R, 0.1, 1000.0).at({0, 0, top + R - 2e-4}, lie));
    w.add_body_contact(w.add_surface(body, dem::surface::Cylinder(R, 0.1)), w.add_surface(w.ground(), ground));
    REQUIRE(w.run_for(0.2));
    const double v = w.machine().body(body).velocity().x();
    REQUIRE(w.run_for(0.6));
    const dem::Body& b = w.machine().body(body);
    // The points of the rims that pass by the lowest one weigh (depth/R)^2-fold little, there and back.
    CHECK((b.velocity().x() - v) / 0.6 == Approx(2.0 / 3.0 * g * std::sin(angle)).epsilon(2e-3));
    CHECK(b.angular_velocity().y() == Approx(b.velocity().x() / R).epsilon(2e-3));
    CHECK(std::abs(b.velocity().y()) < 1e-6);
  }
}

TEST_CASE("superquadric bodies rest on the ground, and on other bodies") {
  using dem::surface::Superquadric;
  struct Round : Balls {
    using Surfaces = dem::surface::Set<Plane, Box, Superquadric, dem::surface::Sphere, TriangleMesh>;
  };
  const Superquadric brick({0.1, 0.06, 0.04}, {8, 8, 8}), egg({0.06, 0.06, 0.08});
  const std::vector<std::pair<Round::Surfaces, double>> grounds = {{Plane{}, 0.0},
                                                                   {Box({1, 1, 0.2}), 0.1},
                                                                   {Superquadric({0.5, 0.5, 0.1}, {20, 20, 20}), 0.1},
                                                                   {TriangleMesh(mesh::box({1, 1, 0.2}, 3)), 0.1}};
  for (const auto& [ground, top] : grounds) {
    for (const Superquadric& shape : {brick, egg}) {
      CAPTURE(top, ground.index());
      dem::World<Round> w(options({0, 0, -g}, 4e-5));
      w.set_contact({{1e5, 200.0, 1.0}, {0.5, 1e5, 100.0, 0.975}});
      const double half = shape.radii().z();
      const auto body =
          w.machine().add_body(box_body("body", 2.0 * shape.radii(), 500.0).at({0, 0, top + half + 1e-4}));
      const auto contact = w.add_body_contact(w.add_surface(body, shape), w.add_surface(w.ground(), ground));
      // An egg stands on its tip only for a while: what is asked is what carries it.
      if (half > 0.05) w.machine().add_joint(dem::mbd::prismatic("rail", body, w.ground(), {0, 0, top}, {0, 0, 1}));
      // 1 kg on springs of 1e5 N/m with 200 N s/m: what the fall leaves dies out as exp(-100 t).
      REQUIRE(w.run_for(0.25));
      const double weight = w.machine().body(body).mass * g;
      CHECK(w.body_contact_force(contact).z() == Approx(weight).epsilon(1e-4));
      CHECK(top + half - w.machine().body(body).position().z() < 3.0 * weight / 1e5);
    }
  }
}

TEST_CASE("a heavy body is carried, or reported, by a mesh cut finer than it sinks") {
  // 20 kg on 2e4 N/m sink by 1 cm, through two layers of a mesh of 5 mm: the ground must not lose it.
  for (const double k : {2e4, 2e3}) {
    dem::World<Balls> w(options({0, 0, -g}, 1e-4));
    w.set_contact({{k, 400.0, 1.0}, {0.0, k, 100.0, 0.975}});
    const auto body = w.machine().add_body(box_body("block", {0.06, 0.06, 0.06}, 20.0 / 2.16e-4).at({0, 0, 0.13}));
    w.add_body_contact(w.add_surface(body, Box({0.06, 0.06, 0.06})),
                       w.add_surface(w.ground(), TriangleMesh(mesh::box({0.2, 0.2, 0.2}, 40))));
    const auto report = w.run_for(1.5);
    if (k > 1e4) {
      CHECK(report);
      CHECK(0.13 - w.machine().body(body).position().z() == Approx(20.0 * g / k).epsilon(1e-3));
    } else {  // 10 cm, more than half its height
      CHECK(!report);
      CHECK_THAT(report.text, Catch::Matchers::ContainsSubstring("overlap"));
    }
  }
}

TEST_CASE("a block sticks below the angle of friction and slides above with g (sin - mu cos)") {
  const double mu = 0.5;
  for (const Pairing& p : pairings()) {
    for (const double slope : {0.9 * mu, 1.4 * mu}) {
      CAPTURE(p.name, slope);
      const double angle = std::atan(slope);
      const Vec3 gravity(g * std::sin(angle), 0, -g * std::cos(angle));
      Block scene(p.block, p.floor, p.floor_top, gravity, -1e-5, mu);
      auto& w = scene.world;
      REQUIRE(w.run_for(0.4));
      const double v = scene.body().velocity().x();
      REQUIRE(w.run_for(0.2));
      const double acceleration = (scene.body().velocity().x() - v) / 0.2;
      if (slope < mu) {
        CHECK(std::abs(acceleration) < 1e-9 * g);
        CHECK(scene.body().velocity().norm() < 1e-10);
        CHECK(scene.body().position().head(2).norm() < 1e-3);
      } else {
        // All contact points slide the same way, so friction is mu times the normal force to rounding, and what is left
        // of the start's swing: exp(-75 * 0.4). On triangles points change their partners' edges, not the plane.
        CHECK(acceleration == Approx(g * (std::sin(angle) - mu * std::cos(angle))).epsilon(1e-6));
        CHECK(std::abs(scene.body().position().y()) < 1e-9);
      }
    }
  }
}

TEST_CASE("a wheel of triangles rolls down an incline with 2/3 g sin") {
  // 96 segments: it rolls on a polygon, whose height changes by R (1 - cos(pi/96)) = 5e-4 R. The springs are soft
  // enough to carry it on several edges at once, which smooths that; the rest loses some energy at each edge.
  const double R = 0.15, slope = 0.2, angle = std::atan(slope);
  const auto wheel = mesh::cylinder(R, 0.1, 96);
  dem::World<Balls> w(options({g * std::sin(angle), 0, -g * std::cos(angle)}, 5e-5));
  w.set_contact({{8e4, 40.0, 1.0}, {0.8, 8e4, 20.0, 1.0}});
  const Mat3 lie = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto body = w.machine().add_body(dem::mbd::mesh_body("wheel", wheel, 1000.0).at({0, 0, R - 2e-4}, lie));
  w.add_body_contact(w.add_surface(body, TriangleMesh(wheel)), w.add_surface(w.ground(), Plane{}));
  REQUIRE(w.run_for(0.2));
  const double v = w.machine().body(body).velocity().x();
  REQUIRE(w.run_for(0.6));
  const dem::Body& b = w.machine().body(body);
  const double acceleration = (b.velocity().x() - v) / 0.6;
  CHECK(acceleration == Approx(2.0 / 3.0 * g * std::sin(angle)).epsilon(0.02));
  CHECK(b.angular_velocity().y() == Approx(b.velocity().x() / R).epsilon(0.01));
  CHECK(std::abs(b.velocity().y()) < 1e-6);
}

TEST_CASE("two free bodies that collide keep their momentum and angular momentum") {
  const Box box({0.1, 0.12, 0.14});
  const TriangleMesh ball(mesh::sphere(0.07, 2)), wheel(mesh::wheel({0.06, 0.05, 8, 0.01, 0.01, 24}));
  const std::vector<std::pair<Balls::Surfaces, Balls::Surfaces>> pairs = {{box, box}, {box, ball}, {ball, wheel}};
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    dem::World<Balls> w(options({0, 0, 0}, 2e-5));
    w.set_contact({{5e4, 5.0, 0.5}, {0.4, 5e4, 5.0, 0.975}});
    const auto a =
        w.machine().add_body(box_body("a", {0.1, 0.12, 0.14}, 800).at({-0.09, 0, 0}).moving({2, 0, 0.1}, {3, -2, 5}));
    const auto b = w.machine().add_body(box_body("b", {0.1, 0.12, 0.14}, 500)
                                            .at({0.09, 0.03, 0.02}, Random(5).rotation())
                                            .moving({-1, 0.2, 0}, {0, 4, 1}));
    const auto c = w.add_body_contact(w.add_surface(a, pairs[k].first), w.add_surface(b, pairs[k].second));
    const auto momenta = [&] {
      Vec3 linear = Vec3::Zero(), angular = linear;
      for (const BodyId i : {a, b}) {
        const dem::Body& body = w.machine().body(i);
        const Vec3 spin = body.rotation().transpose() * body.angular_velocity();
        linear += body.mass * body.velocity();
        angular +=
            body.mass * body.position().cross(body.velocity()) + body.rotation() * body.inertia.cwiseProduct(spin);
      }
      return std::pair(linear, angular);
    };
    const auto before = momenta();
    double largest = 0.0;
    for (int step = 0; step < 5000; ++step) {
      REQUIRE(w.step());
      largest = std::max(largest, w.body_contact_force(c).norm());
    }
    const auto after = momenta();
    CHECK(largest > 100.0);
    CHECK((after.first - before.first).norm() < 1e-11);
    // Symplectic Euler turns the momentum of a free tumbling body by an error of first order in the step.
    CHECK((after.second - before.second).norm() < 1e-4 * before.second.norm());
  }
}

TEST_CASE("an elastic head-on collision of two bodies exchanges their velocities") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-5));
  w.set_contact({{5e4, 0.0, 1.0}, {0.0, 0.0, 0.0, 1.0}});
  const auto a = w.machine().add_body(box_body("a", {0.1, 0.1, 0.1}, 1000).moving({1, 0, 0}));
  const auto b = w.machine().add_body(box_body("b", {0.1, 0.08, 0.08}, 1000.0 / 0.64).at({0.11, 0, 0}));
  w.add_body_contact(w.add_surface(a, Box({0.1, 0.1, 0.1})), w.add_surface(b, Box({0.1, 0.08, 0.08})));
  REQUIRE(w.run_for(0.05));
  CHECK(w.machine().body(a).velocity().norm() < 1e-4);  // O(omega dt) of symplectic Euler at the first and last contact
  CHECK(w.machine().body(b).velocity().x() == Approx(1.0).epsilon(1e-4));
}

TEST_CASE("contacts of bodies are found by rule, but not those of joints, of one body, or of the ground with itself") {
  dem::World<Balls> w(options({0, 0, -g}, 1e-4));
  w.set_contact({{1e4, 10.0, 1.0}, {0.4, 1e4, 10.0, 1.0}});
  auto& m = w.machine();
  const auto a = m.add_body(box_body("a", {0.1, 0.1, 0.1}, 1000).at({0, 0, 1}));
  const auto b = m.add_body(box_body("b", {0.1, 0.1, 0.1}, 1000).at({0.1, 0, 1}));
  const auto c = m.add_body(box_body("c", {0.1, 0.1, 0.1}, 1000).at({5, 0, 1}));
  m.add_joint(dem::mbd::revolute("hinge", a, b, {0.05, 0, 1}, {0, 1, 0}));
  for (const BodyId body : {a, a, b, c, w.ground(), w.ground()}) w.add_surface(body, Box({0.1, 0.1, 0.1}));
  w.add_surface(w.ground(), Plane{});
  // a1, a2, b, c, three of the ground: pairs of different bodies 5 * ... without a-b and ground-ground.
  CHECK(w.add_body_contacts() == 2 * 1 + 2 * 3 + 1 * 1 + 3 + 3);
  CHECK(w.add_body_contacts() == 0);
  check_refused([&] { w.add_body_contact(SurfaceId(0), SurfaceId(1)); },
                "surface 0 of body 'a' and surface 1 of body 'a' belong to the same body");
  check_refused([&] { w.add_body_contact(SurfaceId(4), SurfaceId(99)); }, "surface 99");
  check_refused(
      [&] {
        const auto fixed = w.machine().add_fixed_body("post");
        w.add_body_contact(w.add_surface(fixed, Plane{}), SurfaceId(4));
      },
      "both fixed");
  CHECK(w.state().body_contacts.pairs.size() == 15);
}

TEST_CASE("bodies limit the time step, and need contact constants") {
  dem::World<Balls> w(options({0, 0, -g}));
  const auto a = w.machine().add_body(box_body("a", edges, 1000).at({0, 0, 1}));
  w.add_body_contact(w.add_surface(a, Box(edges)), w.add_surface(w.ground(), Plane{}));
  check_refused([&] { w.prepare(); }, "no contact constants");
  w.set_contact({{1e6, 0.0, 1.0}, {0.0, 0.0, 0.0, 1.0}});
  // Two sides, each up to twice as stiff, at R = |edges|/2 from the centre of mass: omega^2 = 4 k (1/m + R^2/I).
  const double I = 1.6 / 12 * (0.01 + 0.0064), R2 = 0.25 * edges.squaredNorm();
  CHECK(w.stable_time_step().dt == Approx(2.0 / std::sqrt(4 * 1e6 * (1 / 1.6 + R2 / I))));
  CHECK_THAT(w.stable_time_step().limited_by, Catch::Matchers::ContainsSubstring("body 'a' on body 'ground'"));
  w.prepare();
  CHECK(w.time_step() == Approx(0.5 * w.stable_time_step().dt));
}
