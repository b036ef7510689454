// An excavator's bucket digs through a bed of cubical grains and lifts what it holds. A motor turns its arm; force and
// torque over time are written. A program with two stages of its own, the bed and the digging, that goes on where it
// was stopped.
//
//   bucket --output out/bucket
//   bucket --every 10            keeps what it can go on from each 10 s, and at Ctrl-C: run it again to go on
//
// Writes bucket.csv, effort.gp, picture.gp and frames for ParaView (bucket.pvd), and draws the plots where gnuplot is
// installed. The bed stays in bed.h5, for other runs with it.

#include "arguments.hpp"
#include "picture.hpp"

#include <dem/dem.hpp>
#include <dem/io/checkpoint.hpp>
#include <dem/io/csv.hpp>
#include <dem/io/vtk_machine.hpp>
#include <dem/report/interrupt.hpp>
#include <dem/report/plot.hpp>
#include <dem/soil/bed.hpp>

#include <chrono>
#include <numbers>

using namespace dem;
namespace fs = std::filesystem;

struct Soil : Model {
  using Shape = shape::SphereCluster<8>;
  using Integrator = integrator::VelocityVerlet;
};

namespace {

constexpr double length = 0.24, width = 0.06, depth = 0.04;  // m, of the bed
constexpr double arm = 0.06, radius = 0.018, mouth = 0.04;   // m; mouth: width of the bucket
constexpr std::size_t samples = 300, while_it_turns = 250;
constexpr double from = 75.0 * std::numbers::pi / 180, to = -100.0 * std::numbers::pi / 180;
const Vec3 pin_at(0, 0, 0.094);

/// Half a pipe along y with two sides: the mouth looks along x, the lip lies at -z.
IndexedMesh drawing() {
  constexpr std::uint32_t pieces = 12;
  IndexedMesh m;
  for (std::uint32_t k = 0; k <= pieces; ++k) {
    const double a = std::numbers::pi * k / pieces;
    for (const double y : {-0.5 * mouth, 0.5 * mouth}) {
      m.vertices.emplace_back(-radius * std::sin(a), y, -radius * std::cos(a));
    }
  }
  for (std::uint32_t k = 0; k < pieces; ++k) {
    const std::uint32_t v = 2 * k;
    m.triangles.push_back({v, v + 1, v + 3});
    m.triangles.push_back({v, v + 3, v + 2});
    if (k == 0) continue;
    m.triangles.push_back({0, v, v + 2});      // of one side, a fan from the lip
    m.triangles.push_back({1, v + 3, v + 1});  // of the other
  }
  return m;
}

struct Digger {
  BodyId bucket;
  SurfaceId shell;
  JointId pin;
  SensorId soil, motor;

  /// Put above the bed; it digs from `start` (s) on.
  Digger(World<Soil>& world, double start, double seconds) {
    auto& m = world.machine();
    const Mat3 turned = Eigen::AngleAxisd(-from, Vec3::UnitY()).toRotationMatrix();
    const Mat3 forward = Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()).toRotationMatrix();  // its mouth
    bucket = m.add_body(mbd::box_body("bucket", {2 * radius, mouth, 2 * radius}, 2000)
                            .at(pin_at + turned * Vec3(0, 0, -arm), turned * forward));
    shell = world.add_surface(bucket, surface::TriangleMesh(drawing(), {.side = surface::MeshSide::two_sided}),
                              {.name = "bucket"});
    pin = m.add_joint(mbd::revolute("pin", m.ground(), bucket, pin_at, Vec3::UnitY()));
    const auto turn = mbd::Signal::smooth_step(0.0, from - to, start, start + seconds);
    const ActuatorId drive =
        m.add_actuator(mbd::joint_actuator("motor", pin, 2000.0, 2.0, turn));  // N m/rad, N m s/rad
    soil = m.add_sensor(mbd::contact_sensor("soil", bucket, 1e-3));
    motor = m.add_sensor(mbd::actuator_sensor("motor", drive, 1e-3));
  }
};

struct Sample {
  double time, angle, force_x, force_z, torque;  // s, rad, N, N m
  template <class V>
  void fields(V& v) {
    v("time", time, "s"), v("angle", angle, "rad"), v("force_x", force_x, "N"), v("force_z", force_z, "N"),
        v("torque", torque, "N m");
  }
};
/// What was found so far, which is saved beside the world.
struct Found {
  double seconds = 0.0;  // given: a run that goes on has the same, as functions of time cannot be compared
  std::vector<Sample> samples = {};
  template <class V>
  void fields(V& v) {
    v.given("seconds", seconds, "s"), v("samples", samples);
  }
};

struct Stopped {};

/// When to save: at Ctrl-C, and where `every` (s of wall time) is above 0, each time that so much has gone by.
struct Clock {
  double every;
  std::chrono::steady_clock::time_point last = std::chrono::steady_clock::now();

  template <class Save>
  void look(Save&& save) {
    const auto now = std::chrono::steady_clock::now();
    const bool stops = io::interrupted();
    const bool is_due = every > 0.0 && std::chrono::duration<double>(now - last).count() > every;
    if (is_due || stops) save(), last = now;
    if (stops) throw Stopped{};
  }
};

/// The grains within the bucket and on it, up to its radius above the mouth.
std::vector<GrainId> load_of(const World<Soil>& world, BodyId bucket) {
  const auto& m = world.machine();
  std::vector<GrainId> list;
  for (const GrainId p : world.grains()) {
    const Vec3 x = m.reference_rotation(bucket).transpose() * (world.position(p) - m.reference_position(bucket));
    if (std::hypot(std::min(0.0, x.x()), x.z()) > radius || x.x() > radius || std::abs(x.y()) > 0.5 * mouth) continue;
    list.push_back(p);
  }
  return list;
}

}  // namespace

int simulate(Arguments& arguments) {
  const double half_edge = arguments.number("--half-edge", 2e-3, "of a grain [m]");
  const double seconds = arguments.number("--seconds", 0.6, "that the bucket turns [s]");
  Clock clock{arguments.number("--every", 0.0, "seconds between files to go on from; 0: at Ctrl-C alone")};
  const fs::path folder = arguments.take("--output", "bucket_output", "folder for the results");
  arguments.check();
  const fs::path bed_file = folder / "bed.h5", dig_file = folder / "digging.h5";
  fs::create_directories(folder);
  const io::InterruptGuard guard;

  World<Soil> world;
  const double size = half_edge / 2e-3;  // stiffness grows as the size, damping as its square
  world.set_contact(
      {.normal = {8000 * size, 0.15 * size * size, 1.0}, .friction = {0.5, 8000 * size, 0.1 * size * size, 0.975}});
  const SpeciesId cube = world.add_species(shape::cube8(half_edge), {.density = 2650});
  soil::Bed<Soil> bed(world, soil::Container::box(length, width), cube, {.height = depth});

  // The first stage. A bed that was made, or left on its way, is taken up.
  if (fs::exists(bed_file)) load(world, bed_file, bed);
  const auto made = bed.make([](double) {}, [&] { clock.look([&] { save(world, bed_file, bed); }); });
  const double start = world.time();
  if (!fs::exists(dig_file)) save(world, bed_file, bed);
  fmt::print("{} grains, solid fraction {:.3f}, at rest after {:.2f} s\n", world.grain_count(), made.solid_fraction,
             start);

  // The second one. The machine is put together before its state is taken up: its motion starts when the bed was made.
  const Digger digger(world, start, seconds);
  Found found{.seconds = seconds};
  io::VtkSeries frames(folder / "bucket.pvd");
  if (fs::exists(dig_file)) load(world, dig_file, found, frames);
  const auto& m = world.machine();
  while (found.samples.size() < samples) {
    const auto report = world.run_for(seconds / while_it_turns);
    if (!report) {
      fmt::print("{}\n", report.text);
      break;  // what was found by then is written
    }
    const auto& force = m.sensor(digger.soil).mean().force;
    found.samples.push_back({world.time(), m.coordinate(digger.pin), force.x, force.z, m.drive_effort(digger.motor)});
    if (found.samples.size() % 15 == 0) io::add_vtk_frame(frames, world, {.plane_size = length});
    clock.look([&] { save(world, dig_file, found, frames); });
  }
  io::CsvWriter csv(folder / "bucket.csv", {"time_s", "angle_rad", "force_x_N", "force_z_N", "motor_Nm"});
  io::Series forward{.name = "force on the bucket along x [N]"}, effort{.name = "torque of the motor [0.1 N m]"};
  for (const Sample& s : found.samples) {
    csv.row(s.time, s.angle, s.force_x, s.force_z, s.torque);
    forward.x.push_back(s.time), effort.x.push_back(s.time);
    forward.y.push_back(s.force_x), effort.y.push_back(10.0 * s.torque);
  }
  csv.flush();
  if (found.samples.empty()) return 1;
  const auto held = load_of(world, digger.bucket);
  double read = 0.0;  // N, mean over the last 20 samples
  const std::size_t last = std::min<std::size_t>(20, found.samples.size());
  for (std::size_t k = 1; k <= last; ++k)
    read -= found.samples[found.samples.size() - k].force_z / static_cast<double>(last);
  const double weight =
      -world.state().options.gravity.z() * world.species(cube).mass * static_cast<double>(held.size());
  fmt::print("{} grains in and on the bucket weigh {:.3f} N; its sensor reads {:.3f} N\n", held.size(), weight, read);

  io::render_plot({.x_label = "time [s]", .y_label = "", .series = {forward, effort}}, folder / "effort");
  Picture picture({1, 0, 0}, Vec3(0, 0.5, 0.87));
  picture.grains(
      world, [&](GrainId p) { return std::find(held.begin(), held.end(), p) == held.end() ? 0xc8a060u : 0xb04030u; });
  for (const double y : {-0.5 * mouth, 0.5 * mouth}) {
    std::vector<Vec3> rim;
    for (int k = 0; k <= 24; ++k) {
      const double a = std::numbers::pi * k / 24;
      rim.push_back(m.body(digger.bucket).point({-radius * std::sin(a), y, -radius * std::cos(a)}));
    }
    picture.line(rim), picture.line({rim.front(), pin_at, rim.back()});
  }
  picture.save(folder / "picture", "A bucket that has dug through a bed: red, what it holds", 1100, 620);
  if (found.samples.size() < samples) return 1;
  fs::remove(dig_file);
  return 0;
}

int main(int argc, char** argv) {
  return run_example(argc, argv, "A bucket digs through a bed of grains", [](Arguments& arguments) {
    try {
      return simulate(arguments);
    } catch (const Stopped&) {
      fmt::print("stopped; run it again with the same options to go on\n");
      return 130;
    }
  });
}
