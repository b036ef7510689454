// Loads of the user's own on grains, and what a function that is called within a step may not do.

#include "scenes.hpp"

#include "core/error_of.hpp"
#include "state_hash.hpp"

#include <dem/io/checkpoint/world_columns.hpp>

using Catch::Approx;
using Catch::Matchers::Contains;
using dem::GrainLoad;
using dem::GrainNow;

namespace {

/// One ball far from everything.
template <class Model>
struct Alone {
  dem::World<Model> w{options({0, 0, -g}, 2e-5)};
  double mass;
  GrainId ball;

  Alone() {
    w.set_contact(sand<Model>());
    const SpeciesId s = w.add_species(dem::shape::Sphere(1e-3), {.density = 2650});
    ball = w.add_grain({s, Vec3(0, 0, 10)});
    mass = w.species(s).mass;
  }
};

}  // namespace

TEMPLATE_TEST_CASE("a ball that falls through a viscous fluid comes to its closed speed", "", models::VerletBalls,
                   models::CorrectedBalls) {
  Alone<TestType> a;
  const double tau = 0.05, drag = a.mass / tau;  // s, N s/m
  a.w.set_grain_load([&](const GrainNow& now) { return GrainLoad{.force = -drag * now.velocity}; });
  REQUIRE(a.w.run_for(0.1));
  // The speed is known half a step before or after the force is found: an error of dt/(2 tau) = 2e-4 at most.
  const double speed = g * tau * (1.0 - std::exp(-2.0));
  CHECK(a.w.velocity(a.ball).z() == Approx(-speed).epsilon(2e-4));
  // Without the law it falls freely from there.
  a.w.set_grain_load({});
  const double before = a.w.velocity(a.ball).z();
  REQUIRE(a.w.run_for(0.1));
  CHECK(a.w.velocity(a.ball).z() == Approx(before - g * 0.1).epsilon(1e-9));
}

TEST_CASE("a torque of a load law spins a ball up, and the law is told its name, its species and the time") {
  Alone<models::VerletBalls> a;
  std::vector<double> times;
  a.w.set_grain_load([&](const GrainNow& now) {
    times.push_back(now.time);
    CHECK(now.id == a.ball);
    CHECK(now.species == SpeciesId(0));
    return GrainLoad{.force = Vec3(0, 0, a.mass * g), .torque = Vec3(0, 0.4 * a.mass * 1e-6, 0)};  // 1 rad/s^2
  });
  REQUIRE(a.w.run(1000));
  CHECK(a.w.angular_velocity(a.ball).y() == Approx(0.02).epsilon(1e-3));
  CHECK(std::abs(a.w.velocity(a.ball).z()) < 1e-9);  // lifted by its weight
  CHECK(times.front() == 0.0);
  CHECK(times.back() == Approx(a.w.time()).margin(2.01e-5));
}

TEST_CASE("grains under a load law have the same bits on any number of threads", "[slow]") {
  const auto run = [](int threads) {
    dem::World<Cubes> w(options({0, 0, -g}, 1e-5));
    w.set_threads(threads);
    w.set_contact(sand<Cubes>());
    add_open_box(w, {0.02, 0.02, 0.02});
    const SpeciesId s = w.add_species(dem::shape::cube8(1e-3));
    for (int k = 0; k < 600; ++k) w.add_grain({s, 2.4e-3 * Vec3(k % 8 + 0.6, k / 8 % 8 + 0.6, k / 64 + 0.6)});
    w.set_grain_load([](const GrainNow& now) {
      return GrainLoad{.force = -1e-4 * now.velocity, .torque = -1e-10 * now.angular_velocity};
    });
    REQUIRE(w.run(1500));
    return hash_of(w);
  };
  CHECK(run(1) == run(3));
}

TEST_CASE("attached grains have no load of a law") {
  Alone<Balls> a;
  const SpeciesId held = a.w.add_species(dem::shape::Sphere(1e-3), {.density = 2650, .held = true});
  const GrainId tooth = a.w.add_grain({held, Vec3(1, 0, 10)});
  a.w.attach(tooth, a.w.ground());
  int asked = 0;
  a.w.set_grain_load([&](const GrainNow& now) {
    ++asked;
    CHECK(now.id == a.ball);
    return GrainLoad{.force = Vec3(1, 0, 0)};
  });
  REQUIRE(a.w.run(5));
  CHECK(asked == 6);  // and as the first forces were found
  CHECK(a.w.force(tooth).norm() == 0.0);
  CHECK(a.w.force(a.ball).x() == 1.0);
}

TEST_CASE("a load law is refused where grains may sleep, and is part of what a saved state asks for") {
  dem::WorldOptions sleeps = options({0, 0, -g});
  sleeps.sleep = dem::SleepOptions{};
  dem::World<Balls> w(sleeps);
  check_refused([&] { w.set_grain_load([](const GrainNow&) { return GrainLoad{}; }); }, "may sleep");
  dem::World<Balls> awake(options({0, 0, -g}));
  awake.set_grain_load([](const GrainNow&) { return GrainLoad{}; });
  check_refused([&] { awake.set_sleep(dem::SleepOptions{}); }, "set_grain_load", "cannot sleep");
  for (const bool had : {false, true}) {
    for (const bool has : {false, true}) {
      Alone<models::VerletBalls> from, to;
      const auto lift = [](const GrainNow&) { return GrainLoad{.force = Vec3(0, 0, 1e-5)}; };
      if (had) from.w.set_grain_load(lift);
      if (has) to.w.set_grain_load(lift);
      REQUIRE(from.w.run(10));
      const auto restore = [&] {
        dem::io::StateColumns state = dem::io::columns_of(from.w);
        dem::io::restore(to.w, state);
      };
      if (had != has) {
        check_refused(restore, "set_grain_load");
        continue;
      }
      restore();
      REQUIRE(from.w.run(10));
      REQUIRE(to.w.run(10));
      CHECK(hash_of(from.w) == hash_of(to.w));
    }
  }
}

TEST_CASE("what is called within a step says so, and a world that was broken off says that") {
  Alone<Balls> a;
  const SpeciesId s(0);
  std::vector<std::string> said;
  bool breaks_off = false;
  a.w.set_grain_load([&](const GrainNow&) {
    if (said.empty()) {
      said.push_back(message_of([&] { (void)a.w.run(1); }));
      said.push_back(message_of([&] { a.w.add_grain({s, Vec3(1, 0, 0)}); }));
      said.push_back(message_of([&] { a.w.remove_grain(a.ball); }));
      said.push_back(message_of([&] { a.w.add_surface(dem::BodyId(0), dem::surface::Plane{}); }));
    }
    if (breaks_off) throw std::runtime_error("no wind");
    return GrainLoad{};
  });
  a.w.ground();
  REQUIRE(a.w.run(2));
  REQUIRE(said.size() == 4);
  const char* calls[] = {"run", "add_grain", "remove_grain", "add_surface"};
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK_THAT(said[k], Contains(std::string(calls[k]) + " is called within a step of this world"));
  }
  CHECK(a.w.grain_count() == 1);
  breaks_off = true;
  CHECK_THROWS_AS((void)a.w.run(1), std::runtime_error);
  check_refused([&] { (void)a.w.run(1); }, "was broken off by an exception");
}
