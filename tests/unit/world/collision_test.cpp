#include "scenes.hpp"

using Catch::Approx;

namespace {

struct Impact {
  double restitution, duration;
  Vec3 momentum_before, momentum_after, angular_before, angular_after;
};

/// Two spheres of different size meet head on; contacts are resolved with `steps` steps in a half period.
template <class Model>
Impact collide(double damping, double separation_factor, double steps) {
  dem::World<Model> world(options({0, 0, 0}));
  const double k = 2000.0;
  world.set_contact({{k, damping, separation_factor}, {0.0, 0.0, 0.0, 0.0}});
  const auto small = world.add_species(Sphere(1e-3)), large = world.add_species(Sphere(2e-3));
  const double m1 = world.species(small).mass, m2 = world.species(large).mass;
  dem::WorldOptions o = options({0, 0, 0}, M_PI / std::sqrt(k * (1 / m1 + 1 / m2)) / steps);

  dem::World<Model> w(o);
  w.set_contact({{k, damping, separation_factor}, {0.0, 0.0, 0.0, 0.0}});
  w.add_species(Sphere(1e-3));
  w.add_species(Sphere(2e-3));
  const Vec3 n = Vec3(1, 2, -2) / 3.0;
  dem::NewGrain a, b;
  a.species = small;
  b.species = large;
  a.position = -1.01e-3 * n + Vec3(0.01, 0, 0);
  b.position = 2.01e-3 * n + Vec3(0.01, 0, 0);
  a.velocity = 0.3 * n;
  b.velocity = -0.2 * n;
  const auto pa = w.add_grain(a), pb = w.add_grain(b);
  Impact result = {0, 0, momentum(w), {}, angular_momentum(w), {}};
  for (int step = 0; step < 10 * static_cast<int>(steps); ++step) {
    REQUIRE(w.step());
    if (w.force(pa).norm() > 0.0) result.duration += w.time_step();
  }
  result.restitution = (w.velocity(pb) - w.velocity(pa)).dot(n) / 0.5;
  result.momentum_after = momentum(w);
  result.angular_after = angular_momentum(w);
  return result;
}

/// Closed form, cut where the force would begin to pull. While approaching, d'' + 2 b d' + w0^2 d = 0 from d = 0 to the
/// turning point d' = 0 at w t = atan(w/b); while parting the same with Sp b, from rest to d'' = 0 at w t = atan(w/b).
/// Each part changes the speed by the factor exp(-b t). For Sp = 1 this is Schwager and Poeschel's result (2007).
struct Closed {
  double restitution, duration;
};
Closed closed_form(double damping, double separation_factor) {
  const double m1 = 2650.0 * Sphere(1e-3).volume(), m2 = 2650.0 * Sphere(2e-3).volume();
  const double inverse = 1 / m1 + 1 / m2, w0 = std::sqrt(2000.0 * inverse);
  double loss = 0.0, duration = 0.0;
  for (const double c : {damping, separation_factor * damping}) {
    const double b = 0.5 * c * inverse, w = std::sqrt(w0 * w0 - b * b), t = std::atan2(w, b) / w;
    loss += b * t;
    duration += t;
  }
  return {std::exp(-loss), duration};
}

}  // namespace

TEMPLATE_TEST_CASE("two spheres rebound as the closed form of the damped spring says", "", models::CorrectedBalls,
                   models::VerletBalls, Balls) {
  // No damping, the thesis's, and heavy damping (0.05, 0.36 of critical), symmetric and not.
  for (const double damping : {0.0, 0.015, 0.1}) {
    for (const double separation_factor : {1.0, 0.05, 0.0}) {
      const Closed expected = closed_form(damping, separation_factor);
      const Impact impact = collide<TestType>(damping, separation_factor, 2000.0);
      CAPTURE(damping, separation_factor, expected.restitution);
      // The contact begins anywhere within a step, with a jump of the damping force, C v: up to a step of it is missing
      // or too much. That is C dt/m = 1.1e-3 of the speed at the heaviest damping, where 0.63 of the speed is left.
      CHECK(impact.restitution == Approx(expected.restitution).margin(7.1e-4));
      // Two steps of the 2000 that an undamped contact takes; the heaviest damping leaves 0.82 of them.
      CHECK(impact.duration == Approx(expected.duration).epsilon(1.22e-3));
      // Equal and opposite forces along the line of centres. 2,000 steps with a force, and 40,000 additions to a
      // position, round by 1e-16 each.
      CHECK((impact.momentum_after - impact.momentum_before).norm() < 2e-13 * impact.momentum_before.norm());
      CHECK((impact.angular_after - impact.angular_before).norm() < 4e-12 * impact.angular_before.norm());
    }
  }
}

TEST_CASE("the rebound converges to the closed form with the time step") {
  const double expected = closed_form(0.1, 0.05).restitution;
  const double coarse = std::abs(collide<models::CorrectedBalls>(0.1, 0.05, 100.0).restitution - expected);
  const double fine = std::abs(collide<models::CorrectedBalls>(0.1, 0.05, 10000.0).restitution - expected);
  CHECK(coarse < 0.02);
  CHECK(fine < 2e-4);
  CHECK(fine < coarse);
}

TEST_CASE("friction turns a glancing blow into spin") {
  // Gross sliding against a wall: impulse mu (1 + e) m vn against the sliding, and its moment. v_x' = v_x - mu (1 + e)
  // vn, omega = 5 mu (1 + e) vn/(2 r).
  const double r = 1e-3, mu = 0.2, vn = 0.1, vt = 1.0;
  for (const double cv : {0.0, 1.0}) {
    dem::World<Balls> w(options({0, 0, 0}, 1e-7));
    const double damping = 0.015;
    w.set_contact({{2000.0, damping, 1.0}, {mu, 2000.0, cv, 1.0}});
    const auto ball = w.add_species(Sphere(r));
    w.add_surface(w.ground(), dem::surface::Plane{});
    dem::NewGrain n;
    n.species = ball;
    n.position = {0, 0, 1.001 * r};
    n.velocity = {vt, 0, -vn};
    const auto p = w.add_grain(n);
    REQUIRE(w.run_for(1e-3));
    REQUIRE(w.force(p).norm() == 0.0);
    const double e = w.velocity(p).z() / vn, change = mu * (1 + e) * vn;
    CHECK(e > 0.5);
    CHECK(e < 1.0);
    // The spring takes the first mu Fn/kt of the way to come up to the limit, the ramp (cv = 1: 1 N at 1 m/s, against a
    // limit of 0.006 N) does so at once. Largest overlap 5e-6 m: 2e-6 m of some 2e-4 m of sliding is 1 %.
    const double tolerance = cv > 0.0 ? 1e-3 : 0.02;
    CHECK(vt - w.velocity(p).x() == Approx(change).epsilon(tolerance));
    // The lever arm is shorter than r by half the overlap, 0.25 %.
    CHECK(w.angular_velocity(p).y() == Approx(2.5 * change / r).epsilon(tolerance + 3e-3));
    CHECK(std::abs(w.velocity(p).y()) < 1e-15);
  }
}
