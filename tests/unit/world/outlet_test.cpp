#include "core/error_of.hpp"
#include "scenes.hpp"

#include <cmath>
#include <tuple>

using Catch::Approx;
using dem::BeyondDomain;
using dem::surface::Aabb;
using Problem = dem::StepReport::Problem;

namespace {

const Aabb below_the_floor = {Vec3(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL), Vec3(HUGE_VAL, HUGE_VAL, 0.0)};

/// Balls of 1 mm on their way, without weight unless given.
dem::World<Balls> balls(dem::WorldOptions o = options({0, 0, 0}, 1e-5)) {
  dem::World<Balls> w(o);
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(1e-3));
  return w;
}
GrainId add(dem::World<Balls>& w, const Vec3& x, const Vec3& v = Vec3::Zero()) {
  return w.add_grain({SpeciesId(0), x, v});
}

}  // namespace

TEST_CASE("a grain that is removed is gone at once for who looks") {
  auto w = balls();
  for (int k = 0; k < 5; ++k) add(w, {0.01 * k, 0, 0});
  REQUIRE(w.step());
  w.remove_grain(GrainId(3));
  CHECK(w.grain_count() == 4);
  CHECK(w.grains() == std::vector{GrainId(0), GrainId(1), GrainId(2), GrainId(4)});
  check_refused([&] { w.position(GrainId(3)); }, "grain 3 is asked for, but it was removed");
  check_refused([&] { w.remove_grain(GrainId(3)); }, "it was removed");
  const GrainId fresh = add(w, {0.1, 0, 0});
  CHECK(fresh == GrainId(5));
  CHECK(w.grain_count() == 5);
  REQUIRE(w.step());
  CHECK(w.grain_count() == 5);
  CHECK(w.position(fresh).x() == 0.1);
  CHECK(w.position(GrainId(4)).x() == 0.04);
}

TEST_CASE("an outlet counts a stream: grains, mass and mass flow, and the run goes on") {
  // Balls one behind the other, 4 mm apart, at 1 m/s: m v/s = m * 250/s.
  auto w = balls();
  const double mass = w.species(SpeciesId(0)).mass;
  for (int k = 0; k < 100; ++k) add(w, {0, 0, 1e-3 + 4e-3 * k}, {0, 0, -1.0});
  const auto hole = w.add_outlet(below_the_floor, {.name = "hole", .window = 0.08});
  CHECK(w.outlet(hole).name() == "hole");
  CHECK(w.outlet(hole).mass_flow() == 0.0);
  REQUIRE(w.run_for(0.2));
  CHECK(w.time() == Approx(0.2));
  // Ball k is at the floor at 1 ms + k * 4 ms: 0 ... 49 by then.
  CHECK(w.outlet(hole).grains() == 50);
  CHECK(w.outlet(hole).mass() == Approx(50 * mass));
  CHECK(w.outlet(hole).mass_flow() == Approx(250 * mass).epsilon(0.06));  // of 20 balls in the window, one more or less
  CHECK(w.grain_count() == 50);
  check_refused([&] { w.velocity(GrainId(49)); }, "it was removed");
  CHECK(w.velocity(GrainId(50)).z() == -1.0);
  REQUIRE(w.run_for(0.3));
  CHECK(w.outlet(hole).grains() == 100);
  CHECK(w.outlet(hole).mass_flow() == 0.0);  // nothing came for longer than the window
  CHECK(w.grain_count() == 0);
}

TEST_CASE("of several outlets each takes what is in it, also a box within the world") {
  auto w = balls();
  for (int k = 0; k < 3; ++k) add(w, {0.1 * k, 0, 0.0005}, {0, 0, -1.0});
  const auto left = w.add_outlet({Vec3(-0.01, -0.01, -0.01), Vec3(0.01, 0.01, 0.0)});
  const auto right = w.add_outlet({Vec3(0.19, -0.01, -0.01), Vec3(0.21, 0.01, 0.0)});
  REQUIRE(w.run(100));
  CHECK(w.outlet(left).grains() == 1);
  CHECK(w.outlet(right).grains() == 1);
  CHECK(w.grains() == std::vector{GrainId(1)});
}

TEST_CASE("who leaned on a grain that was taken feels it for 16 steps at the most") {
  // Two balls that press each other. The outlet holds the left one from the start.
  auto w = balls();
  add(w, {0, 0, 0});
  const GrainId other = add(w, {1.999e-3, 0, 0});
  w.set_contact({{2000.0, 0.0, 1.0}, {0.0, 0.0, 0.0, 1.0}});
  w.add_outlet({Vec3(-1e-3, -1e-3, -1e-3), Vec3(1e-3, 1e-3, 1e-3)});
  REQUIRE(w.step());
  CHECK(w.grain_count() == 1);
  REQUIRE(w.run(17));
  CHECK(w.state().grains.count == 1);
  CHECK(w.force(other).norm() == 0.0);
  // Steps of an undamped push of K d: v = K d t/m for the steps that it lasts, less the little that they part.
  const double mass = w.species(SpeciesId(0)).mass, steps = w.velocity(other).x() * mass / (2000.0 * 1e-6 * 1e-5);
  CHECK(steps > 1.0);
  CHECK(steps < 18.0);
}

TEST_CASE("a domain reports, removes, or lets go on") {
  for (const BeyondDomain what : {BeyondDomain::report, BeyondDomain::remove, BeyondDomain::go_on}) {
    dem::WorldOptions o = options({0, 0, -g}, 1e-5);
    o.domain = Aabb{Vec3(-1, -1, -0.01), Vec3(1, 1, 1)};
    o.beyond_domain = what;
    auto w = balls(o);
    for (int k = 0; k < 300; ++k) add(w, {3e-3 * (k % 20), 3e-3 * (k / 20), 1e-3 * (k % 7)});
    const dem::StepReport report = w.run_for(0.1);  // 49 mm
    CHECK(report.problem == (what == BeyondDomain::report ? Problem::lost : Problem::none));
    CHECK(w.grain_count() == (what == BeyondDomain::remove ? 0U : 300U));
    CHECK(w.beyond_domain().grains() == (what == BeyondDomain::remove ? 300U : 0U));
    CHECK(w.beyond_domain().mass() ==
          Approx(static_cast<double>(w.beyond_domain().grains()) * w.species(SpeciesId(0)).mass));
    if (what == BeyondDomain::report) continue;
    CHECK(w.time() == Approx(0.1));
    if (what == BeyondDomain::go_on) CHECK(w.position(GrainId(0)).z() == Approx(-0.5 * g * 0.01).epsilon(1e-3));
  }
}

TEST_CASE("grains that are not finite are reported, not counted as gone") {
  dem::WorldOptions o = options({0, 0, 0}, 1e-5);
  o.domain = Aabb{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  o.beyond_domain = BeyondDomain::remove;
  auto w = balls(o);
  add(w, {0, 0, 0});
  w.add_outlet(below_the_floor);
  REQUIRE(w.step());
  w.state().grains.position.x[0] = std::nan("");
  CHECK(w.step().problem == Problem::not_finite);
  CHECK(w.beyond_domain().grains() == 0);
}

TEST_CASE("outlets take the same grains on every number of threads, with few new neighbour lists") {
  const auto run = [](int threads) {
    dem::WorldOptions o = options({0, 0, -g}, 2e-6);
    o.threads = threads;
    auto w = balls(o);
    add_block(w, SpeciesId(0), {0, 0, 0.5e-3}, 2.1e-3, 10, 10, 10, 0.5);
    const auto hole = w.add_outlet(below_the_floor);
    REQUIRE(w.run(4000));
    const auto& taken = w.outlet(hole);
    double sum = 0.0;
    for (const GrainId p : w.grains()) sum += w.position(p).z();
    return std::tuple(taken.grains(), taken.mass(), taken.mass_flow(), sum, w.state().rebuilds);
  };
  const auto one = run(1);
  CHECK(std::get<0>(one) > 100);
  CHECK(std::get<4>(one) < 4000 / 16 + 10);
  CHECK(run(3) == one);
}

TEST_CASE("an outlet that is no box, or measures over no time, is refused") {
  auto w = balls();
  check_refused(
      [&] {
        w.add_outlet({Vec3(0, 0, 0), Vec3(1, 0, 1)}, {.name = "slot"});
      },
      "outlet 'slot'", "(0, 0, 0) m, which is not below");
  check_refused([&] { w.add_outlet({Vec3(0, 0, std::nan("")), Vec3(1, 1, 1)}); }, "lower corner");
  check_refused([&] { w.add_outlet(below_the_floor, {.window = -1.0}); }, "averaging window is -1 s");
  check_refused([&] { w.outlet(dem::OutletId(0)); }, "outlet 0 is asked for, but is not known (added so far: 0)");
}
