#include "core/error_of.hpp"
#include "scenes.hpp"

#include <atomic>
#include <limits>

// What users' own functions, and numbers that make no sense, do to a world: it says so, at once and in words.

using Catch::Matchers::ContainsSubstring;
using dem::BodyId;
using Problem = dem::StepReport::Problem;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// A spring whose faults are switched on by the tests.
struct Faulty {
  static inline std::atomic<bool> throws = false, gives_none = false;
  static inline std::atomic<double> told = 2000.0;

  template <class T>
  struct Parameters {
    T stiffness;
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT T force(const Parameters<T>& p, const dem::contact::NormalState<T>& s, History<T>&) {
    if (throws) throw std::runtime_error("no such spring");
    const T broken = gives_none ? T(no_number) : T(0);
    return dem::max(T(0), p.stiffness * s.overlap + broken);
  }
  static double stiffness(const Parameters<double>&, const dem::contact::NormalState<double>&) { return told; }
  static void check(const Parameters<double>&) {}
};
/// Balls on that spring.
struct Sand : Grains<Sphere, dem::integrator::VelocityVerlet> {
  using Normal = Faulty;
};

struct Reset {  // of the faults, at the end of a test
  ~Reset() {
    Faulty::throws = Faulty::gives_none = false;
    Faulty::told = 2000.0;
  }
};

/// `count` pairs of balls that overlap by a thousandth, on as many threads as asked for.
dem::World<Sand> pairs(int count, int threads = 1) {
  dem::WorldOptions o = options({0, 0, 0}, 1e-6);
  o.threads = threads;
  dem::World<Sand> w(o);
  w.set_contact({{2000.0}, {0.0, 0.0, 0.0, 1.0}});
  const SpeciesId ball = w.add_species(Sphere(1e-3));
  for (int k = 0; k < count; ++k) {
    for (const double x : {0.0, 1.998e-3}) w.add_grain({ball, Vec3(x + 0.01 * (k % 20), 0.01 * (k / 20), 0)});
  }
  return w;
}

}  // namespace

TEST_CASE("a run of more steps than doubles count is refused, and nothing is owed for it") {
  auto w = pairs(1);
  for (const double time : {1e20, 1e300}) check_refused([&] { (void)w.run_for(time); }, "time to run", "at most 9e15");
  for (const double time : {no_number, HUGE_VAL, -1.0}) check_refused([&] { (void)w.run_for(time); }, "time to run");
  CHECK(w.steps() == 0);
  REQUIRE(w.run_for(10e-6));
  CHECK(w.steps() == 10);
}

TEST_CASE("a run ends after the step in which it is told to, and owes nothing") {
  auto w = pairs(1);
  int asked = 0;
  REQUIRE(w.run_for(1.0, [&] { return ++asked < 3; }));
  CHECK(w.steps() == 3);
  REQUIRE(w.run_for(2e-6));
  CHECK(w.steps() == 5);
  REQUIRE(w.run(100, [] { return false; }));
  CHECK(w.steps() == 6);
}

TEST_CASE("a law that tells a stiffness that is none is refused, with a chosen time step and with an automatic one") {
  const Reset reset;
  for (const double told : {no_number, HUGE_VAL, -1.0}) {
    Faulty::told = told;
    auto chosen = pairs(1);
    check_refused([&] { chosen.prepare(); }, "stiffness that a normal law tells", "must be finite and not negative");
    dem::World<Sand> automatic(options({0, 0, 0}));
    automatic.set_contact({{2000.0}, {0.0, 0.0, 0.0, 1.0}});
    automatic.add_species(Sphere(1e-3));
    check_refused([&] { automatic.prepare(); }, "stiffness that a normal law tells");
  }
}

TEST_CASE("a force that is not a number is found in its step, on every number of threads") {
  const Reset reset;
  for (const int threads : {1, 3}) {
    auto w = pairs(400, threads);  // 800 grains: 4 chunks
    REQUIRE(w.step());
    Faulty::gives_none = true;
    const dem::StepReport report = w.step();
    CHECK(report.problem == Problem::not_finite);
    CHECK_THAT(report.text, ContainsSubstring("not a number"));
    Faulty::gives_none = false;
  }
}

TEST_CASE("numbers whose sum is infinite are found, whichever grain has them") {
  auto w = pairs(1);
  w.set_contact({{0.0}, {0.0, 0.0, 0.0, 1.0}});
  w.set_velocity(GrainId(1), Vec3(1e308, 0, 1e308));
  const dem::StepReport report = w.step();
  CHECK(report.problem == Problem::not_finite);
  CHECK(report.grain == GrainId(1));
}

TEST_CASE("an exception of a law arrives from every number of threads, and the world is not run on") {
  const Reset reset;
  for (const int threads : {1, 2, 8}) {
    auto w = pairs(2000, threads);
    REQUIRE(w.step());
    Faulty::throws = true;
    CHECK_THROWS_WITH(w.step(), "no such spring");
    Faulty::throws = false;
    CHECK(w.steps() == 1);
    CHECK(w.position(GrainId(0)).allFinite());  // it may be looked at
    check_refused([&] { (void)w.step(); }, "broken off by an exception", "make a new one");
  }
}

TEST_CASE("a hundred free bodies touch each other, each pair with a force of its own") {
  // 100 balls in a lattice 10 x 10 whose neighbours along x overlap by a thousandth of the radius: 90 pairs of 4,950.
  // Two balls of radius R overlap by d: each pushes with K d, so a chain pushes its ends apart and leaves its middle.
  auto w = pairs(1);
  const double radius = 0.1, overlap = 1e-4;
  std::vector<BodyId> balls;
  for (int k = 0; k < 100; ++k) {
    const Vec3 at((2 * radius - overlap) * (k % 10), 1.0 + 3.0 * radius * (k / 10), 0.0);
    balls.push_back(w.machine().add_body(dem::mbd::sphere_body("ball " + std::to_string(k), radius, 1000).at(at)));
    w.add_surface(balls.back(), dem::surface::Sphere(radius));
  }
  CHECK(w.add_body_contacts() == 4950);
  CHECK(w.add_body_contacts() == 0);
  REQUIRE(w.step());
  CHECK(w.state().body_contacts.near.size() == 90);
  int ends = 0;
  for (int k = 0; k < 100; ++k) {
    const double pushed = k % 10 == 0 ? -1.0 : k % 10 == 9 ? 1.0 : 0.0;
    const dem::Vector3<double> f = w.machine().body(balls[static_cast<std::size_t>(k)]).force;
    CHECK(f.x == Catch::Approx(pushed * 2000.0 * overlap).margin(1e-9));  // of rounding: 2000 N/m on 1e-16 of 1 m
    ends += pushed != 0.0 ? 1 : 0;
  }
  CHECK(ends == 20);
  // The last pair is number 4,949, in the second block; it goes on touching, and parts where it is switched off.
  const dem::BodyContactId last(4949);
  CHECK(w.body_contact_force(last).x() == Catch::Approx(-2000.0 * overlap).margin(1e-9));
  REQUIRE(w.run(5));
  CHECK(w.body_contact_force(last).x() < -0.19);
  w.set_active(SurfaceId(99), false);
  REQUIRE(w.run(2));
  CHECK(w.body_contact_force(last).norm() == 0.0);
}

TEST_CASE("a floor that turns by a NaN is reported before anything falls through it") {
  for (const bool alone : {false, true}) {
    auto w = pairs(1);
    const BodyId floor = w.machine().add_body(dem::mbd::box_body("floor", {1, 1, 0.1}, 1000).at({0, 0, -0.2}));
    if (!alone) w.add_surface(floor, dem::surface::Box({1, 1, 0.1}));
    w.machine().add_load(dem::mbd::custom_load("twist", floor, [](double t, const dem::Body&) {
      return dem::Wrench{{0, 0, 0}, {0, 0, t > 5e-6 ? no_number : 0.0}};
    }));
    const dem::StepReport report = w.run(20);
    CHECK(report.problem == Problem::machine);
    CHECK(report.step < 9);
    CHECK_THAT(report.text, ContainsSubstring("body 'floor' blew up") && ContainsSubstring("load 'twist' is not"));
  }
}
