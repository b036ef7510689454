#include "catch.hpp"

#include <dem/rig/calibrate/rig_words.hpp>
#include <dem/rig/calibrate/search.hpp>
#include <dem/rig/calibrate/settings.hpp>
#include <dem/rig/calibrate/tables.hpp>
#include <dem/rig/calibrate/tried.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <unistd.h>

namespace calibrate_test {

using Catch::Approx;
using namespace dem::rig::calibrate;

namespace {

/// Looks at places on finer and finer grids.
std::vector<double> by_grids(double (*function)(const double*, const void*), const void* data,
                             const std::vector<double>& start) {
  std::vector<double> best = start;
  double least = function(best.data(), data);
  for (double step = 0.25; step > 1e-7; step *= 0.7) {
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t k = 0; k < best.size(); ++k) {
        for (const double sign : {-1.0, 1.0}) {
          auto x = best;
          x[k] = std::clamp(x[k] + sign * step, 0.0, 1.0);
          const double value = function(x.data(), data);
          if (value < least) least = value, best = x, moved = true;
        }
      }
    }
  }
  return best;
}

struct SmallNoise {
  std::uint64_t state = 7;
  double operator()() {  // nearly normal, of deviation 1
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      sum += static_cast<double>(state >> 11) * 0x1.0p-53;
    }
    return sum;
  }
};

}  // namespace

TEST_CASE("a surface of second degree gives back what its points were made of") {
  const auto y = [](double a, double b) { return 3.0 - 2.0 * a + 5.0 * b + 4.0 * a * a - a * b + 0.5 * b * b; };
  std::vector<double> places, values;
  for (int i = 0; i < 9; ++i) {
    places.insert(places.end(), {0.5 * (i % 3), 0.5 * (i / 3)});
    values.push_back(y(0.5 * (i % 3), 0.5 * (i / 3)));
  }
  const Surrogate s(places, values, 2, 9);
  CHECK(s.is_quadratic());
  CHECK(s.freedom() == 3);
  CHECK(s.scatter() < 1e-12);
  const std::vector<double> at{0.3, 0.8};
  CHECK(s.value(at) == Approx(y(0.3, 0.8)));
  CHECK(s.gradient(at)[0] == Approx(-2.0 + 8.0 * 0.3 - 0.8));
  CHECK(s.gradient(at)[1] == Approx(5.0 - 0.3 + 0.8));
  CHECK_THROWS_WITH(Surrogate(std::span(places).first(4), std::span(values).first(2), 2, 2),
                    Catch::Contains("try more"));
}

TEST_CASE("a straight line's error is that of textbooks") {
  const std::vector<double> x{0.0, 0.0, 0.5, 1.0}, y{1.0, 1.4, 2.1, 2.9};
  const Surrogate s(x, y, 1, 3);
  CHECK_FALSE(s.is_quadratic());
  double mean = 0.375, sxx = 0.0, sxy = 0.0, rest = 0.0;
  for (int i = 0; i < 4; ++i) sxx += (x[i] - mean) * (x[i] - mean), sxy += (x[i] - mean) * (y[i] - 1.85);
  const double slope = sxy / sxx;
  for (int i = 0; i < 4; ++i) rest += std::pow(y[i] - 1.85 - slope * (x[i] - mean), 2);
  CHECK(s.gradient(std::vector{0.2})[0] == Approx(slope));
  CHECK(s.scatter() == Approx(std::sqrt(rest / 2.0)));
  CHECK(s.error(std::vector{0.9}) == Approx(std::sqrt(rest / 2.0 * (0.25 + std::pow(0.9 - mean, 2) / sxx))));
}

TEST_CASE("constants are found through noise, and as surely as is said") {
  // Two constants from two quantities, one of which bends; 40 searches of 12 points and 2 runs each.
  const auto first = [](double a, double b) { return 20.0 + 15.0 * a - 6.0 * a * a + 3.0 * b; };
  const auto second = [](double a, double b) { return 10.0 + 2.0 * a + 20.0 * b; };
  const double a0 = 0.4, b0 = 0.7;
  const bool by_two_runs =
      GENERATE(false, true);  // a goal is the mean of two runs, which may be close to each other by chance
  SmallNoise noise;
  const auto goal_of = [&](double exact, double scatter) -> Goal {
    if (!by_two_runs) return {exact, 1e-6};
    const double one = exact + scatter * noise(), other = exact + scatter * noise();
    return {0.5 * (one + other), 0.5 * std::abs(one - other), 2.0};
  };
  int held = 0;
  constexpr int searches = 40;
  for (int search = 0; search < searches; ++search) {
    Measurements m{.dimensions = 2, .places = {}, .values = {{}, {}}};
    const std::vector<Goal> goals{goal_of(first(a0, b0), 0.5), goal_of(second(a0, b0), 0.8)};
    std::optional<Found> found;
    for (std::size_t k = 0; k < 12; ++k) {
      const auto place = next_place(k, 2, found);
      for (int run = 0; run < 2; ++run) {
        m.places.insert(m.places.end(), place.begin(), place.end());
        m.values[0].push_back(first(place[0], place[1]) + 0.5 * noise());
        m.values[1].push_back(second(place[0], place[1]) + 0.8 * noise());
      }
      if (k % 3 == 2 && k > 4) found = find_constants(m, goals, by_grids);
    }
    found = find_constants(m, goals, by_grids);
    const double t = dem::terramechanics::student_t(found->freedom);
    held += std::abs(found->place[0] - a0) < t * found->error[0] ? 1 : 0;
    held += std::abs(found->place[1] - b0) < t * found->error[1] ? 1 : 0;
    // Noise 0.5 over a slope of 10, from 24 runs: 0.02; from the two of a goal 0.04, and more where the slope is less.
    CHECK(found->error[0] < (by_two_runs ? 0.25 : 0.1));
  }
  CHECK(held >= 70);  // of 80 intervals of 95 % 76 in the mean; fewer than 70 once in some three hundred times
}

TEST_CASE("a target of few runs that lie apart is known by as few degrees of freedom") {
  Measurements m{.dimensions = 1, .places = {}, .values = {{}}};
  for (int k = 0; k < 12; ++k) {
    m.places.push_back(k / 11.0);
    m.values[0].push_back(k / 11.0 + (k % 2 ? 0.01 : -0.01));
  }
  const auto freedom = [&](const Goal& goal) { return find_constants(m, std::vector<Goal>{goal}, by_grids).freedom; };
  const std::size_t of_surface = freedom({0.5, 1e-3});
  CHECK(of_surface == 9);  // twelve runs, a surface of second degree
  CHECK(freedom({0.5, 0.2, 2.0}) == 1);
  CHECK(freedom({0.5, 0.2, 4.0}) == 3);
  CHECK(freedom({0.5, 1e-6, 2.0}) == of_surface);  // by chance so near each other: known by the scatter of all
}

TEST_CASE("a failed run is passed over, and what the goals do not determine has no error") {
  Measurements m{.dimensions = 2, .places = {}, .values = {{}}};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto place = next_place(k, 2, {});
    m.places.insert(m.places.end(), place.begin(), place.end());
    m.values[0].push_back(k == 3 ? std::nan("") : 1.0 + place[0] + 2.0 * place[1] + (k % 2 ? 0.01 : -0.01));
  }
  const std::vector<Goal> goals{{2.0, 0.1}};
  const auto found = find_constants(m, goals, by_grids);
  CHECK(found.surrogates[0].value(found.place) == Approx(2.0).margin(1e-3));
  CHECK(std::isinf(found.error[0]));  // one goal, two constants
}

TEST_CASE("of two places that fit, that between the tried points is found, and the other one is told") {
  // 4 x (1 - x) is 0.75 at 0.25 and at 0.75.
  const auto measure = [](double last) {
    Measurements m{.dimensions = 1, .places = {}, .values = {{}}};
    for (int k = 0; k < 12; ++k) {
      const double x = 0.05 + (last - 0.05) * (k % 6) / 5.0;
      m.places.push_back(x);
      m.values[0].push_back(4.0 * x * (1.0 - x) + (k < 6 ? 0.01 : -0.01));
    }
    return m;
  };
  const auto from_right = [](double (*function)(const double*, const void*), const void* data,
                             const std::vector<double>&) { return by_grids(function, data, {0.9}); };
  Settings s;
  s.phi = 0.75;
  s.friction_range = {0.0, 1.0};
  const std::vector<Goal> goals{{0.75, 1e-3}};
  const auto left = find_constants(measure(0.6), goals, from_right);
  CHECK(left.place[0] == Approx(0.25).margin(1e-4));
  CHECK(left.other.at(0) == Approx(0.75).margin(1e-4));
  CHECK_FALSE(left.is_beyond());
  CHECK(found_text(s, left).find("; but friction 0.75 fits the target as well") != std::string::npos);
  CHECK(found_text(s, left).find("not told") == std::string::npos);
  // It is drawn where runs were, with what is known of the target and of what was found.
  const std::vector<Trial> tried{{.point = 1, .values = {0.2}, .results = {0.7}}};
  const auto drawn = response_plot(s, tried, left, goals, 0);
  CHECK(drawn.title == "Angle of friction over the friction of grains, size quick");
  const auto named = [&](const char* name) {
    const auto at =
        std::find_if(drawn.series.begin(), drawn.series.end(), [&](const auto& x) { return x.name == name; });
    REQUIRE(at != drawn.series.end());
    return *at;
  };
  CHECK(named("fitted curve").x.front() == Approx(left.low[0]));
  CHECK(named("fitted curve").x.back() == Approx(left.high[0]));
  CHECK(left.high[0] < 0.7);
  CHECK(named("target").y[0] - named("± its error").y[0] == Approx(goals[0].error_with(left.surrogates[0].scatter())));
  const double half = estimate_of(s, left, 0).half_width();
  CHECK(named("± 95 %, within its range").x[0] == Approx(std::max(0.0, 0.25 - half)).margin(1e-3));
  CHECK(named("± 95 %, within its range").x[1] == Approx(std::min(1.0, 0.25 + half)).margin(1e-3));
  auto vague = left;
  vague.error = {0.9};
  CHECK(found_text(s, vague).find(" (wider than its range: not told by the targets)") != std::string::npos);
  vague.error = {0.3};  // ± more than half of the range
  CHECK(found_text(s, vague).find("not told by the targets") != std::string::npos);
  const auto both = find_constants(measure(0.95), goals, by_grids);
  CHECK(both.place[0] + both.other.at(0) == Approx(1.0).margin(2e-3));
  const auto short_of = find_constants(measure(0.2), goals, [](auto* function, const void* data, const auto&) {
    return by_grids(function, data, {0.3});
  });
  CHECK(short_of.place[0] == Approx(0.25).margin(1e-4));
  CHECK(short_of.is_beyond());
  CHECK(found_text(s, short_of).find("beyond the points that were tried, 0.05 to 0.2") != std::string::npos);
}

TEST_CASE("new places stay near what is known, and in the cube") {
  Found sure;
  sure.place = {0.02};
  sure.error = {0.01};
  for (std::size_t k = 0; k < 20; ++k) {
    const double x = next_place(k, 1, sure)[0];
    CHECK(x >= 0.0);
    CHECK(x <= 0.4 + 1e-12);  // a fifth of the cube each way
  }
  sure.error = {std::numeric_limits<double>::infinity()};
  CHECK(next_place(0, 1, sure)[0] == Approx(0.5));
  CHECK(halton(1, 2) == 0.5);
  CHECK(halton(6, 2) == Approx(0.375));  // 110 mirrored: 0.011
}

TEST_CASE("the table of what was tried is read back the same, and refused where it is another") {
  Settings s;
  s.phi = 30.0;
  s.find = "friction,relative-density";
  s.repose = 25.0;
  const auto path = std::filesystem::temp_directory_path() / ("dem_tried_" + std::to_string(::getpid()) + ".csv");
  const std::vector<Trial> tried{{1, 1, {0.1 / 3.0, 0.2}, {31.7 / 0.3, std::nan("")}}, {2, 9, {0.5, 0.3}, {1.0, 2.0}}};
  save_tried(path, s, tried);
  const auto again = load_tried(path, s);
  REQUIRE(again.size() == 2);
  CHECK(again[0].values == tried[0].values);
  CHECK(again[0].results[0] == tried[0].results[0]);
  CHECK(std::isnan(again[0].results[1]));
  CHECK(again[1].seed == 9);
  s.find = "friction,stiffness";
  CHECK_THROWS_WITH(load_tried(path, s), Catch::Contains("has the columns"));
  s.find = "friction,relative-density";
  dem::io::write_file(path, tried_header(s) + "\n1,1,0.2,x,3,4\n");
  CHECK_THROWS_WITH(load_tried(path, s), Catch::Contains("line 2, column relative-density: 'x' is no number"));
  dem::io::write_file(path, tried_header(s) + "\n1,1,0.2\n");
  CHECK_THROWS_WITH(load_tried(path, s), Catch::Contains("3 numbers, but there are 6 columns"));
  std::filesystem::remove(path);
}

TEST_CASE("what a rig would refuse is refused before the search, by the names of its options") {
  Settings s;
  s.size = "smoke";
  s.phi = 30.0;
  s.pressure = 1e4;
  CHECK_NOTHROW(check_rigs(s));
  s.loads = {0.0};
  CHECK_THROWS_WITH(check_rigs(s), Catch::Contains("a mass of --loads is 0"));
  s.loads = {};
  s.plates = {5.0};
  CHECK_THROWS_WITH(check_rigs(s),
                    Catch::Contains("a width of --plate (m, within the bed; the smaller side of a plate) is 5"));
}

TEST_CASE("constants that are not looked for are those of all rigs, and the others as each rig has them") {
  Settings s;
  s.size = "smoke";
  s.phi = 30.0, s.repose = 25.0, s.pressure = 1e4;
  s.held = {.half_edge = 3.2e-3,
            .damping = 0.02,
            .friction = 0.9,
            .wall_friction = 0.1,
            .breaking_factor = 0.9,
            .relative_density = 0.3,
            .rolling = 0.25};
  const Trial t{.values = {0.35}};  // the friction, which is looked for
  const auto shear = detail::shear_settings(s, t, "");
  const auto plate = detail::plate_settings(s, t, "");
  const auto pile = detail::pile_settings(s, t, "");
  const auto have = [&](const auto& grains, double wall_friction) {
    CHECK(grains.half_edge == 3.2e-3);
    CHECK(grains.damping == 0.02);
    CHECK(grains.velocity_stiffness == 0.02);  // as C, where it is not held
    CHECK(grains.friction == 0.35);
    CHECK(wall_friction == 0.1);
    CHECK(grains.breaking_factor == 0.9);
    CHECK(grains.density == 2650.0);
  };
  have(shear, shear.wall_friction), have(plate.grains, plate.grains.wall_friction), have(pile, pile.plate_friction);
  CHECK(shear.relative_density == 0.3);
  CHECK(plate.bed.relative_density == 0.3);
  CHECK(pile.rolling_length == Approx(0.25 * 3.2e-3));
  CHECK(shear.stiffness == 2e4);
  CHECK(pile.stiffness == 2e3);
  const double fine = s.held.half_edge;
  s.held.half_edge = 5e-5;
  CHECK_THROWS_WITH(check_rigs(s), Catch::Contains("change --half-edge") && !Catch::Contains("--grains"));
  s.phi = 0.0;
  CHECK_THROWS_WITH(check_rigs(s), Catch::Contains("change --half-edge, --bed-length, --bed-width or --bed-depth"));
  s.phi = 30.0, s.held.half_edge = fine;
  s.held.density = 0.0;
  CHECK_THROWS_WITH(check_rigs(s), Catch::Contains("--density is 0"));
  s.held.density = -1.0, s.held.rolling = 5.0, s.held.constants_for = 1e-3;
  CHECK_THROWS_WITH(resolve(s), Catch::Contains("--rolling (half-edges, at most the radius of a sphere) is 5"));
  s.held.rolling = 0.2;
  s.find = "relative-density", s.held.friction = std::nan("");
  CHECK_THROWS_WITH(resolve(s), Catch::Contains("--friction is nan"));
}

TEST_CASE("it is said what grains each rig has, and that their stiffnesses differ") {
  Settings s;
  s.size = "smoke";
  s.phi = 30.0, s.repose = 25.0, s.pressure = 1e4, s.exponent = 0.8;
  s.held.friction = 0.5;
  s.find = "relative-density";
  const auto rigs = rigs_of(s);
  REQUIRE(rigs.size() == 3);  // one plate tells pressure and exponent
  CHECK(rigs[0].words ==
        "Shear test: half-edge 3 mm, friction 0.5, K 20000 N/m for half-edge 0.9 mm, relative density looked for.");
  CHECK(rigs[1].words == "Pile: half-edge 3 mm, friction 0.5, K 2000 N/m for half-edge 0.9 mm, of sphere-rolling.");
  CHECK(
      rigs[2].words ==
      "Plate: half-edge 4 mm, friction 0.5, K 20000 N/m for half-edge 1.86 mm, relative density looked for; 50 x 30 mm "
      "of friction 0, pressed by 4 mm into a bed of 0.1 x 0.06 x 0.04 m.");
  CHECK(rigs[2].note.find("2.0 widths wide and 1.3 widths deep") != std::string::npos);
  CHECK(stiffness_note(s).find("--stiffness and --constants-for") != std::string::npos);
  CHECK_THAT(shape_note(s), Catch::Contains("the pile is of sphere-rolling") && Catch::Contains("--pile-kind cube8"));
  CHECK(notes_of_differences(s).size() == 2);
  s.kind = "cube8";
  CHECK(shape_note(s).empty());
  CHECK(notes_of_differences(s).size() == 1);
  s.kind = "sphere-rolling", s.phi = s.pressure = s.exponent = 0.0;
  CHECK(shape_note(s).empty());  // a pile alone
  s.phi = 30.0;
  s.held.stiffness = 1e4, s.held.constants_for = 1e-3;
  CHECK(stiffness_note(s).empty());
  s.held.stiffness = s.held.constants_for = -1.0;
  s.find = "stiffness";
  CHECK(stiffness_note(s).empty());
}

TEST_CASE("a plate of a search is pressed as its options say") {
  Settings s;
  s.size = "smoke";
  s.pressure = 1e4;
  s.plates = {0.02}, s.plate_length = 0.04, s.plate_friction = 0.3, s.sinkage = 3e-3, s.fall_speed = 0.4;
  s.bed_length = 0.12, s.bed_width = 0.08, s.bed_depth = 0.05;
  const auto plate = detail::plate_settings(s, {.values = {0.4}}, "");
  CHECK((plate.widths == std::vector{0.02} && plate.length == 0.04 && plate.plate_friction == 0.3));
  CHECK((plate.sinkage == 3e-3 && plate.bed.fall_speed == 0.4));
  CHECK((plate.bed.length == 0.12 && plate.bed.width == 0.08 && plate.bed.depth == 0.05));
  s.sinkage = 5e-4;
  CHECK_THROWS_WITH(check_rigs(s), Catch::Contains("raise --sinkage: the plate's smooth start"));
}

TEST_CASE("options of rigs that measure no target are idle") {
  const auto is_idle = [](const Settings& s, const char* name) {
    dem::rig::IdleOptions idle;
    find_idle(idle, s);
    return idle.contains(name);
  };
  Settings s;
  s.phi = 32.0;
  CHECK_FALSE(is_idle(s, "--loads"));
  CHECK(is_idle(s, "--plate"));
  CHECK(is_idle(s, "--pile-kind"));
  s.phi = 0.0;
  s.known = {0.3};
  CHECK_FALSE(is_idle(s, "--loads"));  // phi is what is made unless it is said
  s.targets = "pressure,repose";
  CHECK(is_idle(s, "--loads"));
  CHECK_FALSE(is_idle(s, "--plate"));
  CHECK_FALSE(is_idle(s, "--pile-kind"));
  CHECK(is_idle(s, "--friction"));  // it is looked for
  CHECK_FALSE(is_idle(s, "--stiffness"));
  CHECK_FALSE(is_idle(s, "--relative-density"));
  CHECK_FALSE(is_idle(s, "--rolling"));
  s.find = "stiffness,rolling";
  CHECK_FALSE(is_idle(s, "--friction"));
  CHECK(is_idle(s, "--stiffness"));
  CHECK(is_idle(s, "--rolling"));
}

TEST_CASE("searches that cannot work are refused by the names of their options") {
  const auto refuses = [](auto&& change, const char* words) {
    Settings s;
    s.phi = 30.0;
    change(s);
    CHECK_THROWS_WITH(resolve(s), Catch::Contains(words));
  };
  refuses([](auto& s) { s.phi = 0.0; }, "--phi, --repose, --pressure or --exponent");
  refuses([](auto& s) { s.exponent = 20.0; }, "--exponent is 20");
  refuses([](auto& s) { s.find = "friction,rolling"; }, "as many targets as constants");
  refuses([](auto& s) { s.find = "rolling"; }, "--repose");
  refuses([](auto& s) { s.find = "colour"; }, "'colour'");
  refuses([](auto& s) { s.find = "friction,friction", s.repose = 20.0; }, "twice");
  refuses([](auto& s) { s.friction_range = {0.5, 0.2}; }, "--friction-range");
  refuses(
      [](auto& s) {
        s.find = "rolling", s.repose = 20.0, s.rolling_range = {0.02, 5.0};
      },
      "--rolling-range (half-edges, at most the radius of a sphere) is 5");
  refuses([](auto& s) { s.known = {0.95}; }, "--known");
  refuses([](auto& s) { s.known = {0.3, 0.4}; }, "--known has 2 values");
  refuses([](auto& s) { s.trials = 2; }, "--trials");
  refuses([](auto& s) { s.find = "friction,rolling", s.repose = 20.0, s.repeats = 1, s.trials = 3; },
          "raise --trials to 4, or --repeats");
  const auto by_both = [](auto& s) { s.find = "stiffness", s.pressure = 1e4; };
  refuses(by_both,
          "the plate has them for 1.86 mm, shear test and pile for 0.9 mm; give one for all by --constants-for");
  Settings both;
  both.phi = 30.0, by_both(both);
  both.held.constants_for = 1.2e-3;
  CHECK_NOTHROW(resolve(both));
  CHECK(unit_of(both, Constant::stiffness) == "N/m for half-edge 1.2 mm");
  both.held.constants_for = -1.0;
  both.phi = 0.0, both.exponent = 0.8;
  CHECK_NOTHROW(resolve(both));  // one plate has both targets
  CHECK(quantities_of(both) == std::vector{Quantity::pressure, Quantity::exponent});
  CHECK(unit_of(both, Constant::stiffness) == "N/m for half-edge 1.86 mm");
  refuses([](auto& s) { s.phi = std::nan(""); }, "--phi (deg) is nan");
  refuses([](auto& s) { s.pressure = std::nan(""); }, "--pressure is nan");
  Settings fine;
  fine.known = {0.35};
  CHECK_NOTHROW(resolve(fine));
  CHECK(quantities_of(fine) == std::vector{Quantity::phi});
  Settings s;
  CHECK(value_at(s, Constant::stiffness, 0.5) == Approx(std::sqrt(5e3 * 4e4)));  // by its logarithm
  CHECK(place_of(s, Constant::stiffness, value_at(s, Constant::stiffness, 0.3)) == Approx(0.3));
}

}  // namespace calibrate_test
