// A bed that was made and saved is loaded in place of being made, and one that was left on its way goes on, as
// soil::Bed promises.

#include "scenes_to_save.hpp"

#include <dem/soil/bed.hpp>

#include <memory>
#include <set>

namespace {

using models::Balls;

const dem::soil::BedOptions pressed_bed = {.height = 0.01, .lid_pressure = 100.0, .lid_speed = 0.2, .time_limit = 2.0};

struct BedOfBalls {
  dem::World<Balls> world;
  SpeciesId ball;
  dem::soil::Bed<Balls> bed;

  explicit BedOfBalls(int threads, const dem::soil::BedOptions& o = pressed_bed, double radius = 0.0085)
      : world({.time_step = 1.5e-5, .threads = threads}),
        ball([this] {
          set_friction(1.0);
          return world.add_species(Sphere(1e-3));
        }()),
        bed(world, dem::soil::Container::cylinder(radius), ball, o) {}
  void set_friction(double share) { world.set_contact({{2000.0, 0.05, 1.0}, {0.5 * share, 1000.0, 0.02, 1.0}}); }
  /// A ball is dropped on it.
  void drop() {
    world.add_grain({.species = ball, .position = {1e-3, 0, 0.012}, .velocity = {0.05, 0, -0.3}});
    REQUIRE(world.run(1500));
  }
};

}  // namespace

TEST_CASE("a bed that was saved is loaded in place of being made, and goes on in the same bits") {
  const Folder folder;
  BedOfBalls made(2), loaded(3);
  made.bed.make();
  dem::save(made.world, folder / "bed.h5");
  dem::load(loaded.world, folder / "bed.h5");
  CHECK(difference(made.world, loaded.world) == "");
  CHECK(loaded.bed.solid_fraction() == made.bed.solid_fraction());
  for (auto* bed : {&made, &loaded}) bed->drop();
  CHECK(difference(made.world, loaded.world) == "");
  CHECK(made.world.grain_count() > 200);
}

TEST_CASE("a bed that is left at any of its stages goes on from a file on other threads in every bit", "[long]") {
  const Folder folder;
  const bool rains = GENERATE(true, false);
  dem::soil::BedOptions o = pressed_bed;
  o.height = 0.007, o.rain_flow = rains ? 0.02 : 0.0, o.rain_height = 0.01, o.fall_speed = rains ? 0.0 : 0.2;
  constexpr double radius = 0.0065;
  o.lid_pressure = 0.0;
  BedOfBalls loose(2, o, radius);
  loose.bed.make();
  const double settled = loose.bed.solid_fraction();
  o.lid_pressure = 100.0, o.relative_density = 0.4, o.limits = {settled, settled + 0.05}, o.densify_time = 0.1;
  BedOfBalls whole(1, o, radius);
  whole.bed.make([&](double share) { whole.set_friction(share); });

  struct Left {};
  int looks = 0, files = 0;
  std::set<std::string> left_in;
  auto now = std::make_unique<BedOfBalls>(2, o, radius);
  const auto look = [&] {
    if (++looks % 7 != 0) return;
    const auto& w = now->world;
    const auto& lid = w.state().surfaces[now->bed.lid().index()];
    left_in.insert(rains && w.inlet(now->bed.inlet()).is_open() ? "rain"
                   : w.state().options.gravity.x() != 0.0       ? "shaking"
                   : lid.active                                 ? "pressing"
                                                                : "rest");
    ++files;
    dem::save(now->world, folder / "bed.h5", now->bed);
    throw Left{};
  };
  while (!now->bed.is_made()) {
    try {
      now->bed.make([&](double share) { now->set_friction(share); }, look);
    } catch (const Left&) {
      auto next = std::make_unique<BedOfBalls>(1 + files % 3, o, radius);
      dem::load(next->world, folder / "bed.h5", next->bed);
      now = std::move(next);
    }
  }
  CHECK(difference(whole.world, now->world) == "");
  CAPTURE(looks, left_in);
  CHECK(left_in.size() == (rains ? 4 : 3));
  CHECK(files > 20);

  // A bed of other settings is refused.
  o.densify_time = 0.2;
  BedOfBalls other(1, o, radius);
  CHECK(error_of([&] {
          dem::load(other.world, folder / "bed.h5", other.bed);
        }).find("densify time is 0.1 s in the saved state, but 0.2 s in this program") != std::string::npos);
}

TEST_CASE("a bed that was saved is refused where other shares of grains are put into it") {
  const Folder folder;
  struct Mixed {
    dem::World<Balls> world{{.time_step = 1.5e-5}};
    dem::soil::Bed<Balls> bed;
    explicit Mixed(double share)
        : bed(
              [&]() -> dem::World<Balls>& {
                world.set_contact({{2000.0, 0.05, 1.0}, {0.5, 1000.0, 0.02, 1.0}});
                return world;
              }(),
              dem::soil::Container::cylinder(0.0085), mixture(share), pressed_bed) {}
    dem::Mixture mixture(double share) {
      const auto light = world.add_species(Sphere(1e-3)), heavy = world.add_species(Sphere(1e-3), {.density = 5000});
      return dem::Mixture({{light, share}, {heavy, 1.0 - share}});
    }
  };
  Mixed saved(0.7), same(0.7), other(0.05);
  dem::save(saved.world, folder / "bed.h5", saved.bed);
  CHECK(error_of([&] { dem::load(same.world, folder / "bed.h5", same.bed); }) == "no error");
  // Of one size, so that walls and lid are the same.
  CHECK(error_of([&] { dem::load(other.world, folder / "bed.h5", other.bed); }).find("share of grains up to species") !=
        std::string::npos);
}
