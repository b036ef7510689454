#include "core/error_of.hpp"
#include "scenes.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>

#include <cmath>
#include <tuple>

using Catch::Approx;
using dem::InletRegion;

namespace {

/// Balls of 1 mm that fall from a box, 20 mm wide, without weight unless given.
template <class M = Balls>
dem::World<M> fed(const Vec3& gravity = {0, 0, 0}, double time_step = 1e-5, int threads = 1) {
  dem::WorldOptions o = options(gravity, time_step);
  o.threads = threads;
  dem::World<M> w(o);
  w.set_contact(sand<M>());
  if constexpr (std::is_same_v<typename M::Shape, Sphere>) w.add_species(Sphere(1e-3));
  else w.add_species(dem::shape::cube8(1e-3));
  return w;
}
const InletRegion above = InletRegion::box({0, 0, 0.10}, {0.02, 0.02, 0.12});

/// The smallest distance of two grains.
template <class World>
double nearest(const World& w) {
  double least = 1e300;
  const auto all = w.grains();
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) least = std::min(least, (w.position(all[a]) - w.position(all[b])).norm());
  }
  return least;
}

}  // namespace

TEST_CASE("an inlet gives its mass flow, to half a grain at any time, and no grain touches another") {
  auto w = fed();
  const double mass = w.species(SpeciesId(0)).mass, flow = 500 * mass;
  const auto in =
      w.add_inlet(above, {.name = "rain", .grains = SpeciesId(0), .mass_flow = flow, .velocity = {0, 0, -1}});
  for (int k = 1; k <= 10; ++k) {
    REQUIRE(w.run_for(0.02));
    // Batches come 64 steps apart at the most, 0.64 ms.
    CHECK(w.inlet(in).mass() <= flow * w.time() + 0.5 * mass);
    CHECK(w.inlet(in).mass() >= flow * (w.time() - 66e-5) - 0.5 * mass);
    CHECK(w.inlet(in).due() == Approx(flow * w.time()).epsilon(2e-3));
  }
  CHECK(w.inlet(in).grains() == w.grain_count());
  CHECK(w.inlet(in).mass() == Approx(static_cast<double>(w.grain_count()) * mass));
  CHECK(nearest(w) > 2e-3);
  for (const GrainId p : w.grains()) CHECK(w.velocity(p) == Vec3(0, 0, -1));
}

TEST_CASE("an inlet puts no grain deep into a solid of triangles, where nothing of it would be felt") {
  auto w = fed();
  const dem::IndexedMesh block = dem::mesh::box({0.1, 0.1, 0.1});
  w.add_surface(w.ground(), dem::surface::TriangleMesh(block),
                {.position = {-0.04, 0.01, 0.11}});  // as far as x = 10 mm
  const auto in = w.add_inlet(above, {.grains = SpeciesId(0), .grain_flow = 5000, .velocity = {0, 0, -1}});
  REQUIRE(w.run_for(0.02));
  CHECK(w.inlet(in).grains() > 50);
  for (const GrainId p : w.grains()) CHECK(w.position(p).x() > 0.011);
}

TEST_CASE("an inlet starts and ends when it should, and gives its total") {
  auto w = fed();
  const double mass = w.species(SpeciesId(0)).mass;
  const dem::Mixture balls = SpeciesId(0);
  const Vec3 off(0.1, 0, 0), down(0, 0, -1);
  const auto region = [&](int k) { return InletRegion::disc(k * off, {0, 0, 1}, 0.02); };
  const auto timed =
      w.add_inlet(region(0), {.grains = balls, .grain_flow = 1000, .start = 0.02, .end = 0.05, .velocity = down});
  const auto number =
      w.add_inlet(region(1), {.grains = balls, .grain_flow = 1000, .total_grains = 17, .velocity = down});
  const auto weight =
      w.add_inlet(region(2), {.grains = balls, .grain_flow = 1000, .total_mass = 20.4 * mass, .velocity = down});
  REQUIRE(w.run_for(0.019));
  CHECK(w.inlet(timed).grains() == 0);
  REQUIRE(w.run_for(0.1));
  CHECK(w.inlet(timed).grains() == 30);
  CHECK(w.inlet(number).grains() == 17);
  CHECK(w.inlet(weight).grains() == 20);
  CHECK(w.run(1).note.empty());
  // One that is added to a world that has run starts then.
  const auto late = w.add_inlet(region(3), {.grains = balls, .grain_flow = 1000, .velocity = down});
  REQUIRE(w.run_for(0.01));
  CHECK(w.inlet(late).grains() <= 10);
  CHECK(w.inlet(late).grains() >= 9);
}

TEST_CASE("nothing comes of an inlet that is closed, nor falls due") {
  auto w = fed();
  const dem::Mixture balls = SpeciesId(0);
  const auto in = w.add_inlet(above, {.grains = balls, .grain_flow = 1000, .end = 0.05, .velocity = {0, 0, -1}});
  REQUIRE(w.run_for(0.01));
  const std::uint64_t before = w.inlet(in).grains();
  w.set_open(in, false);
  CHECK_FALSE(w.inlet(in).is_open());
  w.set_open(in, false);
  REQUIRE(w.run_for(0.02));
  CHECK(w.inlet(in).grains() == before);
  w.set_open(in, true);
  REQUIRE(w.run_for(0.01));
  CHECK(w.inlet(in).due() == Approx(20.0).epsilon(0.01));
  w.set_open(in, false);
  REQUIRE(w.run_for(0.02));  // over its end
  w.set_open(in, true);
  REQUIRE(w.run_for(0.02));
  CHECK(w.inlet(in).due() == Approx(20.0).epsilon(0.01));
  // One that is closed before it starts loses no time by that.
  const auto later =
      w.add_inlet(InletRegion::disc({0.2, 0, 0.1}, {0, 0, 1}, 0.02),
                  {.grains = balls, .grain_flow = 1000, .start = w.time() + 0.01, .velocity = {0, 0, -1}});
  w.set_open(later, false);
  REQUIRE(w.run_for(5e-3));
  w.set_open(later, true);
  REQUIRE(w.run_for(0.015));
  CHECK(w.inlet(later).due() == Approx(10.0).epsilon(0.01));
  check_refused([&] { w.set_open(dem::InletId(7), true); }, "inlet 7 is asked for");
}

TEST_CASE("a disc gives grains on it, a box in it, evenly, with velocities in a ball") {
  auto w = fed();
  const Vec3 middle(0.3, 0.1, 0.2), normal = Vec3(1, 0, 1).normalized(), v(0, 0, -2.0);
  w.add_inlet(InletRegion::disc(middle, normal, 0.1),
              {.grains = SpeciesId(0), .grain_flow = 1e9, .total_grains = 1000, .velocity = v, .velocity_spread = 0.3});
  REQUIRE(w.run(2));  // nothing is due before the first step
  REQUIRE(w.grain_count() == 1000);
  double second = 0.0, across = 0.0, spread = 0.0;
  for (const GrainId p : w.grains()) {
    const Vec3 r = w.position(p) - w.velocity(p) * 1e-5 - middle;
    across = std::max(across, std::abs(r.dot(normal)));
    second += r.squaredNorm() / 1000;
    spread += (w.velocity(p) - v).squaredNorm() / 1000;
    CHECK(r.norm() < 0.1);
    CHECK((w.velocity(p) - v).norm() < 0.3);
  }
  CHECK(across < 1e-12);
  // R^2/2 with the deviation R^2/sqrt(12) of one, and 3/5 R^2 with sqrt(12/175) R^2; three deviations of the mean.
  CHECK(second == Approx(0.005).margin(3 * 0.01 / std::sqrt(12.0 * 1000)));
  CHECK(spread == Approx(0.6 * 0.09).margin(3 * 0.09 * std::sqrt(12.0 / 175 / 1000)));
}

TEST_CASE("grains keep clear of grains and of surfaces that are there; what does not fit is owed and told") {
  auto w = fed<Cubes>();
  const double pitch = 3e-3;
  // A wall, and a block of grains, take most of the region.
  w.add_surface(w.ground(), dem::surface::Box({0.02, 0.02, 0.01}), {.position = {0.01, 0.01, 0.105}});
  add_block(w, SpeciesId(0), {2e-3, 2e-3, 0.113}, pitch, 6, 6, 2, 0.0);
  REQUIRE(w.run(1));
  const std::size_t before = w.grain_count();
  const auto in = w.add_inlet(above, {.name = "full", .grains = SpeciesId(0), .grain_flow = 1e6});
  dem::StepReport report = w.run(200);
  INFO(report.text);
  REQUIRE(report);
  CHECK(w.inlet(in).grains() == w.grain_count() - before);
  CHECK(w.inlet(in).grains() > 0);
  CHECK(w.inlet(in).owed() == Approx(w.inlet(in).due() - static_cast<double>(w.inlet(in).grains())));
  CHECK(w.inlet(in).is_short());
  CHECK(report.note.find("inlet 'full' has put in ") != std::string::npos);
  CHECK(report.note.find("enlarge the region") != std::string::npos);
  // Nothing touches anything: without weight all that were put in stand still.
  for (const GrainId p : w.grains()) {
    CHECK(w.velocity(p).norm() == 0.0);
    CHECK(w.force(p).norm() == 0.0);
  }
}

TEST_CASE("a mixture by mass comes out by mass, and one by number by number") {
  for (const dem::ShareOf by : {dem::ShareOf::mass, dem::ShareOf::number}) {
    auto w = fed();
    const SpeciesId small = w.add_species(Sphere(0.7e-3));
    const auto in = w.add_inlet(
        InletRegion::box({0, 0, 0}, {0.4, 0.4, 0.4}),
        {.grains = {{{SpeciesId(0), 3.0}, {small, 1.0}}, by}, .grain_flow = 1e9, .total_grains = 4000, .seed = 2});
    REQUIRE(w.run(2));
    REQUIRE(w.inlet(in).grains() == 4000);
    double number = 0.0;
    for (const GrainId p : w.grains()) number += w.species_of(p) == small ? 1.0 : 0.0;
    const double ratio = 1.0 / (0.7 * 0.7 * 0.7), share = by == dem::ShareOf::mass ? ratio / (3 + ratio) : 0.25;
    CHECK(number == Approx(4000 * share).margin(3.0 * std::sqrt(4000 * share * (1 - share))));
  }
}

TEMPLATE_TEST_CASE("a grain that comes falls as one that was there from the start", "", models::CorrectedBalls, Balls,
                   models::VerletBalls) {
  // Grains fall past the place where one is put in after 200 steps. From then on it falls like one that is added by
  // hand to a world that starts there.
  auto w = fed<TestType>({0, 0, -g});
  for (int k = 0; k < 300; ++k) w.add_grain({SpeciesId(0), {0.1 + 3e-3 * (k % 20), 3e-3 * (k / 20), 0.1}});
  REQUIRE(w.run(200));
  w.add_inlet(InletRegion::box({0, 0, 0.2}, {0, 0, 0.2}),
              {.grains = SpeciesId(0), .grain_flow = 1e6, .total_grains = 1, .velocity = {0, 0, -0.5}});
  REQUIRE(w.run(500));
  auto alone = fed<TestType>({0, 0, -g});
  const GrainId one = alone.add_grain({SpeciesId(0), {0, 0, 0.2}, {0, 0, -0.5}});
  REQUIRE(alone.run(500));
  const GrainId last = w.grains().back();
  REQUIRE(last.index() == 300);
  // Its due begins with the flow: half a grain is due before the second step.
  REQUIRE(alone.position(one).z() < 0.2);
  CHECK(std::min(std::abs(w.position(last).z() - alone.position(one).z()),
                 std::abs(w.position(last).z() - alone.position(one).z() + alone.velocity(one).z() * 1e-5)) < 2e-9);
  // Those that were there feel nothing of it: free fall to rounding.
  CHECK(w.velocity(GrainId(0)).z() == Approx(-g * 700e-5).epsilon(1e-12));
  CHECK(w.velocity(last).z() == Approx(alone.velocity(one).z()).epsilon(3e-4));
}

TEST_CASE("inlets put in the same grains on every number of threads, between outlets that take them") {
  const auto run = [](int threads) {
    auto w = fed<models::VerletCubes>({0, 0, -g}, 5e-6, threads);
    add_open_box(w, {0.02, 0.02, 0});
    const SpeciesId small = w.add_species(dem::shape::cube8(0.7e-3));
    w.add_inlet(InletRegion::box({2e-3, 2e-3, 0.02}, {0.018, 0.018, 0.03}),
                {.grains = {{{SpeciesId(0), 0.6}, {small, 0.4}}},
                 .grain_flow = 2e4,
                 .velocity = {0, 0, -0.5},
                 .velocity_spread = 0.2});
    w.add_outlet({Vec3(0.012, -1, -1), Vec3(1, 1, 4e-3)});
    REQUIRE(w.run(6000));
    Vec3 sum = Vec3::Zero();
    for (const GrainId p : w.grains()) sum += w.position(p) + 1e-3 * w.velocity(p);
    return std::tuple(w.grains(), sum.x(), sum.y(), sum.z(), w.outlet(dem::OutletId(0)).grains());
  };
  const auto one = run(1);
  CHECK(std::get<0>(one).size() > 150);
  CHECK(std::get<4>(one) > 5);
  CHECK(run(3) == one);
}

TEST_CASE("inlets ask for few new neighbour lists") {
  // A flow of a grain every 20 steps, at rest: a list a batch of 64 steps and no more.
  auto w = fed();
  w.add_inlet(InletRegion::box({0, 0, 0}, {0.1, 0.1, 0.1}), {.grains = SpeciesId(0), .grain_flow = 5000});
  REQUIRE(w.run(6400));
  CHECK(w.grain_count() >= 316);
  CHECK(w.state().rebuilds <= 101);
}

TEST_CASE("an inlet that makes no sense is refused in words") {
  auto w = fed();
  const dem::Mixture balls = SpeciesId(0);
  const auto refused = [&](const dem::InletOptions& o, const char* text) {
    check_refused([&] { w.add_inlet(above, o); }, text);
  };
  refused({.name = "a", .grains = balls}, "inlet 'a' has a mass flow of 0 kg/s and a flow of 0 grains/s; give it one");
  refused({.grains = balls, .mass_flow = 1, .grain_flow = 1}, "give it one of the two");
  refused({.grains = balls, .mass_flow = -1}, "mass flow of an inlet is -1 kg/s");
  refused({.grains = balls, .mass_flow = 1, .end = 0}, "ends at 0 s, but starts at 0 s");
  refused({.grains = balls, .mass_flow = 1, .total_mass = 0}, "is to give 0 kg");
  refused({.grains = balls, .mass_flow = 1, .velocity_spread = -1}, "spread of an inlet's velocities is -1");
  refused({.mass_flow = 1}, "a mixture has no grains in it");
  refused({.grains = SpeciesId(4), .mass_flow = 1}, "species 4 is asked for, but is not known (added so far: 1)");
  refused({.grains = {{{SpeciesId(0), -1.0}}}, .mass_flow = 1}, "share of a species in a mixture is -1");
  check_refused([] { InletRegion::box({0, 0, 1}, {1, 1, 0}); }, "which is no finite box");
  check_refused([] { InletRegion::disc({0, 0, 1}, {0, 0, 0}, 1); }, "give it a direction");
  check_refused([] { InletRegion::disc({0, 0, 1}, {0, 0, 1}, 0); }, "radius of an inlet is 0 m");
}
