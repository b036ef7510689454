#include "catch.hpp"

#include <dem/io/file.hpp>
#include <dem/rig/program.hpp>
#include <dem/rig/run_within.hpp>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include <unistd.h>

namespace program_test {

using Catch::Matchers::ContainsSubstring;
using namespace dem::rig;
namespace fs = std::filesystem;

namespace {

/// A rig without a world: its run is what the test says.
struct Scripted : Rig {
  void declare(Options& options) override {
    options.add("--load", load, "[N]");
    options.add("--output", folder, "folder");
  }
  void find_idle(IdleOptions& idle) const override { idle.unless(load > 0.0, "with a load", {"--load"}); }
  void resolve() override {
    if (load > 100.0) dem::fail("--load is {:g} N, but must be at most 100", load);
  }
  std::string output() const override { return folder; }
  ResultNames results() const override { return {.files = {"rows.csv", "bed.pvd"}, .frames = {"grains"}}; }
  std::vector<OwnWord> words() const override { return {{"time_step", "--step"}}; }
  void run(Session& session) override { script(session); }
  bool report(Report& report) const override {
    report.part("rows.csv", [&] {
      if (rows_fail) throw std::runtime_error("disk full");
      dem::io::write_file(report.folder() / "rows.csv", "rows\n");
    });
    report.page({{"load", fmt::format("{:g} N", load)}}, [&](dem::io::HtmlReport& page) { page.paragraph("Rows."); });
    return false;
  }

  std::function<void(Session&)> script = [](Session& session) { session.begin_run(1); };
  std::string folder;
  double load = 1.0;
  bool rows_fail = false;
};

struct Program {
  Program() { fs::remove_all(path); }
  ~Program() { fs::remove_all(path); }
  int run(std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"scripted", "--output", path.string()};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<const char*> argv;
    for (const auto& w : words) argv.push_back(w.c_str());
    return run_program({.name = "scripted", .title = "A script"}, rig, static_cast<int>(argv.size()), argv.data());
  }
  std::string page() const { return dem::io::read_file(path / "report.html"); }
  bool has(const char* file) const { return fs::exists(path / file); }

  Scripted rig;
  fs::path path = fs::temp_directory_path() / ("dem_program_test_" + std::to_string(::getpid()));
};

}  // namespace

TEST_CASE("a run that ends well leaves its files, its settings and no lock") {
  Program p;
  CHECK(p.run({"--load=5"}) == 0);
  CHECK(p.has("rows.csv"));
  CHECK(dem::io::read_file(p.path / "settings.toml") == "load=5\noutput=" + toml_text(p.path.string()) + "\n");
  CHECK_THAT(p.page(), ContainsSubstring("5 N") && ContainsSubstring("scripted --config settings.toml"));
  CHECK_FALSE(p.has("run.lock"));
}

TEST_CASE("what is refused touches nothing") {
  Program p;
  CHECK(p.run() == 0);
  dem::io::write_file(p.path / "rows.csv", "of the first run");
  CHECK(p.run({"--load=101"}) == 2);
  CHECK(p.run({"--laod=1"}) == 2);
  CHECK(p.run({"--load=-1"}) == 2);  // counts only with a load
  p.rig.script = [](Session&) { dem::fail("no such grains"); };
  CHECK(p.run({"--load=1"}) == 2);
  p.rig.script = [](Session&) { throw std::bad_alloc(); };
  CHECK(p.run({"--load=1"}) == 2);
  p.rig.script = [](Session&) { throw InAnotherProgram("it is elsewhere"); };
  CHECK(p.run({"--load=1"}) == 3);
  p.rig.script = [&](Session& session) { session.require_writable(p.path / "report.html", "--save"); };
  CHECK(p.run({"--load=1"}) == 2);
  CHECK(dem::io::read_file(p.path / "rows.csv") == "of the first run");
  CHECK(dem::io::read_file(p.path / "settings.toml").starts_with("load=1\n"));
  CHECK_FALSE(p.has("run.lock"));
}

TEST_CASE("a program that was built without ranks does not run under mpirun") {
  for (const bool can : {true, false}) {
    can_have_ranks = can;
    for (const auto& [size, rank] :
         {std::pair("OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"), {"PMI_SIZE", "PMI_RANK"}}) {
      Program p;
      ::setenv(size, "1", 1);
      CHECK(p.run() == 0);
      ::setenv(size, "2", 1);
      CHECK(p.run() == 2);
      CHECK_THAT(detail::why_not_launched("build/examples/scripted"),
                 ContainsSubstring("mpirun started 2 processes") &&
                     ContainsSubstring(can ? "build and run the target scripted_on_ranks" : "leave out mpirun"));
      CHECK(detail::is_first_launched());
      ::setenv(rank, "1", 1);
      CHECK_FALSE(detail::is_first_launched());
      ::unsetenv(size), ::unsetenv(rank);
    }
  }
  can_have_ranks = false;
}

TEST_CASE("a run that never begins is a mistake of the rig's") {
  Program p;
  p.rig.script = [](Session&) {};
  CHECK(p.run() == 2);
}

TEST_CASE("old results go when a run begins, and what else is there stays") {
  Program p;
  for (const char* old : {"rows.csv", "bed.pvd", "bed/grains_000000.vtp", "notes.txt", "packing.txt"}) {
    dem::io::write_file(p.path / old, "old");
  }
  p.rig.script = [&](Session& session) {
    session.require_writable(p.path / "packing.txt", "--save");
    CHECK(p.has("rows.csv"));
    session.begin_run(1);
    CHECK_FALSE(p.has("rows.csv"));
    CHECK_FALSE(p.has("bed"));
    CHECK(p.has("run.lock"));
  };
  CHECK(p.run() == 0);
  CHECK(p.has("notes.txt"));
  CHECK(dem::io::read_file(p.path / "packing.txt") == "old");
}

TEST_CASE("a run that is stopped is reported, in the program's words") {
  Program p;
  p.rig.script = [](Session& session) {
    session.begin_run(2);
    session.begin("press", 1.0);
    throw Stopped("lower time_step");
  };
  CHECK(p.run() == 1);
  CHECK_THAT(p.page(), ContainsSubstring("The run ended early: lower --step") && ContainsSubstring("Rows."));
  CHECK(p.has("rows.csv"));
  p.rig.script = [](Session& session) {
    session.begin_run(1);
    throw std::bad_alloc();
  };
  CHECK(p.run() == 1);
  CHECK_THAT(p.page(), ContainsSubstring("not enough memory"));
}

TEST_CASE("a run that is interrupted is reported and ends with 130") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Program p;
    p.rig.script = [&](Session& session) {
      session.begin_run(1);
      std::raise(signal);
      CHECK(dem::io::interrupted());
      throw Interrupted{};
    };
    CHECK(p.run() == 130);
    dem::io::clear_interrupt();
    CHECK_THAT(p.page(), ContainsSubstring("The run was interrupted"));
  }
}

TEST_CASE("a part that cannot be made costs no other") {
  Program p;
  p.rig.rows_fail = true;
  CHECK(p.run() == 1);
  CHECK_FALSE(p.has("rows.csv"));
  CHECK_THAT(p.page(), ContainsSubstring("Rows."));
}

TEST_CASE("parts of the report of a run within another one that are missing are missed there, and it goes on") {
  Program p;
  Scripted inner;
  inner.folder = (p.path / "inner").string();
  bool goes_on = false;
  p.rig.script = [&](Session& session) {
    session.begin_run(1);
    session.begin("inner", 1.0);
    run_within(session, inner, "inner", "A script within");
    goes_on = true;
  };
  CHECK(p.run() == 0);
  inner.rows_fail = true;
  goes_on = false;
  CHECK(p.run() == 1);
  CHECK(goes_on);
  CHECK_THAT(p.page(), ContainsSubstring("Parts of the report in ") && ContainsSubstring("are missing."));
  inner.script = [](Session&) {};  // never begins
  CHECK(p.run() == 1);
  CHECK_THAT(p.page(), ContainsSubstring("the rig of inner has run no stage"));
}

TEST_CASE("frames that cannot be written cost no results, but are missed") {
  Program p;
  p.rig.script = [](Session& session) {
    session.begin_run(1);
    session.begin("press");
    session.give_up_frames("no place", "this load");
  };
  CHECK(p.run() == 1);
  CHECK_THAT(p.page(), ContainsSubstring("Files for ParaView are missing: no place"));
}

TEST_CASE("frames of a run within another one that cannot be written are missed there, as no parts of a report") {
  Program p;
  Scripted inner;
  inner.folder = (p.path / "inner").string();
  inner.script = [](Session& session) {
    session.begin_run(1);
    session.begin("press");
    session.give_up_frames("no place", "this load");
  };
  p.rig.script = [&](Session& session) {
    session.begin_run(1);
    session.begin("inner", 1.0);
    run_within(session, inner, "inner", "A script within");
    CHECK(session.outcome.frames_problem == "no place");
    CHECK(session.outcome.report_problem.empty());
  };
  CHECK(p.run() == 1);
  CHECK_THAT(p.page(), ContainsSubstring("Files for ParaView are missing: no place"));
}

TEST_CASE("a folder that another run holds is refused") {
  Program p;
  fs::create_directories(p.path);
  const FolderLock other(p.path.string(), "blade");
  CHECK(p.run() == 2);
  CHECK_FALSE(p.has("settings.toml"));
}

}  // namespace program_test
