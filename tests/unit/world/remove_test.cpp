#include "scenes.hpp"

#include "core/error_of.hpp"

using Catch::Approx;

namespace {

/// A cube that sticks on an incline, and a heap of others far away that may be taken out of the world.
struct Scene {
  dem::World<Cubes> w{options(g * Vec3(0.2, 0, -0.98), 1e-5)};
  GrainId block;
  std::vector<GrainId> others;

  Scene() {
    w.set_contact(sand<Cubes>(0.4));
    const auto species = w.add_species(dem::shape::cube8(1.2e-3));
    w.add_surface(w.ground(), dem::surface::Plane{});
    for (int k = 0; k < 40; ++k) {
      others.push_back(w.add_grain({species, Vec3(0.1 + 3e-3 * (k % 5), 3e-3 * (k / 5), 1.2e-3 + 3e-3 * (k % 3))}));
      if (k == 20) block = w.add_grain({species, Vec3(0, 0, 1.2e-3)});
    }
  }
};

}  // namespace

TEST_CASE("a grain that is removed is gone, and nothing else changes") {
  Scene some, all;
  REQUIRE(some.w.run(2000));
  REQUIRE(all.w.run(2000));
  for (std::size_t k = 0; k < some.others.size(); k += 2) some.w.remove_grain(some.others[k]);
  REQUIRE(some.w.run(2000));
  REQUIRE(all.w.run(2000));
  CHECK(some.w.grain_count() == 21);
  // The block keeps its place, its motion and its friction springs. Sums over another neighbour list differ in the last
  // bits, which its rocking makes larger.
  CHECK((some.w.position(some.block) - all.w.position(all.block)).norm() < 1e-12);
  CHECK((some.w.force(some.block) - all.w.force(all.block)).norm() < 1e-6 * all.w.force(all.block).norm());
  check_refused([&] { some.w.position(some.others[0]); }, "grain 0 is asked for, but it was removed");
  check_refused([&] { some.w.remove_grain(some.others[0]); }, "it was removed");
  CHECK(some.w.position(some.others[1]).allFinite());
  // Ids are not given again, and a world may be emptied and filled.
  const auto fresh = some.w.add_grain({SpeciesId(0), Vec3(0.3, 0, 1.2e-3)});
  CHECK(fresh.index() == 41);
  // What is refused is named by the id that it would have got, not by how many grains there are.
  dem::NewGrain wrong = {SpeciesId(0), Vec3(0, std::nan(""), 0)};
  check_refused([&] { some.w.add_grain(wrong); }, "grain 42 was given a position");
  wrong = {SpeciesId(0), Vec3::Zero(), Vec3::Zero(), 2 * Mat3::Identity()};
  check_refused([&] { some.w.add_grain(wrong); }, "grain 42 was given a rotation matrix");
  REQUIRE(some.w.run(10));
  CHECK(some.w.grain_count() == 22);
  for (std::size_t k = 1; k < some.others.size(); k += 2) some.w.remove_grain(some.others[k]);
  some.w.remove_grain(some.block);
  some.w.remove_grain(fresh);
  REQUIRE(some.w.run(10));
  CHECK(some.w.grain_count() == 0);
  const auto last = some.w.add_grain({SpeciesId(0), Vec3(0, 0, 5e-3)});
  REQUIRE(some.w.run(10));
  CHECK(some.w.velocity(last).z() < 0.0);
}

TEST_CASE("a lost grain that is removed no longer counts") {
  dem::WorldOptions o = options(Vec3(0, 0, -g), 1e-5);
  o.domain = {{Vec3(-1, -1, -0.01), Vec3(1, 1, 1)}};
  dem::World<Balls> w(o);
  w.set_contact(sand<Balls>());
  const auto species = w.add_species(Sphere(1e-3));
  const auto ball = w.add_grain({species, Vec3(0, 0, 0)});
  const auto report = w.run(20000);
  REQUIRE(report.problem == dem::StepReport::Problem::lost);
  REQUIRE(report.grain == ball);
  w.remove_grain(report.grain);
  REQUIRE(w.run(100));
  CHECK(w.grain_count() == 0);
}

TEST_CASE("grains are put elsewhere and set spinning by hand") {
  dem::World<Cubes> w(options(Vec3::Zero(), 1e-5));
  w.set_contact(sand<Cubes>());
  const auto species = w.add_species(dem::shape::cube8(1e-3));
  const auto turned = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto p = w.add_grain({.species = species, .position = Vec3::Zero(), .rotation = turned});
  w.set_angular_velocity(p, {1, -2, 3});
  w.set_position(p, {0.1, 0.2, 0.3});
  REQUIRE(w.run(100));
  // A cube's inertia is the same about every axis: it keeps its spin.
  CHECK((w.angular_velocity(p) - Vec3(1, -2, 3)).norm() < 1e-9);
  CHECK((w.position(p) - Vec3(0.1, 0.2, 0.3)).norm() < 1e-15);
  check_refused([&] { w.set_position(p, Vec3(0, std::nan(""), 0)); }, "position of a grain");
  check_refused([&] { w.set_rotation(p, dem::Mat3::Zero()); }, "rotation matrix that is no rotation");
}

TEST_CASE("a grain that is turned by hand meets others as one that was added so, and keeps its spin") {
  const dem::Mat3 turned = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto fallen = [&](bool by_hand) {
    dem::World<Cubes> w(options({0, 0, -g}, 1e-5));
    w.set_contact(sand<Cubes>());
    const auto species = w.add_species(dem::shape::cube8(1e-3));
    w.add_surface(w.ground(), dem::surface::Plane{});
    const auto p = w.add_grain({.species = species,
                                .position = {0, 0, 1.8e-3},
                                .rotation = by_hand ? dem::Mat3(dem::Mat3::Identity()) : turned,
                                .angular_velocity = {1, -2, 3}});
    if (by_hand) {
      REQUIRE(w.run(0));
      w.set_rotation(p, turned);
      CHECK((w.angular_velocity(p) - Vec3(1, -2, 3)).norm() < 1e-14);
    }
    REQUIRE(w.run(2000));
    return w.rotation(p);
  };
  CHECK((fallen(true) - fallen(false)).norm() < 1e-9);  // the spins differ by rounding
}

TEST_CASE("a shape without inertia is refused") {
  dem::World<Cubes> w;
  const dem::Ball ball = {Vec3::Zero(), 1e-3};
  const dem::MassProperties given = {.volume = 4e-9, .centre = Vec3::Zero(), .inertia = dem::Mat3::Zero()};
  check_refused([&] { w.add_species(Cube8(std::span(&ball, 1), given)); }, "moments of inertia of a species are 0");
  for (const double volume : {std::nan(""), HUGE_VAL, 0.0, -4e-9}) {
    const dem::MassProperties odd = {.volume = volume, .centre = Vec3::Zero(), .inertia = dem::Mat3::Identity()};
    check_refused([&] { w.add_species(Cube8(std::span(&ball, 1), odd)); }, "volume of");
  }
}
