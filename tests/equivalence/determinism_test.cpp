#include "scale.hpp"
#include "world/scenes.hpp"

#include <bit>
#include <cstdint>

namespace {

/// Mixes the bits of every position, velocity, rotation and spin: of the grains, by their ids, and of the machine.
template <class World>
std::uint64_t state_hash(const World& w) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto mix = [&](const auto& numbers) {
    for (Eigen::Index k = 0; k < numbers.size(); ++k) {
      hash ^= std::bit_cast<std::uint64_t>(numbers.data()[k]);
      hash *= 0x100000001b3ULL;
      hash ^= hash >> 29;
    }
  };
  for_each_grain(w, [&](GrainId p) {
    for (const Vec3& v : {w.position(p), w.velocity(p), w.angular_velocity(p)}) mix(v);
    mix(w.rotation(p));
  });
  for (const dem::Body& b : w.machine().bodies()) {
    for (const Vec3& v : {b.position(), b.velocity(), b.angular_velocity()}) mix(v);
    mix(b.rotation());
  }
  return hash;
}

/// Cubes of two sizes poured into a box whose side shakes, on a number of threads.
template <class Integrator>
struct Poured {
  dem::World<Grains<Cube8, Integrator>> world;
  std::vector<SurfaceId> walls;

  explicit Poured(int threads, unsigned seed = 1)
      : world([&] {
          dem::WorldOptions o = options({0, 0, -9.81}, 1e-5);
          o.threads = threads;
          return o;
        }()) {
    using Model = Grains<Cube8, Integrator>;
    world.set_contact(sand<Model>());
    world.set_contact("grain", "wall", sand<Model>(0.2));
    const auto large = world.add_species(dem::shape::cube8(1.2e-3)),
               small = world.add_species(dem::shape::cube8(0.9e-3));
    walls = add_open_box(world, {0.02, 0.02, 0});
    add_block(world, large, {2.5e-3, 2.5e-3, 2.5e-3}, 3.6e-3, 5, 5, 6, 0.5, seed);
    add_block(world, small, {2.5e-3, 2.5e-3, 2.5e-3 + 6 * 3.6e-3}, 3.0e-3, 5, 5, 26, 0.5, seed + 1);
  }
  /// Gravity swings: the box is shaken.
  void run(int steps) {
    for (int k = 0; k < steps; k += 500) {
      world.set_gravity({k % 1000 == 0 ? 4.0 : -4.0, 0, -9.81});
      REQUIRE(world.run(500));
    }
  }
};

/// Cubes beside a flap that hangs from a slider: the slider is moved to and fro, the flap swings on its hinge as the
/// cubes push it.
struct Stirred {
  dem::World<Grains<Cube8, dem::integrator::VelocityVerlet>> world;
  dem::BodyId flap;
  dem::JointId hinge;
  SurfaceId front;

  explicit Stirred(int threads)
      : world([&] {
          dem::WorldOptions o = options({0, 0, -9.81}, 1e-5);
          o.threads = threads;
          return o;
        }()) {
    world.set_contact(sand<Grains<Cube8, dem::integrator::VelocityVerlet>>());
    add_open_box(world, {0.028, 0.020, 0});
    add_block(world, world.add_species(dem::shape::cube8(1.2e-3)), {0.010, 2.5e-3, 2.5e-3}, 3.6e-3, 5, 5, 12, 0.5);
    auto& m = world.machine();
    const Vec3 edges(2e-3, 0.016, 0.022), top(5e-3, 0.010, 0.026);
    const auto slider = m.add_body(dem::mbd::box_body("slider", Vec3::Constant(4e-3), 2650).at(top));
    flap = m.add_body(dem::mbd::box_body("flap", edges, 2650).at(top - Vec3(0, 0, 0.5 * edges.z())));
    const auto slide = m.add_joint(dem::mbd::prismatic("slide", world.ground(), slider, top, Vec3::UnitX()));
    hinge = m.add_joint(dem::mbd::revolute("hinge", slider, flap, top, Vec3::UnitY()));
    m.add_motion(dem::mbd::prescribed_joint(
        "stirring", slide, dem::mbd::Signal::function([](double t) { return 2e-3 * (1.0 - std::cos(300.0 * t)); })));
    front = world.add_surface(flap, dem::surface::Box(edges));
  }
};

}  // namespace

TEMPLATE_TEST_CASE("the state is the same to the last bit on any number of threads", "",
                   dem::integrator::VelocityVerlet, dem::integrator::SymplecticEuler,
                   dem::integrator::PredictorCorrector) {
  // 3,000 steps, and fewer with the scheme that costs twice as much (it shares everything but the integrator).
  const int steps = scaled(TestType::stages > 1 ? 1000 : 3000);
  Poured<TestType> one(1);
  one.run(steps);
  const std::uint64_t expected = state_hash(one.world);
  // Lists were made anew, and grains re-sorted, many times, and there is something to share out.
  CHECK(one.world.state().rebuilds > scaled<std::uint64_t>(10));
  CHECK(one.world.state().chunks.size() > 2);
  for (const int threads : {2, 3, 8}) {
    Poured<TestType> many(threads);
    many.run(steps);
    CAPTURE(threads);
    CHECK(many.world.threads() == threads);
    CHECK(state_hash(many.world) == expected);
    for (const SurfaceId s : many.walls) CHECK(many.world.surface_force(s) == one.world.surface_force(s));
  }
}

TEST_CASE("a machine among grains is the same to the last bit on any number of threads") {
  const auto steps = scaled<std::uint64_t>(8000);
  Stirred one(1);
  REQUIRE(one.world.run(steps));
  const std::uint64_t expected = state_hash(one.world);
  REQUIRE(one.world.state().chunks.size() > 1);
  CHECK(one.world.state().rebuilds > scaled<std::uint64_t>(10));
  CHECK(std::abs(one.world.machine().coordinate(one.hinge)) > 0.01 * test_scale());  // the grains do swing the flap
  for (const int threads : {2, 3, 8}) {
    Stirred many(threads);
    REQUIRE(many.world.run(steps));
    CAPTURE(threads);
    CHECK(many.world.threads() == threads);
    CHECK(state_hash(many.world) == expected);
    CHECK(many.world.surface_force(many.front) == one.world.surface_force(one.front));
  }
}

TEST_CASE("the hash sees a difference in the last bit") {
  Poured<dem::integrator::SymplecticEuler> one(1), other(1);
  const std::uint64_t before = state_hash(one.world);
  CHECK(state_hash(other.world) == before);
  const Vec3 v = other.world.velocity(GrainId(17));
  other.world.set_velocity(GrainId(17), {v.x(), v.y(), std::nextafter(v.z(), 1.0)});
  CHECK(state_hash(other.world) != before);
}

TEST_CASE("the number of threads may change during a run") {
  Poured<dem::integrator::SymplecticEuler> one(1), changing(1);
  one.run(1500);
  changing.run(500);
  changing.world.set_threads(3);
  changing.run(500);
  changing.world.set_threads(2);
  changing.run(500);
  // The shaking starts anew in each piece: so does that of the first.
  Poured<dem::integrator::SymplecticEuler> pieces(1);
  for (int k = 0; k < 3; ++k) pieces.run(500);
  CHECK(state_hash(changing.world) == state_hash(pieces.world));
}

TEST_CASE("a run in pieces is the run in one go") {
  Poured<dem::integrator::PredictorCorrector> whole(1), pieces(1);
  REQUIRE(whole.world.run(700));
  for (int k = 0; k < 70; ++k) REQUIRE(pieces.world.run(10));
  CHECK(state_hash(whole.world) == state_hash(pieces.world));
}
