// Cells that are sheared without walls: what happens at a border is what happens anywhere else in the flow.

#include "world/scenes.hpp"

#include <dem/domain/sheared.hpp>
#include <dem/soil/averages.hpp>
#include <dem/world/contacts.hpp>

#include "core/error_of.hpp"

namespace sheared_test {

namespace {

struct ShearedBalls : models::LinearModel {
  using Domain = dem::domain::Sheared;
};
/// Goes back to the start of a step.
struct CorrectedShearedBalls : ShearedBalls {
  using Integrator = dem::integrator::PredictorCorrector;
};

constexpr double edge = 0.02, rate = 30.0;  // m, of the cell; 1/s

dem::WorldOptions cell(double low_z, double shear = rate) {
  dem::WorldOptions o = options(Vec3::Zero(), 1e-5);
  o.domain = dem::surface::Aabb{{0, 0, low_z}, {edge, edge, low_z + edge}};
  o.periodic = {true, true, true};
  o.shear_rate = shear;
  return o;
}

/// Balls of 2 mm that flow, with velocities of their own besides. Where the cell begins higher, those below it are the
/// ones above it that they are images of.
template <class World>
void fill(World& w, double low_z) {
  w.set_contact(
      {.normal = dem::contact::LinearSpringDashpot::with_restitution(2000.0, 0.8), .friction = {0.3, 600.0, 0.0}});
  w.add_species(dem::shape::Sphere(1e-3), {.density = 2500});
  dem::RandomStream random(7);
  for (int k = 0; k < 7; ++k) {
    for (int j = 0; j < 7; ++j) {
      for (int i = 0; i < 7; ++i) {
        Vec3 x(2.8e-3 * i + 1.5e-3, 2.8e-3 * j + 1.5e-3, 2.8e-3 * k + 1.5e-3);
        if (x.z() < low_z) x.z() += edge;
        w.add_grain({SpeciesId(0), x, Vec3(rate * x.z(), 0, 0) + random.in_ball(0.3)});
      }
    }
  }
}

template <class Model>
void check_beginnings() {
  const double up = edge / 3.0;
  dem::World<Model> one(cell(0.0)), other(cell(up));
  fill(one, 0.0), fill(other, up);
  // Cells have gone by three quarters of their lengths, and balls have met several others.
  const int steps = 2500;
  REQUIRE(one.run(steps));
  REQUIRE(other.run(steps));
  CHECK(one.state().rebuilds > 5);
  CHECK(one.state().rebuilds < 90);  // not at each crossing of a border
  const double slip = rate * edge, offset = std::remainder(slip * one.time(), edge);
  double largest = 0.0, fastest = 0.0, crossed = 0.0;
  for (const GrainId p : one.grains()) {
    Vec3 d = other.position(p) - one.position(p), v = other.velocity(p) - one.velocity(p);
    const double levels = std::round(d.z() / edge);
    d -= levels * Vec3(offset, 0, edge);
    for (int k = 0; k < 2; ++k) d[k] -= edge * std::round(d[k] / edge);
    v.x() -= levels * slip;
    crossed += std::abs(levels);
    largest = std::max(largest, d.norm());
    fastest = std::max(fastest, v.norm());
  }
  CHECK(crossed > 50.0);
  // Rounding of positions, 1e-18 m, grows tenfold in every collision or two: it is 1e-14 m after 1,000 steps and 1e-8 m
  // after 4,000. A velocity that is not changed at a border would show as 0.6 m/s.
  CHECK(largest < 1e-9);
  CHECK(fastest < 1e-6);
}

}  // namespace

TEST_CASE("a sheared cell flows the same wherever it is said to begin") {
  SECTION("velocity Verlet") { check_beginnings<ShearedBalls>(); }
  SECTION("predictor-corrector") { check_beginnings<CorrectedShearedBalls>(); }
}

TEST_CASE("momentum across a sheared flow is kept, and along it changes by whole crossings of the border") {
  dem::World<ShearedBalls> w(cell(0.0));
  fill(w, 0.0);
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (const GrainId p : w.grains()) sum += w.velocity(p);
    return sum;
  };
  const Vec3 before = momentum();
  REQUIRE(w.run(4000));
  const Vec3 gained = momentum() - before;
  CHECK(std::abs(gained.y()) < 1e-11);  // 343 velocities of 1 m/s, 4,000 steps
  CHECK(std::abs(gained.z()) < 1e-11);
  const double crossings = gained.x() / (rate * edge);
  CHECK(std::abs(crossings - std::round(crossings)) < 1e-10);
  CHECK(std::abs(crossings) > 0.5);
}

TEST_CASE("layers that rise through a border in shear flow on, and averages see one velocity gradient across it") {
  dem::World<ShearedBalls> w(cell(0.0));
  w.set_contact(
      {.normal = dem::contact::LinearSpringDashpot::with_restitution(2000.0, 0.8), .friction = {0.3, 600.0, 0.0}});
  w.add_species(dem::shape::Sphere(0.8e-3), {.density = 2500});
  constexpr double rise = 0.2;  // m/s; three layers in 0.03 s
  // Layers that pass each other without touching.
  for (int k = 0; k < 10; ++k) {
    for (int j = 0; j < 10; ++j) {
      for (int i = 0; i < 10; ++i) {
        const Vec3 x(2e-3 * (i + 0.5), 2e-3 * (j + 0.5), 2e-3 * (k + 0.5));
        w.add_grain({SpeciesId(0), x, Vec3(rate * x.z(), 0, rise)});
      }
    }
  }
  REQUIRE(w.run(3000));
  const double risen = rise * w.time();
  for (const GrainId p : w.grains()) {
    CHECK(w.velocity(p).x() == Catch::Approx(rate * (w.position(p).z() - risen)).margin(1e-9));
  }
  // Cells of 4 mm that reach over both borders: those half outside hold images, which flow on beyond.
  const auto slices = dem::soil::average_slices(w, {{0, 0, -2e-3}, {edge, edge, edge + 2e-3}}, 2, 6);
  for (std::size_t k = 0; k < 6; ++k) {
    const double z = -2e-3 + 4e-3 * (static_cast<double>(k) + 0.5);
    CHECK(slices[k].velocity.x() == Catch::Approx(rate * (z - risen)).margin(1e-9));
  }
}

TEST_CASE("shear may be reversed, and stops where its rate is zero") {
  dem::World<ShearedBalls> w(cell(0.0));
  fill(w, 0.0);
  REQUIRE(w.run(1000));
  CHECK(w.state().domain.offset() == Catch::Approx(rate * edge * 0.01));
  w.set_shear_rate(-rate);
  REQUIRE(w.run(1000));
  CHECK(std::abs(w.state().domain.offset()) < 1e-12);
  w.set_shear_rate(0.0);
  REQUIRE(w.run(100));
  CHECK(std::abs(w.state().domain.offset()) < 1e-12);
  check_refused([&] { w.set_shear_rate(std::nan("")); }, "shear rate");
}

TEST_CASE("a sheared cell that cannot be is refused in words") {
  check_refused([] { dem::World<ShearedBalls>(cell(0.0)).set_sleep(dem::SleepOptions{}); }, "cannot sleep");
  check_refused(
      [] {
        dem::WorldOptions o = cell(0.0);
        o.sleep = dem::SleepOptions{};
        dem::World<ShearedBalls> w(o);
        fill(w, 0.0);
        w.prepare();
      },
      "grains that may sleep");
  check_refused(
      [] {
        dem::WorldOptions o = cell(0.0);
        o.periodic.x = false;
        dem::World<ShearedBalls> w(o);
      },
      "along x and z at least");
  check_refused(
      [] {
        dem::WorldOptions o;
        o.shear_rate = 1.0;
        dem::World<models::LinearModel> w(o);
      },
      "model is not sheared");
  check_refused(
      [] {
        dem::World<ShearedBalls> w(cell(0.0));
        fill(w, 0.0);
        w.add_surface(w.ground(), dem::surface::Plane{}, {.name = "floor"});
        w.prepare();
      },
      "surface 'floor'");
}

}  // namespace sheared_test
