#include "catch.hpp"
#include "core/error_of.hpp"

#include <dem/geometry/polyhedron/polyhedron.hpp>
#include <dem/report/replay_encode.hpp>
#include <dem/report/replay_world.hpp>
#include <dem/world/world.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace replay_world_test {

using namespace dem::report;
using Catch::Approx;
using dem::Vec3;

namespace {

Vec3 place(const Replay& replay, const KeptPose& p) { return replay.origin() + Vec3(p[0], p[1], p[2]); }

}  // namespace

TEST_CASE("shapes are drawn by their balls, or by their meshes with or without edges") {
  using Any = dem::shape::Mixed<dem::shape::Sphere, dem::shape::SphereCluster<8>, dem::shape::Superquadric>;
  const ReplayShape cube = replay_shape(dem::shape::cube8(2.0));
  REQUIRE(cube.balls.size() == 8);
  for (const ReplayBall& b : cube.balls) {
    CHECK(b.radius == 1.0);
    CHECK((b.centre.cwiseAbs() - Vec3::Ones()).norm() < 1e-12);
  }
  CHECK(replay_shape(Any(dem::shape::cube8(2.0))).balls.size() == 8);
  CHECK(replay_shape(Any(dem::shape::Sphere(3.0))).balls.at(0).radius == 3.0);
  const dem::shape::Superquadric egg({1, 2, 3}, {2, 2, 2}, 1);
  CHECK(replay_shape(egg).smooth_angle == Approx(std::numbers::pi));
  CHECK(replay_shape(Any(egg)).mesh.quads.size() == replay_shape(egg).mesh.quads.size());
  CHECK(replay_shape(egg).balls.empty());
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const ReplayShape sharp = replay_shape(dem::shape::Polyhedron(corners));
  CHECK(sharp.smooth_angle == 0.0);
  CHECK(sharp.mesh.polygons.size() == 4);
}

TEST_CASE("frames of a world hold its grains, surfaces and bodies where they are") {
  dem::World<dem::Model> world({.gravity = {0, 0, -9.81}});
  world.set_contact({{2000.0, 0.5, 1.0}, {0.4, 2000.0, 0.015, 0.975}});
  const auto small = world.add_species(dem::shape::Sphere(1e-3));
  world.add_surface(world.ground(), dem::surface::Plane{}, {.name = "floor"});
  const dem::BodyId lift = world.machine().add_fixed_body("lift", {0, 0, 0.1});
  world.machine().add_motion(
      dem::mbd::prescribed_position("up", lift, Vec3::UnitZ(), dem::mbd::Signal::ramp(0.0, 0.01)));
  const auto plate = world.add_surface(lift, dem::surface::Box({0.1, 0.1, 0.01}));
  const auto resting = world.add_grain({.species = small, .position = {0, 0, 1e-3}});
  const auto falling = world.add_grain({.species = small, .position = {0.01, 0, 0.05}});

  Replay replay({.frames = 3, .plane_size = 0.2});
  const dem::io::SurfaceMesh mesh = dem::io::box_mesh({1, 1, 1});
  const std::vector<dem::io::DrawnBody> bodies = {{.body = lift, .mesh = &mesh, .position = {0, 0, 0.5}}};
  CHECK(replay.record(world, bodies));
  CHECK_FALSE(replay.record(world, bodies));  // the same time again
  REQUIRE(replay.parts().size() == 3);
  CHECK(replay.parts()[0].name == "floor");
  CHECK(replay.parts()[0].mesh.vertices[2] == Vec3(0.1, 0.1, 0));
  CHECK(replay.parts()[1].name == "lift");
  CHECK(replay.parts()[2].name == "lift");

  REQUIRE(world.run_for(0.02));
  world.set_active(plate, false);
  world.remove_grain(resting);
  const auto large = world.add_species(dem::shape::Sphere(2e-3));
  const auto late = world.add_grain({.species = large, .position = {-0.02, 0, 0.2}, .velocity = {3, 4, 0}});
  world.add_surface(world.ground(), dem::surface::Box({0.1, 0.1, 0.1}), {.position = {1, 2, 3}});
  REQUIRE(world.run(1));
  CHECK(replay.record(world, bodies));

  REQUIRE(replay.frames().size() == 2);
  const KeptFrame &first = replay.frames()[0], &second = replay.frames()[1];
  CHECK(second.time == world.time());
  REQUIRE(first.grains.size() == 2);
  REQUIRE(second.grains.size() == 2);
  const auto at = [&](const KeptGrain& g) {
    return Vec3(replay.origin() + Vec3(g.position[0], g.position[1], g.position[2]));
  };
  CHECK((at(first.grains[0]) - Vec3(0, 0, 1e-3)).norm() < 1e-8);
  CHECK((at(first.grains[1]) - Vec3(0.01, 0, 0.05)).norm() < 1e-8);
  CHECK(second.grains[0].number == falling.index());
  CHECK((at(second.grains[0]) - world.position(falling)).norm() < 1e-8);
  CHECK(second.grains[0].speed == Approx(9.81 * 0.02).epsilon(1e-3));
  CHECK(second.grains[1].number == late.index());
  CHECK(second.grains[1].speed == Approx(5.0).epsilon(1e-3));
  CHECK(replay.sample().shape_of(late.index()) == 1);
  CHECK(replay.shapes().at(1).balls.at(0).radius == 2e-3);

  // The new surface stands behind the drawn body; the one that is switched off is not shown, the body is.
  REQUIRE(replay.parts().size() == 4);
  REQUIRE(first.poses.size() == 3);
  REQUIRE(second.poses.size() == 4);
  CHECK((place(replay, first.poses[1]) - Vec3(0, 0, 0.1)).norm() < 1e-7);
  CHECK(second.poses[1] == KeptPose{});
  CHECK((place(replay, second.poses[2]) - Vec3(0, 0, 0.6 + 0.01 * world.time())).norm() < 1e-6);
  CHECK((place(replay, second.poses[3]) - Vec3(1, 2, 3)).norm() < 1e-6);
  CHECK(encode(replay).bytes.size() > 100);

  // Calls between frames count: of the times 0, 1, 2, 3 and 4 every second one stays.
  for (int k = 0; k < 3; ++k) {
    REQUIRE(world.run_for(0.001));
    CHECK(replay.record(world, bodies) == (k != 1));
  }
  CHECK(replay.frames().size() == 3);

  const std::vector<dem::io::DrawnBody> without = {bodies[0], {.body = lift}};
  REQUIRE(world.run_for(0.002));
  replay.pass(world.time());
  REQUIRE(world.run_for(0.002));
  check_refused([&] { replay.record(world, without); }, "drawn body 1 has no mesh", "DrawnBody::mesh");
}

TEST_CASE("frames of a world hold the largest forces at contacts") {
  dem::World<dem::Model> world({.gravity = {0, 0, -9.81}});
  world.set_contact({{2000.0, 0.5, 1.0}, {0.4, 2000.0, 0.015, 0.975}});
  const double r = 1e-3;
  const auto ball = world.add_species(dem::shape::Sphere(r), {.density = 2500});
  world.add_surface(world.ground(), dem::surface::Plane{}, {.name = "wall", .position = {0, 0, -1}});
  const auto floor = world.add_surface(world.ground(), dem::surface::Plane{}, {.name = "floor"});
  // Towers of three, whose upper balls came first, and whose steps down are to their bearers.
  std::vector<dem::GrainId> top, middle, low;
  for (int k = 0; k < 4; ++k) top.push_back(world.add_grain({.species = ball, .position = {0.01 * k, 0, 5 * r}}));
  for (int k = 0; k < 4; ++k) middle.push_back(world.add_grain({.species = ball, .position = {0.01 * k, 0, 3 * r}}));
  for (int k = 0; k < 4; ++k) low.push_back(world.add_grain({.species = ball, .position = {0.01 * k, 0, r}}));
  const double weight = world.species(ball).mass * 9.81;

  // They are found of a world that has never moved too: the lowest balls are pressed in by nothing yet.
  Replay all({.plane_size = 0.1}), strongest({.force_lines = 6, .plane_size = 0.1}), none({.force_lines = 0});
  CHECK(all.record(world));
  CHECK(all.frames().at(0).forces.empty());
  // Dampers and springs make a time of 0.5/2000 s, of which a tower of three takes some; 0.02 s are 80 of it.
  REQUIRE(world.run_for(0.02));
  for (Replay* replay : {&all, &strongest, &none}) CHECK(replay->record(world));
  CHECK(none.frames().at(0).forces.empty());
  REQUIRE(all.frames().at(1).forces.size() == 12);

  const auto place = [&](const Replay& replay, const std::array<float, 3>& x) {
    return Vec3(replay.origin() + Vec3(x[0], x[1], x[2]));
  };
  for (std::size_t k = 0; k < 4; ++k) {
    const auto find = [&](dem::GrainId grain, std::size_t partner, bool on_surface) {
      for (const KeptForce& f : all.frames().at(1).forces) {
        if (f.grain == grain.index() && f.partner == partner && (f.on_surface != 0) == on_surface) return f;
      }
      FAIL("no such line");
      return KeptForce{};
    };
    // A pair's line begins in the grain with the smaller number.
    const KeptForce upper = find(top[k], middle[k].index(), false), under = find(middle[k], low[k].index(), false),
                    foot = find(low[k], floor.index(), true);
    CHECK(upper.force == Approx(weight).epsilon(1e-5));
    CHECK(under.force == Approx(2 * weight).epsilon(1e-5));
    CHECK(foot.force == Approx(3 * weight).epsilon(1e-5));
    CHECK((place(all, upper.from) - world.position(top[k])).norm() < 1e-8);
    CHECK((place(all, upper.to) - world.position(middle[k])).norm() < 1e-8);
    CHECK((place(all, foot.from) - world.position(low[k])).norm() < 1e-8);
    CHECK((place(all, foot.to) - Vec3(0.01 * static_cast<double>(k), 0, 0)).norm() < 1e-7);
  }
  // The feet are the largest, then come two of the four that carry two balls.
  REQUIRE(strongest.frames().at(0).forces.size() == 6);
  int feet = 0;
  for (const KeptForce& f : strongest.frames()[0].forces) feet += f.on_surface != 0;
  CHECK(feet == 4);

  // Of grains that are nowhere no contacts are looked for.
  const std::vector<ReplayGrain> nowhere = {{.position = Vec3::Constant(std::nan(""))}};
  CHECK(detail::replay_forces(world, nowhere).empty());
}

}  // namespace replay_world_test
