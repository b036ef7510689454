// Worlds small enough for the sanitizers, large enough that several threads work in every phase of a step at once.
#include "world/scenes.hpp"

namespace {

using CubesUnderPlate = Grains<Cube8, dem::integrator::VelocityVerlet>;

/// side x side x layers tossed cubes on a floor, `gap` (m) between the layers, and a plate that falls on them.
dem::World<CubesUnderPlate> cubes_under_plate(int threads, int side, int layers, double gap) {
  dem::WorldOptions o = options({0.5, 0, -9.81}, 1e-5);
  o.threads = threads;
  dem::World<CubesUnderPlate> w(o);
  w.set_contact(sand<CubesUnderPlate>());
  const auto cube = w.add_species(dem::shape::cube8(1e-3));
  w.add_surface(w.ground(), dem::surface::Plane{});
  const double middle = 1e-3 + 1.3e-3 * (side - 1), top = 1e-3 + (2e-3 + gap) * (layers - 1);
  const auto plate = w.machine().add_body(
      dem::mbd::given_body("plate", 0.05, Vec3(1e-5, 1e-5, 1e-5)).at({middle, middle, top + 2.5e-3}));
  w.add_surface(plate, dem::surface::Box({middle + 0.017, middle + 0.017, 1e-3}));
  Random random(5);
  for (int n = 0; n < side * side * layers; ++n) {
    dem::NewGrain grain;
    grain.species = cube;
    grain.position =
        Vec3(1e-3 + 2.6e-3 * (n % side), 1e-3 + 2.6e-3 * (n / side % side), 1e-3 + (2e-3 + gap) * (n / side / side));
    grain.velocity = random.vector(0.3);
    w.add_grain(grain);
  }
  return w;
}

void check_same(const dem::World<CubesUnderPlate>& a, const dem::World<CubesUnderPlate>& b) {
  for_each_grain(a, [&](GrainId p) {
    REQUIRE(a.position(p) == b.position(p));
    REQUIRE(a.angular_velocity(p) == b.angular_velocity(p));
  });
}

}  // namespace

TEST_CASE("threads share the phases of a step and give the same bits") {
  auto one = cubes_under_plate(1, 10, 10, 1e-4), four = cubes_under_plate(4, 10, 10, 1e-4);  // four chunks
  REQUIRE(one.run(150));
  REQUIRE(four.run(150));
  CHECK(one.state().rebuilds > 1);
  check_same(one, four);
}

// Two threads move the grains of so many chunks within the sweep over the contacts, four after it (moves_at_once).
TEST_CASE("chunks are moved within the sweep or after it, with the same bits") {
  auto one = cubes_under_plate(1, 24, 21, 1e-5);  // 48 chunks
  REQUIRE(one.run(60));
  CHECK(dem::contacts_of(one).size() > 5000);
  for (const int threads : {2, 4}) {
    auto many = cubes_under_plate(threads, 24, 21, 1e-5);
    REQUIRE(many.run(60));
    check_same(one, many);
  }
}
