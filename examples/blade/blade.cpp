// A machine in soil: a carriage on a rail pushes a blade through a bed of grains. It shows how a body gets a surface,
// how an actuator, a prescribed motion and force sensors work with grains, and how results are written.
//
//   blade --output out/blade
//
// writes blade.csv and ParaView files, and prints what the blade needs beside what the grains press on it.

#include <dem/dem.hpp>
#include <dem/io/csv.hpp>
#include <dem/io/vtk_machine.hpp>
#include <dem/soil/packing.hpp>

#include <CLI/CLI.hpp>

#include <random>

struct Soil : dem::Model {
  using Shape = dem::shape::Sphere;
  using Integrator = dem::integrator::VelocityVerlet;
};

int main(int argc, char** argv) {
  double depth = 0.012, speed = 0.1, travel = 0.05;
  std::string output = "blade";
  bool vtk = true;
  CLI::App app("A blade pushed through a bed of grains");
  app.add_option("--depth", depth, "of the blade in the bed [m]")->capture_default_str()->check(CLI::Range(0.0, 0.02));
  app.add_option("--speed", speed, "[m/s]")->capture_default_str()->check(CLI::Range(1e-3, 1.0));
  app.add_option("--travel", travel, "[m]")->capture_default_str()->check(CLI::Range(1e-3, 0.07));
  app.add_option("--output", output, "folder for the results")->capture_default_str();
  app.add_flag("--vtk,!--no-vtk", vtk, "files for ParaView");
  CLI11_PARSE(app, argc, argv);

  try {
    using namespace dem;
    using namespace dem::mbd;

    // 1. A bed of grains in an open box: poured from a loose block, then left to settle.
    const Vec3 box(0.12, 0.03, 0.06);
    const double radius = 1.5e-3, wall = 0.01;
    World<Soil> world({.gravity = {0, 0, -9.81}});
    world.set_contact({.normal = {2000, 0.05, 1.0}, .friction = {0.5, 2000, 0.05, 0.975}});
    const auto add_wall = [&](const Vec3& middle, const Vec3& edges) {
      world.add_surface(world.ground(), surface::Box(edges), {.position = middle});
    };
    add_wall({box.x() / 2, 0, -wall / 2}, {box.x(), box.y(), wall});
    for (const double side : {-1.0, 1.0}) {
      add_wall({box.x() / 2 + side * (box.x() + wall) / 2, 0, box.z() / 2}, {wall, box.y() + 2 * wall, box.z()});
      add_wall({box.x() / 2, side * (box.y() + wall) / 2, box.z() / 2}, {box.x(), wall, box.z()});
    }
    const SpeciesId grain = world.add_species(shape::Sphere(radius), {.density = 2650});
    std::mt19937 random(1);
    std::uniform_real_distribution<double> jitter(-2e-4, 2e-4);
    const double pitch = 2.3 * radius;
    for (double z = pitch / 2; z < 0.04; z += pitch) {
      for (double x = pitch / 2; x < box.x() - pitch / 2; x += pitch) {
        for (double y = -box.y() / 2 + pitch / 2; y < box.y() / 2 - pitch / 2; y += pitch) {
          world.add_particle({grain, Vec3(x + jitter(random), y + jitter(random), z + jitter(random))});
        }
      }
    }

    if (const auto report = world.run_for(0.4); !report) return fmt::print(stderr, "{}\n", report.text), 1;
    const double level = soil::height_percentile(soil::placements(world), 0.95) + radius;

    // 2. The machine: ground - rail - carriage - guide - blade, which stands just above the bed.
    auto& machine = world.machine();
    const Vec3 blade_edges(4e-3, 0.8 * box.y(), 0.03);
    const double start = 0.02, clear = 3 * radius;
    const Vec3 blade_at(start, 0, level + clear + blade_edges.z() / 2);
    const BodyId carriage = machine.add_body(box_body("carriage", {0.02, 0.02, 0.01}, 7800).at({start, 0, 0.1}));
    const BodyId blade = machine.add_body(box_body("blade", blade_edges, 7800).at(blade_at));
    world.add_surface(blade, surface::Box(blade_edges), {.name = "blade"});
    const JointId rail =
        machine.add_joint(prismatic("rail", machine.ground(), carriage, {start, 0, 0.1}, Vec3::UnitX()));
    const JointId guide = machine.add_joint(prismatic("guide", carriage, blade, blade_at, Vec3::UnitZ()));

    // 3. It goes down by a prescribed motion, and along by an actuator that follows a position.
    const double down = world.time() + 0.3;
    machine.add_motion(prescribed_joint("depth", guide, Signal::smooth_step(0, -clear - depth, world.time(), down)));
    const ActuatorId push = machine.add_actuator(joint_actuator("push", rail, 2e4, 200, Signal::ramp(0, speed, down)));
    const SensorId soil = machine.add_sensor(contact_sensor("soil", blade, 0.02));
    const SensorId drive = machine.add_sensor(actuator_sensor("drive", push, 0.02));

    // 4. The run, with a row of numbers every millisecond.
    io::CsvWriter csv(output + "/blade.csv", {"time_s", "travel_m", "push_N", "soil_x_N", "soil_z_N"});
    io::VtkSeries series(output + "/blade.pvd");
    double sum_push = 0, sum_soil = 0, next_frame = world.time();
    int rows = 0;
    while (world.time() < down + travel / speed) {
      if (const auto report = world.run_for(1e-3); !report) return fmt::print(stderr, "{}\n", report.text), 1;
      const double pushed = machine.sensor(drive).mean().force.x, pressed = machine.sensor(soil).mean().force.x;
      csv.row(world.time(), machine.coordinate(rail), pushed, pressed, machine.sensor(soil).mean().force.z);
      if (world.time() > down + 0.3 * travel / speed) {
        ++rows;
        sum_push += pushed;
        sum_soil -= pressed;
      }
      if (vtk && world.time() > next_frame) {
        next_frame += 0.02;
        io::add_vtk_frame(series, world);
      }
    }
    fmt::print("{} grains, blade {:.0f} mm deep and {:.0f} mm wide, {:.0f} mm/s\n", world.particle_count(), 1e3 * depth,
               1e3 * blade_edges.y(), 1e3 * speed);
    fmt::print("push {:.3f} N, soil on the blade {:.3f} N, ratio {:.3f}\n", sum_push / rows, sum_soil / rows,
               sum_push / sum_soil);
    fmt::print("results in {}\n", output);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
