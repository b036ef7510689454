#include "catch.hpp"
#include "io/files.hpp"

#include <dem/io/file.hpp>
#include <dem/rig/bed/study.hpp>
#include <dem/rig/bed/study_rows.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace study_test {

using Catch::Approx;
using namespace dem::rig;

namespace {

struct Settings {
  std::string study = "none";
  std::uint64_t study_seeds = 1;
  BedSettings bed;
  double speed = 1.0;
};

std::vector<std::string> prefixes(const char* study, std::uint64_t seeds) {
  Settings s;
  s.study = study;
  s.study_seeds = seeds;
  std::vector<std::string> list;
  for (const auto& v : variants_of(s, [](Settings& x) { x.speed *= 0.5; })) list.push_back(v.prefix());
  return list;
}

/// As a rig has them: a run of a bed with a value.
struct Run {
  Variant<Settings> variant;
  double value;
};

}  // namespace

TEST_CASE("a study has its changes for as many seeds as are asked for, all runs of a seed one after the other") {
  using List = std::vector<std::string>;
  CHECK(prefixes("none", 3) == List{""});
  CHECK(prefixes("box", 2) ==
        List{"", "wide_", "deep_", "long_", "second_", "wide_second_", "deep_second_", "long_second_"});
  CHECK(prefixes("speed", 1) == List{"", "slow_"});
  CHECK(prefixes("seeds", 3) == List{"", "second_", "third_"});
  Settings s;
  s.study = "speed";
  s.study_seeds = 2;
  s.bed.seed = 7;
  const auto list = variants_of(s, [](Settings& x) { x.speed *= 0.5; });
  REQUIRE(list.size() == 4);
  CHECK(list[2].settings.bed.seed == 8);
  CHECK(list[3].settings.bed.seed == 8);
  CHECK(list[3].settings.speed == 0.5);
  CHECK(list[3].text == "half the speed, seed 8");
  CHECK(list[3].shares_bed());
  CHECK_FALSE(list[2].is_run_itself());
  const auto names = variant_prefixes();
  for (const auto& v : list) {
    if (!v.is_run_itself()) CHECK(std::find(names.begin(), names.end(), v.prefix()) != names.end());
  }
}

TEST_CASE("a study is of three seeds; of one with a bed from a file, which is refused where other beds are needed") {
  BedSettings own, given;
  given.file = "bed.txt";
  const auto seeds = [](const char* study, std::uint64_t asked, const BedSettings& bed) {
    resolve_study(study, asked, bed);
    return asked;
  };
  CHECK(seeds("box", 0, own) == 3);
  CHECK(seeds("speed", 0, given) == 1);
  CHECK(seeds("speed", 5, own) == 5);
  CHECK_THROWS_WITH(seeds("box", 0, given), Catch::Contains("leave --bed-file out"));
  CHECK_THROWS_WITH(seeds("seeds", 0, given), Catch::Contains("leave --bed-file out"));
  CHECK_THROWS_WITH(seeds("speed", 2, given), Catch::Contains("--study-seeds 2 needs other beds"));
  CHECK_THROWS_WITH(seeds("seeds", 1, own), Catch::Contains("--study-seeds"));
  CHECK_THROWS_WITH(seeds("box", 10, own), Catch::Contains("--study-seeds"));
}

TEST_CASE("a change is that of pairs, with the error by how they scatter, and in percent of the mean as set") {
  // Means 22 and 19.787: -2.213 N, -10.06 %. About their ratio the pairs are 0.0121, 0.4533 and -0.4655 off: deviation
  // 0.4595, of the mean 0.2653, 1.206 % of 22. Beds that differ by a fifth make no error of the percentage.
  const Change c({{20.0, 18.0}, {22.0, 20.24}, {24.0, 21.12}});
  CHECK(c.pairs() == 3);
  CHECK(c.value().value == Approx(-(2.0 + 1.76 + 2.88) / 3.0));
  CHECK(c.value().error == Approx(0.3405).epsilon(1e-3));
  CHECK(c.percent().value == Approx(-10.0606).epsilon(1e-5));
  CHECK(c.percent().error == Approx(1.2059).epsilon(1e-4));
  CHECK(c.is_told() == std::string("yes"));  // Student's t is 4.3027: 2.21 +- 1.47
  // Less 4 % of each pair's own value it is -1.333 +- 4.3027 times 0.3075, which is below zero; less 4.2 % it is not.
  CHECK(c.is_within(4.0) == std::string("no"));
  CHECK(c.is_within(4.2) == std::string("not told"));
  CHECK(c.is_within(6.0) == std::string("not told"));
  CHECK(c.is_within(16.0) == std::string("yes"));
  CHECK(verdict_text("A wider bed", "the pressure", c, 4.0, "Pa", 10.0) ==
        "A wider bed changes the pressure by -22.13 ± 3.40 Pa, -10.1 ± 1.2 % (3 seeds). That is told from none, and "
        "more than the 4 %.");
  // All pairs by the same share: no error of the percentage. Below zero a growing size is a negative change.
  const Change same({{-20.0, -22.0}, {-22.0, -24.2}, {-21.0, -23.1}});
  CHECK(same.percent().value == Approx(-10.0));
  CHECK(same.percent().error == Approx(0.0).margin(1e-9));
  CHECK(same.is_within(9.9) == std::string("no"));
  CHECK(same.is_within(10.1) == std::string("yes"));

  // -1, 1 and 0.3 %: within 3 %, and not told from none.
  const Change none({{20.0, 19.8}, {22.0, 22.22}, {24.0, 24.072}});
  CHECK(none.is_told() == std::string("no"));
  CHECK(none.is_within(3.0) == std::string("yes"));
  CHECK_THAT(verdict_text("Half the speed", "the pressure", none, 3.0, "Pa"),
             Catch::EndsWith("(3 seeds). That is not told from none, and within the 3 %."));
  CHECK_THAT(verdict_text("Half the speed", "the pressure", none, 1.0, "Pa"),
             Catch::EndsWith("and not told to be within or beyond 1 %."));
}

TEST_CASE("where the mean as set is not told from zero there is no percentage, but a change can be told") {
  // Pulls (N) of a wheel near the slip at which it neither pulls nor is pulled.
  const Change c({{4.51, 5.40}, {-7.92, -6.90}, {23.56, 24.60}});
  CHECK(c.value().value == Approx(0.98333).epsilon(1e-4));
  CHECK(c.is_told() == std::string("yes"));  // t = 20
  CHECK(std::isnan(c.percent().value));
  CHECK(c.is_within(5.0) == std::string("not told"));
  CHECK(
      verdict_text("Half the speed", "the pull", c, 5.0, "N") ==
      "Half the speed changes the pull by +0.98 ± 0.05 N (3 seeds). That is told from none, and not told to be within "
      "or beyond 5 %.");
  const Change zero({{-1.0, 2.0}, {1.0, 3.0}});
  CHECK(std::isnan(zero.percent().value));
  CHECK_THAT(verdict_text("Half the speed", "the pull", zero, 5.0, "N"),
             Catch::Contains("by +2.50 ± 0.50 N (2 seeds)"));
}

TEST_CASE("pairs whose values as set scatter widely do not rule the change by those that are small") {
  // Pulls (N) of a wheel at its speed and at half of it. The mean of the pairs' percentages is +4 %, though the mean
  // pull falls by 1.27 N.
  const Change c({{42.0, 27.1}, {25.4, 27.4}, {22.5, 31.6}});
  CHECK(c.value().value == Approx(-1.2667).epsilon(1e-4));
  CHECK(c.percent().value == Approx(-100.0 * 1.2667 / 29.9667).epsilon(1e-4));
  CHECK(c.is_within(5.0) == std::string("not told"));
}

TEST_CASE("rows of a study have what scatters between seeds, and pairs of a seed; runs without a value drop out") {
  Settings s;
  s.study = "speed";
  s.study_seeds = 3;
  const double pulls[] = {20.0, 18.0, 24.0, 21.6, 22.0, std::nan("")};
  std::vector<Run> runs;
  for (const auto& v : variants_of(s, [](Settings& x) { x.speed *= 0.5; })) runs.push_back({v, pulls[runs.size()]});
  std::vector<const Run*> all;
  for (const Run& r : runs) all.push_back(&r);
  StudiedValue of{
      .name = "pull", .unit = "N", .si_unit = "N", .place = "slip", .file_place = "slip", .speed_limit = 5.0};
  of.add_place("0.3", "0.3", "the pull at slip 0.3");
  const auto rows = study_rows<Run>(all, of, [](const Run& r, std::size_t) { return r.value; });
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].value.count == 3);
  CHECK(rows[0].value.mean == Approx(22.0));
  CHECK(rows[0].value.deviation == Approx(2.0));
  CHECK(rows[1].from_as_set.pairs() == 2);
  CHECK(rows[1].from_as_set.value().value == Approx(-2.2));
  const auto table = study_table(of, rows, "pulls");
  dem::io::check_table(table);
  CHECK(table.rows[0][0] == "as set");
  CHECK(table.rows[1][0] == "half the speed");
  CHECK(table.rows[0][5] == "2.00");
  CHECK(table.rows[1][12] == "5 %: not told");  // of two pairs Student's t is 12.7
  const auto words = study_findings(of, rows);
  REQUIRE(words.size() == 2);
  CHECK(words[0] == "Beds of 3 seeds in the box as set deviate by 2.00 N in the pull at slip 0.3, 22.00 ± 1.15 N.");
  CHECK_THAT(words[1], Catch::StartsWith("Half the speed changes the pull at slip 0.3 by -2.20 ± 0.20 N"));
  TempFolder folder;
  write_study(folder / "study.csv", of, rows);
  CHECK_THAT(dem::io::read_file(folder / "study.csv"),
             Catch::StartsWith("runs,slip,seeds,mean_pull_N,pull_error_N,bed_deviation_N,pairs,change_N,") &&
                 Catch::Contains("\nas set,0.3,3,22,1.15470053837925") && Catch::Contains(",0,,,,,,,\n") &&
                 Catch::Contains(",no,5,not told\n"));
  // With one seed neither errors nor verdicts are known.
  all.resize(2);
  const auto one = study_rows<Run>(all, of, [](const Run& r, std::size_t) { return r.value; });
  write_study(folder / "study.csv", of, one);
  CHECK_THAT(dem::io::read_file(folder / "study.csv"), Catch::Contains("\nhalf the speed,0.3,1,18,,,1,-2,,-10,,,5,\n"));
  // Where nothing is changed there are no columns of changes.
  CHECK(study_table(of, std::vector<StudyRow>{rows[0]}, "seeds").header.size() == 6);
  all.resize(1);
  CHECK(study_rows<Run>(all, of, [](const Run& r, std::size_t) { return r.value; }).empty());
}

TEST_CASE("one pair has a change without an error, and none of either is said to be known without pairs") {
  const Change one({{20.0, 18.0}});
  CHECK(one.percent().value == Approx(-10.0));
  CHECK(one.is_told() == std::string("-"));
  CHECK(one.is_within(5.0) == std::string("-"));
  CHECK(verdict_text("A wider bed", "the pressure", one, 5.0, "kPa") ==
        "A wider bed changes the pressure by -2.00 kPa, -10.0 % (one seed). How sure that is, one seed does not tell.");
  CHECK_THAT(verdict_text("A wider bed", "the pull", Change({{0.0, 1.0}}), 5.0, "N"),
             Catch::StartsWith("A wider bed changes the pull by +1.00 N (one seed)."));
  CHECK(Change().is_within(5.0) == std::string("-"));
  CHECK(std::isnan(Change().value().value));
  CHECK_THAT(verdict_text("A wider bed", "the pressure", Change(), 5.0, "kPa"),
             Catch::Contains("no two runs of one seed"));
}

}  // namespace study_test
