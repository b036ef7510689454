#include "world/laws.hpp"

#include <dem/world/energy.hpp>

using Catch::Approx;

namespace {

/// Grains in a box that fall, bounce, roll and rub.
template <class Model>
void add_falling_grains(World<Model>& w, double radius) {
  add_open_box(w, {9 * radius, 9 * radius, 0});
  add_block(w, SpeciesId(0), Vec3::Constant(1.3 * radius), 2.1 * radius, 4, 4, 4, 0.3);
}

/// Counts energy over a run in pieces. The sum stays what it was to `error` of what moved; what is dissipated never
/// falls. Returns the energies at the end.
template <class Model>
GrainEnergy run_counted(World<Model>& w, int pieces, int steps, double error, double slack) {
  count_energy(w);
  const GrainEnergy start = energy_of(w);
  CHECK(start.dissipated() == Approx(0.0).margin(1e-18));
  GrainEnergy e = start;
  double most = 0.0, normal = 0.0;
  for (int k = 0; k < pieces; ++k) {
    const StepReport report = w.run(static_cast<std::uint64_t>(steps));
    INFO(report.text);
    REQUIRE(report);
    e = energy_of(w);
    const double size = start.kinetic() + std::abs(start.potential - e.potential);
    most = std::max(most, std::abs(e.balance() - start.balance()) / size);
    CHECK(e.dissipated_normal >= normal - slack * size);
    normal = e.dissipated_normal;
  }
  INFO("largest error of the balance " << most);
  CHECK(most < error);
  return e;
}

constexpr double ball_radius = 1e-3;

}  // namespace

TEST_CASE("what laws store is the work that was put in") {
  // The energy of each law is the integral of its force over the overlap, from first contact on, without speed.
  const auto check = []<class Law>(Law, const auto& parameters, double deepest) {
    typename Law::template History<double> h{}, h2{};
    double work = 0.0;
    const int n = 20000;
    const double step = deepest / n;
    for (int k = 0; k < n; ++k) {
      work += step * Law::force(parameters, contact::NormalState<double>{(k + 0.5) * step, 0, 1e-3, 1e-6, 1e-6}, h);
    }
    const contact::NormalState<double> at = {deepest, 0, 1e-3, 1e-6, 1e-6};
    Law::force(parameters, at, h2);
    return std::pair(Law::energy(parameters, at, h2), work);
  };
  const auto expect = [](const std::pair<double, double>& both) {
    CHECK(both.first == Approx(both.second).epsilon(1e-6));
  };
  expect(check(contact::Penalty{}, contact::Penalty::Parameters<double>{2000, 0.1, 1}, 1e-4));
  expect(check(contact::LinearSpringDashpot{}, contact::LinearSpringDashpot::Parameters<double>{2000, 0.1}, 1e-4));
  expect(check(contact::Hertz{}, contact::Hertz::Parameters<double>{1e7, 0.1}, 1e-4));
  // Plastic flow gives back k1/k2 of it.
  const auto plastic = check(contact::Hysteretic{}, contact::Hysteretic::Parameters<double>{1000, 4000}, 1e-4);
  CHECK(plastic.first == Approx(plastic.second / 4).epsilon(1e-6));
}

TEST_CASE("the potential of cohesion is the integral of its pull") {
  const auto check = []<class Law>(Law, const auto& parameters, double from, double to, bool joined) {
    typename Law::template History<double> h{};
    const auto state = [](double d) { return contact::NormalState<double>{d, 0, 1e-3, 1e-6, 1e-6}; };
    if (joined) Law::force(parameters, state(0.0), h);
    double work = 0.0;
    const int n = 20000;
    for (int k = 0; k < n; ++k) {
      const double d = from + (k + 0.5) * (to - from) / n;
      auto same = h;
      work -= (to - from) / n * Law::force(parameters, state(d), same).pull;
    }
    auto end = h;
    const double gained = Law::energy(parameters, state(to), end) - Law::energy(parameters, state(from), h);
    CHECK(gained == Approx(work).epsilon(1e-5));
    CHECK(work < 0.0);
  };
  check(cohesion::Constant{}, cohesion::Constant::Parameters<double>{1e-3, 4e-5}, 0.0, 1e-4, false);
  check(cohesion::Constant{}, cohesion::Constant::Parameters<double>{1e-3}, 0.0, 1e-4, false);
  const cohesion::LiquidBridge::Parameters<double> water = {0.07, 1e-11, 2e-4};
  check(cohesion::LiquidBridge{}, water, -2e-4, 3e-5, true);
  // JKR's pull is less Hertz's force than it is in `pull`, which has both: so is its energy.
  const cohesion::JKR::Parameters<double> sticky = {0.1, 1e7};
  const double last = -0.999 * cohesion::JKR::range(sticky, 1e-3);
  check(cohesion::JKR{}, sticky, last, 2e-5, true);
}

TEST_CASE("a ball's energy goes into the spring and comes back") {
  // Undamped Hertz: at the turn all is in the spring, and the sum is the same all the way, to (omega dt)^2.
  const auto pair = contact::elastic_pair({3e6, 0.3});
  World<HertzModel> w(options({0, 0, 0}, 1e-6));
  w.set_contact({contact::Hertz::with_restitution(pair, 1.0), friction::Mindlin::with(pair, 0.0)});
  w.add_species(Sphere(ball_radius));
  w.add_surface(w.ground(), surface::Plane{});
  const GrainId ball = w.add_grain(grain_at({0, 0, 1.001 * ball_radius}, {0, 0, -0.5}));
  count_energy(w);
  const double start = energy_of(w).kinetic();
  CHECK(start == Approx(0.5 * mass_of(w, ball) * 0.25));
  double least = start, stored = 0.0, worst = 0.0;
  while (w.velocity(ball).z() < 0.0 || w.force(ball).norm() > 0.0) {
    REQUIRE(w.run(10));
    const GrainEnergy e = energy_of(w);
    least = std::min(least, e.kinetic());
    stored = std::max(stored, e.normal_springs);
    worst = std::max(worst, std::abs(e.kinetic() + e.elastic() - start) / start);
    CHECK(std::abs(e.dissipated()) < 1e-4 * start);
  }
  CHECK(least < 0.01 * start);
  CHECK(stored > 0.99 * start);
  CHECK(worst < 1e-4);
}

TEST_CASE("what a damper takes is 1 - e^2 of an impact") {
  World<LinearModel> w(options({0, 0, 0}, 1e-6));
  const double restitution = 0.6;
  w.set_contact({Linear::with_restitution(2000.0, restitution), {0.0, 2000.0, 0.0}});
  w.add_species(Sphere(ball_radius));
  w.add_surface(w.ground(), surface::Plane{});
  const GrainId ball = w.add_grain(grain_at({0, 0, 1.001 * ball_radius}, {0, 0, -0.5}));
  count_energy(w);
  const double start = energy_of(w).kinetic();
  REQUIRE(w.run(1000));
  REQUIRE(w.force(ball).norm() == 0.0);
  const GrainEnergy e = energy_of(w);
  // The force jumps at first contact, which a step finds up to dt late: omega dt = 0.013 of the damper's work.
  CHECK(e.dissipated_normal == Approx((1 - restitution * restitution) * start).epsilon(0.01));
  CHECK(e.dissipated_friction == Approx(0.0).margin(1e-12 * start));
  CHECK(e.balance() == Approx(start).epsilon(1e-3));
}

TEST_CASE("what friction takes from a sliding ball is what the slide costs") {
  // A ball that slides on a floor without turning before it rolls: it ends with 5/7 of its speed, and friction takes
  // 2/7 of its energy. The springs of friction hold next to nothing.
  World<LinearModel> w(options({0, 0, -g}, 2e-6));
  w.set_contact({Linear::with_restitution(2000.0, 0.5), {0.3, 2000.0, 0.2}});
  w.add_species(Sphere(ball_radius));
  w.add_surface(w.ground(), surface::Plane{});
  const double mass = w.species(SpeciesId(0)).mass;
  const GrainId ball = w.add_grain(grain_at({0, 0, ball_radius - mass * g / 2000.0}, {0.2, 0, 0}));
  count_energy(w);
  const GrainEnergy start = energy_of(w);
  REQUIRE(w.run_for(0.04));  // it rolls after 2/7 v/(mu g) = 19 ms
  const GrainEnergy e = energy_of(w);
  CHECK(w.velocity(ball).x() == Approx(0.2 * 5 / 7).epsilon(1e-3));
  CHECK(e.dissipated_friction == Approx(start.translation * 2 / 7).epsilon(2e-3));
  CHECK(e.rotation == Approx(0.4 * e.translation).epsilon(1e-2));
  CHECK(e.balance() == Approx(start.balance()).epsilon(1e-4));
}

TEST_CASE("the work of a moving wall is what the grain gains") {
  // A wall that comes at 0.1 m/s meets a ball at rest without damping: it leaves at 0.2 m/s.
  World<LinearModel> w(options({0, 0, 0}, 1e-6));
  w.set_contact({Linear::with_restitution(2000.0, 1.0), {0.0, 2000.0, 0.0}});
  w.add_species(Sphere(ball_radius));
  auto& m = w.machine();
  const auto wall = m.add_body(mbd::box_body("wall", {0.01, 0.01, 0.01}, 1e6).at({0, 0, -0.005}).moving({0, 0, 0.1}));
  w.add_surface(wall, surface::Box({0.01, 0.01, 0.01}));
  const GrainId ball = w.add_grain(grain_at({0, 0, 1.001 * ball_radius}));
  count_energy(w);
  REQUIRE(w.run(1500));
  REQUIRE(w.force(ball).norm() == 0.0);
  const GrainEnergy e = energy_of(w);
  CHECK(w.velocity(ball).z() == Approx(0.2).epsilon(1e-3));
  CHECK(e.by_surfaces == Approx(0.5 * mass_of(w, ball) * 0.04).epsilon(2e-3));
  CHECK(e.balance() == Approx(0.0).margin(1e-3 * e.kinetic()));
}

// The work is that which moves the grains, so the balance closes to what the height of a grain is wrong by: a step goes
// on with the speed in its middle, the work is that of the mean speed. They differ by dt^2/4 of a change of
// acceleration: 1e-8 of the energy was measured, and nothing with the predictor-corrector, whose steps go on with the
// mean.
TEST_CASE("the energies of grains that fall, bounce, roll and rub add up to what they were") {
  SECTION("linear springs, velocity Verlet") {
    World<LinearModel> w(options({0, 0, -g}, 2e-6));
    w.set_contact({Linear::with_restitution(2000.0, 0.7), {0.4, 1500.0, 0.1}});
    w.add_species(Sphere(ball_radius));
    add_falling_grains(w, ball_radius);
    const GrainEnergy e = run_counted(w, 20, 500, 1e-6, 1e-4);
    CHECK(e.dissipated_normal > 0.0);
    CHECK(e.dissipated_friction > 0.0);
  }
  SECTION("Hertz and Mindlin") {
    const auto pair = contact::elastic_pair({3e6, 0.3});
    World<HertzModel> w(options({0, 0, -g}, 2e-6));
    w.set_contact({contact::Hertz::with_restitution(pair, 0.6), friction::Mindlin::with_restitution(pair, 0.4, 0.6)});
    w.add_species(Sphere(ball_radius));
    add_falling_grains(w, ball_radius);
    run_counted(w, 20, 500, 1e-6, 1e-4);
  }
  SECTION("clusters") {
    World<models::VerletCubes> w(options({0, 0, -g}, 2e-6));
    w.set_contact(sand<models::VerletCubes>());
    w.add_species(shape::cube8(0.6 * ball_radius));
    add_falling_grains(w, ball_radius);
    run_counted(w, 20, 500, 1e-6, 1e-4);
  }
  SECTION("the predictor-corrector") {
    World<models::CorrectedBalls> w(options({0, 0, -g}, 2e-6));
    w.set_contact(sand<models::CorrectedBalls>());
    w.add_species(Sphere(ball_radius));
    add_falling_grains(w, ball_radius);
    run_counted(w, 20, 500, 1e-6, 1e-4);
  }
}

TEST_CASE("counting energy changes no bit of a run, and grains that come and go are counted") {
  const auto run = [](bool counts) {
    World<Balls> w(options({0, 0, -g}, 5e-6));
    w.set_contact(sand<Balls>());
    w.add_species(Sphere(ball_radius));
    add_falling_grains(w, ball_radius);
    if (counts) count_energy(w);
    REQUIRE(w.run(2000));
    Vec3 sum = Vec3::Zero();
    for (const GrainId p : w.grains()) sum += w.position(p);
    return sum;
  };
  CHECK(run(true) == run(false));

  World<Balls> w(options({0, 0, -g}, 5e-6));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(ball_radius));
  w.add_grain(grain_at({0, 0, 0.0}, {0, 0, 1.0}));
  w.add_grain(grain_at({0, 0, 0.1}, {0, 0, -1.0}));
  count_energy(w);
  const GrainEnergy start = energy_of(w);
  w.remove_grain(GrainId(0));
  w.add_grain(grain_at({0.1, 0, 0.0}, {0, 0, 2.0}));
  REQUIRE(w.run(100));
  const double mass = mass_of(w, GrainId(1));
  CHECK(energy_of(w).came == Approx(0.5 * mass * (4.0 - 1.0)).epsilon(1e-8));
  CHECK(energy_of(w).balance() == Approx(start.balance()).epsilon(1e-6));  // a step of Euler loses (g dt)^2/2
}

TEST_CASE("what an attached grain does to others is the work of its part", "[slow]") {
  // A plunger drives a ball up and down in a heap: the grains gain by the plunger's work, and the sum stays.
  World<LinearModel> w(options({0, 0, -g}, 2e-6));
  w.set_contact(
      {.normal = contact::LinearSpringDashpot::with_restitution(2000.0, 0.6), .friction = {0.4, 1500.0, 0.1}});
  w.add_species(Sphere(ball_radius));
  const SpeciesId held = w.add_species(Sphere(2 * ball_radius), {.held = true});
  add_falling_grains(w, ball_radius);
  const Vec3 top(4.5e-3, 4.5e-3, 11.5e-3);
  const BodyId plunger = w.machine().add_fixed_body("plunger", top);
  w.machine().add_motion(
      mbd::prescribed_position("plunge", plunger, Vec3::UnitZ(), mbd::Signal::sine(6e-3, 20.0, 3.14159265358979)));
  NewGrain head;
  head.species = held;
  head.position = top;
  w.attach(w.add_grain(head), plunger);
  const GrainEnergy e = run_counted(w, 20, 3000, 5e-3, 1e-3);
  CHECK(e.by_surfaces > 0.1 * e.dissipated());
}
