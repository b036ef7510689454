#include "core/error_of.hpp"
#include "world/laws.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>

using Catch::Approx;
using dem::surface::Box;
using dem::surface::Plane;
using dem::surface::TriangleMesh;
namespace mesh = dem::mesh;

namespace {

const contact::ElasticPair rubber = {2e6, 5e5};

/// A ball of radius r and density rho over ground of some kind whose top is z = 0; as a body, or as a grain.
constexpr double r = 1e-3, density = 2500.0;
const double mass = density * Sphere(r).volume();
template <class Model>
struct OnGround {
  World<Model> world;
  BodyId body;
  GrainId grain;
  BodyContactId contact;
  bool is_body;

  OnGround(bool as_body, const typename Model::Surfaces& ground, const ContactParameters<Model>& p, double gap,
           const Vec3& velocity, double dt)
      : world(options({0, 0, 0}, dt)), is_body(as_body) {
    world.set_contact(p);
    SurfaceOptions o;
    o.position = {0, 0, std::holds_alternative<Plane>(ground) ? 0.0 : -0.05};
    const auto s = world.add_surface(world.ground(), ground, o);
    const Vec3 at(1e-3, 2e-3, r + gap);
    if (is_body) {
      body = world.machine().add_body(mbd::sphere_body("ball", r, density).at(at).moving(velocity));
      contact = world.add_body_contact(world.add_surface(body, surface::Sphere(r)), s);
    } else {
      world.add_species(Sphere(r), {"grain", density});
      grain = world.add_grain(grain_at(at, velocity));
    }
  }
  Vec3 position() const { return is_body ? world.machine().body(body).position() : world.position(grain); }
  double gap() const { return position().z() - r; }
};
template <class Model>
std::vector<typename Model::Surfaces> grounds() {
  return {Plane{}, Box({0.1, 0.1, 0.1}), TriangleMesh(mesh::box({0.1, 0.1, 0.1}, 3))};
}

using JkrModel = Laws<contact::Hertz, friction::Mindlin, rolling::None, cohesion::JKR>;
using WetModel = Laws<Linear, friction::CundallStrack, rolling::None, cohesion::LiquidBridge>;

constexpr double work = 0.5;
const contact::ElasticPair soft = {1e7, 3e6};
const ContactParameters<JkrModel> sticky = {contact::Hertz::with_restitution(soft, 0.2),
                                            friction::Mindlin::with(soft, 0.0),
                                            {},
                                            cohesion::JKR::with(soft, work)};

}  // namespace

TEST_CASE("a ball body settles on Hertz's spring, and rolls with Mindlin's friction") {
  for (const auto& ground : grounds<HertzModel>()) {
    CAPTURE(ground.index());
    const ContactParameters<HertzModel> p = {contact::Hertz::with_restitution(rubber, 0.3),
                                             friction::Mindlin::with_restitution(rubber, 0.6, 0.3)};
    OnGround<HertzModel> ball(true, ground, p, 0.0, {0, 0, 0}, 2e-6);
    ball.world.set_gravity({0, 0, -g});
    REQUIRE(ball.world.run_for(0.1));
    const double depth = std::pow(0.75 * mass * g / (rubber.modulus * std::sqrt(r)), 2.0 / 3.0);
    CHECK(-ball.gap() == Approx(depth).epsilon(1e-6));
    CHECK(ball.world.body_contact_force(ball.contact).z() == Approx(mass * g).epsilon(1e-9));
    // Tilted, it rolls without slip: the lever is shorter by half the depth, 1e-3 of r.
    const double angle = 0.2;
    ball.world.set_gravity({g * std::sin(angle), 0, -g * std::cos(angle)});
    REQUIRE(ball.world.run_for(0.02));
    const double v = ball.world.machine().body(ball.body).velocity().x();
    REQUIRE(ball.world.run_for(0.03));
    const double gained = ball.world.machine().body(ball.body).velocity().x() - v;
    CHECK(gained / 0.03 == Approx(5.0 / 7.0 * g * std::sin(angle)).epsilon(2e-3));
  }
}

TEST_CASE("a block on a slab is one Hertz contact of its own size, whichever of them is named first, however cut") {
  // Both show points; all contacts of the pair have the radius of the smaller one, half its smallest edge.
  const Vec3 edges(0.2, 0.1, 0.08);
  const double depth = 1e-4, R = 0.04;
  const double force = 4.0 / 3.0 * rubber.modulus * std::sqrt(R) * std::pow(depth, 1.5);
  for (const int pieces : {1, 37}) {
    for (const HertzModel::Surfaces& block : {HertzModel::Surfaces(Box(edges)), {TriangleMesh(mesh::box(edges, 4))}}) {
      for (const bool slab_first : {false, true}) {
        CAPTURE(pieces, block.index(), slab_first);
        World<HertzModel> w(options({0, 0, 0}));
        w.set_contact({contact::Hertz::with_restitution(rubber, 1.0), friction::Mindlin::with(rubber, 0.5)});
        const auto body = w.machine().add_body(mbd::box_body("block", edges, 1000.0).at({0, 0, 0.04 - depth}));
        SurfaceOptions o;
        o.position = {0.013, 0.017, -0.2};
        const auto upper = w.add_surface(body, block);
        const auto lower = w.add_surface(w.ground(), TriangleMesh(mesh::box({3, 3, 0.4}, pieces)), o);
        const auto contact = slab_first ? w.add_body_contact(lower, upper) : w.add_body_contact(upper, lower);
        w.prepare();
        CHECK(w.body_contact_force(contact).z() * (slab_first ? -1.0 : 1.0) == Approx(force).epsilon(1e-9));
        CHECK(w.state().body_contacts.worst_overlap == Approx(depth / (2 * R)).epsilon(1e-9));
        // The stiffest contact is taken at overlap_limit effective diameters: 2 E* sqrt(R d), of two sides that are
        // twice as stiff each, at the far corner.
        const double limit = w.state().options.overlap_limit;
        const double k = 4.0 * 2.0 * rubber.modulus * std::sqrt(R * 2 * R * limit);
        const double m = 1.6, I = m / 12 * (0.01 + 0.0064),
                     inverse_effective_mass = 1 / m + 0.25 * edges.squaredNorm() / I;
        CHECK(w.stable_time_step().dt == Approx(2.0 / std::sqrt(k * inverse_effective_mass)));
      }
    }
  }
}

TEST_CASE("JKR holds a ball body as it holds a grain, across a gap") {
  const double pull_off = 1.5 * M_PI * work * r, reach = cohesion::JKR::range(sticky.cohesion, r);
  for (const auto& ground : grounds<JkrModel>()) {
    CAPTURE(ground.index());
    OnGround<JkrModel> body(true, ground, sticky, -1e-7, {0, 0, 0}, 1e-6),
        grain(false, ground, sticky, -1e-7, {0, 0, 0}, 1e-6);
    double widest = -1.0;
    for (const double share : {0.5, 0.9, 0.98, 1.02}) {
      // Loads grow slowly, in steps of half a percent and less.
      for (int k = 0; k < 100; ++k) {
        const double before = share > 0.95 ? share - 0.04 : share > 0.6 ? 0.5 : 0.0;
        const Vec3 up(0, 0, (before + (share - before) * (k + 1) / 100) * pull_off / mass);
        body.world.set_gravity(up);
        grain.world.set_gravity(up);
        REQUIRE(body.world.run(60));
        REQUIRE(grain.world.run(60));
        if (share < 1.0) {
          CHECK((body.position() - grain.position()).norm() < 1e-12);
          widest = std::max(widest, body.gap());
        }
      }
      REQUIRE(body.world.run(3000));
      REQUIRE(grain.world.run(3000));
      CHECK((body.gap() <= reach) == (share < 1.0));
      CHECK((grain.gap() <= reach) == (share < 1.0));
    }
    CHECK(widest > 0.0);  // it was held across a gap
  }
}

TEST_CASE("a liquid bridge pulls two ball bodies together until it breaks") {
  const auto water = cohesion::LiquidBridge::of(0.072, 0.0, 2.7e-11);
  World<WetModel> w(options({0, 0, 0}, 1e-6));
  w.set_contact({Linear::with_restitution(2000.0, 1.0), {0.0, 1.0, 0.0}, {}, water});
  auto& m = w.machine();
  const auto a = m.add_body(mbd::sphere_body("a", r, density));
  const auto b = m.add_body(mbd::sphere_body("b", 2 * r, density).at({3 * r - 1e-6, 0, 0}).moving({0.3, 0, 0}));
  const auto contact =
      w.add_body_contact(w.add_surface(a, surface::Sphere(r)), w.add_surface(b, surface::Sphere(2 * r)));
  const double R = r * 2 * r / (3 * r);
  int seen = 0;
  for (double gap = -1.0; gap < 1.2 * water.rupture; ++seen) {
    REQUIRE(w.run(10));
    // Forces are those of the step's beginning, at most 0.3 m/s 1e-6 s before.
    gap = (m.body(b).position() - m.body(a).position()).norm() - 3 * r;
    const double s = gap * std::sqrt(2 * R / water.volume);
    const double pull = 4 * M_PI * R * water.wetting_tension / (1 + 1.05 * s + 2.5 * s * s);
    if (gap > 1e-6 && gap < 0.99 * water.rupture) {
      CHECK(w.body_contact_force(contact).x() == Approx(pull).epsilon(4e-3));
    }
    if (gap > 1.01 * water.rupture) CHECK(w.body_contact_force(contact).norm() == 0.0);
  }
  CHECK(seen > 50);
}

TEST_CASE("cohesion at a distance between bodies of which none is a ball is refused, unless it is zero") {
  const auto world_with = [](double adhesion) {
    World<JkrModel> w(options({0, 0, -g}));
    w.set_contact({contact::Hertz::with_restitution(soft, 0.5),
                   friction::Mindlin::with(soft, 0.5),
                   {},
                   cohesion::JKR::with(soft, adhesion)});
    const auto body = w.machine().add_body(mbd::box_body("crate", {0.1, 0.1, 0.1}, 1000.0).at({0, 0, 0.05}));
    w.add_body_contact(w.add_surface(body, Box({0.1, 0.1, 0.1})), w.add_surface(w.ground(), Plane{}));
    w.prepare();
  };
  check_refused([&] { world_with(0.5); }, "body 'crate' and body 'ground'", "attract each other up to a gap of",
                "without cohesion", "surface::Sphere");
  world_with(0.0);
}
