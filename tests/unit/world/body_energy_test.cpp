#include "scenes.hpp"

#include <dem/geometry/box/box.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/mbd/sensor/energy_balance.hpp>

#include <array>

using dem::BodyId;
using dem::contact::LinearSpringDashpot;
using dem::mbd::box_body;
using dem::surface::Box;

// The shares of a contact's points have no potential (contact/weights.hpp), so a contact may gain energy, and dampers
// must take more. Restitutions of 0.7 and 0.5 are damping ratios of 0.11 and 0.22.

namespace {

using Sprung = models::LinearModel;

double kinetic_energy_of(const dem::Body& body) {
  const Vec3 spin = body.rotation().transpose() * body.angular_velocity();
  return 0.5 * body.mass * body.velocity().squaredNorm() + 0.5 * spin.dot(body.inertia.cwiseProduct(spin));
}

/// The kinetic energy of a block that rocks on its four corners, never lifting them: over that at the start, the most
/// that it has in the first and in the second of two times of 10 swings.
std::array<double, 2> rock(double height, double damping_ratio) {
  const double width = 0.1, K = 1e5, density = 1000.0;
  dem::World<Sprung> w(options({0, 0, -g}, 2e-5));
  w.set_contact({{K, damping_ratio}, {0.0, 1.0, 0.0}});
  const Vec3 edges(width, width, height * width);
  const double mass = density * edges.prod(), sunk = mass * g / K,
               inertia = mass / 12 * (1 + height * height) * width * width;
  // Two points of a share each that grows with the overlap are as stiff for rocking as two whole springs.
  const double swing = std::sqrt(2.0 * K * 0.25 * width * width / inertia);
  const double speed = 0.9 * sunk / (0.5 * width) * swing;
  const BodyId block = w.machine().add_body(
      box_body("block", edges, density).at({0, 0, 0.5 * edges.z() - sunk}).moving({0, 0, 0}, {0, speed, 0}));
  w.add_body_contact(w.add_surface(block, Box(edges)), w.add_surface(w.ground(), dem::surface::Plane{}));
  const double start = 0.5 * inertia * speed * speed, time = 10.0 * 2.0 * std::numbers::pi / swing;
  std::array<double, 2> most = {};
  for (double& energy : most) {
    for (const double end = w.time() + time; w.time() < end;) {
      if (const auto report = w.step(); !report) FAIL(report.text);
      energy = std::max(energy, kinetic_energy_of(w.machine().body(block)) / start);
    }
  }
  return most;
}

/// The kinetic energy of two boxes that meet as they tumble, after over before.
double tumble(unsigned seed, double restitution) {
  dem::World<Sprung> w(options({0, 0, 0}, 2e-5));
  w.set_contact({LinearSpringDashpot::with_restitution(1e5, restitution), {0.0, 1.0, 0.0}});
  Random random(seed);
  const Vec3 a(0.1, 0.08, 0.06), b(0.12, 0.05, 0.05);
  const auto add = [&](const char* name, const Vec3& edges, double side) {
    const BodyId body = w.machine().add_body(box_body(name, edges, 800)
                                                 .at({side * 0.08, 0, 0}, random.rotation())
                                                 .moving({-side, 0, 0}, random.in({9, 9, 9})));
    return std::pair(body, w.add_surface(body, Box(edges)));
  };
  const auto [first, first_surface] = add("first", a, -1.0);
  const auto [second, second_surface] = add("second", b, 1.0);
  w.add_body_contact(first_surface, second_surface);
  const auto energy = [&, i = first, j = second] {
    return kinetic_energy_of(w.machine().body(i)) + kinetic_energy_of(w.machine().body(j));
  };
  const double before = energy();
  if (const auto report = w.run_for(0.06); !report) FAIL(report.text);
  return energy() / before;
}

}  // namespace

TEST_CASE("a block that rocks on its corners comes to rest with a tenth of critical damping") {
  // Without dampers it reaches 1.2, 1.5 and 1.05 times its energy; the last is near the resonance of rocking with
  // bouncing, where a plane model finds up to ten times at other amplitudes.
  for (const double height : {1.0, 3.0, 4.75}) {
    CAPTURE(height);
    const auto [first, later] = rock(height, 0.1);
    CHECK(first < 1.01);  // the start itself is the most
    CHECK(later < 0.05);
    CHECK(rock(height, 0.2)[1] < 0.01);
  }
}

TEST_CASE("boxes that collide as they tumble lose energy where their dampers make up for their shares") {
  // Of 60 pairs none kept more than 0.93 of its energy with a restitution of 0.5; with 0.7 two or three gained, 12 % at
  // the most, and the mean was 0.64. Stiffness made no difference: what is gained is a share of what is stored.
  double mean = 0.0;
  constexpr unsigned pairs = 20;
  for (unsigned seed = 1; seed <= pairs; ++seed) {
    CAPTURE(seed);
    CHECK(tumble(seed, 0.5) < 1.0);
    const double kept = tumble(seed, 0.7);
    CHECK(kept < 1.2);
    mean += kept / pairs;
  }
  CHECK(mean < 0.8);
}

TEST_CASE("what a fixed body does to grains as a motion moves it is work of its drive") {
  using dem::mbd::Signal;
  for (const bool by_pose : {false, true}) {
    CAPTURE(by_pose);
    dem::World<Balls> w(options({0, 0, -g}, 1e-5));
    w.set_contact(sand<Balls>());
    const auto ball = w.add_species(Sphere(1e-3));
    w.add_grain({ball, {0, 0, 1e-3}});
    auto& m = w.machine();
    const BodyId lift = m.add_fixed_body("lift", {0, 0, 0});
    w.add_surface(lift, dem::surface::Plane{});
    if (by_pose) {
      m.add_motion(dem::mbd::prescribed_pose("up", lift, [](double t) {
        return dem::mbd::Pose{.position = {0, 0, 0.1 * t}};
      }));
    } else {
      m.add_motion(dem::mbd::prescribed_position("up", lift, Vec3::UnitZ(), Signal::ramp(0, 0.1)));
    }
    w.prepare();
    dem::mbd::EnergyBalance balance(m, {0, 0, -g}, w.time());
    REQUIRE(w.run_for(0.2, [&] {
      balance.follow(w.time());
      return true;
    }));
    // It was lifted by 20 mm, and moves at 0.1 m/s; the damper of the first touch took some.
    const double mass = w.species(ball).mass, lifted = mass * g * 0.02 + 0.5 * mass * 0.01;
    CHECK(balance.work_of_drives() > lifted);
    CHECK(balance.work_of_drives() < 1.05 * lifted);
    CHECK(balance.work_of_contacts() == Approx(-balance.work_of_drives()).epsilon(1e-3));
    CHECK(std::abs(balance.error()) < 1e-3 * lifted);
  }
}
