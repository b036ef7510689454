// A pendulum in ten lines, and how exact it is: a first look at dem's machines, without any grains.
//
//   pendulum --output out/pendulum
//
// writes pendulum.csv (time, angle, speed, forces in the pivot), plots and a series for ParaView, and prints the errors
// against closed forms.

#include <dem/io/csv.hpp>
#include <dem/io/vtk_machine.hpp>
#include <dem/mbd/mbd.hpp>
#include <dem/report/columns.hpp>
#include <dem/report/plot.hpp>
#include <dem/rig/launcher.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <optional>
#include <string>

int main(int argc, char** argv) {
  double dt = 1e-4, duration = 10.0;
  std::string output = "pendulum_output";
  bool vtk = true;
  CLI::App app("A pendulum, released horizontal, against closed forms");
  app.add_option("--dt", dt, "time step in s")->capture_default_str();
  app.add_option("--duration", duration, "in s")->capture_default_str();
  app.add_option("--output", output, "folder for the results")->capture_default_str();
  app.add_flag("--vtk,!--no-vtk", vtk, "files for ParaView");
  CLI11_PARSE(app, argc, argv);
  if (!dem::rig::may_run("pendulum", argv[0])) return 1;

  try {
    using namespace dem;
    using namespace dem::mbd;

    // 1. A machine is bodies and joints. Every machine has a ground.
    Machine<integrator::PredictorCorrector> machine;
    const double mass = 1.0, length = 1.0;
    const BodyId rod = machine.add_body(given_body("rod", mass, Vec3(1e-4, 1.0 / 12, 1.0 / 12)).at({length / 2, 0, 0}));
    const JointId pivot = machine.add_joint(revolute("pivot", machine.ground(), rod, {0, 0, 0}, Vec3::UnitY()));

    // 2. A recorder turns it into rows of numbers; a mesh shows the rod.
    Recorder recorder(machine);
    recorder.add("time_s", [&] { return machine.time(); }).add(pivot);
    io::CsvWriter csv(output + "/pendulum.csv", recorder.columns());
    io::Columns rows(recorder.columns());
    const io::SurfaceMesh rod_mesh = io::box_mesh({length, 0.05, 0.05});
    std::optional<io::VtkSeries> frames;
    if (vtk) frames.emplace(output + "/pendulum.pvd");
    long row = 0;

    // 3. Run. The joint's stiffness is derived from the masses and the time step.
    const auto energy = [&] { return energy_of(machine.parts(), machine.gravity).sum(); };
    const double start = energy();
    double drift = 0.0, opening = 0.0, last_speed = 0.0, last_turn = 0.0;
    int half_periods = 0;
    const MachineReport report = machine.run(duration, dt, [&] {
      const double t = machine.time(), speed = machine.speed(pivot);
      drift = std::max(drift, std::abs(energy() - start));
      opening = std::max(opening, machine.violation(pivot).displacement);
      if (t > 0.1 && last_speed * speed < 0.0) {  // a turning point
        last_turn = t - dt * speed / (speed - last_speed);
        ++half_periods;
      }
      last_speed = speed;
      if (!recorder.is_due(t, 0.01)) return;
      csv.row(recorder.sample());
      rows.row(recorder.sample());
      if (vtk && row++ % 5 == 0) io::add_vtk_frame(*frames, t, machine, {{rod, &rod_mesh}}, "rod");
    });
    csv.flush();
    if (!report) {
      fmt::print(stderr, "{}\n", report.text);
      return 1;
    }

    // 4. Compare: the period of a rod that swings through 180 degrees is 4 K(sin 45 deg) sqrt(2 l / 3 g).
    const double exact = 4.0 * std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt(2.0 * length / (3.0 * 9.81));
    fmt::print("time step                     {:.1e} s (stable up to {:.1e} s)\n", dt, machine.stable_time_step().dt);
    fmt::print("largest change of the energy  {:.1e} J (of motion, of height, and in the pivot's springs)\n", drift);
    fmt::print("largest opening of the pivot  {:.1e} m\n", opening);
    if (half_periods > 0) {
      const double period = 2.0 * last_turn / half_periods;
      fmt::print("period                        {:.7f} s, closed form {:.7f} s, error {:.1e}\n", period, exact,
                 std::abs(period / exact - 1.0));
    }
    io::render_plot({.title = "Pendulum, released horizontal",
                     .x_label = "time [s]",
                     .y_label = "angle [rad], speed [rad/s]",
                     .series = {rows.series("time_s", "pivot_turn_rad", {.name = "angle"}),
                                rows.series("time_s", "pivot_turn_speed_rad_per_s", {.name = "speed"})}},
                    output + "/pendulum");
    io::render_plot({.title = "What the pivot carries",
                     .x_label = "time [s]",
                     .y_label = "force on the rod [N]",
                     .series = {rows.series("time_s", "pivot_force_x_N", {.name = "horizontal"}),
                                rows.series("time_s", "pivot_force_z_N", {.name = "vertical"})}},
                    output + "/reactions");
    fmt::print("results in {}\n", output);
  } catch (const dem::Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
