#include "catch.hpp"
#include "io/files.hpp"

#include <dem/io/file.hpp>
#include <dem/report/ascii_table.hpp>
#include <dem/report/progress.hpp>

#include <algorithm>
#include <csignal>
#include <stdexcept>
#include <string>
#include <string_view>

#include <sys/wait.h>
#include <unistd.h>

using Catch::Approx;
using dem::io::EtaEstimator;
using dem::io::format_duration;
using dem::io::Progress;
using dem::io::ProgressOptions;

namespace {

struct Bench {
  Captured out;
  double now = 1000;

  ProgressOptions options(bool terminal, int stages = 1) {
    return {.stages = stages, .out = out.file(), .terminal = terminal, .width = 80, .clock = [this] { return now; }};
  }
};

}  // namespace

TEST_CASE("a duration is told in two units at most") {
  CHECK(format_duration(0) == "0.0 s");
  CHECK(format_duration(9.94) == "9.9 s");
  CHECK(format_duration(9.96) == "10 s");
  CHECK(format_duration(59.6) == "1 min 00 s");
  CHECK(format_duration(185) == "3 min 05 s");
  CHECK(format_duration(3599.7) == "1 h 00 min");
  CHECK(format_duration(7620) == "2 h 07 min");
  CHECK(format_duration(86400 * 3 + 3600 * 4) == "3 d 04 h");
  CHECK(format_duration(-1) == "?");
  CHECK(format_duration(1.0 / 0.0) == "?");
}

TEST_CASE("the time left is exact at a steady rate") {
  EtaEstimator eta(50, 10);  // half way through, as after a restart
  CHECK(!eta.left(20));
  for (int i = 1; i <= 100; ++i) {
    eta.sample(50 + 0.2 * i, 10 + 0.01 * i);
    REQUIRE(eta.left(20).value() == Approx((20 - 10 - 0.01 * i) / 0.05));
  }
}

TEST_CASE("the time left follows a rate that changes") {
  EtaEstimator eta;
  double done = 0;
  for (int i = 1; i <= 60; ++i) eta.sample(i, done += 10);
  CHECK(eta.left(1600).value() == Approx(100));
  for (int i = 61; i <= 180; ++i) eta.sample(i, done += 1);
  // 280 left at 1 a second; the mean over the whole job would say 280 / 4 = 70 s.
  CHECK(eta.left(1000).value() == Approx(280).margin(30));
}

TEST_CASE("the time left is unknown without headway and zero at the end") {
  EtaEstimator eta;
  eta.sample(0, 1);  // no time has passed
  CHECK(!eta.left(10));
  eta.sample(5, 0);
  CHECK(!eta.left(10));
  eta.sample(6, 10);
  CHECK(eta.left(10).value() == 0);
}

TEST_CASE("without a terminal progress prints a line each ten per cent") {
  Bench bench;
  Progress progress(bench.options(false, 2));
  progress.begin("settle");
  CHECK(bench.out.take() == "[1/2] settle: started\n");
  bench.now += 61;
  progress.update(0.3, "speed 1.2 m/s");
  CHECK(bench.out.take() == "[1/2] settle: 1 min 01 s, speed 1.2 m/s\n");
  bench.now += 9;
  progress.begin("shear", 4.0);
  CHECK(bench.out.take() ==
        "[1/2] settle: done in 1 min 10 s\n"
        "[2/2] shear: started\n");
  for (int i = 1; i <= 40; ++i) {
    bench.now += 0.5;
    progress.update(0.1 * i + 1e-9);
    if (i == 3) CHECK(bench.out.take().empty());
    if (i == 4) CHECK(bench.out.take() == "[2/2] shear: 10 %, 18 s left\n");
    if (i == 8) CHECK(bench.out.take() == "[2/2] shear: 20 %, 16 s left\n");
  }
  const std::string rest = bench.out.take();
  CHECK(std::count(rest.begin(), rest.end(), '\n') == 7);  // 30 to 90 %; 100 % is told by finish()
  progress.finish("peak 43 kPa");
  CHECK(bench.out.take() == "[2/2] shear: done in 20 s, peak 43 kPa\n");
}

TEST_CASE("without a terminal a slow stage still gives a sign of life") {
  Bench bench;
  Progress progress(bench.options(false));
  progress.begin("run", 1000);
  bench.now += 60;
  progress.update(1, "sigma 100 kPa");
  CHECK(bench.out.take() == "run: started\nrun: 0 %, 16 h 39 min left, sigma 100 kPa\n");
}

TEST_CASE("a stage that goes on counts what was done before as no headway") {
  Bench bench;
  Progress progress(bench.options(false));
  progress.begin("press", 100.0);
  progress.go_on();
  bench.now += 5;
  progress.update(40.0);  // where an earlier run had left it
  bench.now += 60;
  progress.update(46.0);  // 54 left at 6 a minute
  CHECK(bench.out.take() == "press: started\npress: 40 %, time left ?\npress: 46 %, 9 min 00 s left\n");
}

TEST_CASE("on a terminal progress redraws one line") {
  Bench bench;
  Progress progress(bench.options(true));
  progress.begin("shear", 200);
  CHECK(bench.out.take() == "\rshear  [......................]    0 %  time left ?");
  bench.now += 10;
  progress.update(100, "sigma 100 kPa");
  CHECK(bench.out.take() == "\rshear  [###########...........]   50 %  10 s left  sigma 100 kPa");
  bench.now += 0.1;
  progress.update(101, "too early to be seen");
  CHECK(bench.out.take().empty());
  bench.now += 0.1;
  progress.update(200);
  CHECK(bench.out.take() == "\rshear  [######################]  100 %  0.0 s left              ");
  progress.finish();
  const std::string end = bench.out.take();
  CHECK(end.substr(end.rfind('\r')) == "\rshear: done in 10 s\n");
}

TEST_CASE("a bar never takes more cells than the terminal has") {
  for (const int width : {20, 30, 45, 60, 80, 200}) {
    Bench bench;
    auto options = bench.options(true);
    options.width = width;
    Progress progress(options);
    progress.begin("shear of the dense bed", 10);
    bench.out.take();
    bench.now += 1;
    progress.update(3, "τ = 43 kPa\nσ = 100 kPa, and a long remark");
    const std::string line = bench.out.take();
    INFO(line);
    CHECK(dem::io::display_width(line) - 1 <= width - 1);  // -1: the leading \r takes no cell
    CHECK(line.find('\n') == std::string::npos);
    CHECK((line.find('[') != std::string::npos) == (width >= 200));  // the remark takes the place of the bar
  }
}

TEST_CASE("the bar makes room for the status on a terminal of 80 cells") {
  Bench bench;
  Progress progress(bench.options(true, 9));
  for (int k = 0; k < 4; ++k) progress.begin("pour");
  progress.begin("shear at 44.1 kPa", 3600);
  bench.out.take();
  bench.now += 1;
  progress.update(1, "43.2 kPa");
  CHECK(bench.out.take() == "\r[5/9] shear at 44.1 kPa  [.............]    0 %  59 min 59 s left  43.2 kPa");
  bench.now += 1;
  progress.update(2, "shear 43.2 kPa");  // ten cells are the least
  CHECK(bench.out.take() == "\r[5/9] shear at 44.1 kPa  [..........]    0 %  59 min 58 s left  shear 43.2 kPa");
  bench.now += 1;
  progress.update(3, "shear stress 43.2 kPa");
  CHECK(bench.out.take() == "\r[5/9] shear at 44.1 kPa    0 %  59 min 57 s left  shear stress 43.2 kPa       ");
  bench.now += 1;
  progress.update(4, "43.2 kPa");  // the bar does not come and go
  CHECK(bench.out.take() == "\r[5/9] shear at 44.1 kPa    0 %  59 min 56 s left  43.2 kPa             ");
  progress.begin("shear at 71.4 kPa", 3600);
  CHECK_THAT(bench.out.take(), Catch::Matchers::ContainsSubstring("[.............]"));
}

TEST_CASE("the status text is made only when it is shown") {
  Bench bench;
  Progress progress(bench.options(true));
  progress.begin("run", 1000);
  int made = 0;
  for (int i = 1; i <= 1000; ++i) {
    bench.now += 0.001;
    progress.update(i, [&made] {
      ++made;
      return std::string("text");
    });
  }
  CHECK(made == Approx(5).margin(1));
}

TEST_CASE("a message stands on a line of its own") {
  Bench bench;
  {
    Progress progress(bench.options(true));
    progress.begin("run", 10);
    bench.out.take();
    progress.message("packing saved");
    CHECK_THAT(bench.out.take(), Catch::Matchers::ContainsSubstring("\rpacking saved\n\rrun  [...."));
  }
  bench.out.take();
  Progress progress(bench.options(false));
  progress.message("packing saved");
  CHECK(bench.out.take() == "packing saved\n");
}

TEST_CASE("a stage that ends early says so") {
  Bench bench;
  {
    Progress progress(bench.options(false));
    progress.begin("run", 10);
    bench.now += 3;
    progress.update(0.5);
    progress.stop("interrupted");
    CHECK(bench.out.take() == "run: started\nrun: stopped at 5 % after 3.0 s, interrupted\n");
    progress.finish();
    progress.update(1);
    CHECK(bench.out.take().empty());
  }
  CHECK(bench.out.take().empty());
  try {
    Progress progress(bench.options(false));
    progress.begin("settle");
    throw std::runtime_error("lost a grain");
  } catch (const std::runtime_error&) {
  }
  CHECK(bench.out.take() == "settle: started\nsettle: stopped after 0.0 s\n");
}

TEST_CASE("a total that is no amount of work is refused") {
  Bench bench;
  Progress progress(bench.options(false));
  CHECK(error_of([&] { progress.begin("run", -1); }) ==
        "progress stage 'run': total is -1; give a finite total > 0, or Progress::kUnknown");
}

TEST_CASE("a stream that is no terminal is known as such") {
  Captured out;
  CHECK(!dem::io::is_terminal(out.file()));
  CHECK(dem::io::terminal_width(out.file()) > 0);
}

namespace {

/// Everything that Progress prints, and a table, on a terminal or not.
void show_all(std::FILE* out, bool terminal) {
  double now = 0;
  Progress progress({.stages = 2, .out = out, .terminal = terminal, .width = 80, .clock = [&] { return now; }});
  progress.begin("settle");
  now += 100;
  progress.update(1, "half way");
  progress.message("a note");
  progress.begin("shear", 4.0);
  now += 100;
  progress.update(2.0, [] { return std::string("sigma"); });
  progress.stop("enough");
  dem::io::Table table{.header = {"a", "b"}};
  table.row(1, 2);
  dem::io::print(table, out);
}

/// How a process ends that does `actions`: 0 for well, else 256 plus the signal or the exit code.
template <class Actions>
int end_of(Actions&& actions) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGPIPE, SIG_DFL);
    int code = 0;
    try {
      actions();
    } catch (...) {
      code = 1;
    }
    std::exit(code);  // with the last flush of all streams
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? 256 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

TEST_CASE("a terminal that is gone is no error, and nothing of it reaches a file") {
  for (const bool terminal : {false, true}) {
    INFO("terminal " << terminal);
    show_all(nullptr, terminal);
    std::FILE* full = std::fopen("/dev/full", "w");
    if (full != nullptr) {
      show_all(full, terminal);
      CHECK_FALSE(dem::io::show_text(full, "lost"));
      std::fclose(full);
    }
    CHECK(end_of([&] {  // closed before the program begins: 2>&-
            ::close(STDERR_FILENO);
            show_all(stderr, terminal);
          }) == 0);
    CHECK(end_of([&] {  // a reader that goes, as of `program | head -1`, of a stream that is buffered
            int ends[2];
            if (::pipe(ends) != 0 || ::dup2(ends[1], STDOUT_FILENO) < 0) ::_exit(2);
            ::close(ends[0]);
            ::close(ends[1]);
            show_all(stdout, terminal);
            if (dem::io::show_text(stdout, "lost")) ::_exit(3);
          }) == 0);
    const TempFolder folder;
    CHECK(end_of([&] {  // a file that is opened next must not take the stream's place
            ::close(STDERR_FILENO);
            dem::io::OutputFile file(folder / "data.csv");
            show_all(stderr, terminal);
            file.write("data");
            file.close();
          }) == 0);
    CHECK(dem::io::read_file(folder / "data.csv") == "data");
  }
}

TEST_CASE("a signal of a pipe that was there before stays") {
  CHECK(end_of([] {
          sigset_t pipe;
          ::sigemptyset(&pipe);
          ::sigaddset(&pipe, SIGPIPE);
          ::pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
          std::raise(SIGPIPE);
          std::FILE* full = std::fopen("/dev/full", "w");
          dem::io::show_text(full, "lost");
          sigset_t waiting;
          ::sigpending(&waiting);
          if (::sigismember(&waiting, SIGPIPE) != 1) ::_exit(4);
        }) == 0);
}
