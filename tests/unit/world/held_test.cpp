// Grains that are held: a rough base, and grains that a machine part carries.

#include "core/error_of.hpp"
#include "scenes.hpp"

#include <dem/world/relist.hpp>

#include <tuple>
#include <vector>

using Catch::Approx;

namespace {

constexpr double radius_of_held = 2e-3, radius_of_free = 1e-3;  // m

/// Species 0 is held, species 1 moves.
template <class M>
dem::World<M> held_and_free(const dem::WorldOptions& o, double mu = 0.4) {
  dem::World<M> w(o);
  w.set_contact(sand<M>(mu));
  if constexpr (std::is_same_v<typename M::Shape, Sphere>) {
    w.add_species(Sphere(radius_of_held), {.held = true}), w.add_species(Sphere(radius_of_free));
  } else {
    w.add_species(dem::shape::cube8(radius_of_held), {.held = true});
    w.add_species(dem::shape::cube8(radius_of_free));
  }
  return w;
}
const SpeciesId held(0), free_one(1);

/// A cube without joints, with balls or cubes attached to all of its sides.
template <class World>
dem::BodyId add_rough_cube(World& w) {
  const double edge = 8e-3, out = 0.5 * edge;
  const dem::BodyId cube = w.machine().add_body(dem::mbd::box_body("cube", Vec3::Constant(edge), 2000));
  Random random(2);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-out, out}) {
      w.attach(w.add_grain({.species = held, .position = side * Vec3::Unit(axis), .rotation = random.rotation()}),
               cube);
    }
  }
  return cube;
}

}  // namespace

TEMPLATE_TEST_CASE("a rough base stands still and bears what lies on it", "", Balls, models::CorrectedBalls, Cubes) {
  auto w = held_and_free<TestType>(options({0, 0, -g}, 1e-5));
  // Four in a square, so near that they overlap: they feel nothing of each other. One more lies in their middle.
  std::vector<GrainId> base;
  const double half = 0.8 * radius_of_held;
  for (int k = 0; k < 4; ++k) {
    base.push_back(w.add_grain({held, {k % 2 == 0 ? half : -half, k / 2 == 0 ? half : -half, 0}}));
  }
  const GrainId top = w.add_grain({free_one, {0, 0, radius_of_held + 1.2 * radius_of_free}});
  for (const GrainId p : base) CHECK(w.force(p).norm() == 0.0);
  REQUIRE(w.run_for(0.2));
  Vec3 borne = Vec3::Zero();
  for (int k = 0; k < 4; ++k) {
    const GrainId p = base[static_cast<std::size_t>(k)];
    CHECK(w.position(p) == Vec3(k % 2 == 0 ? half : -half, k / 2 == 0 ? half : -half, 0));
    CHECK(w.velocity(p).norm() == 0.0);
    CHECK(w.rotation(p) == Mat3::Identity());
    borne += w.force(p);
  }
  // At rest: the damper has halved its motion a hundred times.
  const double weight = mass_of(w, top) * g;
  CHECK(borne.z() == Approx(-weight).epsilon(1e-6));
  CHECK(w.position(top).z() > 0.0);
  CHECK((w.force(top) + borne).norm() < 1e-12 * weight);
}

TEST_CASE("a ball that is attached to a part is to grains what a ball as its surface is") {
  // A part turns and carries a ball through a row of others. Without friction, as the lever arms of the two kinds of
  // contact differ by half of the overlap.
  const auto run = [](bool attached) {
    auto w = held_and_free<Balls>(options({0, 0, -1.0}, 1e-6), 0.0);
    auto& m = w.machine();
    const dem::BodyId arm = m.add_fixed_body("arm");
    m.add_motion(dem::mbd::prescribed_rotation("turn", arm, Vec3::UnitY(), dem::mbd::Signal::ramp(0, 40.0)));
    const Vec3 at(0.02, 0, 0);
    const auto sensor = m.add_sensor(dem::mbd::contact_sensor("arm", arm, 0.0));
    GrainId ball;
    if (attached) w.attach(ball = w.add_grain({.species = held, .position = at}), arm);
    else w.add_surface(arm, dem::surface::Sphere(radius_of_held), {.position = at});
    std::vector<GrainId> row;
    for (int k = 0; k < 5; ++k) row.push_back(w.add_grain({free_one, {0.02 - 1e-3 * k, 0, -3.5e-3 - 2.2e-3 * k}}));
    double hardest = 0.0, torque = 0.0;
    for (int k = 0; k < 80; ++k) {
      REQUIRE(w.run(100));
      const dem::Wrench& on_arm = m.sensor(sensor).mean();
      hardest = std::max(hardest, norm(on_arm.force)), torque += on_arm.torque.y;
    }
    if (attached) CHECK((w.position(ball) - m.body(arm).point(at)).norm() < 1e-15);
    std::vector<double> all = {hardest, torque};
    for (const GrainId p : row) {
      for (const Vec3& v : {w.position(p), w.velocity(p)}) all.insert(all.end(), v.data(), v.data() + 3);
    }
    return all;
  };
  const auto attached = run(true), as_surface = run(false);
  CHECK(attached[0] > 1e-3);  // N: it did hit
  CHECK(std::abs(attached[1]) > 1e-6);
  for (std::size_t k = 0; k < attached.size(); ++k)
    CHECK(attached[k] == Approx(as_surface[k]).epsilon(1e-9).margin(1e-11));
}

TEMPLATE_TEST_CASE("grains that hit a part's attached grains hand it their momentum and spin", "", Balls,
                   models::VerletBalls, Cubes) {
  // No joint and no weight. The part is a cube, whose spin is kept to rounding by integrators of one stage.
  auto w = held_and_free<TestType>(options({0, 0, 0}, 2e-6));
  const dem::BodyId cube = add_rough_cube(w);
  const std::size_t attached = w.grain_count();
  Random random(5);
  for (int k = 0; k < 60; ++k) {
    const Vec3 from = 0.02 * random.direction() * (1.0 + 0.1 * k);
    w.add_grain({.species = free_one, .position = from, .velocity = random.vector(0.1) - 25.0 * from});
  }
  const auto& body = w.machine().body(cube);
  const auto sums = [&] {
    Vec3 p = body.mass * body.velocity(), l = Vec3::Zero();
    const Mat3 r = body.rotation();
    const Vec3 spin = r.transpose() * body.angular_velocity();
    l = body.mass * body.position().cross(body.velocity()) + r * body.inertia.cwiseProduct(spin);
    for (const GrainId k : w.grains()) {
      if (k.index() < attached) continue;
      const double m = mass_of(w, k);
      const Mat3 turn = w.rotation(k);
      const Vec3 own = turn.transpose() * w.angular_velocity(k);
      p += m * w.velocity(k);
      l += m * w.position(k).cross(w.velocity(k)) + turn * w.species(free_one).inertia.cwiseProduct(own);
    }
    return std::pair(p, l);
  };
  const auto [p0, l0] = sums();
  double sum = 0.0;  // of the magnitudes of momentum, to which rounding is relative
  for (const GrainId k : w.grains()) sum += mass_of(w, k) * w.velocity(k).norm();
  REQUIRE(w.run(40000));
  const auto [p1, l1] = sums();
  CHECK(body.velocity().norm() > 1e-3);
  CHECK(body.angular_velocity().norm() > 0.1);
  CHECK((p1 - p0).norm() < 1e-11 * sum);
  CHECK((l1 - l0).norm() < 1e-11 * sum * 0.02);
  // They are where the part is, and move as it does.
  for (std::size_t k = 0; k < attached; ++k) {
    const Vec3 place = (k % 2 == 0 ? -4e-3 : 4e-3) * Vec3::Unit(static_cast<int>(k / 2));
    CHECK((w.position(GrainId(k)) - body.point(place)).norm() < 1e-15);
    CHECK((w.velocity(GrainId(k)) - body.point_velocity(place)).norm() < 1e-15);
    CHECK((w.angular_velocity(GrainId(k)) - body.angular_velocity()).norm() < 1e-12);
  }
}

TEST_CASE("attached grains do the same on every number of threads, many in a bed that is stirred", "[slow]") {
  const auto run = [](int threads) {
    dem::WorldOptions o = options({0, 0, -g}, 1e-5);
    o.threads = threads;
    auto w = held_and_free<models::VerletCubes>(o);
    add_open_box(w, {0.04, 0.04, 0});
    auto& m = w.machine();
    const dem::BodyId drum = m.add_fixed_body("drum", {0.02, 0.02, 5e-3});
    m.add_motion(dem::mbd::prescribed_rotation("turn", drum, Vec3::UnitY(), dem::mbd::Signal::ramp(0, 20.0)));
    const auto sensor = m.add_sensor(dem::mbd::contact_sensor("drum", drum, 0.01));
    for (int k = 0; k < 12; ++k) {
      const double a = 2 * 3.14159265358979 * k / 12;
      for (int j = 0; j < 5; ++j) {
        const Vec3 x(0.02 + 6e-3 * std::cos(a), 0.008 + 6e-3 * j, 5e-3 + 6e-3 * std::sin(a));
        w.attach(w.add_grain({held, x}), drum);
      }
    }
    add_block(w, free_one, {2e-3, 2e-3, 0.016}, 3e-3, 12, 12, 4, 0.1);
    REQUIRE(w.run(3000));
    Vec3 sum = Vec3::Zero();
    for (const GrainId p : w.grains()) sum += w.position(p) + 1e-3 * w.velocity(p);
    const dem::Wrench on_drum = m.sensor(sensor).mean();
    return std::tuple(sum.x(), sum.y(), sum.z(), on_drum.torque.y, on_drum.force.z);
  };
  const auto one = run(1);
  CHECK(std::get<4>(one) < 0.0);  // it bears a part of the bed
  CHECK(run(3) == one);
}

TEST_CASE("a bed on a rough base falls asleep") {
  dem::WorldOptions o = options({0, 0, -g}, 1e-5);
  o.sleep = dem::SleepOptions{};
  auto w = held_and_free<Cubes>(o);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) w.add_grain({held, 4e-3 * Vec3(i, j, 0)});
  }
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) w.add_grain({free_one, 4e-3 * Vec3(i, j, 0) + Vec3(0, 0, 3.05e-3)});
  }
  REQUIRE(w.run_for(0.3));
  CHECK(w.asleep_count() == w.grain_count());
}

TEST_CASE("the held twin of a species has its shape, not only its mass") {
  // Four balls on four corners of a box and on the other four are mirror images.
  const double a = 1e-3, b = 1.5e-3, c = 2e-3, r = 1.8e-3;
  std::vector<dem::Ball> left, right;
  for (const Vec3& corner : {Vec3(a, b, c), Vec3(-a, -b, c), Vec3(a, -b, -c), Vec3(-a, b, -c)}) {
    left.push_back({corner, r}), right.push_back({-corner, r});
  }
  dem::World<Cubes> w(options({0, 0, 0}, 1e-5));
  const auto l = w.add_species(Cubes::Shape(left)), m = w.add_species(Cubes::Shape(right));
  const auto twin = held_twin(w, l);
  CHECK(held_twin(w, l) == twin);
  CHECK(held_twin(w, m) != twin);
}

TEST_CASE("what cannot be held or moved is refused") {
  auto w = held_and_free<Balls>(options({0, 0, 0}, 1e-5));
  const GrainId a = w.add_grain({held, {0, 0, 0}}), b = w.add_grain({free_one, {1, 0, 0}});
  check_refused([&] { w.attach(b, w.ground()); }, "grain 1 is to be attached to a body, but moves by itself");
  check_refused([&] { w.attach(a, dem::BodyId(7)); }, "body 7 is asked for");
  check_refused([&] { w.set_velocity(a, {1, 0, 0}); }, "grain 0 is held and cannot be moved by hand");
  check_refused([&] { w.set_angular_velocity(a, {1, 0, 0}); }, "grain 0 is held");
  check_refused([&] { w.set_position(a, {1, 0, 0}); }, "grain 0 is held");
  check_refused([&] { w.add_grain({held, {0, 1, 0}, {1, 0, 0}}); }, "grain 2 is of a species that is held");
  check_refused(
      [&] {
        w.add_inlet(dem::InletRegion::box({0, 0, 0}, {1, 1, 1}), {.name = "in", .grains = held, .mass_flow = 1});
      },
      "inlet 'in' is to give grains of species 0, which is held");
  // One that is attached may be taken out.
  const dem::BodyId body = w.machine().add_body(dem::mbd::box_body("box", Vec3::Constant(1e-2), 1000));
  w.attach(a, body);
  REQUIRE(w.run(10));
  w.remove_grain(a);
  REQUIRE(w.run(100));
  CHECK(w.grain_count() == 1);
}
