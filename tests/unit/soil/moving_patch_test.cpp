// A patch of bed that goes along with a machine: tiles come ahead and go behind, and nothing else notices.

#include "tile_beds.hpp"

#include <dem/soil/moving_patch.hpp>
#include <dem/world/energy.hpp>
#include <dem/world/memory.hpp>

#include "core/error_of.hpp"

#include <cstring>

using dem::soil::MovingPatch;
using dem::soil::PatchOptions;

namespace {

constexpr double rim = 3e-3;  // m
const PatchOptions short_patch{.tiles = 4, .along_y = 2, .rim = rim, .ahead = 1.2 * tile_length, .rut_cell = half_edge};

/// A ball on a spring swings over the bed and touches nothing.
dem::BodyId add_pendulum(dem::World<OpenCubes>& w) {
  auto& m = w.machine();
  const auto bob = m.add_body(dem::mbd::sphere_body("bob", 5e-3, 2000).at({0.0, 0.0, 0.3}));
  m.add_joint(dem::mbd::revolute("hinge", m.ground(), bob, Vec3(0.05, 0.0, 0.3), Vec3::UnitY()));
  return bob;
}
Vec3 place_of(const dem::World<OpenCubes>& w, dem::BodyId b) { return w.machine().bodies()[b.index()].position(); }

}  // namespace

TEST_CASE("a patch at rest stays at rest as it goes on, with as many grains and ids and as much memory") {
  dem::World<OpenCubes> w = open_ground(), alone = open_ground();
  const auto bob = add_pendulum(w);
  add_pendulum(alone);
  MovingPatch<OpenCubes> patch(w, settled_tile(), short_patch);
  REQUIRE(w.run(1));
  REQUIRE(alone.run(1));
  const std::size_t grains = w.grain_count(), ids = w.state().grains.row_of.size();
  CHECK(grains == 4 * 2 * 120);
  std::size_t bytes = 0, shifts = 0;
  double most = 0.0;
  for (int k = 0; k < 24; ++k) {
    const double x = 1.5 * tile_length + 0.5 * k * tile_length;
    shifts += patch.follow(w, x) ? 1 : 0;
    CHECK(patch.front() - x >= short_patch.ahead);
    CHECK(patch.front() - patch.back() == Catch::Approx(4 * tile_length));
    CHECK(w.grain_count() == grains);
    REQUIRE(w.run(20));
    REQUIRE(alone.run(20));
    most = std::max(most, kinetic_energy_of_a_grain(w));
    if (k == 8) bytes = dem::memory_bytes(w.state());
  }
  CHECK(shifts == patch.shifts());
  CHECK(shifts == 11);
  CHECK(w.state().grains.row_of.size() == ids);  // ids of the tiles that go are given to those that come
  CHECK(10 * dem::memory_bytes(w.state()) < 11 * bytes);
  // A fall through 1e-8 m: far less than the overlap of 6 cubes' weight on a stiffness of 2 kN/m, 6e-7 m.
  const double mass = w.species(SpeciesId(0)).mass;
  CHECK(most < mass * g * 1e-8);
  // The machine has gone on in every bit as without a bed.
  CHECK(place_of(w, bob) == place_of(alone, bob));
  CHECK((place_of(w, bob) - Vec3(0, 0, 0.3)).norm() > 1e-4);
}

TEST_CASE("grains of the patch that stay are moved by no bit when it goes on, and the rim stands") {
  dem::World<OpenCubes> w = open_ground();
  MovingPatch<OpenCubes> patch(w, settled_tile(), short_patch);
  REQUIRE(w.run(50));
  std::vector<std::pair<GrainId, Vec3>> before;
  for (const GrainId p : w.grains()) {
    if (w.position(p).x() > patch.back() + tile_length) before.emplace_back(p, w.position(p));
  }
  CHECK(patch.follow(w, 3.9 * tile_length));
  CHECK(patch.back() == Catch::Approx(2 * tile_length));
  CHECK(patch.tiles() == 4);
  std::size_t same = 0, held = 0, free_at_old_front = 0;
  for (const auto& [id, x] : before) {
    if (x.x() < patch.back()) continue;
    CHECK(w.position(id) == x);
    ++same;
  }
  CHECK(same > 300);
  for (const GrainId id : w.grains()) {
    const double x = w.position(id).x();
    const bool is_held = w.species(w.species_of(id)).is_held();
    const double y = w.position(id).y();
    const bool in_rim = x < patch.back() + rim || x > patch.front() - rim || y < rim || y > 2 * tile_width - rim;
    CHECK(is_held == in_rim);
    held += is_held ? 1 : 0;
    if (std::abs(x - 4 * tile_length) < rim && !is_held) ++free_at_old_front;
  }
  CHECK(held > 100);
  CHECK(free_at_old_front > 20);
  // Contacts in the rim that was let go remember what the tile does: all of them, in the middle of the bed.
  std::size_t contacts = 0, remembered = 0;
  for (const auto& c : dem::contacts_of(w)) {
    if (c.kind != dem::ContactKind::grains || std::abs(c.point.x() - 4 * tile_length) > rim) continue;
    if (std::abs(c.point.y() - tile_width) > rim) continue;
    ++contacts;
    remembered += norm(c.last.friction.slip) > 0.0 ? 1 : 0;
  }
  CHECK(contacts > 20);
  CHECK(remembered == contacts);
}

TEST_CASE("grains that lie where a tile comes make room for it, and no others") {
  dem::World<OpenCubes> w = open_ground();
  MovingPatch<OpenCubes> patch(w, settled_tile(), short_patch);
  // As high as a grain can lie on the bed, and so high that it is no hindrance.
  const double r = w.species(SpeciesId(0)).shape.bounding_radius(), front = patch.front();
  double high = 0.0;
  for (const auto& grain : settled_tile().grains) high = std::max(high, grain.position.z + 1.99 * r);
  const GrainId fallen = w.add_grain({SpeciesId(0), Vec3(front + 5e-3, tile_width, 1e-3)});
  const GrainId over = w.add_grain({SpeciesId(0), Vec3(front - 0.5e-3, tile_width, high)});
  const GrainId on_top = w.add_grain({SpeciesId(0), Vec3(front - 3e-3, tile_width, high)});
  const GrainId above = w.add_grain({SpeciesId(0), Vec3(front, 1.5 * tile_width, high + r)});
  REQUIRE(w.run(1));
  REQUIRE(patch.follow(w, 2.9 * tile_length));
  CHECK(patch.strays() == 2);
  CHECK(w.grain_count() == 4 * 2 * 120 + 2);
  CHECK(w.position(on_top).z() == Catch::Approx(high).epsilon(1e-6));
  CHECK(w.position(above).z() == Catch::Approx(high + r).epsilon(1e-6));
  check_refused([&] { (void)w.position(fallen); }, "was removed");
  check_refused([&] { (void)w.position(over); }, "was removed");
  REQUIRE(w.run(20));
}

TEST_CASE("ruts stay behind as heights") {
  dem::World<OpenCubes> w = open_ground();
  MovingPatch<OpenCubes> patch(w, settled_tile(), short_patch);
  // A trench: what is above 4 mm in the middle goes.
  const double middle = tile_width, deep = 4e-3;
  for (const GrainId p : w.grains()) {
    const Vec3 x = w.position(p);
    if (std::abs(x.y() - middle) < 3e-3 && x.z() > deep && !w.species(w.species_of(p)).is_held()) w.remove_grain(p);
  }
  REQUIRE(w.run(1));
  REQUIRE(patch.follow(w, 3.9 * tile_length));
  const dem::soil::HeightField& rut = patch.rut();
  CHECK(rut.across == 24);
  CHECK(rut.along() >= 32);  // two tiles, and as far as their last grains reach
  CHECK(rut.along() <= 34);
  double in = 0.0, beside = 0.0;
  int cells_in = 0, cells_beside = 0;
  for (std::size_t i = 4; i < 32; ++i) {
    for (std::size_t j = 0; j < rut.across; ++j) {
      const double y = (static_cast<double>(j) + 0.5) * rut.cell, z = rut.z[i * rut.across + j];
      if (!(z == z)) continue;
      if (std::abs(y - middle) < 2e-3) in += z, ++cells_in;
      if (std::abs(y - middle) > 6e-3) beside += z, ++cells_beside;
    }
  }
  REQUIRE(cells_in > 60);
  REQUIRE(cells_beside > 100);
  CHECK(in / cells_in < deep + 1.4e-3);  // a ball of a cube's volume on top
  CHECK(beside / cells_beside > in / cells_in + 1e-3);
  const auto whole = patch.surface(w);
  CHECK(whole.along() >= 6 * 16);  // of the patch as well
}

TEST_CASE("a patch doubles its length once, and says what that changed") {
  dem::World<OpenCubes> w = open_ground();
  MovingPatch<OpenCubes> patch(w, settled_tile(), short_patch);
  REQUIRE(w.run(1));
  check_refused([&] { (void)patch.length_effect(); }, "0 readings of the short patch");
  patch.note(1.0), patch.note(3.0);
  patch.double_length();
  patch.note(100.0);  // while it grows
  double x = 1.7 * tile_length;
  CHECK(patch.follow(w, x));
  CHECK(patch.front() - x >= 2 * short_patch.ahead);
  while (patch.tiles() < 8) {
    REQUIRE(x < 1.0);
    patch.follow(w, x += 0.5 * tile_length);
  }
  patch.note(2.5);
  CHECK(w.grain_count() == 8 * 2 * 120);
  const auto effect = patch.length_effect();
  CHECK(effect.before == 2.0);
  CHECK(effect.after == 2.5);
  CHECK(effect.shift() == Catch::Approx(0.2));
  CHECK(effect.readings_before == 2);
  CHECK(effect.readings_after == 1);
  check_refused([&] { patch.double_length(); }, "once");
  for (int k = 0; k < 20; ++k) patch.follow(w, x += 0.5 * tile_length);
  CHECK(patch.tiles() == 8);
  CHECK(w.grain_count() == 8 * 2 * 120);
  double most = 0.0;
  for (int k = 0; k < 5; ++k) {
    REQUIRE(w.run(10));
    most = std::max(most, kinetic_energy_of_a_grain(w));
  }
  CHECK(most < w.species(SpeciesId(0)).mass * g * 1e-8);
}

TEST_CASE("on a patch parts keep the grains that they hold, and energy is counted") {
  dem::World<OpenCubes> w = open_ground();
  const auto glued = w.add_species(dem::shape::cube8(half_edge), {.held = true});
  MovingPatch<OpenCubes> patch(w, settled_tile(), short_patch);
  const auto bob = add_pendulum(w);
  const GrainId grain = w.add_grain({glued, Vec3(0, 0.1, 0.3)});  // behind all of the patch, but the bob's
  w.attach(grain, bob);
  w.remove_grain(GrainId(3));  // gives its id to another
  REQUIRE(w.run(600));
  dem::count_energy(w);
  const auto counted = [&] {
    const dem::GrainEnergy e = dem::energy_of(w);
    return e.kinetic() + e.potential - e.came;
  };
  const double before = counted();
  for (int k = 0; k < 8; ++k) {
    patch.follow(w, 1.5 * tile_length + k * tile_length);
    REQUIRE(w.run(300));
  }
  // All grains at rest, as above: no energy comes or goes but with them.
  CHECK(std::abs(counted() - before) < 960 * w.species(SpeciesId(0)).mass * g * 1e-7);
  CHECK(w.species_of(grain) == glued);
  const auto& body = w.machine().bodies()[bob.index()];
  CHECK((w.position(grain) - (body.position() + body.rotation() * Vec3(0, 0.1, 0))).norm() < 1e-12);
  // The id of the grain that went is another's now; the world has no more of them than it needs.
  CHECK(w.state().grains.row_of.size() == 4 * 240 + 1);
}

TEST_CASE("threads change no bit of a patch that goes on") {
  const auto run = [](int threads) {
    dem::World<OpenCubes> w = open_ground(threads);
    MovingPatch<OpenCubes> patch(w, settled_tile(), short_patch);
    auto& m = w.machine();
    const auto ball = m.add_body(dem::mbd::sphere_body("ball", 4e-3, 3000).at({1.5 * tile_length, tile_width, 14e-3}));
    w.add_surface(ball, dem::surface::Sphere(4e-3));
    for (int k = 0; k < 6; ++k) {
      patch.follow(w, 1.5 * tile_length + k * tile_length);
      REQUIRE(w.run(100));
    }
    return w;
  };
  const auto one = run(1), three = run(3);
  REQUIRE(one.grains() == three.grains());
  for (const GrainId p : one.grains()) {
    CHECK(one.position(p) == three.position(p));
    CHECK(one.velocity(p) == three.velocity(p));
  }
}

TEST_CASE("patches that make no sense are refused in words") {
  dem::World<OpenCubes> w = open_ground();
  const auto refused = [&](PatchOptions o, auto... words) {
    check_refused([&] { MovingPatch<OpenCubes>(w, settled_tile(), o); }, words...);
  };
  refused({.tiles = 4, .ahead = 0.02}, "rim");
  refused({.tiles = 4, .rim = 0.01, .ahead = 0.02}, "rim", "0.008");
  refused({.tiles = 2, .rim = rim, .ahead = 0.02}, "2 tiles", "0.032 m long", "at least 0.039 m");
  refused({.tiles = 0, .rim = rim}, "0 x 1 tiles");
  dem::World<TiledCubes> cell = tiled_cell(4, 1);
  check_refused([&] { MovingPatch<TiledCubes>(cell, settled_tile(), {.tiles = 4, .rim = rim}); }, "repeats itself");
  CHECK(w.grain_count() + cell.grain_count() == 0);
  MovingPatch<OpenCubes> patch(w, settled_tile(), short_patch);
  check_refused([&] { patch.follow(w, 1.0); }, "run away");
}
