#include "world/laws.hpp"
#include "world/listed_contacts.hpp"

#include <dem/world/force_lines.hpp>
#include <dem/world/query.hpp>

using Catch::Approx;
using dem::ContactKind;
using dem::contacts_of;
using listed::add_bed_and_plate;
using listed::check_listed;

namespace {

template <class Model>
void check_spheres_and_cubes(const dem::ContactParameters<Model>& constants) {
  dem::World<Model> w(options({0, 0, -g}, 1e-5));
  w.set_contact(constants);
  if constexpr (std::is_same_v<typename Model::Shape, Sphere>) {
    w.add_species(Sphere(1e-3));
    w.add_species(Sphere(0.95e-3));
    add_bed_and_plate(w, 1.95e-3, 7);
  } else {
    w.add_species(dem::shape::cube8(0.8e-3));
    add_bed_and_plate(w, 2.0e-3, 7);
  }
  std::array<int, 3> most = check_listed(w);  // as it was set up, before the first step
  for (int k = 0; k < 4; ++k) {
    REQUIRE(w.run(300));
    const auto count = check_listed(w);
    for (std::size_t kind = 0; kind < 3; ++kind) most[kind] = std::max(most[kind], count[kind]);
  }
  CHECK(most[0] > 100);
  CHECK(most[1] > 50);
  CHECK(most[2] > 0);
}

}  // namespace

TEST_CASE("listed contacts add up to the forces on grains, surfaces and bodies, and asking changes nothing", "[slow]") {
  SECTION("spheres, symplectic Euler") { check_spheres_and_cubes<Balls>(sand<Balls>()); }
  SECTION("spheres, predictor-corrector") {
    check_spheres_and_cubes<models::CorrectedBalls>(sand<models::CorrectedBalls>());
  }
  SECTION("cubes, velocity Verlet") { check_spheres_and_cubes<models::VerletCubes>(sand<models::VerletCubes>()); }
  SECTION("spheres, Hertz and Mindlin") {
    const auto pair = dem::contact::elastic_pair({3e6, 0.3});
    check_spheres_and_cubes<HertzModel>(
        {dem::contact::Hertz::with_restitution(pair, 0.5), dem::friction::Mindlin::with_restitution(pair, 0.4, 0.5)});
  }
}

TEST_CASE("listed contacts are what moves the grains") {
  // Symplectic Euler's next step begins with the evaluation that is listed: m (v' - v)/dt = sum of forces + m g.
  dem::World<Balls> w(options({0, 0, -g}, 1e-5));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(1e-3));
  add_bed_and_plate(w, 1.95e-3, 6);
  REQUIRE(w.run(100));
  std::map<std::uint32_t, Vec3> sum;
  const auto contacts = contacts_of(w);
  for (const auto& c : contacts) {
    sum.try_emplace(c.grain.value, Vec3::Zero()).first->second += c.force;
    if (c.kind == ContactKind::grains) sum.try_emplace(c.other_grain.value, Vec3::Zero()).first->second -= c.force;
  }
  REQUIRE(sum.size() > 100);
  const auto before = w;
  REQUIRE(w.step());
  for (const auto& [id, force] : sum) {
    const GrainId p(id);
    if (!p.valid()) continue;  // of two bodies
    const double mass = mass_of(w, p);
    const Vec3 moved = mass * (w.velocity(p) - before.velocity(p)) / 1e-5 - mass * Vec3(0, 0, -g);
    // The difference of velocities of 0.2 m/s rounds by 3e-17 m/s, so the force by 4e-17 kg m/s over 1e-5 s.
    CHECK((moved - force).norm() < 1e-14 * force.norm() + mass * 1e-10);
  }
}

TEMPLATE_TEST_CASE("a listed contact tells what its laws remember", "", Balls, models::CorrectedBalls) {
  // A ball that is pressed on a plane by its weight and pushed aside sticks by its spring: K d = m g, kt s = force.
  dem::World<TestType> w(options({1.0, 0, -g}, 1e-5));
  w.set_contact(sand<TestType>());
  w.add_species(Sphere(1e-3));
  w.add_surface(w.ground(), dem::surface::Plane{});
  const double mass = w.species(SpeciesId(0)).mass, depth = mass * g / 2000.0;
  w.add_grain(grain_at({0, 0, 1e-3 - depth}));
  const auto fresh = contacts_of(w);
  REQUIRE(fresh.size() == 1);
  CHECK(fresh[0].kind == ContactKind::grain_on_surface);
  CHECK(fresh[0].grain == GrainId(0));
  CHECK(fresh[0].surface == SurfaceId(0));
  CHECK(fresh[0].overlap == Approx(depth).epsilon(1e-9));
  CHECK(fresh[0].normal_force() == Approx(mass * g).epsilon(1e-9));
  CHECK((fresh[0].normal - Vec3(0, 0, -1)).norm() < 1e-15);
  CHECK(fresh[0].point.z() == Approx(-0.5 * depth).epsilon(1e-6));
  CHECK(norm(fresh[0].last.friction.slip) == 0.0);

  REQUIRE(w.run(200));
  const auto later = contacts_of(w);
  REQUIRE(later.size() == 1);
  const double slip = later[0].last.friction.slip.x;
  CHECK(slip > 0.0);
  CHECK(later[0].history.friction.slip.x ==
        Approx(slip + 1e-5 / TestType::Integrator::stages *
                          (w.velocity(GrainId(0)).x() - 1e-3 * w.angular_velocity(GrainId(0)).y()))
            .epsilon(1e-3));
}

TEST_CASE("force lines join the contacts of a pair") {
  // Two clusters that lie on each other, face on face, with four contacts, and four more on the floor.
  dem::World<models::Cubes> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<models::Cubes>());
  w.add_species(dem::shape::cube8(1e-3));
  w.add_surface(w.ground(), dem::surface::Plane{});
  w.add_grain(grain_at({0, 0, 0.999e-3}));
  w.add_grain(grain_at({0, 0, 2.998e-3}));
  const auto contacts = contacts_of(w);
  CHECK(contacts.size() == 8);
  const auto lines = dem::force_lines(contacts);
  REQUIRE(lines.size() == 2);
  for (const auto& line : lines) {
    CHECK(line.points == 4);
    CHECK(line.grain == GrainId(0));
    CHECK(line.overlap == Approx(1e-6).epsilon(1e-6));
    CHECK(line.normal_force == Approx(4 * 2000.0 * 1e-6).epsilon(1e-6));
    CHECK((line.from - Vec3(0, 0, 0.999e-3)).norm() < 1e-15);
  }
  CHECK(lines[0].other_grain == GrainId(1));
  CHECK((lines[0].to - Vec3(0, 0, 2.998e-3)).norm() < 1e-15);
  CHECK(lines[1].surface == SurfaceId(0));
  CHECK((lines[1].to - Vec3(0, 0, -0.5e-6)).norm() < 1e-9);
}

TEST_CASE("questions about grains in a box, momentum, one grain's contacts and the fabric are answered") {
  dem::World<Balls> w(options({0, 0, -g}, 1e-5));
  w.set_contact(sand<Balls>());
  const SpeciesId ball = w.add_species(Sphere(1e-3));
  // Three balls that touch along x, one that touches the middle one along y, one by itself.
  std::vector<GrainId> p;
  for (const Vec3& x : {Vec3(-1.99e-3, 0, 0), Vec3(0, 0, 0), Vec3(1.99e-3, 0, 0), Vec3(0, 1.99e-3, 0), Vec3(0, 0, 0.1)})
    p.push_back(
        w.add_grain({.species = ball, .position = x, .velocity = Vec3(1, 2, 3), .angular_velocity = {0, 0, 50}}));
  w.set_velocity(p[4], {-1, 0, 2});

  CHECK(dem::grains_in(w, {-1e-3, -1e-3, -1e-3}, {2e-3, 2e-3, 1e-3}) == std::vector{p[1], p[2], p[3]});
  CHECK(dem::grains_in(w, {0, 0, 0.1}, {0, 0, 0.1}) == std::vector{p[4]});

  CHECK_THROWS_WITH(dem::grains_in(w, {0, 0, 0.1}, {0, 0, 0}),
                    Catch::Matchers::ContainsSubstring("(0, 0, 0.1) to (0, 0, 0) m; swap its corners"));

  const dem::Momentum sum = dem::momentum_of(w);
  const double m = w.species(ball).mass;
  CHECK(sum.mass == Approx(5 * m));
  CHECK((sum.linear - m * Vec3(3, 8, 14)).norm() < 1e-14 * m);
  CHECK((sum.linear - momentum(w)).norm() < 1e-14 * m);
  CHECK((sum.angular - angular_momentum(w)).norm() < 1e-14 * m);
  CHECK((sum.centre - Vec3(0, 1.99e-3, 0.1) / 5).norm() < 1e-15);
  const Vec3 point(0.1, 0.2, 0.3);
  CHECK((dem::momentum_of(w, point).angular - (sum.angular - point.cross(sum.linear))).norm() < 1e-13 * m);

  const auto contacts = contacts_of(w);
  CHECK(dem::contacts_with(contacts, p[1]).size() == 3);
  CHECK(dem::contacts_with(contacts, p[3]).size() == 1);
  CHECK(dem::contacts_with(contacts, p[4]).empty());
  const dem::Mat3 fabric = dem::fabric_of(contacts);  // two normals along x, one along y
  CHECK((fabric - dem::Mat3(Vec3(2.0 / 3, 1.0 / 3, 0).asDiagonal())).norm() < 1e-12);
}
