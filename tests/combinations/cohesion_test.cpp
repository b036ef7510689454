#include "world/laws.hpp"

#include <dem/geometry/mixed.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>

namespace cohesion_test {

using Catch::Approx;

namespace {

using JkrModel = Laws<contact::Hertz, friction::Mindlin, rolling::None, cohesion::JKR>;
using StickyModel = Laws<Linear, friction::CundallStrack, rolling::None, cohesion::Constant>;
template <class S>
struct Wet : Laws<Linear, friction::CundallStrack, rolling::None, cohesion::LiquidBridge, S> {
  using Executor = exec::Threads;
};
using WetModel = Wet<Sphere>;
using shape::Superquadric;
using Any = shape::Mixed<Sphere, Cube8, Superquadric>;
/// Grains of a shape, in a world of that shape or of more.
template <class S, class OfWorld = S>
struct Grain {
  using Shape = S;
  using Model = Wet<OfWorld>;
};

constexpr double r = 1e-3, density = 2500.0, stiffness = 2000.0;
const double mass = density * Sphere(r).volume();

// Soft and sticky: pull-off at 2.4e-3 N, 225 times the weight.
constexpr double work = 0.5;
const contact::ElasticPair soft = {1e7, 3e6};
const double pull_off = 1.5 * M_PI * work * r;
const double unit = std::cbrt(2.0 * M_PI * work * r * r / soft.modulus);  // of the contact radius
// Energy (J) that JKR takes from an impact: what tearing costs beyond the overlap 0, minus what the jump at first
// contact does not give back. The integral of F dd over the curve from x = a/unit = 1 (first contact) to 4^(-2/3)
// (pull-off) is pi w unit^2 [16/15 x^5 - 8/3 x^(7/2) + x^2].
const double torn = [] {
  const auto f = [](double x) { return 16.0 / 15.0 * std::pow(x, 5) - 8.0 / 3.0 * std::pow(x, 3.5) + x * x; };
  return M_PI * work * unit * unit * (f(std::pow(4.0, -2.0 / 3.0)) - f(1.0));
}();

ContactParameters<JkrModel> jkr(double e, double mu = 0.0) {
  return {contact::Hertz::with_restitution(soft, e),
          friction::Mindlin::with(soft, mu),
          {},
          cohesion::JKR::with(soft, work)};
}
const cohesion::LiquidBridge::Parameters<double> water = cohesion::LiquidBridge::of(0.072, 0.0, 2.7e-11);  // 0.3 mm
template <class Model = WetModel>
ContactParameters<Model> wet(double e) {
  return {Linear::with_restitution(stiffness, e), {0.0, 1.0, 0.0}, {}, water};
}
double bridge_force(double gap) {
  const double s = gap * std::sqrt(2 * r / water.volume);
  return 4 * M_PI * r * water.wetting_tension / (1 + 1.05 * s + 2.5 * s * s);
}
/// Work (J) of tearing a bridge between a ball and a plane.
const double drawn = [] {
  double sum = 0.0;
  const int n = 100000;
  for (int k = 0; k < n; ++k) sum += bridge_force((k + 0.5) * water.rupture / n) * water.rupture / n;
  return sum;
}();

/// A ball over a plane.
template <class Model>
struct OnPlane {
  World<Model> world;
  GrainId id;

  OnPlane(const ContactParameters<Model>& p, double gap, const Vec3& velocity, double dt, bool box = false)
      : world(options({0, 0, 0}, dt)) {
    world.set_contact(p);
    world.add_species(Sphere(r), {"grain", density});
    SurfaceOptions o;
    o.position = {0, 0, box ? -0.5 : 0.0};
    if (box) {
      world.add_surface(world.ground(), surface::Box({1, 1, 1}), o);
    } else {
      world.add_surface(world.ground(), surface::Plane{}, o);
    }
    id = world.add_grain(grain_at({0, 0, r + gap}, velocity));
  }
  double gap() const { return world.position(id).z() - r; }
  double speed() const { return world.velocity(id).z(); }
};

/// Pulls at the ball with a force that grows slowly to `force` (N), and says whether it still sticks.
template <class Model>
bool holds(OnPlane<Model>& ball, double from, double to, double range) {
  for (int k = 0; k < 100; ++k) {
    ball.world.set_gravity({0, 0, (from + (to - from) * (k + 1) / 100) / mass});
    REQUIRE(ball.world.run(60));
  }
  REQUIRE(ball.world.run(3000));
  return ball.gap() <= range;
}

/// Six by six by so many wet spheres that move at random in an open box.
template <class Model>
void add_wet_spheres(World<Model>& w, int layers) {
  w.set_contact(wet<Model>(0.5));
  const auto species = w.add_species(Sphere(r), {"grain", density});
  add_open_box(w, {14e-3, 14e-3, 1});
  add_block(w, species, Vec3::Constant(1.05e-3), 2.02e-3, 6, 6, layers, 0.3);
}

}  // namespace

TEST_CASE("cohesion holds a ball up to its pull-off force") {
  // Loads go up in steps of 1 % and less, over ten swings of the ball: 2 % on either side.
  const auto check = [](auto ball, double force, double range) {
    CHECK(holds(ball, 0.0, 0.9 * force, range));
    CHECK(holds(ball, 0.9 * force, 0.98 * force, range));
    CHECK_FALSE(holds(ball, 0.98 * force, 1.02 * force, range));
  };
  check(OnPlane<JkrModel>(jkr(0.2), -0.57 * unit * unit / r, {0, 0, 0}, 1e-6), pull_off,
        cohesion::JKR::range(jkr(0.2).cohesion, r));
  check(OnPlane<StickyModel>({Linear::with_restitution(stiffness, 0.2), {0, 1, 0}, {}, {2e-3}}, -1e-6, {0, 0, 0}, 3e-6),
        2e-3, 0.0);
  check(OnPlane<WetModel>(wet(0.2), -4 * M_PI * r * 0.072 / stiffness, {0, 0, 0}, 3e-6), 4 * M_PI * r * 0.072,
        0.5 * water.rupture);
}

TEST_CASE("JKR takes the work of tearing from an impact, and catches what is too slow") {
  const double capture = std::sqrt(2 * torn / mass);
  for (const double speed : {1.06 * capture, 2 * capture, 5 * capture}) {
    OnPlane<JkrModel> ball(jkr(1.0), 1e-7, {0, 0, -speed}, 2e-7);
    REQUIRE(ball.world.run_for(2e-3));
    CAPTURE(speed, capture);
    // First contact and pull-off fall anywhere within steps of 2e-7 s v: 2 % of the torn energy.
    CHECK(ball.speed() * ball.speed() == Approx(speed * speed - 2 * torn / mass).margin(0.02 * capture * capture));
    CHECK(ball.gap() > 0.0);
  }
  OnPlane<JkrModel> caught(jkr(1.0), 1e-7, {0, 0, -0.94 * capture}, 2e-7);
  REQUIRE(caught.world.run_for(2e-3));
  CHECK(caught.gap() < cohesion::JKR::range(jkr(1.0).cohesion, r));
}

TEST_CASE("a liquid bridge pulls after first contact only, over its distance, and takes its work") {
  const double speed = 0.2;
  for (const bool box : {false, true}) {
    OnPlane<WetModel> ball(wet(1.0), 0.9 * water.rupture, {0, 0, -speed}, 1e-6, box);
    auto& w = ball.world;
    double at = ball.gap();
    while (at > 1e-6) {
      CHECK(w.force(ball.id).norm() == 0.0);
      REQUIRE(w.run(10));
      at = ball.gap();
    }
    while (ball.gap() <= 0.0 || ball.speed() <= 0.0) REQUIRE(w.step());
    int seen = 0;
    while (ball.gap() < water.rupture) {
      CHECK(w.force(ball.id).z() == Approx(-bridge_force(ball.gap())).epsilon(1e-9));
      REQUIRE(w.run(20));
      ++seen;
    }
    CHECK(seen > 20);
    REQUIRE(w.step());
    CHECK(w.force(ball.id).norm() == 0.0);
    // A step of 1e-6 s is 0.07 % of the way at either end.
    CHECK(ball.speed() * ball.speed() == Approx(speed * speed - 2 * drawn / mass).epsilon(2e-3));
    CHECK(drawn / (0.5 * mass * speed * speed) > 0.2);
  }
}

TEMPLATE_TEST_CASE("grains find partners as far away as bridges reach, whatever the skin", "", Grain<Sphere>,
                   Grain<Superquadric>, (Grain<Cube8, Any>), (Grain<Superquadric, Any>),
                   (Grain<Cube8, shape::Mixed<Cube8>>)) {
  // Two grains part at once; the neighbour list's skin is a thirtieth of the bridge. Clusters face each other with a
  // ball of each.
  using Shape = typename TestType::Shape;
  using Model = typename TestType::Model;
  const auto shape = [] {
    if constexpr (std::is_same_v<Shape, Sphere>) {
      return Sphere(r);
    } else if constexpr (std::is_same_v<Shape, Superquadric>) {
      return Superquadric(Vec3::Constant(r), {2, 2, 2});  // a ball, too
    } else {
      const Ball balls[] = {{{0, 0, 0}, r}, {{1.5 * r, 0, 0}, r}};  // of the eight that it may have
      return Cube8(balls);
    }
  }();
  for (const bool joined : {true, false}) {
    World<Model> w(options({0, 0, 0}, 1e-6, 1e-5));
    w.set_contact(wet<Model>(1.0));
    w.add_species(shape, {"grain", density});
    const double reach = shape.bounding_radius(), start = joined ? -1e-6 : 1e-9;
    const auto a = w.add_grain(grain_at({0, 0, 0}));
    const auto b = w.add_grain(grain_at({2 * reach + start, 0, 0}, {0.3, 0, 0}));
    const Vec3 p = momentum(w);
    const auto gap = [&] { return (w.position(b) - w.position(a)).norm() - 2 * reach; };
    // Spheres of radius r each: R* = r/2.
    const auto pull = [&](double d) {
      return 2 * M_PI * r * 0.072 / (1 + 1.05 * d * std::sqrt(r / water.volume) + 2.5 * d * d * r / water.volume);
    };
    w.prepare();
    int seen = 0;
    while (gap() < 0.99 * water.rupture) {
      REQUIRE(w.run(10));
      const double expected = joined ? pull(gap()) : 0.0;
      // The search for superquadrics leaves the gap wrong by up to 1e-12 m of the 3e-4 m that the bridge is long.
      if (gap() < water.rupture) CHECK(w.force(a).x() == Approx(expected).epsilon(1e-7).margin(1e-15));
      ++seen;
    }
    CHECK(seen > 50);
    REQUIRE(w.run(200));
    CHECK(gap() > water.rupture);
    CHECK(w.force(a).norm() == 0.0);
    CHECK((momentum(w) - p).norm() < 1e-12 * p.norm());
    CHECK(w.state().rebuilds > 5);
  }
}

TEST_CASE("wet spheres do among wet clusters what they do alone, to the bit") {
  // Without friction nothing turns, and what does not turn is the same whether the model keeps a rotation or not.
  const auto run = [](auto& w) {
    add_wet_spheres(w, 8);  // two chunks
    REQUIRE(w.run(1000));
    std::vector<Vec3> places;
    for_each_grain(w, [&](GrainId p) { places.push_back(w.position(p)); });
    return places;
  };
  World<WetModel> alone(options({0, 0, -9.81}, 5e-6, 1e-4));
  World<Wet<Any>> among(options({0, 0, -9.81}, 5e-6, 1e-4));
  CHECK(run(among) == run(alone));
}

TEST_CASE("a bridge between a sphere and a ball of a cluster pulls as between two spheres") {
  // The cube shows a corner ball of radius h/2 = r to a sphere of radius r beyond it on the diagonal, and parts from
  // it.
  using Model = Wet<Any>;
  for (const bool cube_first : {true, false}) {
    World<Model> w(options({0, 0, 0}, 1e-6, 1e-5));
    w.set_contact(wet<Model>(1.0));
    const auto ball = w.add_species(Sphere(r), {"grain", density}),
               cube = w.add_species(shape::cube8(2 * r), {"grain", density});
    const Vec3 diagonal = Vec3::Ones().normalized();
    const double apart = std::sqrt(3.0) * r + 2 * r;  // of the centres when they touch
    NewGrain grains[] = {grain_at({0, 0, 0}), grain_at((apart - 1e-6) * diagonal, 0.3 * diagonal)};
    grains[0].species = cube;
    grains[1].species = ball;
    const auto first = w.add_grain(grains[cube_first ? 0 : 1]), second = w.add_grain(grains[cube_first ? 1 : 0]);
    const auto a = cube_first ? first : second, b = cube_first ? second : first;
    const Vec3 p = momentum(w);
    int seen = 0;
    for (double gap = 0.0; gap < 0.99 * water.rupture; ++seen) {
      REQUIRE(w.run(10));
      gap = (w.position(b) - w.position(a)).norm() - apart;
      // R* = r/2. The other balls of the cube are 2 r farther away.
      const double s = gap * std::sqrt(r / water.volume);
      const double pull = 2 * M_PI * r * 0.072 / (1 + 1.05 * s + 2.5 * s * s);
      if (gap > 0.0 && gap < water.rupture) CHECK((w.force(a) - pull * diagonal).norm() < 1e-9 * pull);
    }
    CHECK(seen > 50);
    REQUIRE(w.run(200));
    CHECK(w.force(a).norm() == 0.0);
    CHECK((momentum(w) - p).norm() < 1e-12 * p.norm());
  }
}

TEST_CASE("a bridge between an ellipsoid and a floor is one contact") {
  using Model = Wet<Any>;
  const Superquadric egg({1.2 * r, r, 0.9 * r}, {2, 2, 2});
  World<Model> w(options({0, 0, 0}, 1e-6));
  w.set_contact(wet<Model>(1.0));
  w.add_species(egg, {"grain", density});
  w.add_surface(w.ground(), surface::Plane{});
  const auto id = w.add_grain(grain_at({0, 0, 0.9 * r - 1e-6}, {0, 0, 0.2}));
  int seen = 0;
  for (double gap = 0.0; gap < 0.9 * water.rupture; ++seen) {
    REQUIRE(w.run(10));
    gap = w.position(id).z() - 0.9 * r;
    const double s = gap * std::sqrt(2 * egg.mean_radius() / water.volume);
    const double pull = 4 * M_PI * egg.mean_radius() * water.wetting_tension / (1 + 1.05 * s + 2.5 * s * s);
    if (gap > 0.0) CHECK(-w.force(id).z() == Approx(pull).epsilon(1e-9));
  }
  CHECK(seen > 20);
  REQUIRE(w.run_for(water.rupture / 0.1));
  CHECK(w.force(id).norm() == 0.0);
}

TEST_CASE("wet grains go the same way, to the bit, on any number of threads") {
  const auto run = [](int threads) {
    WorldOptions o = options({0, 0, -9.81}, 5e-6, 1e-4);
    o.threads = threads;
    World<WetModel> w(o);
    add_wet_spheres(w, 15);  // three chunks
    REQUIRE(w.run(300));
    std::vector<Vec3> all;
    for_each_grain(w, [&](GrainId p) { all.push_back(w.position(p)); });
    for_each_grain(w, [&](GrainId p) { all.push_back(w.angular_velocity(p)); });
    return std::pair(all, w.state().rebuilds);
  };
  const auto [one, rebuilds] = run(1);
  CHECK(rebuilds > 1);
  CHECK(run(2).first == one);
  CHECK(run(3).first == one);
}

TEST_CASE("what cohesion presses together rubs") {
  // Weightless balls that cohesion holds on a plane slide: constant pull F, mu F; JKR without a load, mu x twice the
  // pull-off force.
  const double mu = 0.3, u0 = 2.0, t = 1e-3;
  OnPlane<StickyModel> constant({Linear::with_restitution(stiffness, 0.5), {mu, 1e4, 0}, {}, {2e-3}}, -2e-3 / stiffness,
                                {u0, 0, 0}, 1e-6);
  REQUIRE(constant.world.run_for(t));
  CHECK(u0 - constant.world.velocity(constant.id).x() == Approx(mu * 2e-3 / mass * t).epsilon(1e-3));
  // Zero load at x^(3/2) = 3/2: D = x^2 - sqrt(x).
  const double x = std::pow(1.5, 2.0 / 3.0), depth = (x * x - std::sqrt(x)) * unit * unit / r;
  OnPlane<JkrModel> jkr_ball(jkr(0.5, mu), -depth, {u0, 0, 0}, 1e-6);
  REQUIRE(jkr_ball.world.run_for(t));
  CHECK(jkr_ball.gap() == Approx(-depth).epsilon(1e-3));
  CHECK(u0 - jkr_ball.world.velocity(jkr_ball.id).x() == Approx(mu * 2 * pull_off / mass * t).epsilon(1e-3));
}

TEST_CASE("two grains that swing in an undamped pull across gaps keep their energy") {
  // Two balls that meet beside their middles, too slow to part. Where they pass first contact, at v = 2 v0, the slope
  // of the force jumps by at most k, and a step of dt that this falls into errs by at most k (v dt)^2/8. Signs are
  // random, so N passages err by the root of N times that; three times it is the bound. Within each side Verlet has no
  // trend.
  const auto check = [](auto& w, double v0, double k) {
    w.add_species(Sphere(r), {"grain", density});
    const double across = 0.7 * r, along = std::sqrt(4 * r * r - across * across);
    const auto a = w.add_grain(grain_at({0, 0, 0}, {v0, 0, 0}));
    const auto b = w.add_grain(grain_at({along - 1e-6, across, 0}, {-v0, 0, 0}));
    const auto gap = [&] { return (w.position(a) - w.position(b)).norm() - 2 * r; };
    double most[2] = {0, 0};  // kinetic energy in the first tenth and in the last
    int passages = 0;
    const int steps = 100000;
    REQUIRE(w.step());
    for (int n = 0; n < steps; ++n) {
      const bool apart = gap() > 0.0;
      REQUIRE(w.step());
      passages += (gap() > 0.0) != apart ? 1 : 0;
      if (n < steps / 10) most[0] = std::max(most[0], kinetic_energy(w));
      if (n >= steps - steps / 10) most[1] = std::max(most[1], kinetic_energy(w));
    }
    INFO(passages << " passages, " << gap() / r << " apart");
    CHECK(passages > 20);
    const double dt = w.time_step(), once = k * 4 * v0 * v0 * dt * dt / 8;
    CHECK(std::abs(most[1] - most[0]) < 3 * std::sqrt(passages) * once);
  };
  WorldOptions o = options({0, 0, 0});
  o.time_step_safety = 0.05;
  World<WetModel> bridge(o);
  bridge.set_contact(wet(1.0));
  check(bridge, 0.01, stiffness);
  World<JkrModel> neck(o);
  neck.set_contact(jkr(1.0));
  // JKR's curve is smooth at first contact once it is joined: the kink of half its slope is room for rounding only.
  check(neck, 0.01, soft.modulus * unit);
}

TEST_CASE("sticky grains in a box never gain more than their cohesion can give") {
  {
    World<WetModel> w(options({0, 0, 0}));
    w.set_contact(wet(0.7));
    // A bridge in contact lowers the energy by F^2/(2 k). Drawn out it holds at most F gap, and F sqrt(V/(2 R)) times
    // the integral of 1/(1 + 1.05 s + 2.5 s^2), 0.826.
    const double f = 4 * M_PI * r * 0.072;
    const auto drawn = [](double gap, double radius) {
      if (gap > water.rupture) return 0.0;
      return 4 * M_PI * radius * 0.072 * std::min(gap, 0.83 * std::sqrt(water.volume / (2 * radius)));
    };
    CHECK(run_box(w, Sphere(r), r, 0.2, 5000, {f * f / (2 * stiffness), drawn}) < 0.2);
  }
  {
    World<JkrModel> w(options({0, 0, 0}));
    w.set_contact(jkr(0.7, 0.4));
    // At zero load the energy is lower than at first contact by the integral above from x = 1 to 1.31.
    const double x = std::pow(1.5, 2.0 / 3.0);
    const auto f = [](double y) { return 16.0 / 15.0 * std::pow(y, 5) - 8.0 / 3.0 * std::pow(y, 3.5) + y * y; };
    const double well = M_PI * work * unit * unit * (f(1.0) - f(x));
    CHECK(well > 0.0);
    // A neck holds at most its largest pull times the gap.
    const auto drawn = [](double gap, double radius) {
      return gap > cohesion::JKR::range(jkr(1.0).cohesion, radius) ? 0.0 : pull_off * radius / r * gap;
    };
    CHECK(run_box(w, Sphere(r), r, 0.2, 10000, {well, drawn}) < 0.2);
  }
}

}  // namespace cohesion_test
