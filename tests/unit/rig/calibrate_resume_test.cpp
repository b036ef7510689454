// A search for constants that was stopped goes on: what was tried is not tried again, and what is found is the same.

#include "catch.hpp"
#include "io/files.hpp"

#include <dem/rig/calibrate/calibrate_rig.hpp>
#include <dem/rig/program.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace calibrate_resume_test {

using namespace dem::rig;
namespace fs = std::filesystem;

namespace {

int runs = 0, stop_at = -1;

/// In place of a pile: an angle that rises with friction, and differs with the seed.
void pile_by_formula(const sand_pile::Settings& s, sand_pile::PileResult& result, dem::report::Replay*, Session&,
                     Stages&) {
  if (++runs == stop_at) throw Interrupted{};
  result.flank.angle = 0.3 + 0.4 * s.friction + 0.01 * std::sin(static_cast<double>(s.seed) + 20.0 * s.friction);
}
/// Of one constant: over a grid.
std::vector<double> least_on_grid(double (*function)(const double*, const void*), const void* data,
                                  const std::vector<double>&) {
  std::vector<double> best = {0.0};
  for (int k = 1; k <= 1000; ++k) {
    const std::vector<double> x = {1e-3 * k};
    if (function(x.data(), data) < function(best.data(), data)) best = x;
  }
  return best;
}

/// Runs the program, and returns what main() returns. It is stopped in its run number `stop`.
int search(const fs::path& output, std::vector<std::string> more, int stop = -1, int trials = 5) {
  runs = 0, stop_at = stop;
  calibrate::CalibrateRig rig({nullptr, nullptr, pile_by_formula, pile_by_formula}, least_on_grid);
  std::vector<std::string> words = {"calibrate",   "--size=smoke",      "--known=0.35", "--targets=repose",
                                    "--repeats=2", "--pile-kind=cube8", "--threads=1"};
  words.insert(words.end(), {"--trials", std::to_string(trials), "--output", output.string()});
  words.insert(words.end(), more.begin(), more.end());
  std::vector<const char*> argv;
  for (const auto& w : words) argv.push_back(w.c_str());
  return run_program({.name = "calibrate", .title = "Search"}, rig, static_cast<int>(argv.size()), argv.data());
}

}  // namespace

TEST_CASE("a search that was stopped in any of its runs goes on there, and ends as one that was not") {
  const TempFolder folder;
  const auto whole = folder / "whole", stopped = folder / "stopped";
  REQUIRE(search(whole, {}) == 0);
  const int all = runs;
  REQUIRE(all == 4 + 5 * 2);
  for (int stop = 2; stop <= all; stop += 3) {
    CAPTURE(stop);
    REQUIRE(search(stopped, {"--checkpoint-every=1000"}, stop) == 130);
    CHECK(fs::exists(stopped / "checkpoint/calibrate.h5"));
    REQUIRE(search(stopped, {"--resume"}) == 0);
    CHECK(runs == all - stop + 1);
    for (const char* file : {"tried.csv", "found.csv"}) {
      CHECK(dem::io::read_file(stopped / file) == dem::io::read_file(whole / file));
    }
    CHECK_FALSE(fs::exists(stopped / "checkpoint"));
  }
}

TEST_CASE("a search goes on by --resume with its own settings, more points allowed, and by --go-on once it has ended") {
  const TempFolder folder;
  const auto output = folder / "search";
  REQUIRE(search(output, {"--checkpoint-every=1000"}, 9) == 130);
  const std::string table = dem::io::read_file(output / "tried.csv");
  CHECK(search(output, {"--resume", "--seed=3"}) == 2);
  CHECK(search(output, {"--resume", "--go-on"}) == 2);
  CHECK(dem::io::read_file(output / "tried.csv") == table);
  REQUIRE(search(output, {"--resume"}, -1, 6) == 0);
  CHECK(runs == 4 + 6 * 2 - 8);
  CHECK(search(output, {"--resume"}, -1, 8) == 2);  // it has ended
  REQUIRE(search(output, {"--go-on"}, -1, 8) == 0);
  CHECK(runs == 4);
  // Begun anew, nothing of it is left but what it does not know.
  for (const char* name : {"1_1_repose", "9_1_phi", "9_1_phi_mine"}) {
    dem::io::write_file(output / "runs" / name / "load.csv", "0\n");
  }
  REQUIRE(search(output, {}, 3) == 130);
  CHECK(runs == 3);
  CHECK_FALSE(fs::exists(output / "runs/1_1_repose/load.csv"));
  CHECK_FALSE(fs::exists(output / "runs/9_1_phi"));
  CHECK(fs::exists(output / "runs/9_1_phi_mine/load.csv"));
}

}  // namespace calibrate_resume_test
