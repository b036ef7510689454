#include "geometry/fillet.hpp"
#include "world/scenes.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/geometry/superquadric/superquadric_surface.hpp>
#include <dem/law/normal/hysteretic.hpp>

using Catch::Approx;
namespace surface = dem::surface;

namespace {

struct Round : Balls {
  using Surfaces =
      surface::Set<surface::Plane, surface::Sphere, surface::Cylinder, surface::Superquadric, surface::TriangleMesh>;
};

struct Rest {
  const char* name;
  Round::Surfaces geometry;
  Vec3 at;  ///< where the ball rests, but for the overlap
};

}  // namespace

TEST_CASE("the weight of a grain arrives in the sensor through every kind of surface") {
  const double r = 5e-3;
  // The ball stands on the highest point, or lies in the lowest: labile places hold to rounding in 0.2 s.
  const std::vector<Rest> rests = {
      {"ball", surface::Sphere(0.03), {0, 0, 0.03 + r}},
      {"round cavity", surface::Sphere(0.03, surface::Side::inside), {0, 0, -0.03 + r}},
      {"cylinder's end", surface::Cylinder(0.03, 0.04), {0.01, 0, 0.02 + r}},
      {"drum's end", surface::Cylinder(0.03, 0.04, surface::Side::inside), {0.01, 0, -0.02 + r}},
      {"tube's rim", surface::Cylinder::tube(0.01, 0.03, 0.04), {0.02, 0, 0.02 + r}},
      {"superquadric", surface::Superquadric({0.03, 0.03, 0.03}, {8, 8, 8}), {0, 0, 0.03 + r}},
      {"hollow superquadric",
       surface::Superquadric({0.03, 0.04, 0.03}, {2, 2, 2}, surface::Side::inside),
       {0, 0, -0.03 + r}},
      {"mesh", surface::TriangleMesh(dem::mesh::cylinder(0.03, 0.04, 24)), {0.01, 0, 0.02 + r}}};
  for (const Rest& rest : rests) {
    CAPTURE(rest.name);
    dem::World<Round> w(options({0, 0, -g}, 2e-5));
    w.set_contact({{2000.0, 1.0, 1.0}, {0.4, 2000.0, 0.5, 1.0}});
    const auto body = w.machine().add_fixed_body("scale");
    const auto s = w.add_surface(body, rest.geometry);
    const auto sensor = w.machine().add_sensor(dem::mbd::contact_sensor("weight", body, 0.0));
    const auto ball = w.add_grain({w.add_species(Sphere(r)), rest.at + Vec3(0, 0, 1e-5)});
    REQUIRE(w.run_for(0.2));  // damped with exp(-360/s t)
    const double weight = mass_of(w, ball) * g;
    CHECK((w.surface_force(s) + Vec3(0, 0, weight)).norm() < 1e-9 * weight);
    CHECK(w.machine().sensor(sensor).latest().force.z == Approx(-weight).epsilon(1e-9));
  }
}

TEST_CASE("a ball inside a drum swings as a pendulum does, sliding and rolling") {
  // Without friction it slides: omega^2 = g/(R - r); with enough friction it rolls: 5/7 of that. Amplitude 0.1 rad: the
  // period is longer by a^2/16. The contact's compression changes R - r by 7e-6/0.045.
  const double R = 0.05, r = 5e-3, amplitude = 0.1;
  for (const double mu : {0.0, 0.8}) {
    dem::World<Round> w(options({-g, 0, 0}, 1e-5));
    w.set_contact({{2000.0, 1.0, 1.0}, {mu, 2000.0, 0.02, 1.0}});
    w.add_surface(w.ground(), surface::Cylinder(R, 0.1, surface::Side::inside));
    const Vec3 at = (R - r + 7e-6) * Vec3(-std::cos(amplitude), std::sin(amplitude), 0);
    const auto ball = w.add_grain({w.add_species(Sphere(r)), at});
    std::vector<double> crossings;
    for (double last = at.y(); crossings.size() < 5 && w.time() < 3.0;) {
      REQUIRE(w.run(10));
      const double y = w.position(ball).y();
      if (last * y < 0.0) crossings.push_back(w.time() - 1e-4 * y / (y - last));
      last = y;
    }
    REQUIRE(crossings.size() == 5);
    const double inertia = mu > 0.0 ? 7.0 / 5.0 : 1.0;
    const double exact =
        2 * std::numbers::pi * std::sqrt(inertia * (R - r + 7e-6) / g) * (1 + amplitude * amplitude / 16);
    CHECK(0.5 * (crossings[4] - crossings[0]) == Approx(exact).epsilon(5e-4));
  }
}

TEST_CASE("a body that is a ball moves on a mesh as a grain that is a ball does") {
  const double r = 5e-3, density = 2650.0;
  const surface::TriangleMesh block(dem::mesh::box({0.1, 0.1, 0.02}, 4));
  const Vec3 at(-0.03, 0.011, 0.01 + r + 1e-4), velocity(0.5, -0.1, -0.1);
  const dem::ContactParameters<Round> constants = {{2000.0, 0.1, 0.5}, {0.3, 2000.0, 0.05, 0.975}};

  dem::World<Round> grain(options({0.3, 0, -g}, 1e-5)), body(options({0.3, 0, -g}, 1e-5));
  grain.set_contact(constants);
  body.set_contact(constants);
  grain.add_surface(grain.ground(), block);
  dem::SpeciesOptions o;
  o.density = density;
  const auto p = grain.add_grain({grain.add_species(Sphere(r), o), at, velocity});
  const auto b = body.machine().add_body(dem::mbd::sphere_body("ball", r, density).at(at).moving(velocity));
  body.add_body_contact(body.add_surface(body.ground(), block), body.add_surface(b, surface::Sphere(r)));
  double apart = 0.0, spin_apart = 0.0;
  for (int k = 0; k < 220; ++k) {
    REQUIRE(grain.run(200));
    REQUIRE(body.run(200));
    const dem::Body& ball = body.machine().body(b);
    apart = std::max(apart, (grain.position(p) - ball.position()).norm());
    spin_apart = std::max(spin_apart, (grain.angular_velocity(p) - ball.angular_velocity()).norm());
  }
  // It slid, rolled, and fell off an edge; rounding differs between the two loops.
  CHECK(grain.position(p).z() < 0.0);
  CHECK(apart < 1e-9);
  CHECK(spin_apart < 1e-6);
}

TEST_CASE("a ball in a fillet that leaves the floor or the wall remembers the other one") {
  // One group of triangles: both contacts share their name but for the direction. The ball is so heavy that it moves as
  // it was started, out of one contact at 10 times the speed than out of the other; Hysteretic remembers the largest
  // overlaps, 4e-5 m and 2e-5 m.
  struct Plastic : Round {
    using Normal = dem::contact::Hysteretic;
  };
  const double r = 5e-3, k1 = 2000.0, k2 = 3000.0, deep = 4e-5, shallow = 2e-5, v = 1e-2;
  for (const bool leaves_floor : {true, false}) {
    for (const bool deeper_leaves : {true, false}) {
      CAPTURE(leaves_floor, deeper_leaves);
      dem::World<Plastic> w(options({0, 0, 0}, 1e-6));
      w.set_contact({{k1, k2}, {0.0, 1.0, 0.0, 1.0}});
      const auto s = w.add_surface(
          w.ground(), surface::TriangleMesh(fillet(2e-3, 6, 0.05), {.side = surface::MeshSide::one_sided}));
      dem::SpeciesOptions o;
      o.density = 1e12;
      const double leaving = deeper_leaves ? deep : shallow, staying = deeper_leaves ? shallow : deep;
      const Vec3 out = leaves_floor ? Vec3::UnitZ() : Vec3::UnitX(), on = leaves_floor ? Vec3::UnitX() : Vec3::UnitZ();
      w.add_grain({w.add_species(Sphere(r), o), (r - leaving) * out + (r - staying) * on, v * out + 0.1 * v * on});
      double last = -1.0;
      for (int step = 0; step < 500; ++step) {
        REQUIRE(w.run(10));
        const double moved = v * w.time(), overlap = staying - 0.1 * moved;
        if (moved < 1.01 * leaving || overlap <= 0.0) continue;
        const double force = std::max(0.0, k1 * overlap - (k2 - k1) * (staying - overlap));
        // The first step's overlap is the largest that is remembered: 1e-9 m less, times k2 - k1.
        CHECK(-w.surface_force(s).dot(on) == Approx(force).margin(2e-9 * k2));
        last = force;
      }
      CHECK(last >= 0.0);
    }
  }
}

TEST_CASE("an ellipsoid on a drum's end remembers it as it slides near a wall, and against it") {
  // The wall comes within its bounding sphere 2 mm before they touch. So heavy that it moves as it was started, out of
  // the end and towards the wall, which it enters by a hundredth of a millimetre. It is a grain or a body; the drum is
  // round, or a box of triangles, of whose walls some are listed before both ends and some after one.
  struct Plastic : Round {
    using Shape = dem::shape::Superquadric;
    using Normal = dem::contact::Hysteretic;
  };
  const double k1 = 2000.0, k2 = 3000.0, deep = 4e-5, R = 0.05, half = 0.02, time = 2e-3;
  const Vec3 radii(6e-3, 4e-3, 2e-3);
  const double start = R - radii.y() - 3e-3, speed = (3e-3 + 1e-5) / time, out = 0.25 * deep / time;
  const Round::Surfaces drums[] = {
      surface::Cylinder(R, 2 * half, surface::Side::inside),
      surface::TriangleMesh(dem::mesh::box({2 * R, 2 * R, 2 * half}), {.facing = dem::MeshFacing::inward})};
  for (int k = 0; k < 16; ++k) {
    const bool is_body = (k & 1) != 0;
    const auto& geometry = drums[k >> 1 & 1];
    const double wall = (k & 4) != 0 ? 1.0 : -1.0, end = (k & 8) != 0 ? 1.0 : -1.0;
    CAPTURE(is_body, geometry.index(), wall, end);
    dem::World<Plastic> w(options({0, 0, 0}, 1e-6));
    w.set_contact({{k1, k2}, {0.0, 1.0, 0.0, 1.0}});
    const auto drum = w.add_surface(w.ground(), geometry);
    const Vec3 at(0, wall * start, end * (half - radii.z() + deep)), velocity(0, wall * speed, -end * out);
    dem::BodyContactId contact;
    dem::SpeciesOptions o;
    o.density = 1e12;
    if (is_body) {
      const auto body = w.machine().add_body(dem::mbd::sphere_body("egg", 4e-3, o.density).at(at).moving(velocity));
      contact = w.add_body_contact(w.add_surface(body, surface::Superquadric(radii)), drum);
    } else {
      w.add_grain({w.add_species(dem::shape::Superquadric(radii, {2, 2, 2}), o), at, velocity});
    }
    Vec3 force;
    for (int step = 0; step < 200; ++step) {
      REQUIRE(w.run(10));
      force = is_body ? w.body_contact_force(contact) : Vec3(-w.surface_force(drum));
      const double overlap = deep - out * w.time(), expected = k1 * overlap - (k2 - k1) * (deep - overlap);
      // The largest overlap is remembered from the first step's end on.
      CHECK(-end * force.z() == Approx(expected).margin(1.01 * k2 * out * 1e-6));
    }
    CHECK(-wall * force.y() > 0.8 * k1 * 1e-5);
  }
}
