#include "world/laws.hpp"

namespace rolling_test {

using Catch::Approx;

namespace {

using Rolling = rolling::Sum<rolling::ElasticPlastic, rolling::Torsion>;
using SpringModel = Laws<Linear, friction::CundallStrack, Rolling>;
using MindlinModel = Laws<contact::Hertz, friction::Mindlin, rolling::ElasticPlastic>;
using TorqueModel = Laws<Linear, friction::CundallStrack, rolling::ConstantTorque>;

constexpr double r = 5e-3, stiffness = 1e4, mu_r = 0.2, mu_t = 0.1;

template <class Model>
ContactParameters<Model> constants(double mu) {
  ContactParameters<Model> p = {Linear::with_restitution(stiffness, 0.5), {mu, stiffness, 0.3}};
  if constexpr (std::is_same_v<Model, SpringModel>) {
    p.rolling = {{mu_r, stiffness, 0.3}, {mu_t, stiffness, 0.3}};
  } else {
    p.rolling = {mu_r};
  }
  return p;
}

/// A ball that lies on a plane under gravity that is tilted by `slope` = tan(angle), pressed in as far as its weight
/// needs.
template <class Model>
struct OnPlane {
  World<Model> world;
  GrainId id;
  double angle;

  OnPlane(double slope, double mu, const Vec3& velocity = {0, 0, 0}, const Vec3& spin = {0, 0, 0})
      : world(options(g * Vec3(std::sin(std::atan(slope)), 0, -std::cos(std::atan(slope))), 1e-5)),
        angle(std::atan(slope)) {
    world.set_contact(constants<Model>(mu));
    const auto species = world.add_species(Sphere(r), {"grain", 2500.0});
    world.add_surface(world.ground(), surface::Plane{});
    const double depth = world.species(species).mass * g * std::cos(angle) / stiffness;
    id = world.add_grain(grain_at({0, 0, r - depth}, velocity, spin));
  }
  double speed() const { return world.velocity(id).x(); }
  Vec3 spin() const { return world.angular_velocity(id); }
};

}  // namespace

TEST_CASE("rolling resistance holds a ball on every slope below atan(mu_r)") {
  for (const double slope : {0.5 * mu_r, 0.9 * mu_r}) {
    OnPlane<SpringModel> ball(slope, 0.8);
    auto& w = ball.world;
    REQUIRE(w.run_for(0.2));
    // The weight comes on at once, so it rolls a little before the spring holds: within some stretches of the spring,
    // mu_r m g/k = 3e-7 m. Free, it would have rolled 7 cm and more.
    const Vec3 at = w.position(ball.id);
    CHECK(at.x() > 0.0);
    CHECK(at.x() < 1e-5);
    REQUIRE(w.run_for(0.1));
    CHECK((w.position(ball.id) - at).norm() < 1e-12);
    CHECK(w.velocity(ball.id).norm() < 1e-9);
    CHECK(ball.spin().norm() < 1e-6);
  }
}

TEMPLATE_TEST_CASE("above that angle a ball rolls with 5/7 g (sin - mu_r cos)", "", SpringModel, TorqueModel) {
  OnPlane<TestType> ball(1.3 * mu_r, 0.8);
  REQUIRE(ball.world.run_for(0.1));
  const double before = ball.speed();
  REQUIRE(ball.world.run_for(0.1));
  const double expected = 5.0 / 7.0 * g * (std::sin(ball.angle) - mu_r * std::cos(ball.angle));
  // The arm is short by half the overlap, 1e-4 of it; what is left of the springs' swing is smaller.
  CHECK((ball.speed() - before) / 0.1 == Approx(expected).epsilon(1e-3));
  CHECK(ball.spin().y() * r == Approx(ball.speed()).epsilon(1e-3));
}

TEMPLATE_TEST_CASE("a rolling ball slows down by 5/7 mu_r g and stops", "", SpringModel, TorqueModel) {
  const double u0 = 0.1;
  OnPlane<TestType> ball(0.0, 0.8, {u0, 0, 0}, {0, u0 / r, 0});
  REQUIRE(ball.world.run_for(0.05));
  CHECK(ball.speed() == Approx(u0 - 5.0 / 7.0 * mu_r * g * 0.05).epsilon(2e-3));
  REQUIRE(ball.world.run_for(0.1));  // it stops after 0.0714 s
  CHECK(std::abs(ball.speed()) < 1e-6);
  const double way = ball.world.position(ball.id).x();
  CHECK(way == Approx(0.7 * u0 * u0 / (mu_r * g)).epsilon(2e-3));
  REQUIRE(ball.world.run_for(0.05));
  CHECK(ball.world.position(ball.id).x() == Approx(way).margin(1e-7));
}

TEMPLATE_TEST_CASE("without friction rolling resistance takes 5/2 mu_r g/r off the spin", "", SpringModel,
                   TorqueModel) {
  OnPlane<TestType> ball(0.0, 0.0, {0, 0, 0}, {0, 80.0, 0});
  REQUIRE(ball.world.run_for(0.05));
  CHECK(ball.spin().y() == Approx(80.0 - 2.5 * mu_r * g / r * 0.05).epsilon(1e-3));
  CHECK(std::abs(ball.speed()) < 1e-12);
}

TEST_CASE("torsion takes 5/2 mu_t g/r off a spin about the normal, stops it, and leaves rolling alone") {
  OnPlane<SpringModel> ball(0.0, 0.8, {0, 0, 0}, {0, 0, 30.0});
  REQUIRE(ball.world.run_for(0.04));
  CHECK(ball.spin().z() == Approx(30.0 - 2.5 * mu_t * g / r * 0.04).epsilon(1e-3));
  CHECK(ball.spin().head<2>().norm() < 1e-9);
  REQUIRE(ball.world.run_for(0.1));  // at rest after 0.061 s
  CHECK(std::abs(ball.spin().z()) < 1e-6);
  OnPlane<TorqueModel> free(0.0, 0.8, {0, 0, 0}, {0, 0, 30.0});  // a law without torsion
  REQUIRE(free.world.run_for(0.04));
  CHECK(free.spin().z() == Approx(30.0).epsilon(1e-12));
}

TEMPLATE_TEST_CASE("a ball that cannot roll sticks below atan(mu) and slides above", "", SpringModel, MindlinModel) {
  const double mu = 0.3;
  for (const double slope : {0.9 * mu, 1.3 * mu}) {
    const double angle = std::atan(slope);
    World<TestType> w(options({0, 0, -g}, 1e-5));
    const rolling::ElasticPlastic::Parameters<double> never = {10.0, stiffness, 0.3};
    double depth = 0.0;
    const auto species = w.add_species(Sphere(r), {"grain", 2500.0});
    const double weight = w.species(species).mass * g;
    if constexpr (std::is_same_v<TestType, SpringModel>) {
      w.set_contact({Linear::with_restitution(stiffness, 0.5), {mu, stiffness, 0.3}, {never, {mu_t, stiffness, 0.3}}});
      depth = weight / stiffness;
    } else {
      const auto soft = contact::elastic_pair({1e7, 0.3}, {1e20, 0.3});
      w.set_contact({contact::Hertz::with_restitution(soft, 0.5), friction::Mindlin::with(soft, mu, 0.3), never});
      depth = std::pow(0.75 * weight / (soft.modulus * std::sqrt(r)), 2.0 / 3.0);
    }
    w.add_surface(w.ground(), surface::Plane{});
    const auto ball = w.add_grain(grain_at({0, 0, r - depth}));
    for (int k = 1; k <= 100; ++k) {  // tilted slowly, so that nothing swings
      w.set_gravity({g * std::sin(angle * k / 100), 0, -g * std::cos(angle * k / 100)});
      REQUIRE(w.run(50));
    }
    REQUIRE(w.run_for(0.02));
    const double before = w.velocity(ball).x();
    REQUIRE(w.run_for(0.05));
    const double a = (w.velocity(ball).x() - before) / 0.05;
    CAPTURE(slope);
    if (slope < mu) {
      CHECK(std::abs(w.velocity(ball).x()) < 1e-9);
      CHECK(w.position(ball).x() < 1e-5);  // stretches of springs: 1e-6 m
    } else {
      // The damper beside the rolling spring still turns it a little when friction changes: 1e-4.
      CHECK(a == Approx(g * (std::sin(angle) - mu * std::cos(angle))).epsilon(1e-3));
      CHECK(w.angular_velocity(ball).norm() * r < 1e-3 * w.velocity(ball).x());
    }
  }
}

TEST_CASE("torques of rolling and torsion are equal and opposite") {
  World<SpringModel> w(options({0, 0, 0}, 2e-6));
  w.set_contact(constants<SpringModel>(0.4));
  w.add_species(Sphere(r));
  w.add_species(Sphere(0.6 * r));
  w.add_grain(grain_at({0, 0, 0}, {0.1, 0.02, 0}, {5, -20, 30}));
  NewGrain other = grain_at({1.59 * r, 0.1 * r, 0}, {-0.2, 0, 0.05}, {-40, 10, 20});
  other.species = SpeciesId(1);
  w.add_grain(other);
  const Vec3 p = momentum(w), l = angular_momentum(w), spin = w.angular_velocity(GrainId(0));
  REQUIRE(w.run_for(0.02));
  CHECK((w.angular_velocity(GrainId(0)) - spin).norm() > 1.0);
  CHECK(w.force(GrainId(0)).norm() == 0.0);
  // Rounding of 1e4 steps.
  CHECK((momentum(w) - p).norm() < 1e-12 * p.norm());
  CHECK((angular_momentum(w) - l).norm() < 1e-11 * l.norm());
}

TEST_CASE("a rolling history seen from the other grain points the other way, and a twist stays") {
  constexpr int size = history_size<SpringModel>;
  STATIC_REQUIRE(size == 3 + 3 + 1);
  grain::Remembered<size> remembered = {3, 5, 0, {1, 2, 3, 4, 5, 6, 7}};
  grain::mirror<SpringModel>(remembered);
  CHECK(remembered.i == 5);
  CHECK(remembered.history == std::array<double, 7>{-1, -2, -3, -4, -5, -6, 7});
}

TEST_CASE("rolling histories survive new neighbour lists") {
  const auto run = [](double skin) {
    World<SpringModel> w(options({0, 0, 0}, 1e-5, skin * r));
    w.set_contact(constants<SpringModel>(0.4));
    run_box(w, Sphere(r), r, 0.3, 2000);
    std::vector<Vec3> all;
    for_each_grain(w, [&](GrainId p) { all.push_back(w.position(p)); });
    return std::pair(all, w.state().rebuilds);
  };
  const auto [often, many] = run(0.02);
  const auto [seldom, few] = run(1.0);
  CHECK(many > 5 * few);
  // Sums in another order: rounding, which collisions amplify.
  for (std::size_t k = 0; k < often.size(); ++k) CHECK((often[k] - seldom[k]).norm() < 1e-9 * r);
}

TEST_CASE("grains that resist rolling lose energy in a box and never gain any") {
  {
    World<SpringModel> w(options({0, 0, 0}));
    w.set_contact(constants<SpringModel>(0.4));
    CHECK(run_box(w, Sphere(r), r, 0.3, 5000) < 0.2);
  }
  {
    World<TorqueModel> w(options({0, 0, 0}));
    w.set_contact(constants<TorqueModel>(0.4));
    CHECK(run_box(w, Sphere(r), r, 0.3, 5000) < 0.2);
  }
}

}  // namespace rolling_test
