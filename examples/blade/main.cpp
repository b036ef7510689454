// A machine in soil: a carriage on a rail pushes a blade through a bed of grains. It shows how a rig becomes a program
// (include/dem/rig/README.md), how a body gets a surface, and how an actuator, a prescribed motion and force sensors
// work with grains.
//
//   blade --output out/blade
//
// writes blade.csv, report.html and ParaView files, and prints what the blade needs beside what the grains press on it.

#include <dem/dem.hpp>
#include <dem/rig/frames.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/processes.hpp>
#include <dem/rig/program.hpp>
#include <dem/rig/samples_file.hpp>
#include <dem/soil/bed.hpp>

#include <string>
#include <vector>

using namespace dem;

struct Soil : Model {
  using Shape = shape::Sphere;
  using Integrator = integrator::VelocityVerlet;
  using Domain = rig::Domain;
};

const Vec3 blade_edges(4e-3, 0.024, 0.03);                // m
const double grain_radius = 1.5e-3, blade_start = -0.04;  // m

/// A bed of grains, 30 mm high in an open box of 120 x 30 mm, to be made.
soil::Bed<Soil> add_bed(World<Soil>& world) {
  world.set_contact({.normal = {2000, 0.05, 1.0}, .friction = {0.5, 2000, 0.05, 0.975}});
  const SpeciesId grain = world.add_species(shape::Sphere(grain_radius), {.density = 2650});
  return {world, soil::Container::box(0.12, 0.03), grain, {.height = 0.03}};
}

/// The machine: ground - rail - carriage - guide - blade, which stands just above a bed of this height (m). It goes
/// down by a prescribed motion from the time `start` until `down`, and then along by an actuator that follows a
/// position.
struct Pusher {
  Pusher(World<Soil>& world, double level, double depth, double speed, double start, double down) {
    using namespace mbd;
    auto& machine = world.machine();
    const double clear = 3 * grain_radius;
    const Vec3 at(blade_start, 0, level + clear + blade_edges.z() / 2);
    const BodyId carriage = machine.add_body(box_body("carriage", {0.02, 0.02, 0.01}, 7800).at({blade_start, 0, 0.1}));
    const BodyId blade = machine.add_body(box_body("blade", blade_edges, 7800).at(at));
    world.add_surface(blade, surface::Box(blade_edges), {.name = "blade"});
    rail = machine.add_joint(prismatic("rail", machine.ground(), carriage, {blade_start, 0, 0.1}, Vec3::UnitX()));
    const JointId guide = machine.add_joint(prismatic("guide", carriage, blade, at, Vec3::UnitZ()));
    machine.add_motion(prescribed_joint("depth", guide, Signal::smooth_step(0, -clear - depth, start, down)));
    const ActuatorId push = machine.add_actuator(joint_actuator("push", rail, 2e4, 200, Signal::ramp(0, speed, down)));
    soil = machine.add_sensor(contact_sensor("soil", blade, 0.02));
    drive = machine.add_sensor(actuator_sensor("drive", push, 0.02));
  }
  JointId rail;
  SensorId soil, drive;
};

struct Sample {
  double time, travel, push, soil_x, soil_z;  // s, m, N
  template <class V>
  void fields(V& v) {
    v("time", time), v("travel", travel), v("push", push), v("soil_x", soil_x), v("soil_z", soil_z);
  }
};
constexpr rig::Column<Sample> columns[] = {{"time_s", &Sample::time},
                                           {"travel_m", &Sample::travel},
                                           {"push_N", &Sample::push},
                                           {"soil_x_N", &Sample::soil_x},
                                           {"soil_z_N", &Sample::soil_z}};

class Blade : public rig::Rig {
  std::string size = "quick", folder = "blade_output";
  double depth = 0.012, speed = 0.1, travel = 0.0, frame_time = 0.02;
  bool vtk = true;

  // What a run that goes on after it was stopped takes over, besides the world.
  struct Found {
    double start = 0.0;  // s, when the bed is made
    std::uint64_t grains = 0;
    std::vector<Sample> samples;
    template <class V>
    void fields(V& v) {
      v("start", start), v("grains", grains), v("samples", samples);
    }
  } found;

 public:
  // ---- settings

  void declare(rig::Options& options) override {
    options.add("--size", size, "smoke (a short way), quick or full (a long one)");
    options.add("--depth", depth, "of the blade in the bed [m]");
    options.add("--speed", speed, "[m/s]");
    options.add("--travel", travel, "[m]; 0: by size");
    options.add("--output", folder, "folder for the results").changes_no_result();
    options.flag("--vtk", vtk, "files for ParaView").off("--no-vtk");
    options.add("--frame-time", frame_time, "between two frames for ParaView [s]");
  }
  void find_idle(rig::IdleOptions& idle) const override {
    idle.unless(vtk, "with files for ParaView, without --no-vtk", {"--frame-time"});
  }
  void resolve() override {
    const rig::BySize<double> travels = {.smoke = 0.01, .quick = 0.05, .full = 0.07};
    rig::fill(travel, travels[rig::size_named(size)]);
    require_within(depth, 0.0, 0.02, "--depth (m)");
    require_within(speed, 1e-3, 1.0, "--speed (m/s)");
    require_within(travel, 1e-3, 0.07, "--travel (m)");
    require_positive(frame_time, "--frame-time", "s");
  }
  std::string output() const override { return folder; }
  rig::ResultNames results() const override {
    return {.files = {"blade.csv", "blade.pvd"}, .plots = {"push"}, .frames = {"grains", "surfaces"}};
  }

  bool can_resume() const override { return true; }

  // ---- world, stages and samples

  void run(rig::Session& session) override {
    World<Soil> world({.gravity = {0, 0, -9.81}});
    soil::Bed<Soil> bed = add_bed(world);
    session.begin_run(3);
    rig::PartOf<Soil> part(session, session, "blade");
    rig::Frames frames(session, vtk ? "blade" : "", frame_time);
    const auto keep_found = session.keep("found", found), keep_frames = session.keep("frames", frames);
    rig::NoNumbers none;

    session.begin("make the bed");
    if (const auto stage = session.enter(world, bed)) {
      bed.make([](double) {}, [&] { session.update(world.time()); });
      found.start = world.time();
      found.grains = world.grain_count();
    }
    const double down = found.start + 0.3, end = down + travel / speed;
    const Pusher pusher(world, bed.height(), depth, speed, found.start, down);
    const auto go_on = [&] {  // for a millisecond
      rig::run(world, 1e-3);
      const auto& machine = world.machine();
      const auto &push = machine.sensor(pusher.drive).mean().force, &soil = machine.sensor(pusher.soil).mean().force;
      found.samples.push_back({world.time(), machine.coordinate(pusher.rail), push.x, soil.x, soil.z});
      frames.show(world.time(), [&](io::VtkSeries& series) { io::add_vtk_frame(series, world); });
    };
    session.begin("lower", down - found.start);
    if (const auto stage = session.enter(world, none)) {
      while (world.time() < down) go_on(), session.update(world.time() - found.start);
    }
    session.begin("push", travel);
    if (const auto stage = session.enter(world, none)) {
      while (world.time() < end) {
        go_on();
        session.update(found.samples.back().travel, text("{:.2f} N", found.samples.back().push));
      }
    }
    session.complete();
  }

  // ---- report

  bool report(rig::Report& report) const override {
    report.part("blade.csv",
                [&] { rig::save_samples<Sample>(report.folder() / "blade.csv", found.samples, columns, 0); });
    double push = 0.0, soil = 0.0, count = 0.0;
    for (const Sample& s : found.samples) {
      if (s.travel < 0.3 * travel) continue;  // until there the forces rise
      push += s.push;
      soil -= s.soil_x;
      count += 1.0;
    }
    io::Table table{.caption = "Mean forces", .header = {"push [N]", "soil on the blade [N]", "ratio"}};
    const auto over = [](double sum, double of) { return of != 0.0 ? text("{:.3f}", sum / of) : std::string("-"); };
    table.row(over(push, count), over(soil, count), over(push, soil));
    report.part("the printed report", [&] {
      fmt::print("{} grains, blade {:.0f} mm deep and {:.0f} mm wide, {:.0f} mm/s\n", found.grains, 1e3 * depth,
                 1e3 * blade_edges.y(), 1e3 * speed);
      fmt::print("push {} N, soil on the blade {} N, ratio {}\n", over(push, count), over(soil, count),
                 over(push, soil));
    });
    report.page({{"depth", text("{:g} mm", 1e3 * depth)}, {"speed", text("{:g} mm/s", 1e3 * speed)}},
                [&](io::HtmlReport& page) {
                  io::Series line{.name = "push"};
                  for (const Sample& s : found.samples) line.x.push_back(1e3 * s.travel), line.y.push_back(s.push);
                  page.table(table);
                  report.plot(page, {.x_label = "travel [mm]", .y_label = "force [N]", .series = {line}}, "push",
                              "Force on the blade over its way.");
                });
    return vtk;
  }
};

int main(int argc, char** argv) {
  const rig::MpiSession mpi(argc, argv);
  Blade blade;
  return rig::run_program({.name = "blade",
                           .title = "A blade in soil",
                           .about = "A blade pushed through a bed of grains",
                           .footer = rig::exit_codes},
                          blade, argc, argv);
}
