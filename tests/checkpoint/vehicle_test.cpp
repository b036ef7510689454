// A vehicle goes on from a file in every bit, also one that was saved on its brakes or under its engine.

#include "checkpoint/folder.hpp"
#include "worlds.hpp"

#include <dem/dem.hpp>
#include <dem/io/checkpoint.hpp>
#include <dem/vehicle/humvee.hpp>

namespace {

using namespace dem::vehicle;

constexpr double time_step = 5e-5;  // s

struct Driven {
  dem::World<models::VerletBalls> world{{.time_step = time_step, .threads = 1}};
  Vehicle car;

  explicit Driven(const std::string& engine) {
    world.machine().joint_tolerance = 0.5;  // m: light shafts wind up
    const VehicleSpec spec = humvee(with_engine({.rubber_rear = false}, engine));
    car = add_vehicle(Assembly(world.machine(), "car", {0, 0, 0.5}, dem::Mat3::Identity(), 3.0), spec, Road{});
  }
  void go(int steps, const Controls& c) {
    for (int k = 0; k < steps; ++k) {
      drive(world.machine(), car, c, time_step);
      REQUIRE(world.step());
    }
  }
  std::uint64_t hash() const { return dem::io::hash_of(dem::io::columns_of(world, car)); }
};

}  // namespace

TEST_CASE("a vehicle that was saved while it brakes, or pushes, goes on in a fresh program in every bit") {
  const Folder folder;
  for (const char* engine : {"motor", "actuator"}) {
    for (const Controls& c : {Controls{.brake = 0.4, .steer = 0.1}, Controls{.throttle = 0.3}}) {
      CAPTURE(engine, c.brake);
      Driven whole(engine), fresh(engine);
      whole.go(200, c);
      dem::save(whole.world, folder / "car.h5", whole.car);
      dem::load(fresh.world, folder / "car.h5", fresh.car);
      CHECK(fresh.hash() == whole.hash());
      whole.go(200, c), fresh.go(200, c);
      CHECK(fresh.hash() == whole.hash());
      // And where it brakes less, or not at all, from then on.
      whole.go(50, {.brake = 0.1}), fresh.go(50, {.brake = 0.1});
      whole.go(50, {}), fresh.go(50, {});
      CHECK(fresh.hash() == whole.hash());
    }
  }
}
