#include "combinations/combinations.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>

// The predictor-corrector evaluates every contact twice a step, and what contacts remember moves on by half a step each
// time: with every kind of history, and every kind of grain that renames its points, it must tell the same as an
// integrator that evaluates once.

namespace {

using Catch::Approx;
using combinations::ElasticGrains;
using combinations::PlasticGrains;
using combinations::StickyGrains;
using combinations::Superquadric;

template <class M>
struct Corrected : M {
  using Integrator = dem::integrator::PredictorCorrector;
};

using Rolling = rolling::Sum<rolling::ElasticPlastic, rolling::Torsion>;
using HertzJkr = Laws<contact::Hertz, friction::Mindlin, Rolling, cohesion::JKR>;
using PlasticDmt = Laws<contact::Hysteretic, friction::CoulombViscous, rolling::ConstantTorque, cohesion::DMT>;
using LinearWet = Laws<Linear, friction::CundallStrack, Rolling, cohesion::LiquidBridge>;
using Asperities = Laws<contact::Penalty, friction::AsperitySpring>;

constexpr double ball_radius = 1e-3;

template <class M>
ContactParameters<M> constants() {
  if constexpr (std::is_base_of_v<HertzJkr, M>) {
    const auto pair = contact::elastic_pair({1e7, 0.3});
    return {contact::Hertz::with_restitution(pair, 0.6),
            friction::Mindlin::with(pair, 0.4),
            {{0.1, 500.0, 0.3}, {0.05, 500.0, 0.3}},
            cohesion::JKR::with(pair, 0.05)};
  } else if constexpr (std::is_base_of_v<PlasticDmt, M>) {
    return {contact::Hysteretic::with_restitution(2000.0, 0.6), {0.4, 0.05}, {0.1}, {0.01}};
  } else if constexpr (std::is_base_of_v<LinearWet, M>) {
    return {Linear::with_restitution(2000.0, 0.6),
            {0.4, 1500.0, 0.1},
            {{0.1, 500.0, 0.3}, {0.05, 500.0, 0.3}},
            cohesion::LiquidBridge::of(0.072, 0.0, 2.7e-11)};
  } else {
    return {{2000.0, 0.015, 0.05}, {0.4, 2000.0, 0.015, 0.975}};
  }
}

/// Velocities and spins of two balls after they met off their middles, turning: 12 numbers.
template <class M>
Eigen::Matrix<double, 12, 1> collide(double dt) {
  World<M> w(options({0, 0, 0}, dt));
  w.set_contact(constants<M>());
  w.add_species(Sphere(ball_radius), {"grain", 2500.0});
  const auto a = w.add_grain(grain_at({-1.0e-3, 0, 0}, {0.4, 0.05, 0}, {100, 50, -80}));
  const auto b = w.add_grain(grain_at({1.0e-3, 0.7e-3, 0.2e-3}, {-0.4, 0, 0.1}, {-30, 90, 120}));
  REQUIRE(w.run_for(2e-3));
  REQUIRE((w.position(a) - w.position(b)).norm() > 2.4 * ball_radius);
  Eigen::Matrix<double, 12, 1> result;
  result << w.velocity(a), w.velocity(b), ball_radius * w.angular_velocity(a), ball_radius * w.angular_velocity(b);
  return result;
}

}  // namespace

TEMPLATE_TEST_CASE("a collision under any law is the same by predictor-corrector and by velocity Verlet", "", HertzJkr,
                   PlasticDmt, LinearWet, Asperities) {
  // Where a contact begins, slips or ends, each is off by a part of a step: of the 1,000 steps and more of a contact by
  // up to 2 in all, and by a quarter of that with a quarter of the step. A history that counted steps twice would stay
  // apart by its whole.
  const auto apart = [](double dt) { return (collide<Corrected<TestType>>(dt) - collide<TestType>(dt)).norm(); };
  CHECK(apart(1e-7) < 2e-3 * 0.4);  // of the speed
  CHECK(apart(1e-7) < 0.5 * apart(4e-7));
}

TEMPLATE_TEST_CASE("grains of every shape come to rest and weigh what they weigh by predictor-corrector", "",
                   ElasticGrains<combinations::Polyhedron>, StickyGrains<Superquadric>,
                   PlasticGrains<combinations::SuperquadricPoints>) {
  combinations::pour<Corrected<TestType>>();
}

TEST_CASE("a body of triangles rebounds as asked, and slides as friction lets it, by predictor-corrector") {
  struct Elastic : Corrected<LinearModel> {
    using Surfaces = surface::Set<surface::Plane, surface::Box, surface::TriangleMesh>;
  };
  const double e = 0.7, speed = 0.5, mu = 0.3;
  World<Elastic> w(options({0, 0, 0}, 5e-6));
  w.set_contact({Linear::with_restitution(4e5, e), {mu, 3e5, 0.5}});
  const Vec3 edges(0.2, 0.2, 0.02);  // flat, so that it does not tip over
  const auto block =
      w.machine().add_body(mbd::box_body("block", edges, 1000.0).at({0, 0, 0.011}).moving({4, 0, -speed}));
  w.add_body_contact(w.add_surface(block, surface::TriangleMesh(mesh::box(edges, 3))),
                     w.add_surface(w.ground(), surface::Plane{}));
  REQUIRE(w.run_for(0.02));
  const dem::Body& b = w.machine().body(block);
  // Friction turns it by mu times the push at 0.01 m below its middle: the rebound errs by that turn's share, 1 %.
  CHECK(b.velocity().z() == Approx(e * speed).epsilon(0.02));
  CHECK(b.velocity().x() == Approx(4.0 - mu * (1 + e) * speed).epsilon(1e-3));
}
