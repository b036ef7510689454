#include "core/error_of.hpp"
#include "law/lanes.hpp"

#include <dem/law/friction/asperity_spring.hpp>
#include <dem/law/friction/coulomb_viscous.hpp>
#include <dem/law/friction/cundall_strack.hpp>
#include <dem/law/friction/mindlin.hpp>
#include <dem/law/friction/varying.hpp>
#include <dem/law/normal/hertz.hpp>

namespace spring_laws_test {

using Catch::Approx;
using dem::Vec3;
using namespace dem::friction;

namespace {

constexpr double dt = 1e-6;

TangentialState<double> state(const Vec3& velocity, double normal_force, double overlap = 1e-5) {
  return {dem::from_eigen(velocity), normal_force, overlap, 1e-3, 7e-5, dt};
}
template <class Law, class P, class H>
Vec3 force(const P& p, const Vec3& velocity, double normal_force, H& h, double overlap = 1e-5) {
  return to_eigen(Law::force(p, state(velocity, normal_force, overlap), h));
}

}  // namespace

TEST_CASE("viscous friction is a ramp up to Coulomb's limit") {
  const CoulombViscous::Parameters<double> p = {0.4, 2.0};
  CoulombViscous::History<double> h;
  CHECK((force<CoulombViscous>(p, {0.03, 0.04, 0}, 1.0, h) + Vec3(0.06, 0.08, 0)).norm() < 1e-15);
  CHECK((force<CoulombViscous>(p, {3, 4, 0}, 1.0, h) + Vec3(0.24, 0.32, 0)).norm() < 1e-15);
  CHECK(force<CoulombViscous>(p, Vec3::Zero(), 1.0, h) == Vec3::Zero());
  CHECK(force<CoulombViscous>(p, {1, 0, 0}, 0.0, h) == Vec3::Zero());
  CHECK(CoulombViscous::stiffness(p) == 0.0);
  CHECK(CoulombViscous::damping(p, {}) == 2.0);
}

TEST_CASE("the spring of Cundall and Strack stretches, is damped, and slips") {
  const CundallStrack::Parameters<double> p = {0.4, 1000.0, 0.5};
  const double c = CundallStrack::damping(p, {0, 0, 1e-3, 7e-5, dt});
  CHECK(c == Approx(2 * 0.5 * std::sqrt(2e-5 * 1000.0)));  // tangential mass 2/7 of 7e-5 kg
  CundallStrack::History<double> h = {};
  const Vec3 v(0.3, 0.4, 0);
  CHECK((force<CundallStrack>(p, v, 1.0, h) + (1000.0 * dt + c) * v).norm() < 1e-14);
  CHECK((to_eigen(h.spring) - dt * v).norm() < 1e-20);
  // Dragged on it slips at mu Fn, and then the spring holds no more than that.
  for (int n = 0; n < 10000; ++n) force<CundallStrack>(p, v, 1.0, h);
  CHECK((force<CundallStrack>(p, v, 1.0, h) + 0.4 * Vec3(0.6, 0.8, 0)).norm() < 1e-14);
  CHECK(1000.0 * to_eigen(h.spring).norm() == Approx(0.4));
  // At rest the spring alone holds, and where the pressure falls so does it.
  CHECK((force<CundallStrack>(p, Vec3::Zero(), 1.0, h) + 0.4 * Vec3(0.6, 0.8, 0)).norm() < 1e-14);
  CHECK((force<CundallStrack>(p, Vec3::Zero(), 0.5, h) + 0.2 * Vec3(0.6, 0.8, 0)).norm() < 1e-14);
  CHECK((force<CundallStrack>(p, Vec3::Zero(), 1.0, h) + 0.2 * Vec3(0.6, 0.8, 0)).norm() < 1e-14);
  CHECK(force<CundallStrack>(p, v, 0.0, h) == Vec3::Zero());
}

TEST_CASE("Mindlin's spring has the stiffness 8 G* sqrt(R* d)") {
  const Mindlin::Parameters<double> p = {0.4, 1e8, 0.0};
  Mindlin::History<double> h = {};
  const double k = 8e8 * std::sqrt(1e-3 * 1e-5);
  CHECK(Mindlin::stiffness(p, {1e-5, 0, 1e-3, 7e-5, dt}) == Approx(k));
  CHECK((force<Mindlin>(p, {0.01, 0, 0}, 1e3, h) + Vec3(k * dt * 0.01, 0, 0)).norm() < 1e-12 * k * dt);
  // Twice the overlap: what was stretched before stays, what comes is stiffer.
  CHECK(force<Mindlin>(p, {0.01, 0, 0}, 1e3, h, 2e-5).x() ==
        Approx(-k * dt * 0.01 * (1 + std::sqrt(2.0))).epsilon(1e-12));
}

TEST_CASE("Mindlin's spring gives back no more than it took when the contact shrinks") {
  // Shear at a large overlap, unload the normal direction, shear back at a small one: without rescaling the force of
  // the first part would be given back over a longer way.
  const Mindlin::Parameters<double> p = {1e9, 1e8, 0.0};  // never slips
  Mindlin::History<double> h = {};
  double work = 0.0, way = 0.0;
  const auto go = [&](double v, double overlap) {
    const double before = h.spring_force.x;
    const double f = force<Mindlin>(p, {v, 0, 0}, 1.0, h, overlap).x();
    work += 0.5 * (-before + f) * v * dt;
    way += v * dt;
  };
  for (int n = 0; n < 1000; ++n) go(0.01, 1e-5);
  const double held = h.spring_force.x, put_in = -work;
  CHECK(put_in > 0.0);
  force<Mindlin>(p, Vec3::Zero(), 1.0, h, 0.25e-5);  // half the radius
  CHECK(h.spring_force.x == Approx(0.5 * held));
  CHECK(force<Mindlin>(p, Vec3::Zero(), 1.0, h, 1e-5).x() == Approx(-0.5 * held));  // pressing again gives nothing back
  force<Mindlin>(p, Vec3::Zero(), 1.0, h, 0.25e-5);
  work = 0.0;
  while (h.spring_force.x > 0.0) go(-0.01, 0.25e-5);
  CHECK(work > 0.0);
  CHECK(work < put_in);
}

TEST_CASE("the tangential spring of two materials follows from their Poisson ratios") {
  using namespace dem::contact;
  for (const double nu : {0.0, 0.2, 0.3, 0.5}) {
    const ElasticPair pair = elastic_pair({7e10, nu});
    CHECK(tangential_share(pair) == Approx(2 * (1 - nu) / (2 - nu)).epsilon(1e-14));
    CHECK(CundallStrack::with(pair, 0.4, 1e5).stiffness == Approx(2 * (1 - nu) / (2 - nu) * 1e5).epsilon(1e-14));
    // It is Mindlin's stiffness over Hertz's, at any overlap.
    const NormalState<double> s = {1e-6, 0, 1e-3, 7e-5, dt};
    CHECK(Mindlin::stiffness(Mindlin::with(pair, 0.4), s) ==
          Approx(tangential_share(pair) * Hertz::stiffness({pair.modulus, 0.0}, s)).epsilon(1e-14));
  }
  // A soft and a hard material: nearly the soft one's own ratio on a rigid wall, (1 - nu^2)/E and (2 - nu)/G of it
  // only.
  const ElasticPair on_wall = elastic_pair({1e7, 0.4}, {1e20, 0.3});
  CHECK(tangential_share(on_wall) == Approx(2 * (1 - 0.4) / (2 - 0.4)).epsilon(1e-10));
  CHECK(CundallStrack::with(on_wall, 0.4, 1e5).coefficient == 0.4);
  CHECK(CundallStrack::with(on_wall, 0.4, 1e5).damping_ratio == 0.0);
  check_refused([] { CundallStrack::with_restitution(elastic_pair({1e7, 0.4}), 0.4, 1e5, 0.0); }, "restitution is 0");
  check_refused([] { Mindlin::with_restitution(elastic_pair({1e7, 0.4}), 0.4, 1.1); }, "restitution is 1.1");
}

TEST_CASE("a contact that sticks swings back with the restitution that was asked for") {
  // The contact point of two solid spheres moves like 2/7 of their effective mass on the spring and dashpot.
  const auto pair = dem::contact::elastic_pair({7e10, 0.2});
  const double mass = 2.0 / 7.0 * 7e-5, overlap = 1e-6;
  const auto swing = [&](auto law, const auto& p, double stiffness) {
    using Law = decltype(law);
    TangentialState<double> s = {{0.01, 0, 0}, 1e9, overlap, 1e-3, 7e-5, std::sqrt(mass / stiffness) / 20000.0};
    typename Law::template History<double> h = {};
    double stretch = 0.0;
    do {
      const double f = Law::force(p, s, h).x;  // the law's own spring is a step ahead of stretch: first order
      stretch += s.time_step * s.velocity.x;
      s.velocity.x += f / mass * s.time_step;
    } while (stretch > 0.0);
    return -s.velocity.x / 0.01;
  };
  for (const double e : {1.0, 0.9, 0.5, 0.1}) {
    // Some 6e4 steps of first order each: 2e-4 of the speed.
    const auto linear = CundallStrack::with_restitution(pair, 1.0, 1e5, e);
    CHECK(swing(CundallStrack{}, linear, linear.stiffness) == Approx(e).margin(2e-4));
    const auto mindlin = Mindlin::with_restitution(pair, 1.0, e);
    CHECK(swing(Mindlin{}, mindlin, Mindlin::stiffness(mindlin, {overlap, 0, 1e-3, 7e-5, dt})) ==
          Approx(e).margin(2e-4));
    // The dashpot of codes with the whole effective mass, 2 sqrt(5/6) b sqrt(m* kt), for the same b.
    const dem::contact::NormalState<double> state = {overlap, 0, 1e-3, 7e-5, dt};
    CHECK(std::sqrt(5.0 / 6.0 * 3.5) * CundallStrack::damping(linear, state) ==
          Approx(2 * std::sqrt(5.0 / 6.0) * linear.damping_ratio * std::sqrt(7e-5 * linear.stiffness)));
  }
}

TEST_CASE("the dashpots of springs never push over the limit") {
  CundallStrack::History<double> h = {};
  const CundallStrack::Parameters<double> p = {0.4, 1000.0, 5.0};
  CHECK(force<CundallStrack>(p, {100, 0, 0}, 1.0, h).norm() == Approx(0.4));
  Mindlin::History<double> m = {};
  CHECK(force<Mindlin>(Mindlin::Parameters<double>{0.4, 1e8, 5.0}, {100, 0, 0}, 1.0, m).norm() == Approx(0.4));
}

TEST_CASE("varying friction falls or rises with speed and pressure as it says") {
  using Law = Varying<CoulombViscous>;
  Law::Parameters<double> p = {{0.5, 1e9}};  // always at the limit
  Law::History<double> h;
  CHECK(force<Law>(p, {2, 0, 0}, 1.0, h).x() == Approx(-0.5));  // by default the law itself
  p.kinetic_ratio = 0.6;
  p.decay_speed = 0.1;
  CHECK(force<Law>(p, {1e-6, 0, 0}, 1.0, h).norm() == Approx(0.5).epsilon(1e-5));
  CHECK(force<Law>(p, {0.1, 0, 0}, 1.0, h).norm() == Approx(0.5 * (0.6 + 0.4 / M_E)));
  CHECK(force<Law>(p, {100, 0, 0}, 1.0, h).norm() == Approx(0.3));
  p.pressed_ratio = 0.5;
  p.decay_pressure = 2.0;
  CHECK(force<Law>(p, {100, 0, 0}, 2.0, h).norm() == Approx(2 * 0.3 * (0.5 + 0.5 / M_E)));
  CHECK(force<Law>(p, {100, 0, 0}, 200.0, h).norm() == Approx(200 * 0.15));
  p.kinetic_ratio = 2.0;
  p.pressed_ratio = 1.5;  // and rises
  CHECK(force<Law>(p, {0.1, 0, 0}, 2.0, h).norm() == Approx(2 * 0.5 * (2 - 1 / M_E) * (1.5 - 0.5 / M_E)));
  CHECK(force<Law>(p, {100, 0, 0}, 200.0, h).norm() == Approx(200 * 1.5));
  // The mean pressure on Hertz's circle: 3 N on pi R d.
  const TangentialState<double> s = {{100, 0, 0}, 3.0, 2e-5, 1e-3, 1e-5, dt};
  p.mean_pressure = 1.0;
  p.decay_pressure = 3.0 / (M_PI * 1e-3 * 2e-5);
  CHECK(norm(Law::force(p, s, h)) == Approx(3 * 0.5 * 2 * (1.5 - 0.5 / M_E)));
  // Slopes of the law inside reach the stable time step.
  const Varying<Mindlin>::Parameters<double> q = {{0.4, 1e8, 0.1}};
  const dem::contact::NormalState<double> deep = {1e-5, 0, 1e-3, 7e-5, dt};
  CHECK(Varying<Mindlin>::stiffness(q, deep) == Mindlin::stiffness(q.law, deep));
  CHECK(Varying<Mindlin>::damping(q, deep) == Mindlin::damping(q.law, deep));
  CHECK(Varying<AsperitySpring>::stiffness({{0.4, 7.0, 0, 0}}, deep) == 7.0);
}

TEST_CASE("histories of spring laws turn with the contact") {
  const auto turn = [](const dem::Vector3<double>& v) { return dem::Vector3<double>{-v.y, v.x, v.z}; };
  CundallStrack::History<double> c = {{1, 2, 3}};
  CundallStrack::carry(c, turn);
  CHECK(to_eigen(c.spring) == Vec3(-2, 1, 3));
  Varying<Mindlin>::History<double> m = {{1, 2, 3}, 4};
  Varying<Mindlin>::carry(m, turn);
  CHECK(to_eigen(m.spring_force) == Vec3(-2, 1, 3));
  CHECK(m.contact_radius == 4.0);
}

TEMPLATE_TEST_CASE("every lane of a pack gets what a double gets from the tangential laws", "", CoulombViscous,
                   CundallStrack, Mindlin, Varying<CundallStrack>) {
  typename TestType::template Parameters<double> p;
  if constexpr (std::is_same_v<TestType, CoulombViscous>) p = {0.4, 1.0};
  if constexpr (std::is_same_v<TestType, CundallStrack>) p = {0.4, 1e6, 0.1};
  if constexpr (std::is_same_v<TestType, Mindlin>) p = {0.4, 1e9, 0.1};
  if constexpr (std::is_same_v<TestType, Varying<CundallStrack>>) p = {{0.4, 1e6, 0.1}, 0.5, 0.3, 1.5, 1e7, 1.0};
  check_lanes<TestType::template Parameters, TangentialState, TestType::template History>(
      p, [](const auto& q, const auto& s, auto& h) { return TestType::force(q, s, h); },
      [](auto& uniform) {
        return TangentialState<double>{
            {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}, uniform(0, 1), uniform(1e-6, 1e-5), 1e-3, 1e-5, 1e-6};
      });
}

TEST_CASE("constants of tangential laws that make no sense are refused") {
  check_refused([] { CoulombViscous::check({-1, 0}); }, "friction coefficient is -1");
  check_refused([] { CoulombViscous::check({1, -1}); }, "friction damping is -1 N s/m");
  check_refused([] { CundallStrack::check({0.1, 0.0, 0}); }, "friction spring stiffness is 0 N/m");
  check_refused([] { CundallStrack::check({0.1, 1.0, -1}); }, "friction damping ratio is -1");
  check_refused([] { Mindlin::check({0.1, 0.0, 0}); }, "effective shear modulus is 0 Pa");
  using Law = Varying<CundallStrack>;
  check_refused([] { Law::check({{-1, 1, 0}}); }, "friction coefficient is -1");
  check_refused([] { Law::check({{1, 1, 0}, -0.5}); }, "ratio of kinetic to static friction is -0.5");
  check_refused([] { Law::check({{1, 1, 0}, 0.5, 0.0}); }, "decay speed of friction is 0 m/s");
  check_refused([] { Law::check({{1, 1, 0}, 0.5, 1.0, -1}); }, "heavily to lightly pressed friction is -1");
  check_refused([] { Law::check({{1, 1, 0}, 1.5, 1.0, 2.0, 1.0, 3.0}); }, "mean_pressure");
  check_refused([] { Law::check({{1, 1, 0}, 1.5, 1.0, 2.0, 1.0, 0.5}); }, "mean_pressure is 0.5");
  CHECK_NOTHROW(Law::check({{0.4, 1, 0}}));
}

}  // namespace spring_laws_test
