#include "core/error_of.hpp"
#include "world/laws.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/superquadric/superquadric_surface.hpp>
#include <dem/law/normal/elastic.hpp>

using Catch::Approx;
using dem::mbd::box_body;
using dem::surface::Box;
using dem::surface::Cylinder;
using dem::surface::Plane;
using dem::surface::TriangleMesh;
namespace mesh = dem::mesh;

namespace {

struct Parts : Balls {
  using Surfaces = surface::Set<Plane, Box, Cylinder, surface::Superquadric, surface::Sphere, TriangleMesh>;
};

constexpr double stiffness = 1e5;

/// A surface on a body of its own at a place.
struct BodyAt {
  Parts::Surfaces geometry;
  Vec3 at = Vec3::Zero();
  Mat3 turned = Mat3::Identity();
};
/// Force on a (over the stiffness: m) and torque on it about its place (over the stiffness: m^2) by b; both are held in
/// place.
struct Push {
  Vec3 force, torque;
};
Push push(const BodyAt& a, const BodyAt& b) {
  World<Parts> w(options(Vec3::Zero(), 1e-6));
  w.set_contact({{stiffness, 0.0, 1.0}, {0.0, stiffness, 0.0, 0.0}});
  const auto body = w.machine().add_body(box_body("a", {1, 1, 1}, 1e4).at(a.at, a.turned));
  SurfaceOptions o;
  o.position = b.at;
  o.rotation = b.turned;
  w.add_body_contact(w.add_surface(body, a.geometry), w.add_surface(w.ground(), b.geometry, o));
  w.prepare();
  const auto& pair = w.state().body_contacts.pairs[0];
  return {to_eigen(pair.force) / stiffness, to_eigen(pair.torque_a) / stiffness};
}
Mat3 about(const Vec3& axis, double angle) { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }
Mat3 along(const Vec3& axis) { return dem::rotation_between(Vec3::UnitZ(), axis.normalized()); }

}  // namespace

TEST_CASE("crossed rods touch where their axes come nearest, as deep as 2 R minus the axes' distance") {
  const double R = 0.1, depth = 1e-3;
  for (const double angle : {90.0, 50.0, 20.0}) {
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0.7, -0.4, 0)}) {
      CAPTURE(angle, shift.x());
      const double a = angle * M_PI / 180;
      const Vec3 one(1, 0, 0), other(std::cos(a), std::sin(a), 0);
      // The axes cross over the origin; each rod is shifted along its own.
      const Vec3 at = shift.x() * one + Vec3(0, 0, 2 * R - depth), below = shift.y() * other;
      const Push p = push({Cylinder(R, 2.0), at, along(one)}, {Cylinder(R, 2.0), below, along(other)});
      // The points near the ends of the chords are a fifth as deep and count with the eighth power of that.
      CHECK((p.force - Vec3(0, 0, depth)).norm() < 1e-5 * depth);
      CHECK((p.torque - (Vec3(0, 0, R) - at).cross(p.force)).norm() < 1e-4 * depth * R + shift.norm() * 1e-5 * depth);
      CHECK(push({Cylinder(R, 2.0), at + Vec3(0, 0, 1.01 * depth), along(one)}, {Cylinder(R, 2.0), below, along(other)})
                .force.norm() == 0.0);
    }
  }
}

TEST_CASE("crossed rods of triangles touch as cylinders do, however finely they are cut") {
  // No vertex of either is near the other: what touches are the long edges of the lateral surfaces, which share the
  // contact.
  const double R = 0.1, depth = 1e-3;
  for (const int facets : {48, 400, 2000}) {
    for (const bool other_is_cut : {true, false}) {
      CAPTURE(facets, other_is_cut);
      const Parts::Surfaces cut = TriangleMesh(mesh::cylinder(R, 2.0, facets));
      const Parts::Surfaces other = other_is_cut ? cut : Parts::Surfaces(Cylinder(R, 2.0));
      for (const auto& [a, b] : {std::pair(&cut, &other), {&other, &cut}}) {
        const Push p =
            push({*a, Vec3(0.3, 0, 2 * R - depth), along({1, 0, 0})}, {*b, Vec3(0, 0.2, 0), along({0.2, 1, 0})});
        // Across the bend the depth is a parabola, and shares are weighted by depth: 4/5 of the greatest, but for the
        // few edges of the coarse ones. Where the axes cross: 0.04 m along a on the other side.
        CHECK(p.force.z() == Approx(0.8 * depth).epsilon(facets > 100 ? 4e-3 : 0.02));
        CHECK(p.force.head<2>().norm() < (facets > 100 ? 1e-3 : 0.05) * depth);
        CHECK((p.torque - Vec3(-0.34, 0, -R).cross(p.force)).norm() < 0.01 * depth * R);
      }
    }
  }
}

TEST_CASE("a rod that stands on another one is carried by the line on which they touch") {
  const double R = 0.1, depth = 1e-3;
  const Push p =
      push({Cylinder(R, 1.0), Vec3(0.3, 0, R + 0.5 - depth)}, {Cylinder(R, 2.0), Vec3::Zero(), along({1, 0, 0})});
  // Four points of the rim beside that line are less deep, by R (1 - cos 7.5 degrees), and share the contact.
  CHECK(p.force.z() == Approx(depth).epsilon(0.15));
  CHECK(p.force.z() < depth * (1 + 1e-9));
  CHECK(p.force.head<2>().norm() < 1e-6 * depth);
  CHECK(p.torque.norm() < 1e-6 * depth);
}

TEST_CASE("parallel rods touch along what they share, in line, shifted, and one longer than the other") {
  const double R = 0.1, depth = 1e-3;
  const Mat3 lie = along({1, 0, 0});
  struct Case {
    double length, shift;
  };
  for (const auto& [length, shift] : {Case{2.0, 0.0}, {2.0, 0.9}, {2.0, 1e-5}, {0.7, 0.2}, {6.0, 0.3}}) {
    CAPTURE(length, shift);
    const Vec3 at(shift, 0, 2 * R - depth);
    const Push p = push({Cylinder(R, length), at, lie}, {Cylinder(R, 2.0), Vec3::Zero(), lie});
    // In line the ends push each other by as much as they are shifted (1e-5 m), not at all if they are not.
    CHECK(p.force.z() == Approx(depth).epsilon(1e-9));
    CHECK(std::abs(p.force.x()) < 1.1e-5);
    // In the middle of the part that they share.
    const double low = std::max(shift - 0.5 * length, -1.0), high = std::min(shift + 0.5 * length, 1.0);
    const double middle = (shift - p.torque.y() / p.force.z());
    CHECK(middle == Approx(0.5 * (low + high)).margin(0.01));
  }
  // Side by side, tilted by less than the depth: pushed up more at the end that lies deeper.
  for (const double tilt : {2e-4, -2e-4}) {
    const Push p = push({Cylinder(R, 2.0), Vec3(0.3, 0, 2 * R - depth), about({0, 1, 0}, tilt) * lie},
                        {Cylinder(R, 2.0), Vec3::Zero(), lie});
    const Push level =
        push({Cylinder(R, 2.0), Vec3(0.3, 0, 2 * R - depth), lie}, {Cylinder(R, 2.0), Vec3::Zero(), lie});
    CHECK((p.torque.y() - level.torque.y()) * tilt < 0.0);
    CHECK(p.force.z() > 0.9 * depth);
  }
}

TEST_CASE("a rod rests across two rods, and on the narrow side of a plank") {
  const double R = 0.05, length = 1.0, density = 500.0;
  for (const bool on_plank : {false, true}) {
    CAPTURE(on_plank);
    World<Parts> w(options({0, 0, -g}, 2e-5));
    w.set_contact({{stiffness, 300.0, 1.0}, {0.5, stiffness, 100.0, 0.975}});
    const double top = on_plank ? 0.0 : R;
    const auto rod = w.machine().add_body(
        mbd::cylinder_body("rod", R, length, density).at({0.04, 0, top + R + 1e-3}, along({1, 0, 0})));
    const auto upper = w.add_surface(rod, Cylinder(R, length));
    std::vector<BodyContactId> contacts;
    for (const double x : {-0.3, 0.3}) {
      SurfaceOptions o;
      o.position = on_plank ? Vec3(x, 0, -0.1) : Vec3(x, 0, 0);
      o.rotation = on_plank ? Mat3::Identity() : along({0, 1, 0});
      const Parts::Surfaces below = on_plank ? Parts::Surfaces(Box({0.02, 2.0, 0.2})) : Cylinder(R, 2.0);
      contacts.push_back(w.add_body_contact(upper, w.add_surface(w.ground(), below, o)));
    }
    REQUIRE(w.run_for(1.0));
    const dem::Body& body = w.machine().body(rod);
    const double weight = body.mass * g, depth = weight / (2 * stiffness);
    CHECK(w.body_contact_force(contacts[0]).z() + w.body_contact_force(contacts[1]).z() ==
          Approx(weight).epsilon(1e-6));
    // The lever rule: 0.04 m off the middle.
    CHECK(w.body_contact_force(contacts[1]).z() / weight == Approx(0.5 * (1 + 0.04 / 0.3)).epsilon(0.01));
    CHECK(top + R - body.position().z() == Approx(depth).epsilon(0.05));
    CHECK(std::abs(body.position().y()) < 1e-6);
  }
}

TEST_CASE("a pin in a tube touches the wall, whichever of them is the longer one") {
  const double inner = 0.1, pin = 0.08, depth = 1e-4;
  const Cylinder tube = Cylinder::tube(inner, 0.12, 1.0);
  for (const double length : {0.5, 1.0, 3.0}) {
    for (const double shift : {0.0, 0.2}) {
      CAPTURE(length, shift);
      const Vec3 out = Vec3(0.6, 0.8, 0), at = (inner - pin + depth) * out + Vec3(0, 0, shift);
      const Push p = push({Cylinder(pin, length), at}, {tube});
      CHECK((p.force + depth * out).norm() < 0.01 * depth);
      CHECK(push({Cylinder(pin, length), at - 1.01 * depth * out}, {tube}).force.norm() == 0.0);
      // The other way round.
      const Push q = push({tube, -at}, {Cylinder(pin, length)});
      CHECK((q.force - depth * out).norm() < 0.01 * depth);
    }
  }
  // Tilted, a long pin is touched by the rims of the hole, on opposite sides, which turn it back.
  const double tilt = std::atan((inner - pin + 2 * depth) / 0.5);
  const Push p = push({Cylinder(pin, 3.0), Vec3::Zero(), about({0, 1, 0}, tilt)}, {tube});
  CHECK(std::abs(p.force.x()) < 1e-3 * depth);
  CHECK(p.torque.y() < -0.5 * depth * 0.5);
}

TEST_CASE("an egg in a drum is pushed by the lateral surface alike, whether or not an end is near") {
  // Tilted, so that the point farthest along the way to the lateral surface is not the deepest one.
  const double R = 0.05, length = 0.1, depth = 1e-5;
  const surface::Superquadric egg({4e-3, 2e-3, 1e-3}, {2, 2, 2});
  const double to_side = std::sqrt(0.5 * (4e-3 * 4e-3 + 2e-3 * 2e-3));
  const Cylinder drum(R, length, dem::surface::Side::inside);
  const auto push_at = [&](double z) {
    return push({egg, Vec3(R - to_side + depth, 0, z), about({0, 0, 1}, 0.25 * M_PI)}, {drum});
  };
  const Push amid = push_at(0.0), near_end = push_at(0.5 * length - 3e-3);  // in the bounding sphere, 2 mm off the egg
  CHECK(amid.force.x() < -depth);                                           // the tip beside that point is deeper
  CHECK((near_end.force - amid.force).norm() < 1e-6 * depth);
  CHECK((near_end.torque - amid.torque).norm() < 1e-6 * depth * 4e-3);
}

TEST_CASE("superquadrics with curved sides touch as deep as their common normal says") {
  const double depth = 1e-4;
  // Ellipsoids: x = r^2 n/|r n| is the point with the normal n; put them there, one against the other.
  const Vec3 ra(0.1, 0.15, 0.2), rb(0.12, 0.3, 0.08);
  const auto tip = [](const Vec3& r, const Vec3& n) -> Vec3 {
    return r.cwiseProduct(r).cwiseProduct(n) / r.cwiseProduct(n).norm();
  };
  Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    CAPTURE(trial);
    const Vec3 n = random.vector(1.0).normalized();
    const Mat3 turn_a = random.rotation(), turn_b = random.rotation();
    const Vec3 x_a = turn_a * tip(ra, turn_a.transpose() * n), x_b = turn_b * tip(rb, -turn_b.transpose() * n);
    const Vec3 at = -x_a + (0.5 * depth) * n, below = -x_b - (0.5 * depth) * n;
    const Push p = push({surface::Superquadric(ra), at, turn_a}, {surface::Superquadric(rb), below, turn_b});
    // Fixed points within a contact's radius a of the deepest one, a^2 = 2 R depth with R < 1 m, count less than
    // (a^2/(0.05 m)^2)^2 of it, and only if one is there.
    CHECK((p.force + depth * n).norm() < 1e-3 * depth);
    CHECK((p.torque - (-at).cross(p.force)).norm() < 1e-3 * depth * 0.1);
    CHECK(push({surface::Superquadric(ra), at - 1.01 * depth * n, turn_a}, {surface::Superquadric(rb), below, turn_b})
              .force.norm() == 0.0);
    // On a rod that lies in the tangent plane, and on flat ground.
    const Vec3 along_plane = n.cross(random.vector(1.0)).normalized();
    const Push rod = push({surface::Superquadric(ra), at, turn_a},
                          {Cylinder(0.1, 2.0), (0.1 - 0.5 * depth) * n, along(along_plane)});
    CHECK((rod.force + depth * n).norm() < 1e-3 * depth);
    const Mat3 level = dem::rotation_between(Vec3::UnitZ(), Vec3(-n));
    for (const Parts::Surfaces& flat :
         {Parts::Surfaces(Plane{}), {Box({2, 2, 0.4})}, {TriangleMesh(mesh::box({2, 2, 0.4}, 3))}}) {
      const double top = std::holds_alternative<Plane>(flat) ? 0.0 : 0.2;
      const Push onto = push({surface::Superquadric(ra), at, turn_a}, {flat, (top - 0.5 * depth) * n, level});
      CHECK((onto.force + depth * n).norm() < 1e-3 * depth);
    }
  }
}

TEST_CASE("a ball touches superquadrics and cylinders where their surface is nearest to its centre, from either side") {
  const double r = 0.15, depth = 1e-3;
  const dem::surface::Sphere ball(r);
  const Vec3 at(0.2, -0.1, 0.3);
  const Mat3 turned = about({1, 2, -1}, 0.7);
  const auto check = [&](const Parts::Surfaces& other, const Vec3& foot, const Vec3& normal, double tolerance) {
    const Vec3 place = at + turned * foot, n = turned * normal;
    const BodyAt b = {ball, place + (r - depth) * n}, o = {other, at, turned};
    const Push on_ball = push(b, o), on_other = push(o, b);
    CHECK((on_ball.force - depth * n).norm() < tolerance * depth);
    CHECK((on_other.force + depth * n).norm() < tolerance * depth);
    CHECK((on_other.torque + (place - at).cross(depth * n)).norm() < 10 * tolerance * depth);
    CHECK(push({ball, place + (r + 0.01 * depth) * n}, o).force.norm() == 0.0);
  };
  // Searches for the nearest point of a superquadric end within 3e-6 of its size.
  for (const Vec3& exponents : {Vec3(2, 2, 2), Vec3(4, 3, 6), Vec3(8, 8, 8)}) {
    const Vec3 radii(0.3, 0.2, 0.4);
    const shape::SuperquadricSolid solid(radii, exponents);
    for (const Vec3& way : {Vec3(1, 0.2, 0.1), Vec3(0.5, -1, 1), Vec3(0.1, 0.1, -1)}) {
      CAPTURE(exponents.transpose(), way.transpose());
      const auto foot = solid.radial(from_eigen(Vec3(way.normalized())));
      check(surface::Superquadric(radii, exponents), to_eigen(foot.position), to_eigen(foot.normal), 1e-4);
    }
  }
  const Cylinder cylinder(0.3, 0.8);
  check(cylinder, {0.3, 0, 0.1}, {1, 0, 0}, 1e-9);
  check(cylinder, {0.1, 0.05, -0.4}, {0, 0, -1}, 1e-9);
  check(cylinder, {0, 0.3, 0.4}, Vec3(0, 1, 1).normalized(), 1e-9);
}

TEST_CASE("a superquadric body that is a ball rolls on flat ground as a ball does") {
  const double R = 0.1, slope = 0.2, angle = std::atan(slope);
  const std::vector<Parts::Surfaces> grounds = {Plane{}, Box({8, 1, 0.2}), TriangleMesh(mesh::box({8, 1, 0.2}, 5))};
  for (const auto& ground : grounds) {
    CAPTURE(ground.index());
    const double top = std::holds_alternative<Plane>(ground) ? 0.0 : 0.1;
    World<Parts> w(options({g * std::sin(angle), 0, -g * std::cos(angle)}, 5e-5));
    w.set_contact({{4e5, 100.0, 1.0}, {0.8, 4e5, 50.0, 1.0}});
    const auto body =
        w.machine().add_body(mbd::sphere_body("ball", R, 1000.0).at({0, 0, top + R - 1e-4}, about({1, 2, 3}, 0.7)));
    w.add_body_contact(w.add_surface(body, surface::Superquadric(Vec3::Constant(R))),
                       w.add_surface(w.ground(), ground));
    REQUIRE(w.run_for(0.2));
    const double v = w.machine().body(body).velocity().x();
    double lowest = 1e300, highest = -1e300;
    for (int k = 0; k < 60; ++k) {
      REQUIRE(w.run_for(0.01));
      const double z = w.machine().body(body).position().z();
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
    }
    const dem::Body& b = w.machine().body(body);
    // Points of the boundary that pass by the support point weigh (2 R d/(R/3)^2)^2 = 3e-4 at the most, there and back.
    CHECK((b.velocity().x() - v) / 0.6 == Approx(5.0 / 7.0 * g * std::sin(angle)).epsilon(2e-3));
    CHECK(b.angular_velocity().y() == Approx(b.velocity().x() / R).epsilon(2e-3));
    CHECK(std::abs(b.velocity().y()) < 1e-3);
    const double depth = b.mass * g * std::cos(angle) / 4e5;
    CHECK(highest - lowest < 0.01 * depth);
    CHECK(top + R - b.position().z() == Approx(depth).epsilon(0.01));
  }
}
