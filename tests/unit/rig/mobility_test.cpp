#include <dem/io/checkpoint/fields.hpp>
#include <dem/rig/mobility/cases.hpp>
#include <dem/rig/mobility/drive.hpp>
#include <dem/rig/mobility/tables.hpp>

#include <cmath>

#include "catch.hpp"

namespace mobility_test {

using namespace dem::rig;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
namespace ending = dem::vehicle::ending;

namespace {

mobility::Settings resolved_study(const char* study, const char* lane = "") {
  mobility::Settings s;
  s.study = study;
  s.lane = lane;
  mobility::resolve(s);
  return s;
}

}  // namespace

TEST_CASE("a study has the drives that its lists ask for, each with a name of its own") {
  auto s = resolved_study("map");
  s.slopes = {-10, 0, 10};
  s.side_slopes = {0, 20};
  const auto cases = mobility::cases_of(s);
  REQUIRE(cases.size() == 6);
  CHECK(cases[0].name == "slope_m10_side_0");
  CHECK(cases[5].slope == 10.0);
  CHECK(cases[5].side_slope == 20.0);
  s = resolved_study("loads");
  CHECK(mobility::cases_of(s).size() == s.loads.size() * 5);
  CHECK(mobility::cases_of(s).front().lane[0].soil.name == "sandy-loam");
  CHECK(mobility::cases_of(resolved_study("passes")).size() == 3);
  CHECK(mobility::cases_of(resolved_study("drawbar"))[0].is_held);
}

TEST_CASE("a study of one slope takes one, drives of one name are refused, and so are steps that do not fill 0.01 s") {
  const auto refused = [](const char* study, auto&& change) {
    mobility::Settings s;
    s.study = study;
    change(s);
    mobility::resolve(s);
    return mobility::cases_of(s);
  };
  using S = mobility::Settings;
  CHECK_THROWS_WITH(refused("drive",
                            [](S& s) {
                              s.slopes = {20, -10};
                            }),
                    ContainsSubstring("--slopes has 2 values, but the study drive drives on one; give"));
  CHECK_THROWS_WITH(refused("slopes", [](S& s) { s.side_slopes = {0, 10}; }), ContainsSubstring("--side-slopes has 2"));
  CHECK(refused("drive", [](S& s) { s.slopes = {-10}; })[0].slope == -10.0);
  CHECK_THROWS_WITH(refused("loads",
                            [](S& s) {
                              s.loads = {4430, 4430};
                            }),
                    ContainsSubstring("two drives of the name 'sandy-loam_4430_kg'"));
  CHECK_THROWS_WITH(refused("loads", [](S& s) { s.soils = "snow,hard,snow"; }), ContainsSubstring("'snow_"));
  CHECK_THROWS_WITH(refused("slopes", [](S& s) { s.slopes = {10, 10.0000001}; }), ContainsSubstring("'slope_10'"));
  CHECK_THROWS_WITH(refused("drive", [](S& s) { s.time_step = 3e-5; }),
                    ContainsSubstring("--machine-step is 3e-05 s, but must fill 0.01 s evenly"));
}

TEST_CASE("pull over slip stands beside wheels at the slips at which the soil carries them") {
  mobility::Settings s;
  s.study = "drawbar", s.soil = "snow", s.tyre = "ring";
  mobility::resolve(s);
  const mobility::Case of = mobility::cases_of(s)[0];
  const mobility::Result r{.weight = 8e3, .pulls = {{.slip = 0.1, .pull = 2e3}}};
  const auto plot = mobility::pull_plot(of, r, mobility::wheel_of(s, of));
  REQUIRE(plot.series.size() == 2);
  CHECK(!plot.series[1].x.empty());
  CHECK(plot.series[1].x.size() < 16);
  CHECK_THAT(plot.series[1].name, ContainsSubstring("wheels on snow"));
  CHECK(mobility::pull_plot(of, {.weight = 48.36e3}, mobility::wheel_of(s, of)).series.size() == 1);
}

TEST_CASE("a lane of stretches is as long as they are, and one that cannot be read is refused in words") {
  const auto s = resolved_study("drive", "hard:8,dry-sand:12.5");
  REQUIRE(s.stretches_.size() == 2);
  CHECK(s.stretches_[1].soil.name == "dry-sand");
  CHECK(s.path == 20.5);
  CHECK_THROWS_WITH(mobility::stretches_of("hard"), ContainsSubstring("--lane has the stretch 'hard'"));
  CHECK_THROWS_WITH(mobility::stretches_of("hard:2x"), ContainsSubstring("'hard:2x'"));
  CHECK_THROWS_WITH(mobility::stretches_of("mud:2"), ContainsSubstring("there is no soil 'mud'"));
  mobility::Settings longer;
  longer.lane = "hard:3";
  longer.path = 4.0;
  CHECK_THROWS_WITH(mobility::resolve(longer), ContainsSubstring("longer than the --lane of 3 m"));
}

TEST_CASE("a run of drives that goes on has the soil that it began with") {
  mobility::Case c;
  c.lane = {{dem::terramechanics::known_soil("dry-sand"), 3.0}};
  mobility::SameSoil soil = mobility::soil_of(c);
  dem::io::StateColumns kept;
  const auto visit = [&](dem::io::Fields::Task task, dem::io::StateColumns& columns) {
    dem::io::Fields v(task, columns);
    soil.fields(v);
  };
  const auto go_on = [&] {
    dem::io::StateColumns columns = kept;
    visit(dem::io::Fields::Task::restore, columns);
  };
  visit(dem::io::Fields::Task::collect, kept);
  CHECK_NOTHROW(go_on());
  c.lane[0].soil.soil.shear.cohesion += 1.0;
  soil = mobility::soil_of(c);
  CHECK_THROWS_WITH(go_on(), Catch::Contains("the soil of a drive is another one"));
}

TEST_CASE("a drive by inputs ends with its last row, and one by a driver knows no such end") {
  mobility::Settings s = resolved_study("drive", "hard:3");
  const dem::vehicle::ColumnCar car(mobility::car_of(s, mobility::cases_of(s)[0]));
  mobility::Sample x;
  x.car.time = 2.0, x.way = 1.0;
  CHECK(mobility::Judge(s)(x, car).empty());
  s.open_loop = dem::vehicle::OpenLoop({{0.0, 0.2, 0, 0}, {2.0, 0.2, 0, 0}});
  CHECK(mobility::Judge(s)(x, car) == ending::inputs_ended);
  x.car.time = 1.99;
  CHECK(mobility::Judge(s)(x, car).empty());
}

TEST_CASE("means of a drive are those of its second half, and resistance is the thrust that does not pull") {
  std::vector<mobility::Sample> samples(101);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    auto& x = samples[k];
    x.car.time = 0.01 * static_cast<double>(k);
    x.way = 0.02 * static_cast<double>(k);
    x.car.speed = k < 50 ? 9.0 : 2.0;
    x.car.engine_work = k < 50 ? 1e4 * static_cast<double>(k) : 5e5 + 40.0 * static_cast<double>(k - 50);
    for (auto& w : x.wheels) w.torque = 485.0, w.pull = 400.0, w.slip = 0.2, w.sinkage = 0.1;
  }
  mobility::Result r{.way = 2.0, .time = 1.0, .weight = 5e4};
  mobility::evaluate(r, samples, 0.485);
  CHECK(r.speed == Approx(2.0));
  CHECK(r.slip == Approx(0.2));
  CHECK(r.resistance == Approx(4.0 * 600.0));  // 485/0.485 - 400 a wheel
  CHECK(r.energy_per_metre == Approx(2e3));    // 4 kW at 2 m/s
  CHECK(r.cost_of_transport == Approx(2e3 / 5e4));
}

TEST_CASE("means of a car that slid back are those of the second half of its way back") {
  std::vector<mobility::Sample> samples(101);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].way = -0.003 * static_cast<double>(k);
    samples[k].car.speed = k < 50 ? -0.1 : -0.5;
  }
  mobility::Result r{.way = samples.back().way, .time = 1.0, .weight = 5e4};
  mobility::evaluate(r, samples, 0.485);
  CHECK(r.speed == Approx(-0.5));
}

TEST_CASE("a map shows what arrived, and the word of what did not") {
  mobility::Campaign c;
  c.results = {{.ended = ending::arrived, .speed = 3.0}, {.ended = ending::dug_in, .speed = 0.1}, {}};
  const auto map = mobility::map_of(
      c, "map", {0, 1, 2}, {0}, [](const auto& r) { return r.speed; }, [](const auto&) { return std::string("go"); });
  CHECK(map.value[0] == 3.0);
  CHECK(std::isnan(map.value[1]));
  CHECK(map.texts == std::vector<std::string>{"go", "dug in", "?"});
  c.cases.resize(3);
  const auto over = [&](double mobility::Result::*value) {
    return mobility::plot_over(
        c, "plot", "x", "y", [](const auto&, std::size_t k) { return static_cast<double>(k); },
        [&](const auto& r) { return r.*value; });
  };
  const auto speed = over(&mobility::Result::speed);
  REQUIRE(speed.annotations.size() == 1);
  CHECK(speed.annotations[0].text == "dug in");
  CHECK_NOTHROW(dem::io::check_plot(speed));
  CHECK_NOTHROW(dem::io::check_plot(over(&mobility::Result::energy_per_metre)));  // which what did not go has not
}

}  // namespace mobility_test
