#include "catch.hpp"

#include <dem/rig/bed/study.hpp>
#include <dem/rig/bed/study_change.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace study_test {

using Catch::Approx;
using namespace dem::rig;

namespace {

struct Settings {
  std::string study = "none";
  BedSettings bed;
  double speed = 1.0;
};

std::vector<std::string> prefixes(const char* study, const StudySeeds& seeds) {
  Settings s;
  s.study = study;
  std::vector<std::string> list;
  for (const auto& v : variants_of(s, seeds, [](Settings& x) { x.speed *= 0.5; })) list.push_back(v.prefix());
  return list;
}

}  // namespace

TEST_CASE("a study has its changes for as many seeds as are asked for, all runs of a seed one after the other") {
  using List = std::vector<std::string>;
  CHECK(prefixes("none", {}) == List{""});
  CHECK(prefixes("box", {3, 1}) == List{"", "wide_", "deep_", "second_", "third_"});
  CHECK(prefixes("speed", {2, 2}) == List{"", "slow_", "second_", "slow_second_"});
  CHECK(prefixes("seeds", {3, 3}) == List{"", "second_", "third_"});
  Settings s;
  s.study = "speed";
  s.bed.seed = 7;
  const auto list = variants_of(s, {2, 2}, [](Settings& x) { x.speed *= 0.5; });
  CHECK(list[3].settings.bed.seed == 8);
  CHECK(list[3].settings.speed == 0.5);
  CHECK(list[3].text == "half the speed, seed 8");
  CHECK(list[3].shares_bed());
  CHECK_FALSE(list[3].is_of_seed());
  CHECK(list[2].is_of_seed());
  CHECK_FALSE(list[2].is_run_itself());
  const auto names = variant_prefixes();
  for (const auto& v : list) {
    if (!v.is_run_itself()) CHECK(std::find(names.begin(), names.end(), v.prefix()) != names.end());
  }
}

TEST_CASE("a change is the mean of the changes of pairs, with the error by how these scatter") {
  // -10, -8 and -12 %: deviation 2, error 2/sqrt(3). Beds that differ by a fifth make no error of the change.
  const std::vector<AsSetAndChanged> pairs = {{20.0, 18.0}, {22.0, 20.24}, {24.0, 21.12}};
  const Change c = change_of(pairs);
  CHECK(c.pairs == 3);
  CHECK(c.percent.value == Approx(-10.0));
  CHECK(c.percent.error == Approx(2.0 / std::sqrt(3.0)));
  CHECK(c.value.value == Approx(-(2.0 + 1.76 + 2.88) / 3.0));
  CHECK(c.reach == Approx(4.3027).epsilon(1e-4));  // Student's t of two degrees: the change lies within 10 +- 4.97 %
  CHECK(c.is_told() == std::string("yes"));
  CHECK(c.is_within(5.0) == std::string("no"));
  CHECK(c.is_within(6.0) == std::string("not told"));
  CHECK(c.is_within(15.0) == std::string("yes"));
  CHECK(verdict_text("A wider bed", "the pressure", c, 5.0) ==
        "A wider bed changes the pressure by -10.0 ± 1.2 % (3 seeds). That is told from none, and more than the 5 %.");

  // -1, 1 and 0.3 %: within 3 %, and not told from none.
  const Change none = change_of(std::vector<AsSetAndChanged>{{20.0, 19.8}, {22.0, 22.22}, {24.0, 24.072}});
  CHECK(none.is_told() == std::string("no"));
  CHECK(none.is_within(3.0) == std::string("yes"));
  CHECK_THAT(verdict_text("Half the speed", "the pressure", none, 3.0),
             Catch::EndsWith("(3 seeds). That is not told from none, and within the 3 %."));
  CHECK_THAT(verdict_text("Half the speed", "the pressure", none, 1.0),
             Catch::EndsWith("and not told to be within or beyond 1 %."));
}

TEST_CASE("one pair has a change without an error, and none of either is said to be known without pairs") {
  const Change one = change_of(std::vector<AsSetAndChanged>{{20.0, 18.0}});
  CHECK(one.percent.value == Approx(-10.0));
  CHECK(one.is_told() == std::string("-"));
  CHECK(one.is_within(5.0) == std::string("-"));
  CHECK(verdict_text("A wider bed", "the pressure", one, 5.0) ==
        "A wider bed changes the pressure by -10.0 % (one seed). How sure that is, one seed does not tell.");
  const Change none = change_of(std::vector<AsSetAndChanged>{});
  CHECK(none.is_within(5.0) == std::string("-"));
  CHECK_THAT(verdict_text("A wider bed", "the pressure", none, 5.0), Catch::Contains("no two runs of one seed"));
}

}  // namespace study_test
