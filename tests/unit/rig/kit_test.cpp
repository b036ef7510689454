#include "catch.hpp"

#include <dem/core/error.hpp>
#include <dem/rig/affordable.hpp>
#include <dem/rig/samples.hpp>
#include <dem/rig/samples_file.hpp>
#include <dem/rig/settings_file.hpp>
#include <dem/rig/sizes.hpp>
#include <dem/rig/stages.hpp>

#include <csignal>
#include <filesystem>
#include <string>

#include <unistd.h>

namespace kit_test {

using Catch::Matchers::ContainsSubstring;
using namespace dem::rig;

TEST_CASE("sizes by name") {
  CHECK(size_named("smoke") == Size::smoke);
  CHECK_THROWS_WITH(size_named("huge"), ContainsSubstring("'huge', but must be smoke, quick or full"));
  const BySize<int> n{.smoke = 1, .quick = 2, .full = 3};
  CHECK(n[Size::quick] == 2);
  double open = 0.0, given = 5.0;
  fill(open, 7.0);
  fill(given, 7.0);
  CHECK(open == 7.0);
  CHECK(given == 5.0);
}

TEST_CASE("options have names of their own, and hold what they were given") {
  double depth = 0.1;
  bool vtk = true;
  std::string name = "a";
  Options options;
  options.add("--depth", depth, "[m]");
  options.flag("--vtk", vtk, "files").off("--no-vtk");
  options.add("--name", name, "of it").one_of({"a", "b"});
  CHECK_THROWS_WITH(options.add("--depth", depth, ""), ContainsSubstring("two options are called '--depth'"));
  CHECK_THROWS_WITH(options.add("--no-vtk", depth, ""), ContainsSubstring("two options"));
  CHECK_THROWS_WITH(options.add("depth", depth, ""), ContainsSubstring("two dashes"));
  REQUIRE(options.find("--no-vtk") != nullptr);
  CHECK(options.find("--no-vtk")->name == "--vtk");
  CHECK(options.find("--nothing") == nullptr);
  for (Option& o : options.all()) o.default_text = text_of(o);
  IdleOptions idle;
  CHECK(settings_text(options, idle) == "depth=0.1\nvtk=true\nname=\"a\"\n");
  idle.unless(false, "with --vtk", {"--depth"});
  CHECK(settings_text(options, idle) == "vtk=true\nname=\"a\"\n");
  CHECK_NOTHROW(refuse_idle(options, idle));
  options.all()[0].given = {"0.1"};  // on the command line: meant, also if it is the default
  CHECK_THROWS_WITH(refuse_idle(options, idle), ContainsSubstring("--depth is 0.1, but counts only with --vtk"));
  options.all()[0].in_file = true;  // as settings.toml lists defaults
  CHECK_NOTHROW(refuse_idle(options, idle));
}

TEST_CASE("values of options are read whole or not at all, in any locale") {
  double x = 0.0;
  std::uint64_t n = 0;
  int i = 0;
  bool b = false;
  std::vector<double> list;
  const auto read = [](OptionValue value, std::vector<std::string> texts) {
    return read_value({.name = "--it", .text = {}, .value = value}, texts);
  };
  CHECK(read(&x, {"1.5e-3"}));
  CHECK(x == 1.5e-3);
  CHECK(read(&x, {"+2"}));
  CHECK(x == 2.0);
  for (const char* wrong : {"", "1,5", "1.5m", "1 2", "one"}) CHECK_FALSE(read(&x, {wrong}));
  CHECK(read(&n, {"1e6"}));
  CHECK(n == 1000000);
  CHECK(read(&i, {"-3"}));
  CHECK(i == -3);
  CHECK_THROWS_WITH(read(&n, {"-3"}), ContainsSubstring("--it is -3, but must be a whole number from 0"));
  CHECK_THROWS_WITH(read(&n, {"0.5"}), ContainsSubstring("whole number"));
  CHECK_THROWS_WITH(read(&i, {"3e9"}), ContainsSubstring("from -2147483648 to 2147483647"));
  CHECK_FALSE(read(&n, {"x"}));
  CHECK(read(&b, {"On"}));
  CHECK(b);
  CHECK(read(&b, {"false"}));
  CHECK_FALSE(b);
  CHECK_FALSE(read(&b, {"maybe"}));
  CHECK(read(&list, {"1", "2.5"}));
  CHECK(list == std::vector<double>{1.0, 2.5});
  CHECK_FALSE(read(&list, {"1", "b"}));
  CHECK_FALSE(read(&x, {"1", "2"}));
}

TEST_CASE("what no machine can do is refused") {
  CHECK_NOTHROW(require_memory(1e3, "1 grain", "take fewer"));
  CHECK_THROWS_WITH(require_memory(1e18, "many grains", "take fewer"),
                    ContainsSubstring("many grains need some 1e+09 GB") && ContainsSubstring("take fewer"));
  CHECK_NOTHROW(require_steps(1.0, 1e-9, "the test", "lower it"));
  CHECK_THROWS_WITH(require_steps(1.0, 1e-11, "the test", "lower it"), ContainsSubstring("lower it"));
  CHECK(threads_for(999) == 1);
  CHECK(threads_for(1999) == 1);
}

namespace {

struct Row {
  double x, y;
};

}  // namespace

TEST_CASE("rows become columns of a file") {
  const auto path = std::filesystem::temp_directory_path() / ("dem_rows_" + std::to_string(::getpid()) + ".csv");
  const Column<Row> columns[] = {{"x_m", &Row::x}, {"y_Pa", &Row::y}};
  const std::vector<Row> rows = {{0.5, 1e6}, {1.0, 1.0 / 3.0}};
  save_samples<Row>(path, rows, columns, 3);
  CHECK(dem::io::read_file(path) == "x_m,y_Pa\n0.5,1e+06\n1,0.333\n");
  std::filesystem::remove(path);
}

namespace {

struct Ending {
  std::string text;
  explicit operator bool() const { return text.empty(); }
};

/// A world of which only the steps are counted, which ends badly or is interrupted in one of them.
struct Counted {
  void prepare() {}
  double time_step() const { return 1e-3; }
  template <class GoesOn>
  Ending run(std::uint64_t n, GoesOn&& goes_on) {
    for (std::uint64_t k = 0; k < n; ++k) {
      if (++steps == interrupt_at) std::raise(SIGTERM);
      if (steps == fail_at) return {"step " + std::to_string(steps)};
      if (!goes_on()) break;
    }
    return {""};
  }
  int steps = 0, fail_at = -1, interrupt_at = -1;
};

}  // namespace

TEST_CASE("a world is run by whole steps, until a problem or an interrupt") {
  Counted world;
  run(world, 0.0124);
  CHECK(world.steps == 12);
  run(world, 0.0);
  CHECK(world.steps == 13);
  world.fail_at = 20;
  CHECK_THROWS_WITH(run(world, 1.0), "step 20");
  CHECK(world.steps == 20);
  world.interrupt_at = 23;
  {
    const dem::io::InterruptGuard guard(dem::io::InterruptGuard::Message::Silent);
    CHECK_THROWS_AS(run(world, 1e9), Interrupted);
    CHECK(world.steps == 23);  // after the step that was under way
    dem::io::clear_interrupt();
  }
}

TEST_CASE("what a run has found is saved, also when it is stopped") {
  std::string done;
  work_and_save([&] { done += "work "; }, [&] { done += "save "; });
  CHECK_THROWS_AS(work_and_save([&] { throw Interrupted{}; }, [&] { done += "save"; }), Interrupted);
  CHECK(done == "work save save");
}

}  // namespace kit_test
