// Andrews' squeezer: seven bodies that weigh grams, driven within 0.03 s through two and a half turns. The standard
// test of multibody codes; squeezer.hpp builds it.
//
//   squeezer --dt 5e-8 --output out/squeezer
//
// prints the seven angles at 0.03 s against the reference, writes squeezer.csv, and draws the angles and what the
// crank's bearing carries.

#include <dem/io/csv.hpp>
#include <dem/report/ascii_table.hpp>
#include <dem/report/columns.hpp>
#include <dem/report/plot.hpp>
#include <dem/rig/launcher.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "squeezer.hpp"

int main(int argc, char** argv) {
  double dt = 5e-8;
  std::string output = "squeezer_output";
  CLI::App app("Andrews' squeezer against its reference solution");
  app.add_option("--dt", dt, "time step in s; the joints get stiffer as it gets smaller")->capture_default_str();
  app.add_option("--output", output, "folder for the results")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (!dem::rig::may_run("squeezer", argv[0])) return 1;

  try {
    using namespace dem;
    auto s = squeezer::make<integrator::PredictorCorrector>();
    auto& machine = s.machine;

    mbd::Recorder recorder(machine);
    recorder.add("time_s", [&] { return machine.time(); });
    for (std::size_t k = 0; k < 7; ++k) {
      recorder.add(fmt::format("{}_rad", squeezer::names[k]), [&, k] { return machine.coordinate(s.angles[k]); });
    }
    recorder.add(s.angles[0]);  // and the reaction of the crank's bearing
    io::CsvWriter csv(output + "/squeezer.csv", recorder.columns());
    io::Columns rows(recorder.columns());

    const auto clock = std::chrono::steady_clock::now();
    const mbd::MachineReport report = machine.run(0.03, dt, [&] {
      if (!recorder.is_due(machine.time(), 3e-5)) return;
      csv.row(recorder.sample());
      rows.row(recorder.sample());
    });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    csv.flush();
    if (!report) {
      fmt::print(stderr, "{}\n", report.text);
      return 1;
    }

    io::Table table{
        .caption = "angles at t = 0.03 s", .header = {"angle", "computed", "reference", "relative error"}, .digits = 9};
    for (std::size_t k = 0; k < 7; ++k) {
      table.row(squeezer::names[k], machine.coordinate(s.angles[k]), squeezer::reference[k],
                fmt::format("{:.1e}", s.error(k)));
    }
    fmt::print("{}", io::to_text(table));
    fmt::print("largest relative error {:.2e} at dt = {:g} s: {:.1f} digits, {:.2f} s of computing, {:.0f} steps/s\n",
               s.error(), dt, -std::log10(s.error()), seconds, 0.03 / dt / seconds);
    io::Plot plot{.title = "Andrews' squeezer", .x_label = "time [s]", .y_label = "angle [rad]"};
    for (const char* name : squeezer::names) {
      io::Series angle = rows.series("time_s", fmt::format("{}_rad", name), {.name = name});
      // Two of the angles make whole turns; the plot shows all of them within one.
      for (double& q : angle.y) q = std::remainder(q, 2.0 * std::numbers::pi);
      plot.series.push_back(std::move(angle));
    }
    io::render_plot(plot, output + "/squeezer");
    io::render_plot({.title = "What the crank's bearing carries",
                     .x_label = "time [s]",
                     .y_label = "force on the crank [N]",
                     .series = {rows.series("time_s", "O_force_x_N", {.name = "x"}),
                                rows.series("time_s", "O_force_y_N", {.name = "y"})}},
                    output + "/reactions");
    fmt::print("results in {}\n", output);
  } catch (const dem::Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
