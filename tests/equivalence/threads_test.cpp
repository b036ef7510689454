// A world small enough for the sanitizers, large enough that four threads work in every phase of a step at once.
#include "world/scenes.hpp"

TEST_CASE("threads share the phases of a step and give the same bits") {
  using Model = Grains<Cube8, dem::integrator::VelocityVerlet>;
  const auto make = [](int threads) {
    dem::WorldOptions o = options({0.5, 0, -9.81}, 1e-5);
    o.threads = threads;
    dem::World<Model> w(o);
    w.set_contact(sand<Model>());
    const auto cube = w.add_species(dem::shape::cube8(1e-3));
    // A floor, and a plate above that falls on the grains.
    w.add_surface(w.ground(), dem::surface::Plane{});
    const auto plate =
        w.machine().add_body(dem::mbd::given_body("plate", 0.05, Vec3(1e-5, 1e-5, 1e-5)).at({0.013, 0.013, 0.0225}));
    w.add_surface(plate, dem::surface::Box({0.03, 0.03, 1e-3}));
    Random random(5);
    for (int n = 0; n < 1000; ++n) {  // four chunks
      dem::NewGrain grain;
      grain.species = cube;
      grain.position = 1e-3 * Vec3(1 + 2.6 * (n % 10), 1 + 2.6 * (n / 10 % 10), 1 + 2.1 * (n / 100));
      grain.velocity = random.vector(0.3);
      w.add_grain(grain);
    }
    return w;
  };
  auto one = make(1), four = make(4);
  REQUIRE(one.run(150));
  REQUIRE(four.run(150));
  CHECK(one.state().rebuilds > 1);
  for_each_grain(one, [&](GrainId p) {
    REQUIRE(one.position(p) == four.position(p));
    REQUIRE(one.angular_velocity(p) == four.angular_velocity(p));
  });
}
