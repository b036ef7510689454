// Runs that are stopped and go on, seen from within: at every moment at which they may be saved, and with files that
// are not theirs.

#include "catch.hpp"
#include "io/files.hpp"
#include "worlds.hpp"

#include <dem/rig/hdf5_checkpoints.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/program.hpp>
#include <dem/rig/samples_file.hpp>

#include <csignal>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace resume_test {

using Catch::Matchers::ContainsSubstring;
using namespace dem::rig;
namespace fs = std::filesystem;
using dem::Vec3;

namespace {

using Balls = models::Balls;

struct HeightOfBalls {
  double time, height, speed;
};
constexpr Column<HeightOfBalls> height_columns[] = {
    {"time_s", &HeightOfBalls::time}, {"height_m", &HeightOfBalls::height}, {"speed_m_s", &HeightOfBalls::speed}};

/// What is found of balls that fall into a box and are pushed.
struct Found {
  std::vector<HeightOfBalls> samples;
  double rest_height = 0.0;
  template <class V>
  void fields(V& v) {
    v.numbers("samples", samples), v("rest_height", rest_height, "m");
  }
};
struct Pushing {
  double start = 0.0;
  int pushes = 0;
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("pushes", pushes);
  }
};

dem::World<Balls> balls(double mu, const Vec3& gravity) {
  dem::World<Balls> world({.gravity = gravity, .time_step = 2e-5});
  world.set_contact({{500.0, 0.02, 0.5}, {mu, 500.0, 0.02, 0.9}});
  const auto ball = world.add_species(dem::shape::Sphere(2e-3));
  world.add_surface(world.ground(), dem::surface::Plane{});
  for (int k = 0; k < 8; ++k) {
    world.add_grain(
        {.species = ball, .position = Vec3(3e-3 * (k % 2), 3e-3 * (k / 2 % 2) + 1e-4 * k, 3e-3 + 4.2e-3 * (k / 4))});
  }
  return world;
}

/// Two parts: balls come to rest; then they are pushed by gravity that tilts, in two stages.
struct PushedBalls : Rig {
  void declare(Options& options) override {
    options.add("--friction", friction, "");
    options.add("--threads", threads, "").changes_no_result();
    options.add("--output", folder, "").changes_no_result();
  }
  std::string output() const override { return folder; }
  ResultNames results() const override { return {.files = {"rest.csv", "pushed.csv"}}; }
  bool can_resume() const override { return true; }

  void run(Session& session) override {
    auto world = balls(friction, {0, 0, -9.81});
    session.begin_run(4);
    Found first, second;
    {
      PartOf<Balls> part(session, session, "rest");
      const auto kept = session.keep("found", first);
      session.begin("fall", 0.01);
      Pushing n;
      if (const auto stage = session.enter(world, n)) {
        while (world.time() < 0.0095) go_on(world, session, first);
        first.rest_height = first.samples.back().height;
      }
      session.complete(world);
    }
    save_samples<HeightOfBalls>(session.folder() / "rest.csv", first.samples, height_columns, 0);
    {
      PartOf<Balls> part(session, session, "pushed");
      const auto kept = session.keep("found", second);
      for (const double tilt : {2.0, -3.0}) {
        session.begin("push", 0.01);
        Pushing n{.start = world.time()};
        if (const auto stage = session.enter(world, n)) {
          while (n.pushes < 10) {
            ++n.pushes;
            world.set_gravity({tilt * n.pushes, 0, -9.81});
            go_on(world, session, second);
          }
          second.rest_height += n.start;
        }
      }
      session.complete();
    }
    found = second;
    save_samples<HeightOfBalls>(session.folder() / "pushed.csv", second.samples, height_columns, 0);
  }
  bool report(Report& report) const override {
    report.page({}, [](dem::io::HtmlReport&) {});
    return false;
  }

  void go_on(dem::World<Balls>& world, Session& session, Found& to) {
    if (signal_after < 0) dem::rig::run(world, 1e-3);
    else REQUIRE(world.run_for(1e-3));
    double height = 0.0, speed = 0.0;
    for (const auto p : world.grains()) height += world.position(p).z(), speed += world.velocity(p).norm();
    to.samples.push_back({world.time(), height, speed});
    ++updates;
    if (updates == signal_after) std::raise(SIGTERM);
    session.update(world.time());
    if (updates == stop_after) throw Interrupted{};
  }

  std::string folder;
  double friction = 0.4;
  int threads = 1, updates = 0, stop_after = -1, signal_after = -1;
  Found found;
};

struct RunOfBalls {
  int run(std::vector<std::string> more, int stop_after = -1, int signal_after = -1) {
    rig = {};
    rig.stop_after = stop_after, rig.signal_after = signal_after;
    std::vector<std::string> words = {"balls", "--output", path().string()};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<const char*> argv;
    for (const auto& w : words) argv.push_back(w.c_str());
    return run_program({.name = "balls", .title = "Balls"}, rig, static_cast<int>(argv.size()), argv.data());
  }
  fs::path path() const { return folder / "out"; }
  std::string text(const char* file) const { return dem::io::read_file(path() / file); }

  TempFolder folder;
  PushedBalls rig;
};

}  // namespace

TEST_CASE("a run that was stopped at any of its moments ends as one that was not", "[long]") {
  RunOfBalls whole;
  REQUIRE(whole.run({}) == 0);
  const int moments = whole.rig.updates;
  REQUIRE(moments == 30);
  for (int stop = 1; stop < moments; ++stop) {
    CAPTURE(stop);
    RunOfBalls r;
    REQUIRE(r.run({"--checkpoint-every=1e-9"}, stop) == 130);
    REQUIRE(fs::exists(r.path() / "checkpoint"));
    if (stop % 4 == 0) {  // again
      REQUIRE(r.run({"--resume", "--checkpoint-every=1e-9", "--threads=2"}, 1) == 130);
    }
    REQUIRE(r.run({"--resume"}) == 0);
    CHECK(r.rig.updates <= moments - stop);  // what was done is not done again
    CHECK(r.text("rest.csv") == whole.text("rest.csv"));
    CHECK(r.text("pushed.csv") == whole.text("pushed.csv"));
    CHECK(r.rig.found.rest_height == whole.rig.found.rest_height);
    CHECK_FALSE(fs::exists(r.path() / "checkpoint"));
  }
}

TEST_CASE("what is saved now and then is where the run goes on, not where it was stopped") {
  RunOfBalls r;
  REQUIRE(r.run({"--checkpoint-every=1000"}, 15) == 130);  // of the first part all, of the second nothing
  CHECK(fs::exists(r.path() / "checkpoint/rest.h5"));
  CHECK_FALSE(fs::exists(r.path() / "checkpoint/pushed.h5"));
  REQUIRE(r.run({"--resume"}) == 0);
  CHECK(r.rig.updates == 20);
}

// rig::run would have heard the signal itself.
TEST_CASE("a signal ends a stage whose world is not run by rig::run, whether the run is kept or not") {
  for (const bool is_kept : {false, true}) {
    CAPTURE(is_kept);
    RunOfBalls r;
    std::vector<std::string> options;
    if (is_kept) options.emplace_back("--checkpoint-every=1000");
    CHECK(r.run(options, -1, 15) == 130);
    dem::io::clear_interrupt();
    CHECK(r.rig.updates == 15);
    CHECK(fs::exists(r.path() / "checkpoint/pushed.h5") == is_kept);
  }
}

TEST_CASE("a run that goes on is kept again, unless it is told not to") {
  for (const bool is_told : {false, true}) {
    RunOfBalls r;
    std::vector<std::string> options = {"--resume"};
    if (is_told) options.emplace_back("--checkpoint-every=0");
    REQUIRE(r.run({"--checkpoint-every=1000"}, -1, 15) == 130);
    dem::io::clear_interrupt();
    REQUIRE(r.run(options, -1, 3) == 130);
    dem::io::clear_interrupt();
    REQUIRE(r.run({"--resume"}) == 0);
    CHECK(r.rig.updates == (is_told ? 15 : 12));
  }
}

TEST_CASE("a run goes on with its own settings only, and is refused in words") {
  RunOfBalls r;
  const auto refusal = [&](const char* settings, CheckpointOptions options) {
    options.resume = true;
    options.files = hdf5_checkpoints();
    Session session({.program = "balls", .output = r.path().string(), .config = settings, .checkpoints = options});
    return error_of([&] { session.begin_run(1); });
  };
  CHECK_THAT(refusal("", {}), ContainsSubstring("there is no run in '") && ContainsSubstring("leave out --resume"));
  CHECK_FALSE(fs::exists(r.path()));  // no folder is left behind
  REQUIRE(r.run({"--checkpoint-every=1e-9"}, 12) == 130);
  const std::string rest = r.text("rest.csv"), settings = r.text("settings.toml");
  CHECK(settings.find("checkpoint") == std::string::npos);
  CHECK(r.run({"--resume", "--friction=0.5"}) == 2);
  CHECK(r.text("rest.csv") == rest);
  CHECK_THAT(refusal("friction=0.5\n", {.free_settings = {"output", "threads"}}),
             ContainsSubstring("--friction was 0.4 in the run in '") && ContainsSubstring("but is 0.5 now"));
  CHECK_THAT(refusal("friction=0.4\nspeed=2\n", {.free_settings = {"output", "threads"}}),
             ContainsSubstring("--speed was not given in the run in"));

  // The settings in the folder are not those of the file: someone has changed them.
  dem::io::write_file(r.path() / "settings.toml", "friction=0.5\n");
  CHECK(r.run({"--resume", "--friction=0.5"}) == 1);
  CHECK_THAT(r.text("report.html"), ContainsSubstring("cannot go on from") && ContainsSubstring("--friction was 0.4"));
  dem::io::write_file(r.path() / "settings.toml", settings);
  CHECK(r.run({"--resume"}) == 0);
  CHECK(r.run({"--resume"}) == 2);  // it has ended
}

TEST_CASE("a file that is damaged or cut short is refused in words before anything is replaced") {
  RunOfBalls r;
  REQUIRE(r.run({"--checkpoint-every=1e-9"}, 14) == 130);
  const auto file = r.path() / "checkpoint/pushed.h5";
  const std::string good = dem::io::read_file(file), rest = r.text("rest.csv");
  CheckpointOptions options{.resume = true, .files = hdf5_checkpoints()};
  const auto refusal = [&](const std::string& bytes) {
    dem::io::write_file(file, bytes);
    CHECK(r.run({"--resume"}) == 2);
    CHECK(r.text("rest.csv") == rest);
    Session session({"balls", r.path().string(), r.text("settings.toml"), {}, {}, options});
    return error_of([&] { session.begin_run(1); });
  };
  CHECK_THAT(refusal(good.substr(0, good.size() / 2)), ContainsSubstring("pushed.h5': it is cut short"));
  std::string bad = good;
  bad[good.size() / 2] = static_cast<char>(bad[good.size() / 2] ^ 1);
  CHECK_THAT(refusal(bad),
             ContainsSubstring("pushed.h5': it is damaged") && ContainsSubstring("begin that part of the run anew"));
  CHECK_THAT(refusal("no state"), ContainsSubstring("it is no saved state"));
  fs::remove(file);  // that part begins anew
  REQUIRE(r.run({"--resume"}) == 0);
  CHECK(r.rig.updates == 20);
}

TEST_CASE("a new run removes what another could have gone on from") {
  RunOfBalls r;
  REQUIRE(r.run({"--checkpoint-every=1e-9"}, 12) == 130);
  dem::io::write_file(r.path() / "checkpoint/notes.txt", "mine");
  REQUIRE(r.run({}, 3) == 130);
  CHECK_FALSE(fs::exists(r.path() / "checkpoint/rest.h5"));
  CHECK(fs::exists(r.path() / "checkpoint/notes.txt"));
}

}  // namespace resume_test
