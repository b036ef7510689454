// What sleep saves and changes: a settled bed of cubes or spheres goes on twice from the same state, awake and with
// sleeping grains, for several seeds: at rest, and with a blade drawn through it. Prints CPU time and mean forces. Beds
// part as soon as anything differs, so each may be drawn through several times, from grains that were pushed a little
// in other ways: what chance does is seen then.

#include <dem/dem.hpp>
#include <dem/io/checkpoint.hpp>
#include <dem/report/ascii_table.hpp>

#include <CLI/CLI.hpp>

#include <ctime>
#include <exception>
#include <random>

using namespace dem;

struct Cubes : Model {
  using Shape = shape::SphereCluster<8>;
  using Integrator = integrator::VelocityVerlet;
  static Shape grain() { return shape::cube8(1.2e-3); }
  static constexpr double pitch = 3.48e-3;  // m, of the lattice that is poured
};
struct Spheres : Model {
  using Integrator = integrator::VelocityVerlet;
  static Shape grain() { return shape::Sphere(1.5e-3); }
  static constexpr double pitch = 3.22e-3;
};

struct Settings {
  double length = 0.12, width = 0.06, height = 0.06, settle = 0.7, travel = 0.01, speed = 0.05;
  SleepOptions sleep;
  double blade = 0.03, doze = 0.02, rest = 0.05, start = -0.3, fill = 1.9;
  std::string shape = "cubes";
  std::filesystem::path beds;
  int first = 1, seeds = 3, draws = 1, threads = 1;
};

/// Loose grains in an open box, and a blade that stands in them from the start.
template <class Soil>
struct Bed {
  World<Soil> world;
  SurfaceId blade;
  std::size_t grains = 0;

  Bed(const Settings& s, unsigned seed) : world({.threads = s.threads}) {
    world.set_contact({.normal = {2000, 0.05, 1.0}, .friction = {0.5, 2000, 0.015, 0.975}});
    const auto wall = [&](const Vec3& middle, const Vec3& edges) {
      world.add_surface(world.ground(), surface::Box(edges), {.position = middle});
    };
    const double t = 0.02, high = 3 * s.height;
    wall({0, 0, -t / 2}, {s.length + 2 * t, s.width + 2 * t, t});
    for (const double side : {-1.0, 1.0}) {
      wall({side * (s.length + t) / 2, 0, high / 2}, {t, s.width + 2 * t, high});
      wall({0, side * (s.width + t) / 2, high / 2}, {s.length, t, high});
    }
    const Vec3 edges(4e-3, s.blade, s.height);
    const double x = s.start * s.length;
    const BodyId body = world.machine().add_fixed_body("blade", Vec3(x, 0, 0.75 * s.height + edges.z() / 2));
    blade = world.add_surface(body, surface::Box(edges), {.name = "blade"});
    world.machine().add_motion(mbd::prescribed_position("draw", body, Vec3::UnitX(),
                                                        mbd::Signal::ramp(0.0, s.speed, s.settle + s.doze + s.rest)));
    const SpeciesId cube = world.add_species(Soil::grain(), {.density = 2650});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> turn(-1.0, 1.0), shift(-1e-4, 1e-4);
    constexpr double pitch = Soil::pitch;
    for (double z = pitch / 2; z < s.fill * s.height; z += pitch) {
      for (double gx = -s.length / 2 + pitch / 2; gx < s.length / 2 - pitch / 3; gx += pitch) {
        for (double y = -s.width / 2 + pitch / 2; y < s.width / 2 - pitch / 3; y += pitch) {
          if (std::abs(gx - x) < 2e-3 + 0.6 * pitch && std::abs(y) < 0.5 * s.blade + 0.6 * pitch &&
              z > 0.75 * s.height - pitch) {
            continue;  // here stands the blade
          }
          const Quaternion q = Quaternion(1, 0.3 * turn(random), 0.3 * turn(random), 0.3 * turn(random)).normalized();
          world.add_grain({cube, Vec3(gx + shift(random), y + shift(random), z + shift(random)), Vec3::Zero(),
                           q.toRotationMatrix()});
        }
      }
    }
    grains = world.grain_count();
    settle(s, s.beds.empty() ? s.beds : s.beds / fmt::format("{}_{}_{}.h5", s.shape, grains, seed));
  }
  /// Takes the settled bed from the file if there is one, or else settles it and keeps it there.
  void settle(const Settings& s, const std::filesystem::path& file) {
    if (file.empty() || !exists(file)) {
      run(s.settle);
      if (!file.empty()) save(world, file);
      return;
    }
    load(world, file);
    if (std::abs(world.time() - s.settle) > world.time_step()) {
      fail("the bed of {} settled for {} s, but --settle is {}; take another folder for --beds", file.string(),
           world.time(), s.settle);
    }
  }
  void run(double seconds) {
    if (const StepReport report = world.run_for(seconds); !report) fail("{}", report.text);
  }
};

struct Drawn {
  double force = 0.0, lift = 0.0, seconds = 0.0, asleep = 0.0;  // N, N, CPU s, mean share
  double at_rest = 0.0, asleep_at_rest = 0.0;                   // before the blade moves: CPU s, share at the end
};

/// Adds a speed of up to 1e-8 m/s along each axis to that of all grains, which changes forces by 1e-5 of a grain's
/// weight: no more than is needed for beds to part.
template <class Soil>
void push_a_little(World<Soil>& world, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> speed(-1e-8, 1e-8);
  for (const GrainId p : world.grains()) {
    world.set_velocity(p, world.velocity(p) + Vec3(speed(random), speed(random), speed(random)));
  }
}

/// The second half of the travel counts for the forces, all of it for the time.
template <class Soil>
Drawn draw(World<Soil> world, SurfaceId blade, const Settings& s, bool sleep) {
  if (sleep) world.set_sleep(s.sleep);
  if (const StepReport report = world.run_for(s.doze); !report) fail("{}", report.text);  // time to fall asleep
  Drawn d;
  const auto seconds = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  d.at_rest = -seconds();
  if (const StepReport report = world.run_for(s.rest); !report) fail("{}", report.text);
  d.at_rest += seconds();
  d.asleep_at_rest = static_cast<double>(world.asleep_count()) / static_cast<double>(world.grain_count());
  d.seconds = -seconds();
  const int samples = 200;
  for (int k = 0; k < samples; ++k) {
    if (const StepReport report = world.run_for(s.travel / s.speed / samples); !report) fail("{}", report.text);
    d.asleep += static_cast<double>(world.asleep_count()) / static_cast<double>(world.grain_count()) / samples;
    if (k < samples / 2) continue;
    d.force -= world.surface_force(blade).x() / (samples / 2);
    d.lift += world.surface_force(blade).z() / (samples / 2);
  }
  d.seconds += seconds();
  return d;
}

/// Of several draws: their mean, and its standard error.
struct Forces {
  double sum = 0.0, squares = 0.0;
  int count = 0;
  void add(double f) { sum += f, squares += f * f, ++count; }
  double mean() const { return sum / count; }
  double error() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean()) / (count - 1)); }
};

template <class Soil>
void compare(const Settings& s) {
  double changes = 0.0, variance = 0.0;  // %, of the mean over beds
  io::Table still{.caption = "nothing moves",
                  .header = {"seed", "grains", "asleep", "CPU s awake", "CPU s asleep", "share (%)"},
                  .digits = 3};
  io::Table table{.caption = "the blade is drawn",
                  .header = {"seed", "draw", "grains", "asleep", "CPU s awake", "CPU s asleep", "times faster",
                             "force awake (N)", "asleep (N)", "change (%)", "lift awake (N)", "asleep (N)"},
                  .digits = 4};
  for (int seed = s.first; seed < s.first + s.seeds; ++seed) {
    Bed<Soil> bed(s, static_cast<unsigned>(seed));
    Forces of_awake, of_asleep;
    for (int k = 0; k < s.draws; ++k) {
      if (k > 0) push_a_little(bed.world, static_cast<unsigned>(k));
      const Drawn awake = draw(bed.world, bed.blade, s, false), asleep = draw(bed.world, bed.blade, s, true);
      of_awake.add(awake.force), of_asleep.add(asleep.force);
      if (k == 0) {
        still.row(seed, bed.grains, asleep.asleep_at_rest, awake.at_rest, asleep.at_rest,
                  100.0 * asleep.at_rest / awake.at_rest);
      }
      table.row(seed, k, bed.grains, asleep.asleep, awake.seconds, asleep.seconds, awake.seconds / asleep.seconds,
                awake.force, asleep.force, 100.0 * (asleep.force / awake.force - 1.0), awake.lift, asleep.lift);
    }
    io::print(still), io::print(table);
    if (s.draws > 1) {
      const double share = of_asleep.mean() / of_awake.mean();
      const double error = share * std::hypot(of_asleep.error() / of_asleep.mean(), of_awake.error() / of_awake.mean());
      changes += 100.0 * (share - 1.0) / s.seeds, variance += std::pow(100.0 * error / s.seeds, 2);
      fmt::print("bed {}: awake {:.4g} +- {:.2g} N, asleep {:.4g} +- {:.2g} N, change {:+.1f} +- {:.1f} %\n", seed,
                 of_awake.mean(), of_awake.error(), of_asleep.mean(), of_asleep.error(), 100.0 * (share - 1.0),
                 100.0 * error);
    }
    std::fflush(stdout);
  }
  if (s.draws > 1) fmt::print("all beds: change {:+.1f} +- {:.1f} %\n", changes, std::sqrt(variance));
}

int main(int argc, char** argv) {
  Settings s;
  CLI::App app("A blade through a bed, awake and with sleeping grains");
  app.add_option("--length", s.length, "of the bed [m]")->capture_default_str();
  app.add_option("--width", s.width, "[m]")->capture_default_str();
  app.add_option("--height", s.height, "[m]")->capture_default_str();
  app.add_option("--settle", s.settle, "time to settle [s]")->capture_default_str();
  app.add_option("--travel", s.travel, "of the blade [m]")->capture_default_str();
  app.add_option("--speed", s.speed, "[m/s]")->capture_default_str();
  app.add_option("--shape", s.shape, "of the grains")->check(CLI::IsMember({"cubes", "spheres"}));
  app.add_option("--blade", s.blade, "width of the blade [m]")->capture_default_str();
  app.add_option("--start", s.start, "where the blade starts, in lengths of the bed from its middle");
  app.add_option("--fill", s.fill, "height to which loose grains are put, in --height");
  app.add_option("--rest", s.rest, "time before the blade moves that is measured as well [s]");
  app.add_option("--doze", s.doze, "time to fall asleep, which is not measured [s]")->capture_default_str();
  app.add_option("--balance", s.sleep.balance, "of what a grain bears, out of balance when it falls asleep")
      ->capture_default_str();
  app.add_option("--change", s.sleep.change, "of what a grain bears that leaves it asleep")->capture_default_str();
  app.add_option("--jolt", s.sleep.jolt, "of what a grain bears that wakes it at once")->capture_default_str();
  app.add_option("--window", s.sleep.window, "after two of which a grain at rest falls asleep [steps]")
      ->capture_default_str();
  app.add_option("--mean", s.sleep.mean, "over which a change of the forces counts [steps]")->capture_default_str();
  app.add_option("--beds", s.beds, "folder in which settled beds are kept and looked for (needs HDF5)");
  app.add_option("--first", s.first, "seed of the first bed")->capture_default_str()->check(CLI::Range(0, 1000000));
  app.add_option("--seeds", s.seeds, "beds")->capture_default_str()->check(CLI::Range(1, 100));
  app.add_option("--draws", s.draws, "of each bed, awake and with sleep; all but the first from grains pushed a little")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--threads", s.threads, "of the worlds")->capture_default_str()->check(CLI::Range(1, 64));
  CLI11_PARSE(app, argc, argv);
  try {
    if (s.shape == "cubes") compare<Cubes>(s);
    else compare<Spheres>(s);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
