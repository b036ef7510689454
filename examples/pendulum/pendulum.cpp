// A pendulum in ten lines, and how exact it is: a first look at dem's machines, without any grains.
//
//   pendulum --output out/pendulum
//
// writes pendulum.csv (time, angle, speed, forces in the pivot), draws it, and prints the errors against closed forms.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/io/csv.hpp>
#include <dem/io/plot.hpp>
#include <dem/mbd/mbd.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

int main(int argc, char** argv) {
  double dt = 1e-4, duration = 10.0;
  std::string output = "pendulum";
  CLI::App app("A pendulum, released horizontal, against closed forms");
  app.add_option("--dt", dt, "time step in s")->capture_default_str();
  app.add_option("--duration", duration, "in s")->capture_default_str();
  app.add_option("--output", output, "folder for the results")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  try {
    using namespace dem;
    using namespace dem::mbd;

    // 1. A machine is bodies and joints. Every machine has a ground.
    Machine<integrator::PredictorCorrector> machine;
    const double mass = 1.0, length = 1.0;
    const BodyId rod = machine.add_body(given_body("rod", mass, Vec3(1e-4, 1.0 / 12, 1.0 / 12)).at({length / 2, 0, 0}));
    const JointId pivot = machine.add_joint(revolute("pivot", machine.ground(), rod, {0, 0, 0}, Vec3::UnitY()));

    // 2. A recorder turns it into rows of numbers.
    Recorder recorder(machine);
    recorder.add("time_s", [&] { return machine.time(); }).add(pivot);
    io::CsvWriter csv(output + "/pendulum.csv", recorder.columns());
    io::Series angle{.name = "angle of the rod"};

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
      if (recorder.is_due(t, 0.01)) {
        csv.row(recorder.sample());
        angle.x.push_back(t);
        angle.y.push_back(machine.coordinate(pivot));
      }
    });
    if (!report) {
      fmt::print(stderr, "{}\n", report.text);
      return 1;
    }

    // 4. Compare: the period of a rod that swings through 180 degrees is 4 K(sin 45 deg) sqrt(2 l / 3 g).
    const double exact = 4.0 * std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt(2.0 * length / (3.0 * 9.81));
    fmt::print("time step                     {:.1e} s (stable up to {:.1e} s)\n", dt, machine.stable_time_step().dt);
    fmt::print("largest change of the energy  {:.1e} J\n", drift);
    fmt::print("largest opening of the pivot  {:.1e} m\n", opening);
    if (half_periods > 0) {
      const double period = 2.0 * last_turn / half_periods;
      fmt::print("period                        {:.7f} s, closed form {:.7f} s, error {:.1e}\n", period, exact,
                 std::abs(period / exact - 1.0));
    }
    io::render_plot(
        {.title = "Pendulum, released horizontal", .x_label = "time [s]", .y_label = "angle [rad]", .series = {angle}},
        output + "/pendulum");
    fmt::print("results in {}\n", output);
  } catch (const dem::Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
