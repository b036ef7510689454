#include "scenes.hpp"

#include "core/error_of.hpp"

#include <dem/world/energy.hpp>
#include <dem/world/rest.hpp>

#include <algorithm>
#include <functional>
#include <set>

using Catch::Approx;

namespace {

/// Towers of cubes in three chunks, which come to rest within some hundredths of a second: 64 towers of 9 cubes, face
/// on face, with clearance between towers.
struct Towers {
  static constexpr double half = 1e-3, pitch = 2.2e-3;
  static constexpr int across = 8, high = 9;
  dem::World<models::VerletCubes> w;
  SurfaceId floor;
  std::vector<GrainId> grains;
  double weight = 0.0;  // N, of all grains

  explicit Towers(bool sleep, int threads = 1) : w(with(sleep, threads)) {
    // The damper is a third of the critical one.
    w.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
    const auto cube = w.add_species(dem::shape::cube8(half));
    floor = w.add_surface(w.ground(), dem::surface::Plane{});
    for (int i = 0; i < across; ++i) {
      for (int j = 0; j < across; ++j) {
        for (int k = 0; k < high; ++k) {
          grains.push_back(w.add_grain({cube, Vec3(pitch * i, pitch * j, half + 2 * half * k)}));
        }
      }
    }
    weight = static_cast<double>(grains.size()) * w.species(cube).mass * g;
  }
  static dem::WorldOptions with(bool sleep, int threads) {
    dem::WorldOptions o = options({0, 0, -g});
    if (sleep) o.sleep = dem::SleepOptions{};
    o.threads = threads;
    return o;
  }
  double on_floor() const { return -w.surface_force(floor).z(); }
};

/// Towers of 6 cubes on a table that goes up by `height(t)` (m): 384 in all, which sleep after 0.06 s.
struct TowersOnTable {
  dem::World<models::VerletCubes> w;
  std::vector<GrainId> grains;
  SurfaceId table;

  explicit TowersOnTable(const std::function<double(double)>& height,
                         const dem::WorldOptions& o = Towers::with(true, 1))
      : w(o) {
    w.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
    const auto cube = w.add_species(dem::shape::cube8(1e-3));
    const auto body = w.machine().add_fixed_body("table", Vec3::Zero());
    table = w.add_surface(body, dem::surface::Plane{});
    w.machine().add_motion(
        dem::mbd::prescribed_position("lift", body, Vec3::UnitZ(), dem::mbd::Signal::function(height)));
    for (int k = 0; k < 384; ++k) grains.push_back(w.add_grain({cube, place(k)}));
  }
  /// Where cube k stands on a table at height 0.
  static Vec3 place(int k) { return {2.2e-3 * (k % 8), 2.2e-3 * (k / 8 % 8), 1e-3 + 2e-3 * (k / 64)}; }
};

/// The force and the torque on each sleeper are the sums over all of its contacts. Of a grain among sleepers they must
/// agree to rounding. Beside one that is awake dampers differ, as contacts_of takes speeds after the forces and the
/// step those before: by c a dt/2 = 0.025 N s/m times 3e-5 s times a few g, a few hundredths of a grain's weight; more
/// where it is hit.
void check_sums(const dem::World<models::VerletCubes>& w, const std::vector<GrainId>& grains, double weight) {
  const double one = w.species(SpeciesId(0)).mass * g;
  std::vector<Vec3> sum(w.grain_count(), Vec3::Zero()), turn = sum;
  std::set<std::uint32_t> beside_awake;
  for (const auto& c : dem::contacts_of(w)) {
    if (c.kind == dem::ContactKind::grains && !w.is_asleep(c.grain)) beside_awake.insert(c.other_grain.value);
    if (c.kind == dem::ContactKind::grains && !w.is_asleep(c.other_grain)) beside_awake.insert(c.grain.value);
    sum[c.grain.value] += c.force;
    turn[c.grain.value] += c.torque;
    if (c.kind != dem::ContactKind::grains) continue;
    sum[c.other_grain.value] -= c.force;
    turn[c.other_grain.value] += c.other_torque;
  }
  for (const GrainId p : grains) {
    if (!w.is_asleep(p)) continue;
    INFO("grain " << p.value << " after " << w.steps() << " steps");
    const bool is_kept = beside_awake.count(p.value) == 0;
    const double most = is_kept ? 1e-9 * weight : 0.5 * one;
    CHECK((w.force(p) - sum[p.value]).norm() < most);
    CHECK((w.torque(p) - turn[p.value]).norm() < most * Towers::half);
  }
}

}  // namespace

TEST_CASE("a bed falls asleep, weighs what it weighs, and its grains stay where they are", "[slow]") {
  Towers bed(true), awake(false);
  REQUIRE(bed.w.run_for(0.07));
  REQUIRE(awake.w.run_for(0.07));
  CHECK(bed.w.asleep_count() == bed.grains.size());
  CHECK(awake.w.asleep_count() == 0);
  CHECK(bed.w.state().sleepers.working.empty());
  // What is left of the forces on a grain is at most 0.01 of what it bears, in a tower 9 weights on average. Towers
  // that swing in step fall asleep in step, so nothing but the swing's place makes the sum smaller: 0.003 was seen.
  CHECK(bed.on_floor() == Approx(bed.weight).epsilon(0.01));
  // The contacts of a tower are off by 0.01 (2 k - 1) m g/(4 K) in layer k from the top: 9e-8 m in all.
  for (const GrainId p : bed.grains) CHECK((bed.w.position(p) - awake.w.position(p)).norm() < 9e-8);
  CHECK(bed.w.velocity(bed.grains[0]).norm() == 0.0);
}

TEST_CASE("no grain hangs in the air when what it stands on is taken away", "[slow]") {
  Towers bed(true);
  REQUIRE(bed.w.run_for(0.07));
  REQUIRE(bed.w.asleep_count() == bed.grains.size());
  const double time = 0.01;  // a fall by an edge takes 0.02 s
  SECTION("a floor that is switched off") {
    bed.w.set_active(bed.floor, false);
    REQUIRE(bed.w.run_for(time));
    // All of them fall freely.
    for (const GrainId p : bed.grains) CHECK(bed.w.velocity(p).z() < -0.9 * g * time);
  }
  SECTION("the lowest grain of each tower") {
    for (std::size_t k = 0; k < bed.grains.size(); k += Towers::high) bed.w.remove_grain(bed.grains[k]);
    REQUIRE(bed.w.run_for(time));
    for (std::size_t k = 0; k < bed.grains.size(); ++k) {
      if (k % Towers::high != 0) CHECK(bed.w.velocity(bed.grains[k]).z() < -0.9 * g * time);
    }
  }
  SECTION("the lowest grain of each tower, which is put elsewhere") {
    for (std::size_t k = 0; k < bed.grains.size(); k += Towers::high)
      bed.w.set_position(bed.grains[k], bed.w.position(bed.grains[k]) + Vec3(0.1, 0, 0.1));
    REQUIRE(bed.w.run_for(time));
    for (const GrainId p : bed.grains) CHECK(bed.w.velocity(p).z() < -0.9 * g * time);
  }
  SECTION("gravity that points elsewhere") {
    bed.w.set_gravity({0, 0, g});
    REQUIRE(bed.w.run_for(time));
    for (const GrainId p : bed.grains) CHECK(bed.w.velocity(p).z() > 0.9 * g * time);
  }
}

TEST_CASE("a sleeper wakes where its neighbour is given a velocity, and a whole bed where constants are", "[slow]") {
  Towers bed(true);
  REQUIRE(bed.w.run_for(0.07));
  REQUIRE(bed.w.asleep_count() == bed.grains.size());
  SECTION("nobody by what is as it was") {
    bed.w.set_gravity(bed.w.state().options.gravity);
    bed.w.set_sleep(dem::SleepOptions{});
    REQUIRE(bed.w.run(1));
    CHECK(bed.w.asleep_count() == bed.grains.size());
    bed.w.set_sleep(dem::SleepOptions{.window = 50});
    CHECK(bed.w.asleep_count() == 0);
  }
  SECTION("a velocity") {
    bed.w.set_velocity(bed.grains[4], {0, 0, 0.1});
    CHECK(!bed.w.is_asleep(bed.grains[5]));  // it stands on the one that jumps
    double fastest = 0.0;
    for (int k = 0; k < 40; ++k) {
      REQUIRE(bed.w.run(1));
      fastest = std::max(fastest, bed.w.velocity(bed.grains[5]).z());
    }
    CHECK(fastest > 0.02);
  }
  SECTION("constants") {
    const double top = bed.w.position(bed.grains[8]).z();
    bed.w.set_contact({{250.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
    CHECK(bed.w.asleep_count() == 0);
    REQUIRE(bed.w.run_for(0.06));
    // Springs half as stiff give twice as much: m g (1 + 2 + ... + 9) over those of four contacts, once more.
    const double one = bed.weight / static_cast<double>(bed.grains.size());
    CHECK(top - bed.w.position(bed.grains[8]).z() == Approx(45 * one / (4 * 500.0)).epsilon(0.1));
  }
}

TEST_CASE("a floor that sinks under a sleeping bed takes it along", "[slow]") {
  TowersOnTable bed([](double t) { return t < 0.07 ? 0.0 : -0.02 * (t - 0.07); });
  REQUIRE(bed.w.run_for(0.06));
  REQUIRE(bed.w.asleep_count() == bed.grains.size());
  REQUIRE(bed.w.run_for(0.06));
  // 1 mm down; the contacts of a tower of 6 give by less than 3e-6 m in all.
  for (int k = 0; k < 384; ++k) {
    const double now = bed.w.position(bed.grains[static_cast<std::size_t>(k)]).z();
    CHECK(now == Approx(TowersOnTable::place(k).z() - 1e-3).margin(1e-5));
  }
}

TEST_CASE("no grain hangs in the air when the floor is far away after one step", "[slow]") {
  TowersOnTable bed([](double t) { return t < 0.07 ? 0.0 : -0.1; });
  REQUIRE(bed.w.run_for(0.069));
  REQUIRE(bed.w.asleep_count() == bed.grains.size());
  REQUIRE(bed.w.run_for(0.011));
  for (const GrainId p : bed.grains) CHECK(bed.w.velocity(p).z() < -0.9 * g * 0.01);
  CHECK(bed.w.surface_force(bed.table).norm() == 0.0);
}

TEST_CASE("a surface that is added where grains sleep is felt in the next step", "[slow]") {
  Towers bed(true);
  REQUIRE(bed.w.run_for(0.07));
  REQUIRE(bed.w.asleep_count() == bed.grains.size());
  const double top = 2e-3 * Towers::high, edge = 2.4e-3 * Towers::across, into = 2e-5;  // m
  const SurfaceId lid = bed.w.add_surface(bed.w.ground(), dem::surface::Box(Vec3(2 * edge, 2 * edge, 1e-3)),
                                          {.position = Vec3(0.5 * edge, 0.5 * edge, top + 5e-4 - into)});
  REQUIRE(bed.w.run(2));
  // Each of 64 cubes by four spheres of 500 N/m; towers have sunk by 5e-6 m.
  CHECK(bed.w.surface_force(lid).z() == Approx(64 * 4 * 500.0 * (into - 5e-6)).epsilon(0.1));
  CHECK(bed.w.asleep_count() < bed.grains.size());
}

TEST_CASE("a grain that turns in its place, or flies slowly, does not sleep") {
  const auto check = [](auto& w, const auto& shape) {
    const auto kind = w.add_species(shape);
    w.add_surface(w.ground(), dem::surface::Plane{}, {.material = "ice"});
    const double radius = 1e-3, turning = 5.0, drift = 1e-7;  // m, rad/s, m/s
    const auto top = w.add_grain({.species = kind, .position = {0, 0, radius}, .angular_velocity = {0, 0, turning}});
    const auto rests = w.add_grain({.species = kind, .position = {0.01, 0, radius}});
    REQUIRE(w.run_for(0.2));
    CHECK(w.is_asleep(rests));
    CHECK(!w.is_asleep(top));
    CHECK(w.angular_velocity(top).z() == Approx(turning).epsilon(1e-9));
    // Without gravity one that moves goes on; one that does not may sleep.
    w.remove_grain(top);
    w.remove_grain(rests);
    w.set_gravity({0, 0, 0});
    const auto flier = w.add_grain({kind, Vec3(0, 0, 0.05), {drift, 0, 0}}),
               stays = w.add_grain({kind, Vec3(0.01, 0, 0.05)});
    REQUIRE(w.run_for(0.1));
    CHECK(w.velocity(flier).x() == drift);
    CHECK(!w.is_asleep(flier));
    CHECK(w.is_asleep(stays));
  };
  const auto without_friction = [](auto& w) {
    w.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
    w.set_contact("grain", "ice", {{500.0, 0.06, 1.0}, {0.0, 500.0, 0.05, 0.975}});
  };
  dem::World<models::VerletCubes> cubes(Towers::with(true, 1));
  dem::World<models::VerletBalls> balls(Towers::with(true, 1));
  without_friction(cubes), without_friction(balls);
  check(cubes, dem::shape::cube8(1e-3));
  check(balls, Sphere(1e-3));
}

TEST_CASE("what grains that fall asleep lose of their motion is counted", "[slow]") {
  // They may move ten times as far, so that there is something to lose.
  const bool sleeps = GENERATE(false, true);
  Towers bed(false);
  if (sleeps) bed.w.set_sleep(dem::SleepOptions{.balance = 0.3, .change = 0.3, .jolt = 0.3, .motion = 0.01});
  bed.grains.push_back(bed.w.add_grain({SpeciesId(0), Vec3(0, 0, 2e-3 * Towers::high + 2e-3), {0, 0, -0.2}}));
  dem::count_energy(bed.w);
  const double before = dem::energy_of(bed.w).balance();
  REQUIRE(bed.w.run_for(0.08));
  const dem::GrainEnergy e = dem::energy_of(bed.w);
  CHECK(bed.w.asleep_count() == (sleeps ? bed.grains.size() : 0));
  if (sleeps) CHECK(e.dissipated_asleep > 5e-10);
  // 3e-11 J is the integrator's error, with sleep and without.
  CHECK(std::abs(e.balance() - before) < 1e-10);
}

TEST_CASE("neighbours are listed anew where a few grains that are awake lie in many chunks", "[slow]") {
  Towers bed(true);
  REQUIRE(bed.w.run_for(0.07));
  auto& s = bed.w.state();
  REQUIRE(bed.w.asleep_count() == bed.grains.size());
  REQUIRE(s.chunks.size() == 3);
  s.sleepers.measuring = true;
  dem::look_at_order(s);
  CHECK(s.list_valid);  // nobody is awake
  SECTION("all in one chunk") {
    for (std::size_t row = 0; row < 100; ++row) dem::wake_row(s, row);
    dem::look_at_order(s);
    CHECK(s.list_valid);
  }
  SECTION("one in each chunk") {
    for (std::size_t c = 0; c < 3; ++c) dem::wake_row(s, 256 * c + 7);
    dem::look_at_order(s);
    CHECK(!s.list_valid);
    REQUIRE(bed.w.run(1));
    // They come first now.
    for (std::size_t row = 0; row < 3; ++row) CHECK(!bed.w.is_asleep(s.grains.name(s.grains.id[row])));
  }
}

TEST_CASE("a part that holds grains finds its rest under grains that sleep on them", "[slow]") {
  // A table of glued cubes on a spring, and towers of 5 on it.
  dem::World<models::VerletCubes> w(Towers::with(true, 1));
  w.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
  const auto cube = w.add_species(dem::shape::cube8(1e-3)),
             glued = w.add_species(dem::shape::cube8(1e-3), {.held = true});
  auto& m = w.machine();
  const Vec3 middle(7.7e-3, 7.7e-3, 0);
  const auto table = m.add_body(dem::mbd::box_body("table", {0.02, 0.02, 2e-3}, 2650).at(middle));
  m.add_joint(dem::mbd::prismatic("guide", w.ground(), table, middle, Vec3::UnitZ()));
  const double stiffness = 200.0;
  m.add_spring(dem::mbd::spring("spring", w.ground(), middle - Vec3(0, 0, 0.05), table, middle, stiffness, 1.0));
  std::size_t grains = 0;
  for (int k = 0; k < 384; ++k) {
    const GrainId p =
        w.add_grain({k < 64 ? glued : cube, Vec3(2.2e-3 * (k % 8), 2.2e-3 * (k / 8 % 8), 2e-3 * (k / 64))});
    if (k < 64) w.attach(p, table);
    grains += k < 64 ? 0 : 1;
  }
  const double weight = static_cast<double>(grains) * w.species(cube).mass * g;
  REQUIRE(w.run_for(0.3));
  REQUIRE(w.asleep_count() == grains);
  const double sunk = w.machine().body(table).position().z();
  CHECK(sunk < -weight / stiffness);  // and by the weight of the table itself
  const auto rest = dem::find_rest(w);
  INFO(rest.text);
  CHECK(rest);
  // Without what the towers do to the glued cubes it would rise by 3e-4 m.
  CHECK(w.machine().body(table).position().z() == Approx(sunk).margin(1e-7));
}

TEST_CASE("grains that a part holds wake as it moves, and so do those that stand on them", "[slow]") {
  // Towers of 5 on cubes that are glued to a table, and a visitor on one of them, so that contacts are evaluated. The
  // table begins to sink in the middle of a step: its grains wake at the step's end, after the contacts.
  dem::World<models::VerletCubes> w(Towers::with(true, 1));
  w.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
  const auto cube = w.add_species(dem::shape::cube8(1e-3)),
             glued = w.add_species(dem::shape::cube8(1e-3), {.held = true});
  const auto table = w.machine().add_fixed_body("table", Vec3::Zero());
  const double begins = 0.0702, speed = 0.01, way = 1e-4;  // s, m/s, m
  w.machine().add_motion(dem::mbd::prescribed_position(
      "sink", table, Vec3::UnitZ(),
      dem::mbd::Signal::function([=](double t) { return -std::clamp(speed * (t - begins), 0.0, way); })));
  std::vector<GrainId> on_table, grains;
  for (int k = 0; k < 384; ++k) {
    const GrainId p =
        w.add_grain({k < 64 ? glued : cube, Vec3(2.2e-3 * (k % 8), 2.2e-3 * (k / 8 % 8), 2e-3 * (k / 64))});
    if (k < 64) w.attach(p, table);
    (k < 64 ? on_table : grains).push_back(p);
  }
  const double weight = static_cast<double>(grains.size()) * w.species(cube).mass * g;
  REQUIRE(w.run_for(begins - 0.01));
  REQUIRE(w.asleep_count() == 384);
  grains.push_back(w.add_grain({cube, Vec3(0, 0, 2e-3 * 6 + 5e-4), {0, 0, -0.1}}));
  REQUIRE(w.run_for(0.01 - 1e-4));
  REQUIRE(!w.state().sleepers.working.empty());
  REQUIRE(std::any_of(on_table.begin(), on_table.end(), [&](GrainId p) { return w.is_asleep(p); }));
  bool has_moved = false;
  while (w.time() < begins + 2 * way / speed) {
    REQUIRE(w.run(1));
    const bool moves = w.machine().body(table).velocity().norm() > 0.0;
    if (moves && !has_moved) {
      has_moved = true;
      for (const GrainId p : on_table) CHECK(!w.is_asleep(p));
    }
    check_sums(w, grains, weight);
  }
  CHECK(has_moved);
  REQUIRE(w.run_for(0.05));
  for (std::size_t k = 0; k < 320; ++k) {
    CHECK(w.position(grains[k]).z() == Approx(2e-3 * static_cast<double>(k / 64 + 1) - way).margin(1e-5));
  }
  CHECK(w.asleep_count() == 385);
}

TEST_CASE("a grain that lands wakes its surroundings, and is held", "[slow]") {
  Towers bed(true);
  REQUIRE(bed.w.run_for(0.07));
  const double top = 2e-3 * Towers::high;
  const auto visitor = bed.w.add_grain({SpeciesId(0), Vec3(0, 0, top + 2e-3), {0, 0, -0.2}});
  std::size_t least_asleep = bed.grains.size();
  for (int k = 0; k < 20; ++k) {
    REQUIRE(bed.w.run_for(0.005));
    least_asleep = std::min(least_asleep, bed.w.asleep_count());
  }
  // Grains under it wake, but not the whole bed at once.
  CHECK(least_asleep > 0);
  CHECK(least_asleep < bed.grains.size());
  CHECK(bed.w.asleep_count() == bed.grains.size() + 1);
  CHECK(bed.w.position(visitor).z() > top);
  CHECK(bed.on_floor() == Approx(bed.weight * (1.0 + 1.0 / static_cast<double>(bed.grains.size()))).epsilon(0.01));
}

TEST_CASE("the force on each grain is that of all of its contacts, evaluated in this step or kept") {
  // Gravity leans, so that friction holds the towers. A visitor lands on one corner: some grains are awake, most sleep.
  Towers bed(true);
  const dem::SleepOptions lax{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.01, .window = 50};
  bed.w.set_gravity({0.03 * g, 0.01 * g, -g});
  bed.w.set_sleep(lax);
  REQUIRE(bed.w.run_for(0.1));
  bed.grains.push_back(bed.w.add_grain({SpeciesId(0), Vec3(0, 0, 2e-3 * Towers::high + 2e-3), {0, 0, -0.2}}));
  int mixed = 0;
  for (int k = 0; k < 40; ++k) {
    const auto into = static_cast<int>(bed.w.steps() % static_cast<std::uint64_t>(lax.window));
    REQUIRE(bed.w.run(lax.window - into + 1 + k));  // from 1 to 40 steps into a window
    const std::size_t asleep = bed.w.asleep_count();
    mixed += asleep > 0 && asleep < bed.grains.size() ? 1 : 0;
    check_sums(bed.w, bed.grains, bed.weight);
  }
  CHECK(mixed > 5);
}

TEST_CASE("each grain knows how many are awake beside it, while some wake and others fall asleep", "[slow]") {
  Towers bed(true);
  for (std::size_t k = 0; k < bed.grains.size(); ++k) {  // towers that fall asleep at different times
    bed.w.set_position(bed.grains[k], bed.w.position(bed.grains[k]) + Vec3(0, 0, 1e-5 * double(k / 30)));
  }
  bed.w.add_grain({SpeciesId(0), Vec3(0, 0, 2e-3 * Towers::high + 4e-3), {0, 0, -0.2}});
  std::size_t mixed = 0;
  for (int k = 0; k < 150; ++k) {
    REQUIRE(bed.w.run(40));
    dem::World<models::VerletCubes> now = bed.w;
    dem::watch_changed(now.state());
    const std::vector<std::uint16_t> kept = now.state().sleepers.awake_beside;
    dem::count_awake_beside(now.state());
    CHECK(kept == now.state().sleepers.awake_beside);
    mixed += bed.w.asleep_count() > 0 && bed.w.asleep_count() < bed.grains.size() ? 1 : 0;
  }
  CHECK(mixed > 20);
}

TEST_CASE("histories of contacts that were not evaluated stay, whatever comes and goes between them") {
  using Histories = dem::ContactHistories<1>;
  struct Entry {
    std::uint64_t candidate, point;
    double history;
  };
  const auto list = [](Histories& m, const std::vector<Entry>& entries) {
    m.make_room(m.count = static_cast<int>(entries.size()));
    for (std::size_t k = 0; k < entries.size(); ++k) {
      m.key[k] = entries[k].candidate << 32 | entries[k].point;
      m.history[0][k] = entries[k].history;
    }
  };
  const std::vector<std::uint8_t> renews = {0, 1, 0, 1, 0};
  const auto check = [&](const std::vector<Entry>& now, const std::vector<Entry>& wanted) {
    dem::HistoriesOfSteps<1> m;
    Histories spare;
    list(m.last, {{0, 3, 1.0}, {1, 2, 2.0}, {1, 5, 3.0}, {2, 0, 4.0}, {2, 1, 5.0}, {3, 0, 6.0}, {4, 7, 7.0}});
    list(m.now, now);
    m.commit_some(renews, spare);
    REQUIRE(m.committed() == static_cast<int>(wanted.size()));
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      CHECK(m.last.key[k] == (wanted[k].candidate << 32 | wanted[k].point));
      CHECK(m.last.history[0][k] == wanted[k].history);
    }
  };
  const Entry first = {0, 3, 1.0}, third = {2, 0, 4.0}, fourth = {2, 1, 5.0}, last = {4, 7, 7.0};
  SECTION("the same contacts") {
    check({{1, 2, 20.0}, {1, 5, 30.0}, {3, 0, 60.0}},
          {first, {1, 2, 20.0}, {1, 5, 30.0}, third, fourth, {3, 0, 60.0}, last});
  }
  SECTION("one is gone") {
    check({{1, 5, 30.0}, {3, 0, 60.0}}, {first, {1, 5, 30.0}, third, fourth, {3, 0, 60.0}, last});
  }
  SECTION("one is new, another gone") {
    check({{1, 2, 20.0}, {1, 4, 8.0}, {3, 9, 9.0}},
          {first, {1, 2, 20.0}, {1, 4, 8.0}, third, fourth, {3, 9, 9.0}, last});
  }
  SECTION("all are gone") { check({}, {first, third, fourth, last}); }
}

TEST_CASE("a grain that flies past wakes nobody, however often lists are made anew", "[slow]") {
  // It rises beside the towers and touches nothing, all of it in less than the two windows after which a grain that was
  // woken may sleep again. As the only one that is awake it is sorted before all others.
  Towers bed(true);
  bed.w.set_sleep(dem::SleepOptions{.window = 600});
  REQUIRE(bed.w.run_for(0.15));
  REQUIRE(bed.w.asleep_count() == bed.grains.size());
  const double high = 2e-3 * Towers::high, beside = Towers::pitch * (Towers::across - 1) + 6e-3, speed = 4.0;
  const auto flier = bed.w.add_grain({SpeciesId(0), Vec3(beside, 7e-3, 1e-3), {0, 0, speed}});
  const auto lists = bed.w.state().rebuilds, steps = bed.w.steps();
  std::size_t least = bed.grains.size();
  while (bed.w.position(flier).z() < high) {
    REQUIRE(bed.w.run(5));
    least = std::min(least, bed.w.asleep_count());
    CHECK(bed.w.state().grains.row_of[flier.value] == 0);
  }
  CHECK(bed.w.state().rebuilds - lists > 5);
  CHECK(bed.w.steps() - steps < 2 * 600);
  CHECK(least == bed.grains.size());
}

TEST_CASE("a bed falls asleep although neighbours are listed anew again and again", "[slow]") {
  // A grain far away is so fast that there is a new list in each of the windows that grains must be at rest for.
  Towers bed(true);
  const auto flier = bed.w.add_grain({SpeciesId(0), Vec3(0.5, 0.5, 0.5), {3.0, 0, 0}});
  REQUIRE(bed.w.run_for(0.08));
  const auto lists = bed.w.state().rebuilds, steps = bed.w.steps();
  CHECK(bed.w.asleep_count() + dem::chunk_size > bed.grains.size());
  REQUIRE(bed.w.run(1000));
  CHECK(bed.w.steps() - steps < 50 * (bed.w.state().rebuilds - lists));
  CHECK(bed.w.asleep_count() + dem::chunk_size > bed.grains.size());
  CHECK(!bed.w.is_asleep(flier));
}

TEST_CASE("sleeping worlds are the same bits on any number of threads", "[slow]") {
  std::vector<std::vector<Vec3>> positions;
  std::vector<std::size_t> asleep;
  for (const int threads : {1, 2, 3}) {
    Towers bed(true, threads);
    // Towers that start at different heights fall asleep at different times.
    for (std::size_t k = 0; k < bed.grains.size(); ++k) {
      bed.w.set_position(bed.grains[k], bed.w.position(bed.grains[k]) + Vec3(0, 0, 1e-5 * double(k / 30)));
    }
    REQUIRE(bed.w.run_for(0.05));
    asleep.push_back(bed.w.asleep_count());
    positions.emplace_back();
    for (const GrainId p : bed.grains) positions.back().push_back(bed.w.position(p));
  }
  CHECK(asleep[0] == asleep[1]);
  CHECK(asleep[0] == asleep[2]);
  for (std::size_t t : {1, 2}) {
    for (std::size_t k = 0; k < positions[0].size(); ++k) CHECK(positions[t][k] == positions[0][k]);
  }
}

TEST_CASE("a load that grows slowly reaches the floor through a bed that sleeps", "[long]") {
  // In 0.1 s all layers are awake most of the time. In 0.4 s half of them sleep.
  const auto [seconds, most] = GENERATE(std::pair(0.1, 0.03), std::pair(0.4, 0.09));
  Towers bed(true);
  REQUIRE(bed.w.run_for(0.07));
  auto& m = bed.w.machine();
  const double top = 2e-3 * Towers::high, edge = 2.4e-3 * Towers::across;
  const dem::BodyId lid = m.add_fixed_body("lid", Vec3(0.5 * edge, 0.5 * edge, top + 5e-4));
  bed.w.add_surface(lid, dem::surface::Box(Vec3(2 * edge, 2 * edge, 1e-3)), {.name = "lid"});
  // Presses by 4e-5 m. Each tower is 10 contacts of 4 K in a row and has sunk by 45 m g/(4 K) = 5e-6 m, so
  // 0.45 N in all, 3.7 times the bed's weight.
  m.add_motion(
      dem::mbd::prescribed_position("press", lid, -Vec3::UnitZ(), dem::mbd::Signal::ramp(0.0, 4e-5 / seconds, 0.07)));
  double worst = 0.0;
  for (int k = 0; k < 10; ++k) {
    REQUIRE(bed.w.run_for(seconds / 10));
    const double press = bed.w.surface_force(SurfaceId(1)).z();
    worst = std::max(worst, std::abs(bed.on_floor() - press - bed.weight) / bed.on_floor());
  }
  CHECK(bed.w.surface_force(SurfaceId(1)).z() == Approx(0.45).epsilon(0.1));
  // Each of nine layers may pass on changes late of up to 0.01 of what it bears, which is twice the load, and waits for
  // half of that in the mean: 0.09 if all sleep. 0.05 was seen.
  CHECK(worst < most);
}

TEST_CASE("a load that grows in a few steps and stays reaches the floor through a bed that sleeps", "[slow]") {
  // Over before the running mean has seen it. On its way the lid's damper makes a jolt of it.
  Towers bed(true);
  auto& m = bed.w.machine();
  const double top = 2e-3 * Towers::high, edge = 2.4e-3 * Towers::across, before = 4e-5, more = 2.5e-6;  // m
  const dem::BodyId lid = m.add_fixed_body("lid", Vec3(0.5 * edge, 0.5 * edge, top + 5e-4));
  bed.w.add_surface(lid, dem::surface::Box(Vec3(2 * edge, 2 * edge, 1e-3)), {.name = "lid"});
  m.add_motion(dem::mbd::prescribed_position("press", lid, Vec3::UnitZ(), dem::mbd::Signal::function([=](double t) {
                                               const double steps = 5 * 1.1e-5;  // s
                                               return -before * std::clamp(t / 0.05, 0.0, 1.0) -
                                                      more * std::clamp((t - 0.15) / steps, 0.0, 1.0);
                                             })));
  REQUIRE(bed.w.run_for(0.149));
  REQUIRE(bed.w.asleep_count() == bed.grains.size());
  const double press = bed.w.surface_force(SurfaceId(1)).z(), floor = bed.on_floor();
  REQUIRE(bed.w.run_for(0.1));
  const double pressed_more = bed.w.surface_force(SurfaceId(1)).z() - press;
  CHECK(pressed_more > 0.03 * press);
  // What each of nine layers may keep back is 0.01 of what it bears, twice the load; half of that in the mean.
  CHECK(bed.on_floor() - floor > 0.5 * pressed_more);
}

TEST_CASE("a change of load below SleepOptions::change leaves a bed asleep, one above it wakes the bed", "[slow]") {
  // Towers of 6 cubes on a table that rises within 10 ms. The lowest cube bears 6 weights from below and 5 from above.
  // While it sleeps it does not give way, so the table's force on it grows by 4 K times the way.
  const auto least_asleep = [](double share_of_borne, double change) {
    dem::WorldOptions o = Towers::with(true, 1);
    o.sleep->change = change;
    dem::World<models::VerletCubes> w(o);
    w.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
    const auto cube = w.add_species(dem::shape::cube8(1e-3));
    const double way = share_of_borne * 11.0 * w.species(cube).mass * g / (4.0 * 500.0);  // m
    const auto table = w.machine().add_fixed_body("table", Vec3::Zero());
    w.add_surface(table, dem::surface::Plane{});
    w.machine().add_motion(dem::mbd::prescribed_position(
        "rise", table, Vec3::UnitZ(),
        dem::mbd::Signal::function([way](double t) { return way * std::clamp((t - 0.07) / 0.01, 0.0, 1.0); })));
    for (int k = 0; k < 384; ++k) {
      w.add_grain({cube, Vec3(2.2e-3 * (k % 8), 2.2e-3 * (k / 8 % 8), 1e-3 + 2e-3 * (k / 64))});
    }
    REQUIRE(w.run_for(0.065));
    REQUIRE(w.asleep_count() == 384);
    std::size_t least = 384;
    for (int k = 0; k < 20; ++k) {
      REQUIRE(w.run_for(1e-3));
      least = std::min(least, w.asleep_count());
    }
    return least;
  };
  CHECK(least_asleep(0.03, 0.05) == 384);  // above the balance of 0.01
  CHECK(least_asleep(0.03, 0.02) < 384);
  CHECK(least_asleep(0.08, 0.05) < 384);
}

TEST_CASE("settings of sleep that make no sense are refused") {
  auto o = Towers::with(true, 1);
  o.sleep->balance = 0.0;
  check_refused([&] { dem::World<models::VerletCubes> w(o); }, "may be out of balance", "0");
  o = Towers::with(true, 1);
  o.sleep->change = 2.0;
  check_refused([&] { dem::World<models::VerletCubes> w(o); }, "may change without waking it", "2");
  o = Towers::with(true, 1);
  o.sleep->window = 0;
  check_refused([&] { dem::World<models::VerletCubes> w(o); }, "0 steps", "at least 1");
}
