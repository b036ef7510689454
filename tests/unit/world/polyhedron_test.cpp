#include "scenes.hpp"

#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/polyhedron/polyhedron_sphere.hpp>

namespace polyhedron_test {

using Catch::Approx;
using dem::shape::Polyhedron;

namespace {

using Sharp = Grains<Polyhedron, dem::integrator::VelocityVerlet>;
constexpr double half_edge = 1.2e-3, mu = 0.4;

Mat3 about(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(axis.normalized())).toRotationMatrix();
}

/// A cube on a plane, pressed in as far as K = 2000 N/m carries its weight, under gravity tilted by `slope` =
/// tan(angle).
struct Incline {
  dem::World<Sharp> world;
  SurfaceId plate;
  GrainId block;
  double angle;

  explicit Incline(double slope, double breaking_factor = 0.975)
      : world(options(g * Vec3(std::sin(std::atan(slope)), 0, -std::cos(std::atan(slope))), 1e-5)),
        angle(std::atan(slope)) {
    world.set_contact(sand<Sharp>(mu, breaking_factor));
    const auto cube = world.add_species(dem::shape::cube(half_edge));
    plate = world.add_surface(world.ground(), dem::surface::Plane{});
    dem::NewGrain n;
    n.species = cube;
    n.position = {0, 0, half_edge - world.species(cube).mass * g * std::cos(angle) / 2000.0};
    block = world.add_grain(n);
  }
  double weight() const { return world.species(SpeciesId(0)).mass * g; }
};

template <class World>
double energy(const World& w) {  // of motion and height
  double sum = kinetic_energy(w);
  for_each_grain(w, [&](GrainId p) { sum += mass_of(w, p) * g * w.position(p).z(); });
  return sum;
}

}  // namespace

TEST_CASE("a polyhedral cube that came to rest weighs m g") {
  Incline scene(0.0);
  auto& w = scene.world;
  w.set_velocity(scene.block, {0, 0, -0.01});
  // The swing decays with (1 + Sp)/4 C/m = 108/s: e^-54 in half a second.
  REQUIRE(w.run_for(0.5));
  CHECK((w.surface_force(scene.plate) - Vec3(0, 0, -scene.weight())).norm() < 1e-9 * scene.weight());
  CHECK(w.velocity(scene.block).norm() < 1e-12);
  // A face on a plane has the stiffness K, so the cube lies m g/K deep.
  CHECK(half_edge - w.position(scene.block).z() == Approx(scene.weight() / 2000.0).epsilon(1e-6));
}

TEST_CASE("a polyhedral cube sticks below and slides above the angle of friction") {
  Incline sticking(0.95 * mu);
  REQUIRE(sticking.world.run_for(0.4));
  const Vec3 settled = sticking.world.position(sticking.block);
  // As the weight comes on at once, some asperities break: a few dozen stretches of the patch's spring of 2000 N/m.
  CHECK(std::abs(settled.x()) < 3e-3 * half_edge);
  REQUIRE(sticking.world.run_for(0.1));
  const double stretch = sticking.weight() * std::sin(sticking.angle) / 2000.0;  // of the patch's friction spring
  CHECK((sticking.world.position(sticking.block) - settled).norm() < 1e-5 * stretch);

  Incline sliding(1.05 * mu, 1.0);
  auto& w = sliding.world;
  const double expected = g * (std::sin(sliding.angle) - mu * std::cos(sliding.angle));
  REQUIRE(w.run_for(0.1));
  const double v1 = w.velocity(sliding.block).x();
  REQUIRE(w.run_for(0.1));
  // What is left of the vertical swing changes the normal force by some 1e-5.
  CHECK((w.velocity(sliding.block).x() - v1) / 0.1 == Approx(expected).epsilon(1e-4));
}

TEST_CASE("a cube sticks to a cube below the angle of friction, and slides above it") {
  for (const double slope : {0.95 * mu, 1.05 * mu}) {
    dem::World<Sharp> w(options({0, 0, -g}, 1e-5));
    w.set_contact(sand<Sharp>(mu));
    w.set_contact("grain", "wall", sand<Sharp>(2.0));  // the lower one stays
    dem::NewGrain n;
    n.species = w.add_species(dem::shape::cube(half_edge));
    w.add_surface(w.ground(), dem::surface::Plane{});
    const double sink = w.species(n.species).mass * g / 2000.0;
    n.position = {0, 0, half_edge - 2.0 * sink};
    const auto lower = w.add_grain(n);
    n.position += Vec3(1e-4, 0.7e-4, 2.0 * half_edge - sink);
    n.rotation = about(Vec3::UnitZ(), 0.15);  // edges cross edges
    const auto upper = w.add_grain(n);
    // Tilted in 0.2 s: all at once, the stack would bounce.
    for (int k = 1; k <= 40; ++k) {
      const double angle = std::atan(slope) * k / 40.0;
      w.set_gravity(g * Vec3(std::sin(angle), 0, -std::cos(angle)));
      REQUIRE(w.run_for(0.005));
    }
    const Vec3 before = w.position(upper) - w.position(lower);
    REQUIRE(w.run_for(0.1));
    const double moved = (w.position(upper) - w.position(lower) - before).norm();
    // Sticking: what is left of its swing, of a stretch of the spring, 7e-8 m. Sliding: g (sin - mu cos) t^2/2 is 9e-4
    // m.
    if (slope < mu) {
      CHECK(moved < 2e-7);
    } else {
      CHECK(moved > 5e-4);
    }
  }
}

TEST_CASE("a cube that stands on its edge falls on the face that it leans to") {
  dem::World<Sharp> w(options({0, 0, -g}, 1e-5));
  w.set_contact(sand<Sharp>());
  const auto cube = w.add_species(dem::shape::cube(half_edge));
  const auto plate = w.add_surface(w.ground(), dem::surface::Plane{});
  dem::NewGrain n;
  n.species = cube;
  std::vector<GrainId> cubes;
  for (const double lean : {-0.01, 0.01}) {
    n.rotation = about(Vec3::UnitX(), 0.25 * std::numbers::pi + lean);
    n.position = {lean, 0, std::sqrt(2.0) * half_edge};
    cubes.push_back(w.add_grain(n));
  }
  REQUIRE(w.run_for(0.6));
  CHECK(w.rotation(cubes[0])(2, 2) == Approx(1.0).epsilon(1e-6));  // back to where it was at 0
  CHECK(w.rotation(cubes[1])(2, 1) == Approx(1.0).epsilon(1e-6));  // on to 90 degrees
  for (const GrainId p : cubes) CHECK(w.position(p).z() == Approx(half_edge).epsilon(1e-3));
  CHECK(w.surface_force(plate).z() == Approx(-2.0 * w.species(cube).mass * g).epsilon(1e-4));
}

TEST_CASE("a stack of five cubes carries its weight and stays") {
  dem::World<Sharp> w(options({0, 0, -g}, 1e-5));
  w.set_contact(sand<Sharp>());
  const auto cube = w.add_species(dem::shape::cube(half_edge));
  const auto plate = w.add_surface(w.ground(), dem::surface::Plane{});
  const double weight = w.species(cube).mass * g, k = 2000.0;
  // Each contact is pressed in by what it carries. Aligned: corners on corners, the hardest case for features; the
  // upper ones are turned.
  dem::NewGrain n;
  n.species = cube;
  n.position.z() = half_edge - 5.0 * weight / k;
  std::vector<Vec3> start;
  for (int level = 0; level < 5; ++level) {
    if (level > 2) n.rotation = about(Vec3::UnitZ(), 0.2 * level);
    w.add_grain(n);
    start.push_back(n.position);
    n.position.z() += 2.0 * half_edge - (4.0 - level) * weight / k;
  }
  REQUIRE(w.run_for(0.2));
  for (std::size_t level = 0; level < 5; ++level) {
    // Rounding of overlaps, 1e-18 m, and of forces, over 20,000 steps.
    CHECK((w.position(GrainId(level)) - start[level]).norm() < 1e-9 * half_edge);
    CHECK(w.force(GrainId(level)).z() == Approx(weight).epsilon(1e-6));
  }
  CHECK(w.surface_force(plate).z() == Approx(-5.0 * weight).epsilon(1e-6));
}

TEST_CASE("a column of cubes between plates slides or leans, whichever resists less", "[slow]") {
  // A column of n loose cubes under a lid that bears N stands on its edges when it leans: a shear T on lid and floor
  // then has T h = N w, so it resists with N/n, below the mu N of sliding where n > 1/mu. A bed of sharp cubes in
  // columns is therefore weaker than a flat layer that slides.
  const int cubes = GENERATE(1, 2, 3, 5);
  CAPTURE(cubes);
  const double k = 80e3, load = 0.45, speed = 2e-3;  // N/m, N: 45 kPa on 3.2 mm squares, m/s
  dem::World<Sharp> w(options({0, 0, -g}));
  w.set_contact({{k, 0.06, 1.0}, {mu, k, 0.06, 1.0}});
  dem::NewGrain n;
  n.species = w.add_species(dem::shape::cube(1.6e-3));
  n.position.z() = 1.6e-3;
  for (int level = 0; level < cubes; ++level, n.position.z() += 3.2e-3) w.add_grain(n);
  const dem::BodyId table = w.machine().add_fixed_body("table");
  w.add_surface(table, dem::surface::Plane{});
  w.machine().add_motion(
      dem::mbd::prescribed_position("feed", table, Vec3::UnitX(), dem::mbd::Signal::function([=](double t) {
                                      return speed * std::max(0.0, t - 0.05);  // the lid has come to rest by then
                                    })));
  const Vec3 edges(0.02, 0.02, 0.004);
  const double top = 3.2e-3 * cubes + 0.5 * edges.z();
  const dem::BodyId lid =
      w.machine().add_body(dem::mbd::box_body("lid", edges, load / g / edges.prod()).at({0, 0, top}));
  w.machine().add_joint(dem::mbd::prismatic("slide", w.ground(), lid, {0, 0, top}, Vec3::UnitZ()));
  const SurfaceId felt = w.add_surface(lid, dem::surface::Box(edges));
  w.machine().add_spring(dem::mbd::spring("rest", w.ground(), {0, 0, -1.0}, lid, {0, 0, 0}, 0.0, 80.0));
  REQUIRE(w.run_for(0.06));
  double most = 0.0, last = 0.0;
  for (int part = 0; part < 60; ++part) {
    REQUIRE(w.run_for(1e-3));
    const Vec3 force =
        w.surface_force(felt);  // the damper carries some of the load as the leaning column lifts the lid
    last = force.x() / force.z();
    most = std::max(most, last);
  }
  // As the column leans by its tilt the arm is w - h * tilt: some 0.004 until the edges alone carry the load of which
  // each contact is pressed in by 6e-6 m, and 0.01 in the end; one that slides leans by 0.003.
  const bool leans = 1.0 / cubes < mu;
  const double tilt = std::abs(w.rotation(GrainId(0))(0, 2));
  CHECK(most == Approx(std::min(mu, 1.0 / cubes)).margin(0.005));
  CHECK(last == Approx(leans ? 1.0 / cubes - tilt : mu).margin(0.003));
  CHECK((tilt > 0.006) == leans);
}

TEST_CASE("polyhedra keep momentum and angular momentum to rounding") {
  dem::World<Sharp> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Sharp>());
  const SpeciesId kinds[] = {w.add_species(dem::shape::cube(1.2e-3)), w.add_species(dem::shape::tetrahedron(2e-3)),
                             w.add_species(dem::shape::octahedron(1.6e-3))};
  Random random(5);
  for (int k = 0; k < 64; ++k) {
    dem::NewGrain p;
    p.species = kinds[k % 3];
    p.position = 4.2e-3 * Vec3(k % 4, k / 4 % 4, k / 16);
    p.rotation = random.rotation();
    p.velocity = -40.0 * (p.position - Vec3::Constant(6.3e-3)) + random.vector(0.1);
    p.angular_velocity = random.vector(50.0);
    w.add_grain(p);
  }
  const Vec3 p0 = momentum(w), l0 = angular_momentum(w);
  const double e0 = kinetic_energy(w);
  double p_size = 0.0, l_size = 0.0;
  for_each_grain(w, [&](GrainId p) {
    p_size += mass_of(w, p) * w.velocity(p).norm();
    l_size += mass_of(w, p) * w.velocity(p).norm() * w.position(p).norm();
  });
  REQUIRE(w.run(3000));
  CHECK(kinetic_energy(w) < 0.8 * e0);  // they did collide
  // Each of 3,000 steps rounds by 1e-16 of each of the grains' own share. All of these bodies have the same inertia
  // about every axis, so that the scheme keeps angular momentum exactly.
  CHECK((momentum(w) - p0).norm() < 1e-12 * p_size);
  CHECK((angular_momentum(w) - l0).norm() < 1e-12 * l_size);
}

TEST_CASE("without dampers a collision of polyhedra gives back its energy within a tenth, as often more as less") {
  // Shares change with the overlap, so the force of a patch has no potential. These are hard cases: overlaps of
  // percents of the cubes' size, reached while patches turn into edges and corners.
  Random random(2);
  double sum = 0.0, worst = 0.0;
  int n = 0;
  for (int trial = 0; trial < 20; ++trial) {
    dem::World<Sharp> w(options({0, 0, 0}, 2e-6));
    w.set_contact({{2000.0, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
    dem::NewGrain p;
    p.species = w.add_species(dem::shape::cube(half_edge));
    for (const double side : {-1.0, 1.0}) {
      p.position = {side * 2.1e-3, side * 3e-4 * random.between(-1.0, 1.0), side * 1e-4};
      p.velocity = {-side * 0.2, 0, 0};
      p.rotation = random.rotation();
      p.angular_velocity = random.vector(20.0);
      w.add_grain(p);
    }
    const double e0 = kinetic_energy(w);
    double least = e0;
    for (int k = 0; k < 80; ++k) {
      REQUIRE(w.run(100));
      least = std::min(least, kinetic_energy(w));
    }
    if (w.force(GrainId(0)).norm() > 0.0 || least > 0.9 * e0) continue;  // did not hit, or still does
    const double change = kinetic_energy(w) / e0 - 1.0;
    sum += change;
    worst = std::max(worst, std::abs(change));
    ++n;
  }
  REQUIRE(n > 10);
  CHECK(worst < 0.1);
  CHECK(std::abs(sum / n) < 0.02);
}

TEST_CASE("a pile of polyhedra loses its energy, and never takes any from nowhere", "[slow]") {
  dem::World<Sharp> w(options({0, 0, -g}, 1e-5));
  w.set_contact(sand<Sharp>());
  const auto cube = w.add_species(dem::shape::cube(half_edge));
  const auto rock = w.add_species(dem::shape::rock({.length = 3e-3, .elongation = 0.8, .flatness = 0.7, .points = 14}));
  add_open_box(w, {0.013, 0.013, 0});
  add_block(w, cube, {2.5e-3, 2.5e-3, 2.5e-3}, 4e-3, 3, 3, 2, 0.1);
  add_block(w, rock, {2.5e-3, 2.5e-3, 10.5e-3}, 4e-3, 3, 3, 2, 0.1, 2);
  const double start = energy(w);
  double lowest = start, largest_gain = 0.0;
  for (int k = 0; k < 300; ++k) {
    REQUIRE(w.run(100));
    const double now = energy(w);
    largest_gain = std::max(largest_gain, now - lowest);
    lowest = std::min(lowest, now);
  }
  // What springs hold in between comes back: less than a hundredth of what the grains had.
  CHECK(largest_gain < 0.01 * start);
  CHECK(kinetic_energy(w) < 1e-3 * start);
}

TEST_CASE("polyhedra do among other kinds what they do alone") {
  // A heap that slides, tips and comes to rest. Neither friction that a patch remembers while its points change, nor
  // anything else, may depend on whether the grains could have been of another kind: equal to the last bit.
  const auto heap = []<class Shape>(std::type_identity<Shape>) {
    dem::World<Grains<Shape, dem::integrator::VelocityVerlet>> w(options({1.0, 0.5, -g}, 1e-5, 3e-4));
    w.set_contact({{2000.0, 0.015, 0.05}, {mu, 2000.0, 0.015, 0.975}});
    add_open_box(w, Vec3::Constant(8e-3));
    add_block(w, w.add_species(dem::shape::cube(half_edge)), {2.2e-3, 2.2e-3, 2.2e-3}, 3.6e-3, 2, 2, 5, 0.2);
    REQUIRE(w.run(8000));
    std::vector<Vec3> places;
    for_each_grain(w, [&](GrainId p) { places.push_back(w.position(p)); });
    return places;
  };
  using Any = dem::shape::Mixed<Sphere, Polyhedron>;
  CHECK(heap(std::type_identity<Any>{}) == heap(std::type_identity<Polyhedron>{}));
}

}  // namespace polyhedron_test
