#include "scenes.hpp"

using Catch::Approx;

namespace {

constexpr double mu = 0.4, half_edge = 1.2e-3;

/// A cube of eight spheres that lies on a level surface, under gravity that is tilted by `slope` = tan(angle).
template <class Integrator>
struct Incline {
  dem::World<Grains<Cube8, Integrator>> world;
  GrainId block;
  SurfaceId plate;
  double angle;

  Incline(double slope, double breaking_factor, const Vec3& downhill = Vec3::UnitX(), bool box = false)
      : world(options(g * (std::sin(std::atan(slope)) * downhill - std::cos(std::atan(slope)) * Vec3::UnitZ()), 5e-6)),
        angle(std::atan(slope)) {
    world.set_contact(sand<Grains<Cube8, Integrator>>(mu, breaking_factor));
    const auto cube = world.add_species(dem::shape::cube8(half_edge));
    if (box) {
      dem::SurfaceOptions o;
      o.position = {0.04, 0, -0.005};
      plate = world.add_surface(world.ground(), dem::surface::Box({0.1, 0.1, 0.01}), o);
    } else {
      plate = world.add_surface(world.ground(), dem::surface::Plane{});
    }
    dem::NewGrain n;
    n.species = cube;
    // Pressed in as far as four springs of 2000 N/m carry its weight, so that it does not bounce.
    const double weight = world.species(cube).mass * g * std::cos(angle);
    n.position = {0, 0, half_edge - weight / (4 * 2000.0)};
    block = world.add_grain(n);
  }
  double mass() const { return world.species(SpeciesId(0)).mass; }
};

}  // namespace

TEMPLATE_TEST_CASE("a block below the angle of friction sticks", "[slow]", dem::integrator::PredictorCorrector,
                   dem::integrator::VelocityVerlet, dem::integrator::SymplecticEuler) {
  for (const double slope : {0.5 * mu, 0.95 * mu}) {
    Incline<TestType> scene(slope, 0.975);
    auto& w = scene.world;
    const Vec3 start = w.position(scene.block);
    REQUIRE(w.run_for(0.4));
    // It gives way by the stretch of four friction springs, m g sin/(4 kt). As the weight comes on at once, it swings
    // first, and near the limit some asperities break meanwhile: a few dozen stretches, 1e-3 of its size.
    const double stretch = scene.mass() * g * std::sin(scene.angle) / (4 * 2000.0);
    const Vec3 settled = w.position(scene.block);
    CHECK((settled - start).x() > 0.5 * stretch);
    CHECK((settled - start).norm() < 1e-3 * half_edge);
    // Dampers took the swing away with about exp(-50/s t). Then nothing creeps: rounding of 1e-18 m a step at the most.
    REQUIRE(w.run_for(0.2));
    CHECK((w.position(scene.block) - settled).norm() < 1e-5 * stretch);
    CHECK(w.velocity(scene.block).norm() < 1e-12);
    // The plate carries all of the weight, along the slope as well.
    CHECK((w.surface_force(scene.plate) - scene.mass() * w.state().options.gravity).norm() < 1e-9 * scene.mass() * g);
  }
}

TEMPLATE_TEST_CASE("a block above the angle of friction slides with g (sin - mu cos)", "",
                   dem::integrator::PredictorCorrector, dem::integrator::VelocityVerlet,
                   dem::integrator::SymplecticEuler) {
  for (const double slope : {1.05 * mu, 1.2 * mu}) {
    // Asperities that keep all of their force slide at mu Fn exactly.
    Incline<TestType> scene(slope, 1.0);
    auto& w = scene.world;
    const double expected = g * (std::sin(scene.angle) - mu * std::cos(scene.angle));
    REQUIRE(w.run_for(0.05));
    const double v1 = w.velocity(scene.block).x();
    REQUIRE(w.run_for(0.1));
    const double a = (w.velocity(scene.block).x() - v1) / 0.1;
    // What is left of the vertical swing, which decays in milliseconds, and its change of normal force.
    CHECK(a == Approx(expected).epsilon(1e-4));
    // Until its springs are stretched, friction is less than mu Fn: so it is a little faster than if it had slid at
    // once, by mu g cos/omega, omega^2 = 4 kt/m, and up to three times that as it rocks meanwhile.
    const double head_start = 3 * mu * g * std::cos(scene.angle) / std::sqrt(4 * 2000.0 / scene.mass());
    CHECK(v1 > expected * 0.05);
    CHECK(v1 < expected * 0.05 + head_start);
    CHECK(w.position(scene.block).z() < half_edge);
    CHECK(w.rotation(scene.block)(2, 2) > 1 - 1e-6);  // it slides and does not topple
  }
}

TEST_CASE("asperities that break keep a sliding block between their share and the whole of mu") {
  Incline<dem::integrator::SymplecticEuler> scene(1.2 * mu, 0.9);
  auto& w = scene.world;
  REQUIRE(w.run_for(0.05));
  const double v1 = w.velocity(scene.block).x();
  REQUIRE(w.run_for(0.1));
  const double a = (w.velocity(scene.block).x() - v1) / 0.1;
  const double whole = g * (std::sin(scene.angle) - mu * std::cos(scene.angle));
  const double share = g * (std::sin(scene.angle) - 0.9 * mu * std::cos(scene.angle));
  CHECK(a > whole * (1 - 1e-4));
  CHECK(a < share * (1 + 1e-4));
}

TEST_CASE("a slope looks the same in every direction, and a box is as good as a plane") {
  const double along = [] {
    Incline<dem::integrator::SymplecticEuler> scene(1.2 * mu, 1.0);
    REQUIRE(scene.world.run_for(0.1));
    return scene.world.position(scene.block).x();
  }();
  REQUIRE(along > 1e-3);
  Incline<dem::integrator::SymplecticEuler> other(1.2 * mu, 1.0, Vec3::UnitY());
  REQUIRE(other.world.run_for(0.1));
  CHECK(other.world.position(other.block).y() == Approx(along).epsilon(1e-9));
  Incline<dem::integrator::SymplecticEuler> boxed(1.2 * mu, 1.0, Vec3::UnitX(), true);
  REQUIRE(boxed.world.run_for(0.1));
  CHECK(boxed.world.position(boxed.block).x() == Approx(along).epsilon(1e-9));
}

TEST_CASE("a ball that is pushed goes from sliding to rolling at five sevenths of its speed") {
  dem::World<Balls> w(options({0, 0, -g}, 1e-6));
  w.set_contact({{2000.0, 0.015, 1.0}, {mu, 2000.0, 0.0, 1.0}});
  const double r = 1e-3, u0 = 0.2;
  const auto ball = w.add_species(Sphere(r));
  w.add_surface(w.ground(), dem::surface::Plane{});
  dem::NewGrain n;
  n.species = ball;
  n.position = {0, 0, r - w.species(ball).mass * g / 2000.0};
  n.velocity = {u0, 0, 0};
  const auto p = w.add_grain(n);
  // While sliding: u = u0 - mu g t, until t = 2 u0/(7 mu g) = 0.0146 s.
  REQUIRE(w.run_for(0.01));
  CHECK(w.velocity(p).x() == Approx(u0 - mu * g * 0.01).epsilon(1e-3));
  REQUIRE(w.run_for(0.04));
  // Rolling over the spring swings by the spring's stretch: mu g/omega = 4e-3 m/s is its largest speed, but undamped it
  // lives on. The mean of a swing is 5/7 u0.
  double mean = 0.0, mean_spin = 0.0;
  const int steps = 20000;
  for (int k = 0; k < steps; ++k) {
    REQUIRE(w.step());
    mean += w.velocity(p).x() / steps;
    mean_spin += w.angular_velocity(p).y() / steps;
  }
  CHECK(mean == Approx(5.0 / 7.0 * u0).epsilon(2e-3));
  CHECK(mean_spin * r == Approx(mean).epsilon(2e-3));
}

TEMPLATE_TEST_CASE("a ball that sticks swings on its asperities without loss", "", models::CorrectedBalls,
                   models::VerletBalls, Balls) {
  // It lies on a plane as deep as its weight asks for. A push makes its contact point swing with 2/7 of its mass, by
  // 0.2 rad a step. In ten swings the predictor-corrector loses 5e-5 of the amplitude a step, 1.6 %; samples meet the
  // peaks within cos(0.1), 0.5 %. A spring that is stretched by the newest velocity alone loses 1e-2 a step.
  const double r = 5e-3, k = 1000.0, kt = 500.0, m = 2650.0 * Sphere(r).volume();
  dem::World<TestType> w(options({0, 0, -g}, 0.2 / std::sqrt(3.5 * kt / m)));
  w.set_contact({{k, 0.0, 1.0}, {1.0, kt, 0.0, 1.0}});
  w.add_surface(w.ground(), dem::surface::Plane{});
  const SpeciesId s = w.add_species(Sphere(r));
  const GrainId ball = w.add_grain({.species = s, .position = {0, 0, r - m * g / k}, .velocity = {1e-4, 0, 0}});
  double largest = 0.0;
  for (int n = 0; n < 314; ++n) {
    REQUIRE(w.run(1));
    const double slip = w.velocity(ball).x() - r * w.angular_velocity(ball).y();
    if (n >= 282) largest = std::max(largest, std::abs(slip));
  }
  CHECK(largest > 0.95e-4);
  CHECK(largest < 1.02e-4);
}
