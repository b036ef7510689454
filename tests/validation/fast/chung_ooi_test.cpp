#include "law/impact.hpp"
#include "world/laws.hpp"

// Tests 1, 2, 3, 6 and 7 of Chung and Ooi 2011 (Granular Matter 13:643, doi:10.1007/s10035-011-0277-0), and closed
// forms of the same kind for the other laws. (Their tests 4, 5 and 8 have measured or finite element answers.)

using Catch::Approx;

namespace {

struct Peaks {
  double force = 0.0, overlap = 0.0, duration = 0.0;
};

/// Runs until the contact of grain `a`, which has begun or is about to, is over.
template <class World, class Overlap>
Peaks pass_contact(World& w, GrainId a, Overlap&& overlap) {
  Peaks peaks;
  bool begun = false;
  while (!begun || w.force(a).norm() > 0.0) {
    if (!w.step() || w.steps() > 100000) FAIL("the contact does not end");
    const double f = w.force(a).norm();
    begun = begun || f > 0.0;
    peaks.force = std::max(peaks.force, f);
    peaks.overlap = std::max(peaks.overlap, overlap());
    peaks.duration += f > 0.0 ? w.time_step() : 0.0;
  }
  return peaks;
}

/// A ball of radius r above a plane that it is about to hit.
template <class Model>
struct Drop {
  World<Model> world;
  GrainId ball;

  Drop(const ContactParameters<Model>& p, double r, double density, const Vec3& velocity, const Vec3& spin, double dt,
       double gap = 0.0, const Vec3& gravity = {0, 0, 0})
      : world(options(gravity, dt)) {
    world.set_contact(p);
    world.add_species(Sphere(r), {"grain", density});
    world.add_surface(world.ground(), surface::Plane{});
    ball = world.add_grain(grain_at({0, 0, r + gap}, velocity, spin));
  }
  Peaks pass() {
    const double r = world.species(SpeciesId(0)).shape.bounding_radius();
    return pass_contact(world, ball, [&] { return r - world.position(ball).z(); });
  }
};

const contact::Solid rigid = {1e20, 0.3};

ContactParameters<HertzModel> hertz(const contact::ElasticPair& pair, double e, double mu = 0.0) {
  return {contact::Hertz::with_restitution(pair, e), friction::Mindlin::with(pair, mu)};
}

/// A law with the restitution e: Hertz's for the pair, the others with the stiffness k (N/m).
template <class Model>
ContactParameters<Model> frictionless(double k, const contact::ElasticPair& pair, double e) {
  if constexpr (std::is_same_v<Model, HertzModel>) return hertz(pair, e);
  else if constexpr (std::is_same_v<Model, LinearModel>) return {Linear::with_restitution(k, e), {0.0, k, 0.0}};
  else return {contact::Hysteretic::with_restitution(k, e), {}};
}

}  // namespace

TEST_CASE("Chung and Ooi 1: two spheres collide head on") {
  struct Case {
    contact::Solid solid;
    double density, force, overlap, duration;
  };
  for (const Case& c : {Case{{48e9, 0.20}, 2800.0, 10.697e3, 274.11e-6, 40.34e-6},
                        Case{{20e9, 0.25}, 2500.0, 7.108e3, 368.30e-6, 54.20e-6}}) {
    World<HertzModel> w(options({0, 0, 0}, 1e-8));
    w.set_contact(hertz(contact::elastic_pair(c.solid), 1.0));
    w.add_species(Sphere(0.01), {"grain", c.density});
    const auto a = w.add_grain(grain_at({-0.01, 0, 0}, {10, 0, 0}));
    const auto b = w.add_grain(grain_at({0.01, 0, 0}, {-10, 0, 0}));
    const Peaks peaks = pass_contact(w, a, [&] { return 0.02 - (w.position(b) - w.position(a)).norm(); });
    // Published to five, five and four digits; time to two steps of 4,000.
    CHECK(peaks.force == Approx(c.force).epsilon(1e-4));
    CHECK(peaks.overlap == Approx(c.overlap).epsilon(5e-5));
    CHECK(peaks.duration == Approx(c.duration).epsilon(6e-4));
    CHECK(w.velocity(a).x() == Approx(-10.0).epsilon(1e-5));
  }
}

TEST_CASE("Chung and Ooi 2: a sphere meets a rigid plane") {
  struct Case {
    contact::Solid solid;
    double density, force, overlap, duration;
  };
  for (const Case& c : {Case{{70e9, 0.30}, 2699.0, 11.370e3, 49.717e-6, 731.7e-6},
                        Case{{40e9, 0.35}, 1800.0, 7.233e3, 52.123e-6, 767.1e-6}}) {
    Drop<HertzModel> drop(hertz(contact::elastic_pair(c.solid, rigid), 1.0), 0.1, c.density, {0, 0, -0.2}, {0, 0, 0},
                          2e-7);
    const Peaks peaks = drop.pass();
    CHECK(peaks.force == Approx(c.force).epsilon(1e-4));
    CHECK(peaks.overlap == Approx(c.overlap).epsilon(5e-5));
    CHECK(peaks.duration == Approx(c.duration).epsilon(6e-4));
  }
}

TEST_CASE("Chung and Ooi 3: a sphere rebounds with the restitution that was asked for") {
  const auto alumina = contact::elastic_pair({3.8e11, 0.23}, rigid);
  const double r = 2.5e-3, density = 4000.0;
  // A contact of 11 us in 2,000 steps, of first order where the damper is heavy: 1e-3.
  for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    CAPTURE(e);
    Drop<HertzModel> a(hertz(alumina, e), r, density, {0, 0, -3.9}, {0, 0, 0}, 5e-9);
    a.pass();
    CHECK(a.world.velocity(a.ball).z() == Approx(3.9 * e).margin(3.9e-3));
    Drop<LinearModel> b({Linear::with_restitution(1e8, e), {0, 1e7, 0}}, r, density, {0, 0, -3.9}, {0, 0, 0}, 5e-9);
    b.pass();
    CHECK(b.world.velocity(b.ball).z() == Approx(3.9 * e).margin(3.9e-3));
    Drop<PlasticModel> c({contact::Hysteretic::with_restitution(1e8, e), {0, 0}}, r, density, {0, 0, -3.9}, {0, 0, 0},
                         5e-9);
    c.pass();
    CHECK(c.world.velocity(c.ball).z() == Approx(3.9 * e).margin(3.9e-3));
  }
}

TEST_CASE("Chung and Ooi 6: an impact that slides throughout") {
  // vx' = mu (1 + e) vn, omega' = omega0 - 5 mu (1 + e) vn/(2 r), as long as r omega0 > 7/2 mu (1 + e) vn = 0.42 m/s.
  const double r = 0.1, vn = 0.2, mu = 0.4, e = 0.5;
  const auto aluminium = contact::elastic_pair({70e9, 0.33}, rigid);
  const auto check = [&](auto& drop, double spin) {
    drop.pass();
    auto& w = drop.world;
    // The damper's force is there at first contact: mu Fn = 1.9 kN. At 20 rad/s a spring of 1.6e8 N/m takes 6 us of the
    // 0.75 ms to come up to that, so half of that impulse is missing. The arm is short by half the overlap of 5e-5 m:
    // 3e-4.
    CHECK(w.velocity(drop.ball).x() == Approx(mu * (1 + e) * vn).epsilon(5e-3));
    CHECK(w.angular_velocity(drop.ball).y() == Approx(spin - 2.5 * mu * (1 + e) * vn / r).epsilon(1e-3));
    CHECK(std::abs(w.velocity(drop.ball).y()) < 1e-12);
  };
  for (const double spin : {20.0, 80.0}) {
    // A spin about +y moves the lowest point towards -x: friction pushes to +x.
    Drop<HertzModel> a(hertz(aluminium, e, mu), r, 2700.0, {0, 0, -vn}, {0, spin, 0}, 4e-7);
    check(a, spin);
    Drop<LinearModel> b({Linear::with_restitution(2e8, e), {mu, 1.6e8, 0.1}}, r, 2700.0, {0, 0, -vn}, {0, spin, 0},
                        4e-7);
    check(b, spin);
    Drop<PlasticModel> c({contact::Hysteretic::with_restitution(2e8, e), {mu, 1e6}}, r, 2700.0, {0, 0, -vn},
                         {0, spin, 0}, 4e-7);
    check(c, spin);
  }
}

TEST_CASE("Chung and Ooi 7: two spheres with opposite spins meet head on") {
  const double r = 0.1;
  for (const double spin : {1.0, 20.0}) {
    World<HertzModel> w(options({0, 0, 0}, 4e-7));
    w.set_contact(hertz(contact::elastic_pair({70e9, 0.33}), 0.5, 0.4));
    w.add_species(Sphere(r), {"grain", 2700.0});
    const auto a = w.add_grain(grain_at({-r, 0, 0}, {0.2, 0, 0}, {0, spin, 0}));
    const auto b = w.add_grain(grain_at({r, 0, 0}, {-0.2, 0, 0}, {0, -spin, 0}));
    pass_contact(w, a, [] { return 0.0; });
    // The points in contact move alike, so there is no friction: only rounding.
    CHECK(w.angular_velocity(a).y() == Approx(spin).epsilon(1e-12));
    CHECK(w.angular_velocity(b).y() == Approx(-spin).epsilon(1e-12));
    CHECK(std::abs(w.velocity(a).z()) < 1e-12);
    CHECK(std::abs(w.velocity(b).z()) < 1e-12);
    CHECK(w.velocity(a).x() == Approx(-0.1).epsilon(1e-3));
  }
}

TEMPLATE_TEST_CASE("a ball bounces lower by the square of the restitution each time", "", LinearModel, HertzModel,
                   PlasticModel) {
  // A contact of 0.85 ms has 1,000 steps and begins anywhere within one. Where the damper is there at once, as that of
  // the linear law, half a step of it more or less is b 2 pi/1000/2 of the speed: for b < 0.15 up to 5e-4. The heights
  // of five bounces, with the squares, then scatter by 3e-3; of the other laws, 1e-3.
  // Weight acts in a contact too, with 0.02 of the largest force at first and 0.1 in the end: the restitution is that
  // of the law's own equation of motion, with weight, in 60,000 steps.
  using Law = typename TestType::Normal;
  const double r = 5e-3, h0 = 1e-3, g = 9.81, k = 1.76e4, mass = 2500 * Sphere(r).volume();
  const auto pair = contact::elastic_pair({2.9e7, 0.3}, rigid);
  for (const double e : {0.7, 0.8, 0.9}) {
    CAPTURE(e);
    const auto p = frictionless<TestType>(k, pair, e);
    Drop<TestType> drop(p, r, 2500, {0, 0, 0}, {0, 0, 0}, 8.5e-7, h0, {0, 0, -g});
    auto& w = drop.world;
    double height = h0;
    for (int bounce = 1; bounce <= 5; ++bounce) {
      while (w.velocity(drop.ball).z() <= 0.0) REQUIRE(w.run(20));
      double top = 0.0;
      while (w.velocity(drop.ball).z() > 0.0) {
        REQUIRE(w.run(20));
        top = std::max(top, w.position(drop.ball).z());
      }
      const double rebound = impact<Law>(p.normal, mass, r, std::sqrt(2 * g * height), 4e-5, 20000, g).restitution;
      CHECK(rebound == Approx(e).epsilon(0.15));  // weight keeps more of slow bounces: least 0.62 where 0.7 is asked
      height *= rebound * rebound;
      CHECK(top - r == Approx(height).epsilon(std::is_same_v<Law, Linear> ? 3e-3 : 1e-3));
    }
  }
}

TEMPLATE_TEST_CASE("heights of a stiff ball's bounces fall as powers of the restitution squared", "", LinearModel,
                   HertzModel, PlasticModel) {
  // h_n = r + e^(2 n) (h0 - r), without weight in the contacts. Contacts here are a hundred times as short as in the
  // test above: 8.5 us in 1,000 steps. So that they, not the flights between them, are what is run, each starts with
  // the speed of the fall, and the ball goes on up along its parabola. In a contact of depth D ~ v sqrt(m/k) the ball
  // falls and rises through D more, D/h = 2 m g/F of the height with the largest force F ~ v sqrt(k m): 4e-4 at first,
  // not 0.04. A damper that is there at once, as that of the linear law, acts half a step more or less: with b = 0.11,
  // 2 pi b/1000 = 7e-4 of the height.
  const double r = 5e-3, h0 = 1e-3, g = 9.81, weight = 2500 * Sphere(r).volume() * g;
  const auto pair = contact::elastic_pair({2.9e12, 0.3}, rigid);  // force grows with its power 2/5
  for (const double e : {0.7, 0.8, 0.9}) {
    double height = h0, tolerance = 0.0;
    for (int bounce = 1; bounce <= 3; ++bounce) {
      CAPTURE(e, bounce);
      Drop<TestType> drop(frictionless<TestType>(1.76e8, pair, e), r, 2500, {0, 0, -std::sqrt(2 * g * height)},
                          {0, 0, 0}, 8.5e-9, 0.0, {0, 0, -g});
      tolerance += 2 * weight / drop.pass().force + 7e-4;
      const double up = drop.world.velocity(drop.ball).z();
      height = drop.world.position(drop.ball).z() - r + up * up / (2 * g);
      CHECK(height == Approx(std::pow(e, 2 * bounce) * h0).epsilon(tolerance));
    }
    CHECK(tolerance < 5e-3);
  }
}

TEST_CASE("a pushed ball slides, and then rolls at five sevenths of its speed") {
  const double r = 5e-3, u0 = 0.2, mu = 0.3, g = 9.81;
  const auto check = [&](auto drop, double rolling_tolerance) {
    auto& w = drop.world;
    REQUIRE(w.run_for(0.01));  // sliding: u = u0 - mu g t until t = 2 u0/(7 mu g) = 19 ms
    CHECK(w.velocity(drop.ball).x() == Approx(u0 - mu * g * 0.01).epsilon(1e-3));
    REQUIRE(w.run_for(0.05));
    CHECK(w.velocity(drop.ball).x() == Approx(5.0 / 7.0 * u0).epsilon(rolling_tolerance));
    CHECK(w.angular_velocity(drop.ball).y() * r == Approx(w.velocity(drop.ball).x()).epsilon(rolling_tolerance));
  };
  const Vec3 down(0, 0, -g), push(u0, 0, 0), none(0, 0, 0);
  // Pressed in as its weight of 0.0128 N needs, so that it does not hop; the damped springs' swing is gone after the
  // 0.04 s. The arm is short by half the overlap, 1e-4 at the most.
  const auto soft = contact::elastic_pair({1e7, 0.3}, rigid);
  const double weight = 2500 * Sphere(r).volume() * g;
  const double hertz_depth = std::pow(0.75 * weight / (soft.modulus * std::sqrt(r)), 2.0 / 3.0);
  ContactParameters<HertzModel> damped = hertz(soft, 0.5, mu);
  damped.friction.damping_ratio = 0.2;
  check(Drop<HertzModel>(damped, r, 2500, push, none, 2e-6, -hertz_depth, down), 1e-3);
  check(Drop<LinearModel>({Linear::with_restitution(1e4, 0.5), {mu, 1e4, 0.2}}, r, 2500, push, none, 2e-6,
                          -weight / 1e4, down),
        1e-3);
  // A viscous ramp brings the sliding speed down as exp(-7/2 c t/m): over in 0.1 ms.
  check(Drop<PlasticModel>({contact::Hysteretic::with_restitution(1e4, 1.0), {mu, 5.0}}, r, 2500, push, none, 2e-6,
                           -weight / 1e4, down),
        1e-3);
}

TEST_CASE("friction that falls or rises with speed slows a sliding ball as its integral says") {
  // Sliding speed s: s' = -7/2 mu(s) g with mu(s) = mu0 (k + (1 - k) exp(-s/v0)), so that v0/k ln(k exp(s/v0) + 1 - k)
  // falls by 7/2 mu0 g a second.
  using Model = Laws<Linear, friction::Varying<friction::CoulombViscous>>;
  const double r = 5e-3, u0 = 0.5, mu = 0.3, v0 = 0.1, g = 9.81;
  const double weight = 2500 * Sphere(r).volume() * g;
  for (const double k : {0.4, 2.5}) {
    const double t = k < 1 ? 0.04 : 0.015;
    Drop<Model> drop({Linear::with_restitution(1e4, 0.5), {{mu, 10.0}, k, v0}}, r, 2500, {u0, 0, 0}, {0, 0, 0}, 2e-6,
                     -weight / 1e4, {0, 0, -g});
    auto& w = drop.world;
    REQUIRE(w.run_for(t));
    const double sliding = w.velocity(drop.ball).x() - r * w.angular_velocity(drop.ball).y();
    const double left = (k * std::exp(u0 / v0) + 1 - k) * std::exp(-k / v0 * 3.5 * mu * g * t);
    CHECK(sliding == Approx(v0 * std::log((left - 1 + k) / k)).epsilon(2e-3));
    CHECK(sliding > 0.1);
    // Between what the static and the kinetic share alone would leave.
    CHECK((sliding < u0 - 3.5 * k * mu * g * t) == (k < 1));
    CHECK((sliding > u0 - 3.5 * mu * g * t) == (k < 1));
  }
}

TEST_CASE("friction that depends on pressure slows a sliding ball by its weight on Hertz's circle") {
  // In balance the weight W presses on pi R d with d = (3 W/(4 E* sqrt(R)))^(2/3), so mu is the same all the way, and
  // the ball slows down by mu g. It starts at that depth, and its arm is short by half of it, 1e-3.
  using Model = Laws<contact::Hertz, friction::Varying<friction::CoulombViscous>>;
  const double r = 5e-3, u0 = 0.5, mu = 0.2, g = 9.81, t = 0.01;
  const auto soft = contact::elastic_pair({1e7, 0.3}, rigid);
  const double weight = 2500 * Sphere(r).volume() * g;
  const double depth = std::pow(0.75 * weight / (soft.modulus * std::sqrt(r)), 2.0 / 3.0);
  const double pressure = weight / (M_PI * r * depth);
  for (const double pressed : {0.5, 2.0}) {
    for (const double p0 : {0.5 * pressure, 2.0 * pressure}) {
      Drop<Model> drop({contact::Hertz::with_restitution(soft, 0.5), {{mu, 10.0}, 1.0, 1.0, pressed, p0, 1.0}}, r, 2500,
                       {u0, 0, 0}, {0, 0, 0}, 2e-6, -depth, {0, 0, -g});
      REQUIRE(drop.world.run_for(t));
      const double expected = mu * (pressed + (1 - pressed) * std::exp(-pressure / p0));
      CHECK((u0 - drop.world.velocity(drop.ball).x()) / (g * t) == Approx(expected).epsilon(2e-3));
    }
  }
}

TEST_CASE("damped grains in a box never gain energy") {
  const double r = 1e-3;
  const auto pair = contact::elastic_pair({1e7, 0.3});
  {
    World<LinearModel> w(options({0, 0, 0}));
    w.set_contact({Linear::with_restitution(2000, 0.7), {0.4, 1500, 0.1}});
    CHECK(run_box(w, Sphere(r), r, 0.3, 5000) < 0.3);
  }
  {
    World<HertzModel> w(options({0, 0, 0}));
    w.set_contact({contact::Hertz::with_restitution(pair, 0.7), friction::Mindlin::with(pair, 0.4, 0.1)});
    CHECK(run_box(w, Sphere(r), r, 0.3, 10000) < 0.3);
  }
  {
    World<PlasticModel> w(options({0, 0, 0}));
    w.set_contact({contact::Hysteretic::with_restitution(2000, 0.7), {0.4, 0.05}});
    CHECK(run_box(w, Sphere(r), r, 0.3, 5000) < 0.3);
  }
}
