#include "catch.hpp"

#include <dem/rig/sand_pile/options.hpp>
#include <dem/rig/sand_pile/report.hpp>
#include <dem/rig/sand_pile/resolve.hpp>
#include <dem/rig/settings_file.hpp>

#include <cmath>
#include <string>

namespace sand_pile_test {

using namespace dem;
using namespace dem::rig;
using namespace dem::rig::sand_pile;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("kinds of grains by name") {
  const auto kinds = kinds_in("cube8,cube8-viscous,sphere-rolling,sphere-braked");
  REQUIRE(kinds.size() == 4);
  CHECK((kinds[0].shape == "cube8" && !kinds[0].viscous && !kinds[0].rolling));
  CHECK((kinds[1].shape == "cube8" && kinds[1].viscous));
  CHECK((kinds[2].shape == "sphere" && kinds[2].rolling && kinds[2].name == "sphere-rolling" && !kinds[2].braked));
  CHECK((kinds[3].shape == "sphere" && kinds[3].rolling && kinds[3].braked));
  CHECK((kinds[1].world() == "cube8" && kinds[2].world() == "sphere" && kinds[3].world() == "sphere-braked"));
  for (const char* wrong :
       {"", "cube", "cube8-", "cube8-rolling", "cube8-braked", "sphere-soft", "sphere,", "sphere, cube8"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(kinds_in(wrong), ContainsSubstring("but must be cube8, polyhedron"));
  }
  CHECK_THROWS_WITH(kinds_in("sphere,cube8,sphere"), ContainsSubstring("'sphere' twice"));
}

TEST_CASE("what a sand pile's settings leave open follows from the size and the grains") {
  Settings s;
  sand_pile::resolve(s);
  CHECK(s.grains == 1200);
  CHECK(kinds_in(s.kinds).size() == 4);
  // The cylinder's fill, at a solid fraction of 0.6, is twice as high as its radius.
  CHECK(bulk_volume(s) == Approx(1200 * 8 * std::pow(1.6e-3, 3) / 0.6));
  CHECK(2.0 * std::acos(-1.0) * std::pow(s.cylinder_radius, 3) == Approx(bulk_volume(s)));
  CHECK(s.plate_friction == 0.4);
  CHECK(s.container_friction == 0.0);
  Settings box;
  box.method = "drain";
  box.plate_friction = 0.5;
  sand_pile::resolve(box);
  CHECK(box.container_friction == 0.5);
}

TEST_CASE("settings of a sand pile that make no sense are refused") {
  const auto refused = [](auto change) {
    Settings s;
    change(s);
    sand_pile::resolve(s);
  };
  CHECK_THROWS_WITH(refused([](Settings& s) { s.method = "throw"; }), ContainsSubstring("--method is 'throw'"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.size = "big"; }), ContainsSubstring("--size is 'big'"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.grains = 3; }), ContainsSubstring("--grains"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.orifice_radius = 1e-3; }), ContainsSubstring("--orifice-radius"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.plate_radius = 1e-3; }), ContainsSubstring("--plate-radius"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.friction = -1.0; }), ContainsSubstring("--friction"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.flank_low = 0.9; }), ContainsSubstring("--flank-low"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.sample_time = 0.1; }), ContainsSubstring("--sample-time"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.rolling_damping = -0.1; }), ContainsSubstring("--rolling-damping"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.lift_speed = std::nan(""); }), ContainsSubstring("--lift-speed"));
}

TEST_CASE("options of a sand pile that change nothing are named") {
  Settings s;
  Options options;
  sand_pile::declare(options, s);
  for (const char* method : {"lift", "funnel", "drain"}) {
    s.method = method;
    IdleOptions idle;
    sand_pile::find_idle(idle, s);
    for (const IdleOption& o : idle.all()) CHECK(options.find(o.name) != nullptr);
    CHECK(idle.contains("--lift-speed") == (s.method != "lift"));
    CHECK(idle.contains("--orifice-radius") == (s.method != "funnel"));
    CHECK(idle.contains("--slot-width") == (s.method != "drain"));
  }
  s.kinds = "sphere";
  IdleOptions idle;
  sand_pile::find_idle(idle, s);
  CHECK(idle.contains("--rolling-length"));
  CHECK(idle.contains("--rolling-damping"));
  s.kinds = "sphere-braked";
  idle = {};
  sand_pile::find_idle(idle, s);
  CHECK_FALSE(idle.contains("--rolling-length"));
  CHECK(idle.contains("--rolling-damping"));  // a constant torque has no springs
}

TEST_CASE("piles of a kind are one row of the table") {
  Campaign c;
  for (const double angle : {0.4, 0.5}) {
    PileResult& r = c.piles.emplace_back();
    r.kind = kind_named("sphere");
    r.flank.angle = angle;
    r.poured = 100;
    r.lost = 5;
  }
  c.piles.emplace_back().kind = kind_named("cube8");
  const auto t = angle_table(c);
  REQUIRE(t.rows.size() == 2);
  CHECK(t.rows[0][0] == "sphere");
  CHECK(t.rows[0][1] == "2");
  CHECK(t.rows[0][2] == "25.8");  // 0.45 rad
  CHECK(t.rows[0][4] == "4.1");   // 0.1/sqrt(2) rad
  CHECK(t.rows[0][9] == "5.0");
  CHECK(t.rows[1][2] == "-");  // a run that ended early
  CHECK(spread_of({}).mean != spread_of({}).mean);
}

}  // namespace sand_pile_test
