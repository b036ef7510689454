#include "scenes.hpp"

#include <dem/domain/periodic_ranks.hpp>
#include <dem/domain/sheared_ranks.hpp>
#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/integrator/velocity_verlet.hpp>

namespace scenes {

namespace {

/// By the predictor-corrector, which goes back to where a step began: over a border too.
struct PeriodicAlone : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Domain = dem::domain::Periodic;
};
struct PeriodicShared : PeriodicAlone {
  using Domain = dem::domain::PeriodicRanks;
};

struct VerletAlone : dem::Model {
  using Integrator = dem::integrator::VelocityVerlet;
  using Domain = dem::domain::Periodic;
};
struct VerletShared : VerletAlone {
  using Domain = dem::domain::PeriodicRanks;
};

struct ShearedAlone : dem::Model {
  using Domain = dem::domain::Sheared;
};
struct ShearedShared : ShearedAlone {
  using Domain = dem::domain::ShearedRanks;
};

constexpr double length = 0.05, width = 0.01;  // m, of the cell

template <class Model>
dem::World<Model> cell(int n, const dem::Vec3& gravity, std::optional<dem::SleepOptions> sleep, double speed) {
  dem::World<Model> world({.gravity = gravity,
                           .domain = {{{0, 0, -0.01}, {length, width, 0.2}}},
                           .periodic = {.x = true, .y = true},
                           .threads = 2,
                           .sleep = sleep});
  world.set_contact({.normal = {2000, 0.05, 0.05}, .friction = {0.4, 2000, 0.015, 0.975}});
  world.add_surface(world.ground(), dem::surface::Plane{});
  pour(world, world.add_species(dem::shape::cube8(0.7e-3)), n, 20, 4, 2.5e-3, speed);
  return world;
}

/// Cubes fall and slide over the borders; some are taken away and added on the way.
constexpr auto flow = []<class Model>() {
  auto world = cell<Model>(1500, {6, 3, -9.81}, {}, 1.0);
  run(world, 400);
  for (std::uint32_t k = 3; k < 1500; k += 7) world.remove_grain(dem::GrainId(k));
  world.add_grain({.species = dem::SpeciesId(0), .position = {0.01, 0.001, 0.08}, .velocity = {2, -1, -1}});
  world.set_grain_load(drag_of_air);
  run(world, 500);
  const auto ids = world.grains();
  const auto crossed = std::count_if(ids.begin(), ids.end(), [&](dem::GrainId p) {
    return world.velocity(p).x() > 0.5 && world.position(p).x() < 4e-3;
  });
  require(crossed > 10, "no grain went over the border");
  return world;
};

/// Balls that velocity Verlet moves before it lists, so that ranks gather rows in mid-step; they fall asleep about the
/// borders.
template <class Model>
dem::World<Model> rest(int n, std::uint64_t steps) {
  dem::World<Model> world(
      {.gravity = {0.5, 0.2, -9.81},
       .domain = {{{0, 0, -0.01}, {length, width, 0.2}}},
       .periodic = {.x = true, .y = true},
       .threads = 2,
       .sleep = dem::SleepOptions{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.1, .window = 20}});
  world.set_contact({.normal = {500, 0.2, 1.0}, .friction = {0.6, 500, 0.1, 0.975}});
  world.add_surface(world.ground(), dem::surface::Plane{});
  pour(world, world.add_species(dem::shape::Sphere(1e-3)), n, 20, 4, 2.5e-3, 0.3);
  run(world, steps);
  require(steps == 0 || world.asleep_count() > 0, "no grain sleeps");
  require(steps == 0 || world.asleep_count() < world.grain_count(), "all grains sleep");
  return world;
}
/// Energy is counted as they come to rest: that of motion, which those that fall asleep lose, too.
constexpr auto counted = []<class Model>() {
  auto world = rest<Model>(1500, 0);
  count_energy(world);
  run(world, 3000);
  require(energy_of(world).dissipated_asleep > 0.0, "no grain lost its motion as it fell asleep");
  return world;
};
/// As it is before the next list is made.
constexpr auto changed = []<class Model>() {
  auto world = rest<Model>(1500, 6000);
  const std::size_t asleep = world.asleep_count();
  for (std::uint32_t k = 0; k < 600; k += 60) world.remove_grain(dem::GrainId(k));
  require(world.asleep_count() + 50 < asleep, "grains were taken out, but sleepers beside them did not wake");
  world.add_grain({.species = dem::SpeciesId(0), .position = {0.01, 0.001, 0.08}, .velocity = {2, -1, -1}});
  return world;
};

/// Sleep that is taken away and given again, with more chunks of grains than when they slept; as it is before the next
/// run.
constexpr auto allowed_again = []<class Model>() {
  auto world = rest<Model>(1500, 3000);
  const auto sleep = world.state().options.sleep;
  world.set_sleep({});
  for (int k = 0; k < 600; ++k) {
    world.add_grain({.species = dem::SpeciesId(0),
                     .position = {2.5e-3 * (k % 20 + 0.5), 2.5e-3 * (k / 20 % 4 + 0.5), 0.1 + 2.5e-3 * (k / 80)}});
  }
  run(world, 100);
  world.set_sleep(sleep);
  return world;
};

/// Cubes float and fall asleep, and a paddle flies down into them and over the border.
constexpr auto paddle = []<class Model>() {
  auto world =
      cell<Model>(1500, {0, 0, 0},
                  dem::SleepOptions{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.01, .window = 20}, 0.0);
  const dem::Vec3 edges(2e-3, 4e-3, 8e-3);
  const auto body = world.machine().add_body(
      dem::mbd::box_body("paddle", edges, 2650).at({length - 6e-3, width / 2, 0.053}).moving({3, 0, -1.5}));
  world.add_surface(body, dem::surface::Box(edges));
  run(world, 900);
  require(world.machine().body(body).position().x() > length, "the paddle did not go over the border");
  require(world.asleep_count() > 0, "no grain sleeps");
  require(world.asleep_count() < world.grain_count(), "all grains sleep");
  return world;
};

/// Balls in cells that go by each other, there and back.
template <class Model>
dem::World<Model> sheared_cell(int n) {
  const double pitch = 1.7e-3;  // m
  dem::World<Model> world({.gravity = dem::Vec3::Zero(),
                           .domain = {{{0, 0, 0}, {25 * pitch, 5 * pitch, 10 * pitch}}},
                           .periodic = {.x = true, .y = true, .z = true},
                           .shear_rate = 400.0,
                           .threads = threads_of<Model>()});
  world.set_contact({.normal = {500, 0.2, 1.0}, .friction = {0.6, 500, 0.1, 0.975}});
  pour(world, world.add_species(dem::shape::Sphere(0.8e-3)), n, 25, 5, pitch, 2.0);
  return world;
}
constexpr auto shear = []<class Model>() {
  auto world = sheared_cell<Model>(1250);
  run(world, 600);
  require(world.state().domain.offset() > 1.6e-3, "the cells did not go by");
  world.set_shear_rate(-500.0);
  run(world, 600);
  return world;
};

}  // namespace

void other_shear() {
  auto world = sheared_cell<ShearedShared>(1250);
  run(world, 10);
  const auto& d = world.state().domain;
  world.set_shear_rate(d.rank() == d.ranks() - 1 ? 401.0 : 402.0);
  run(world, 10);
}

bool periodic() {
  const bool flows = same_bits<PeriodicShared, PeriodicAlone>("flow", flow);
  const bool sleeps = same_bits<PeriodicShared, PeriodicAlone>("paddle", paddle);
  const bool changes = same_bits<VerletShared, VerletAlone>("changed", changed);
  const bool allows = same_bits<VerletShared, VerletAlone>("allowed", allowed_again);
  const bool counts = same_bits<VerletShared, VerletAlone>("counted", counted);
  const bool rests = goes_on<VerletShared, VerletAlone>(
      "rest", []<class Model>(int n) { return rest<Model>(n, n > 1000 ? 6000 : 0); });
  const bool counts_on = goes_on<VerletShared, VerletAlone>("counted", []<class Model>(int n) {
    auto world = rest<Model>(n, n > 1000 ? 6000 : 0);
    count_energy(world);
    return world;
  });
  const bool goes = goes_on<PeriodicShared, PeriodicAlone>("periodic", []<class Model>(int n) {
    return cell<Model>(n, {6, 3, -9.81}, {}, 1.0);
  });
  const bool shears = same_bits<ShearedShared, ShearedAlone>("shear", shear);
  const bool shears_on = goes_on<ShearedShared, ShearedAlone>(
      "shear", []<class Model>(int n) { return sheared_cell<Model>(n > 1000 ? 1250 : n); });
  return shears && shears_on && counts && counts_on && flows && sleeps && changes && allows && rests && goes;
}

}  // namespace scenes
