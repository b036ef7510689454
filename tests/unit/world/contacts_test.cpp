#include "world/combinations.hpp"

#include <dem/world/contacts.hpp>
#include <dem/world/force_lines.hpp>

#include <map>

using Catch::Approx;
using dem::ContactKind;
using dem::contacts_of;

namespace {

/// A force and a torque, and the sum of the sizes that they were made of, against which they round.
struct SumOfContacts {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double force_size = 0.0, torque_size = 0.0;

  void add(const Vec3& f, const Vec3& t) {
    force += f;
    torque += t;
    force_size += f.norm();
    torque_size += t.norm();
  }
};

/// The contacts of a world add up to the forces of an evaluation at the same state, on grains, surfaces and bodies; and
/// the world runs on as one that was not asked. Returns how many contacts there were of each kind.
template <class Model>
std::array<int, 3> check_listed(dem::World<Model>& w) {
  dem::World<Model> evaluated = w, untouched = w;
  evaluated.set_gravity(evaluated.state().options.gravity);  // forces at the present state are due
  evaluated.prepare();

  std::map<std::uint32_t, SumOfContacts> grains, surfaces, pairs;
  std::array<int, 3> count = {};
  for (const auto& c : contacts_of(w)) {
    ++count[static_cast<std::size_t>(c.kind)];
    CHECK(c.normal.norm() == Approx(1.0).epsilon(1e-9));
    CHECK((c.force + c.normal_force() * c.normal - c.tangential_force()).norm() <= 1e-15 * c.force.norm());
    CHECK(std::abs(c.tangential_force().dot(c.normal)) <= 1e-9 * c.force.norm());
    if (c.kind != ContactKind::bodies) grains[c.grain.value].add(c.force, c.torque);
    if (c.kind == ContactKind::grains) grains[c.other_grain.value].add(-c.force, c.other_torque);
    if (c.kind == ContactKind::grain_on_surface) surfaces[c.surface.value].add(-c.force, c.other_torque);
    if (c.kind != ContactKind::bodies) {
      CHECK((c.centre() - w.position(c.grain)).norm() < 1e-15 * (1.0 + w.position(c.grain).norm()));
    }
    if (c.kind == ContactKind::bodies) {
      const bool back = c.own_surface != w.state().body_contacts.pairs[c.pair.index()].a;
      pairs[c.pair.value].add(back ? Vec3(-c.force) : c.force, c.torque);
    }
  }
  // Sums in another order: each of some ten terms rounds by 1e-16.
  const auto check = [](const SumOfContacts& sum, const Vec3& force, const Vec3& torque) {
    CHECK((sum.force - force).norm() <= 1e-14 * sum.force_size);
    CHECK((sum.torque - torque).norm() <= 1e-14 * sum.torque_size);
  };
  for (const ParticleId p : w.particles()) check(grains[p.value], evaluated.force(p), evaluated.torque(p));
  for (std::size_t s = 0; s < w.state().surfaces.size(); ++s) {
    check(surfaces[static_cast<std::uint32_t>(s)], evaluated.surface_force(SurfaceId(s)),
          evaluated.surface_torque(SurfaceId(s)));
  }
  for (const auto& [pair, sum] : pairs) {
    CHECK((sum.force - evaluated.body_contact_force(dem::BodyContactId(pair))).norm() <= 1e-14 * sum.force_size);
  }

  REQUIRE(w.run(50));
  REQUIRE(untouched.run(50));
  int differ = 0;
  for (const ParticleId p : w.particles()) {
    differ += w.position(p) != untouched.position(p) || w.rotation(p) != untouched.rotation(p) ||
              w.angular_velocity(p) != untouched.angular_velocity(p);
  }
  CHECK(differ == 0);
  return count;
}

/// Grains that fall into a box, with a plate on its way down onto them.
template <class Model>
void add_bed_and_plate(dem::World<Model>& w, double pitch, int per_edge) {
  const double edge = per_edge * pitch;
  add_open_box(w, {edge, edge, 0});
  for (int k = 0; k < per_edge * per_edge * per_edge; ++k) {
    dem::NewParticle n =
        grain_at(pitch * (Vec3(k % per_edge, k / per_edge % per_edge, k / (per_edge * per_edge)) + Vec3::Constant(0.5)),
                 {0.05 * (k % 3 - 1), 0.04 * (k % 5 - 2), -0.2}, {3.0 * (k % 7 - 3), 5, 0});
    n.species = SpeciesId(static_cast<std::size_t>(k) % w.state().species.size());
    n.rotation = Random(static_cast<unsigned>(k)).rotation();
    w.add_particle(n);
  }
  auto& m = w.machine();
  const Vec3 edges(0.9 * edge, 0.9 * edge, pitch);
  const auto plate = m.add_body(dem::mbd::box_body("plate", edges, 3000)
                                    .at({0.5 * edge, 0.5 * edge, (per_edge + 0.6) * pitch})
                                    .moving({0, 0, -0.2}));
  const auto box = w.add_surface(plate, dem::surface::Box(edges));
  // A block that lies on the plate.
  const Vec3 small = 0.3 * edges;
  const auto block =
      m.add_body(dem::mbd::box_body("block", small, 3000)
                     .at({0.5 * edge, 0.5 * edge, (per_edge + 0.6) * pitch + 0.5 * (edges.z() + small.z()) - 2e-5})
                     .moving({0, 0, -0.2}));
  w.add_body_contact(box, w.add_surface(block, dem::surface::Box(small)));
}

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

TEST_CASE("listed contacts add up to the forces on grains, surfaces and bodies, and asking changes nothing") {
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

// One model has every shape, a law with histories of all kinds, patches and searches that remember.
TEST_CASE("listed contacts of all shapes in one world add up to the forces, and asking changes nothing") {
  using All = combinations::ElasticGrains<combinations::SeveralKinds>;
  dem::World<All> w(options({0, 0, -g}, 3e-6));
  w.set_contact(combinations::constants_of<All>());
  w.add_species(Sphere(1e-3));
  w.add_species(dem::shape::cube8(0.8e-3));
  w.add_species(dem::shape::cube(0.8e-3));
  w.add_species(combinations::Superquadric({1e-3, 0.9e-3, 0.8e-3}, {4, 4, 4}));
  add_bed_and_plate(w, 2.1e-3, 4);
  REQUIRE(w.run(800));
  const auto count = check_listed(w);
  CHECK(count[0] > 40);
  CHECK(count[1] > 20);
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
    const ParticleId p(id);
    if (!p.valid()) continue;  // of two bodies
    const double mass = mass_of(w, p);
    const Vec3 moved = mass * (w.velocity(p) - before.velocity(p)) / 1e-5 - mass * Vec3(0, 0, -g);
    // The difference of velocities of 0.2 m/s rounds by 3e-17 m/s, so the force by 4e-17 kg m/s over 1e-5 s.
    CHECK((moved - force).norm() < 1e-14 * force.norm() + mass * 1e-10);
  }
}

TEST_CASE("a listed contact tells what its laws remember") {
  // A ball that is pressed on a plane by its weight and pushed aside sticks by its spring: K d = m g, kt s = force.
  dem::World<Balls> w(options({1.0, 0, -g}, 1e-5));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(1e-3));
  w.add_surface(w.ground(), dem::surface::Plane{});
  const double mass = w.species(SpeciesId(0)).mass, depth = mass * g / 2000.0;
  w.add_particle(grain_at({0, 0, 1e-3 - depth}));
  const auto fresh = contacts_of(w);
  REQUIRE(fresh.size() == 1);
  CHECK(fresh[0].kind == ContactKind::grain_on_surface);
  CHECK(fresh[0].grain == ParticleId(0));
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
        Approx(slip + 1e-5 * (w.velocity(ParticleId(0)).x() - 1e-3 * w.angular_velocity(ParticleId(0)).y()))
            .epsilon(1e-3));
}

TEST_CASE("force lines join the contacts of a pair") {
  // Two clusters that lie on each other, face on face, with four contacts, and four more on the floor.
  dem::World<models::Cubes> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<models::Cubes>());
  w.add_species(dem::shape::cube8(1e-3));
  w.add_surface(w.ground(), dem::surface::Plane{});
  w.add_particle(grain_at({0, 0, 0.999e-3}));
  w.add_particle(grain_at({0, 0, 2.998e-3}));
  const auto contacts = contacts_of(w);
  CHECK(contacts.size() == 8);
  const auto lines = dem::force_lines(contacts);
  REQUIRE(lines.size() == 2);
  for (const auto& line : lines) {
    CHECK(line.points == 4);
    CHECK(line.grain == ParticleId(0));
    CHECK(line.overlap == Approx(1e-6).epsilon(1e-6));
    CHECK(line.normal_force == Approx(4 * 2000.0 * 1e-6).epsilon(1e-6));
    CHECK((line.from - Vec3(0, 0, 0.999e-3)).norm() < 1e-15);
  }
  CHECK(lines[0].other_grain == ParticleId(1));
  CHECK((lines[0].to - Vec3(0, 0, 2.998e-3)).norm() < 1e-15);
  CHECK(lines[1].surface == SurfaceId(0));
  CHECK((lines[1].to - Vec3(0, 0, -0.5e-6)).norm() < 1e-9);
}
