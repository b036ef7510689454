#include "scenes.hpp"

using Catch::Approx;

namespace {

constexpr double half_size = 1e-3;  // m, radius of the balls and half-edge of the cubes
struct Place {
  Vec3 origin, normal;
};

/// Well damped, so that grains are soon at rest.
template <class Model>
dem::ContactParameters<Model> damped() {
  return {{2000.0, 0.1, 1.0}, {0.4, 2000.0, 0.1, 1.0}};
}

}  // namespace

TEMPLATE_TEST_CASE("a grain rests on a plane wherever that is, whichever way it faces", "", Balls, Cubes) {
  const bool ball = std::is_same_v<TestType, Balls>;
  const Place places[] = {
      {{0, 0, 0.7}, {0, 0, 1}},               // a floor above the origin
      {{0, 0, -0.7}, {0, 0, -1}},             // a ceiling below it, with gravity up
      {{1.0, 0, 0}, {1, 0, 0}},               // walls
      {{0, -2.0, 0}, {0, 1, 0}},              // a half space without the origin
      {{0.3, -0.4, 0.5}, Vec3(1, -2, 2) / 3}  // askew
  };
  for (const Place& place : places) {
    CAPTURE(place.origin.transpose(), place.normal.transpose());
    dem::World<TestType> w(options(-g * place.normal, 5e-6));
    w.set_contact(damped<TestType>());
    const auto species = [&] {
      if constexpr (std::is_same_v<TestType, Balls>) return w.add_species(Sphere(half_size));
      else return w.add_species(dem::shape::cube8(half_size));
    }();
    const Mat3 turn = dem::rotation_between(Vec3::UnitZ(), place.normal);
    const auto plane = w.add_surface(w.ground(), dem::surface::Plane{}, {.position = place.origin, .rotation = turn});
    // It falls a millimetre, to a place a little off the plane's origin.
    const Vec3 along = turn * Vec3(2e-3, -3e-3, 0);
    const auto p = w.add_grain({species, place.origin + along + 2 * half_size * place.normal, Vec3::Zero(), turn});
    REQUIRE(w.run_for(0.15));
    // A ball stands on one spring, a cube on four. A millimetre is fallen in 14 ms, and the bounces, each to a third of
    // the speed, last 20 ms; then the swing dies as exp(-4500/s t). A rounding of 1e-16 m is 2e-9 of the overlap.
    const double weight = mass_of(w, p) * g, overlap = weight / (ball ? 2000.0 : 8000.0);
    CHECK((w.position(p) - place.origin - along - (half_size - overlap) * place.normal).norm() < 1e-8 * half_size);
    CHECK((w.surface_force(plane) + weight * place.normal).norm() < 1e-6 * weight);
    CHECK(w.velocity(p).norm() < 1e-9);
  }
}

TEST_CASE("a plane on a body that rises lifts a ball") {
  // The plane lies on top of its body and starts below the origin; it ends above, at 1 m/s^2 all the way.
  const double start = -0.05, above_body = 0.2, rise = 1.0, time = 0.45;
  dem::World<Balls> w(options({0, 0, -g}, 5e-6));
  w.set_contact(damped<Balls>());
  const auto species = w.add_species(Sphere(half_size));
  const auto lift = w.machine().add_fixed_body("lift", {0, 0, start - above_body});
  w.machine().add_motion(dem::mbd::prescribed_position(
      "rise", lift, Vec3::UnitZ(),
      dem::mbd::Signal::function([=](double t) { return 0.5 * rise * t * t; }, [=](double t) { return rise * t; })));
  const auto plane = w.add_surface(lift, dem::surface::Plane{}, {.position = {0, 0, above_body}});
  const auto ball = w.add_grain({species, Vec3(0.01, 0.02, start + half_size)});
  REQUIRE(w.run_for(time));
  const double m = mass_of(w, ball), load = m * (g + rise), top = start + 0.5 * rise * time * time;
  REQUIRE(top > 0.05);
  // The swing of the first moments died as exp(-4500/s t). The plane is where it will be at the end of the step, the
  // force is that of its start: the speed times a step, 2 micrometres, between them.
  CHECK(w.position(ball).z() == Approx(top + half_size - load / 2000.0).margin(rise * time * w.time_step() + 1e-9));
  CHECK(w.velocity(ball).z() == Approx(rise * time).epsilon(1e-4));
  CHECK(w.surface_force(plane).z() == Approx(-load).epsilon(1e-6));
  CHECK(w.velocity(ball).head(2).norm() < 1e-12);
}
