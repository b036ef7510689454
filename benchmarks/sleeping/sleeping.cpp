// What sleep saves and changes: a blade is drawn through a settled bed of cubes twice from the same state, awake and
// with sleeping grains, for several seeds. Prints CPU time and mean forces of both.

#include <dem/dem.hpp>
#include <dem/report/ascii_table.hpp>

#include <CLI/CLI.hpp>

#include <ctime>
#include <random>

using namespace dem;

struct Soil : Model {
  using Shape = shape::SphereCluster<8>;
  using Integrator = integrator::VelocityVerlet;
};
constexpr double half_edge = 1.2e-3;  // m

struct Settings {
  double length = 0.12, width = 0.06, height = 0.06, settle = 0.7, travel = 0.01, speed = 0.05, share = 0.01;
  int seeds = 3, threads = 1;
};

/// Loose grains in an open box, and a blade that stands in them from the start.
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
    const Vec3 edges(4e-3, 0.5 * s.width, s.height);
    const double x = -0.3 * s.length;
    const BodyId body = world.machine().add_fixed_body("blade", Vec3(x, 0, 0.75 * s.height + edges.z() / 2));
    blade = world.add_surface(body, surface::Box(edges), {.name = "blade"});
    world.machine().add_motion(
        mbd::prescribed_position("draw", body, Vec3::UnitX(), mbd::Signal::ramp(0.0, s.speed, s.settle + 0.02)));
    const SpeciesId cube = world.add_species(shape::cube8(half_edge), {.density = 2650});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> turn(-1.0, 1.0), shift(-1e-4, 1e-4);
    const double pitch = 2.9 * half_edge;
    for (double z = pitch / 2; z < 1.9 * s.height; z += pitch) {
      for (double gx = -s.length / 2 + pitch / 2; gx < s.length / 2 - pitch / 3; gx += pitch) {
        for (double y = -s.width / 2 + pitch / 2; y < s.width / 2 - pitch / 3; y += pitch) {
          if (std::abs(gx - x) < 2e-3 + 0.6 * pitch && std::abs(y) < 0.25 * s.width + 0.6 * pitch &&
              z > 0.75 * s.height - pitch) {
            continue;  // here stands the blade
          }
          const Quaternion q = Quaternion(1, 0.3 * turn(random), 0.3 * turn(random), 0.3 * turn(random)).normalized();
          world.add_particle({cube, Vec3(gx + shift(random), y + shift(random), z + shift(random)), Vec3::Zero(),
                              q.toRotationMatrix()});
        }
      }
    }
    grains = world.particle_count();
    run(s.settle);
  }
  void run(double seconds) {
    if (const StepReport report = world.run_for(seconds); !report) fail("{}", report.text);
  }
};

struct Drawn {
  double force = 0.0, lift = 0.0, seconds = 0.0, asleep = 0.0;  // N, N, CPU s, mean share
};

/// The second half of the travel counts for the forces, all of it for the time.
Drawn draw(World<Soil> world, SurfaceId blade, const Settings& s, bool sleep) {
  if (sleep) world.set_sleep(SleepOptions{.share = s.share});
  if (const StepReport report = world.run_for(0.02); !report) fail("{}", report.text);  // time to fall asleep
  Drawn d;
  const std::clock_t start = std::clock();
  const int samples = 200;
  for (int k = 0; k < samples; ++k) {
    if (const StepReport report = world.run_for(s.travel / s.speed / samples); !report) fail("{}", report.text);
    d.asleep += static_cast<double>(world.asleep_count()) / static_cast<double>(world.particle_count()) / samples;
    if (k < samples / 2) continue;
    d.force -= world.surface_force(blade).x() / (samples / 2);
    d.lift += world.surface_force(blade).z() / (samples / 2);
  }
  d.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return d;
}

int main(int argc, char** argv) {
  Settings s;
  CLI::App app("A blade through a bed of cubes, awake and with sleeping grains");
  app.add_option("--length", s.length, "of the bed [m]")->capture_default_str();
  app.add_option("--width", s.width, "[m]")->capture_default_str();
  app.add_option("--height", s.height, "[m]")->capture_default_str();
  app.add_option("--settle", s.settle, "time to settle [s]")->capture_default_str();
  app.add_option("--travel", s.travel, "of the blade [m]")->capture_default_str();
  app.add_option("--speed", s.speed, "[m/s]")->capture_default_str();
  app.add_option("--share", s.share, "of what a grain bears that leaves it asleep")->capture_default_str();
  app.add_option("--seeds", s.seeds, "beds")->capture_default_str()->check(CLI::Range(1, 100));
  app.add_option("--threads", s.threads, "of the worlds")->capture_default_str()->check(CLI::Range(1, 64));
  CLI11_PARSE(app, argc, argv);
  try {
    io::Table table{.header = {"seed", "grains", "asleep", "CPU s awake", "CPU s asleep", "times faster",
                               "force awake (N)", "asleep (N)", "change (%)", "lift awake (N)", "asleep (N)"},
                    .digits = 4};
    for (int seed = 1; seed <= s.seeds; ++seed) {
      Bed bed(s, static_cast<unsigned>(seed));
      const Drawn awake = draw(bed.world, bed.blade, s, false), asleep = draw(bed.world, bed.blade, s, true);
      table.row(seed, bed.grains, asleep.asleep, awake.seconds, asleep.seconds, awake.seconds / asleep.seconds,
                awake.force, asleep.force, 100.0 * (asleep.force / awake.force - 1.0), awake.lift, asleep.lift);
      io::print(table);
    }
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
