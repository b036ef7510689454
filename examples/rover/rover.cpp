// A planetary rover on a rocker-bogie suspension drives on soil columns (dynamic Bekker): up slopes until it digs in,
// and over a rock. One file to copy from: bodies, joints, a differential, motors, soil, a recorder, ParaView.
//
//   rover --output out/rover
//   rover --soil p3 --slopes 0,10,20 --gravity 9.81
//   rover --rock 0.12 --path 2 --slopes 0      its left wheels drive over a rock of 0.12 m
//
// prints a table and writes slopes.csv, a file over time for each drive, plots, and of the last drive its suspension's
// angles, the ruts and frames for ParaView. The rover has the size of the Mars Exploration Rovers (180 kg, six wheels
// of 0.25 m). Its suspension is laid out here such that all wheels carry the same where it stands on level ground.

#include "arguments.hpp"

#include <dem/io/csv.hpp>
#include <dem/io/vtk_machine.hpp>
#include <dem/mbd/mbd.hpp>
#include <dem/mbd/solver/projected.hpp>
#include <dem/report/ascii_table.hpp>
#include <dem/report/columns.hpp>
#include <dem/report/heat_map.hpp>
#include <dem/report/plot.hpp>
#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/column_wheel.hpp>
#include <dem/terramechanics/machine_columns.hpp>
#include <dem/terramechanics/rut_vtk.hpp>
#include <dem/terramechanics/soil_reader.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

using namespace dem;
using namespace dem::mbd;
using namespace dem::terramechanics;

namespace {

constexpr double radius = 0.125, width = 0.16, track = 1.2;  // m, of the wheels
constexpr double wheel_x[3] = {0.6, 0.0, -2.0 / 3};          // m: front, middle, rear
constexpr double bogie_x = -1.0 / 3;                         // m, of the bogies' pivots; the rockers' are at 0
constexpr double rocker_height = 0.40, bogie_height = 0.28;  // m, of the pivots when it stands
constexpr std::array<const char*, 3> wheel_names = {"front", "middle", "rear"};

/// What is asked for.
struct Drive {
  NamedSoil soil;
  double gravity = 3.71, slope = 0.0;  // m/s^2; rad
  double path = 1.5, speed = 0.1;      // m; m/s, of the rims
  double rock = 0.0;                   // m
  double spacing = 0.01;               // m, of the columns
};

/// What came of it: means over the second half of the path.
struct Drove {
  bool arrived = false;
  double standing[3] = {};                          // N, of one wheel before gravity is tilted: front, middle, rear
  double distance = 0.0, slip = 0.0, energy = 0.0;  // m; -; J for a metre
  double pull = 0.0;                                // N, of all wheels along the slope
  double load[3] = {}, sinkage[3] = {};             // N and m: front, middle, rear; of one wheel
};

/// Chassis, two rockers, two bogies, six wheels. The rockers turn on the chassis and are held by a differential: it
/// pitches by the mean of their angles. Each carries a wheel in front and a bogie with two wheels behind.
struct Rover {
  Machine<integrator::VelocityVerlet, Projected> machine;  // joints that are held exactly ask for no sub-steps
  BodyId chassis, rocker[2], bogie[2], wheel[2][3];
  JointId rocker_pivot[2], bogie_pivot[2];
  ActuatorId motor[2][3];

  /// It stands with its chassis over x = 0. The rims turn at `speed` (m/s) from a second after `start` (s) on.
  Rover(double speed, double start) {
    const Vec3 y = Vec3::UnitY();
    const Mat3 axle_along_y = rotation_between(Vec3::UnitZ(), y);
    const Vec3 deck(0.9, 0.7, 0.25);
    chassis = machine.add_body(box_body("chassis", deck, 120.0 / deck.prod()).at({0, 0, rocker_height}));
    for (const int side : {0, 1}) {
      const double at_y = (side == 0 ? 0.5 : -0.5) * track, inner = at_y - (side == 0 ? 0.5 : -0.5) * 0.3;
      const std::string name = side == 0 ? "left" : "right";
      const Vec3 pivot(0, inner, rocker_height), low_pivot(bogie_x, inner, bogie_height);
      const auto beam = [&](const std::string& what, const Vec3& middle, double length, double mass) {
        const Vec3 size(length, 0.04, 0.05);
        return machine.add_body(box_body(name + " " + what, size, mass / size.prod()).at(middle));
      };
      // Beams whose weight hangs on the pivot: so the wheels' loads follow from the geometry alone.
      rocker[side] = beam("rocker", pivot, 0.9, 10.0);
      bogie[side] = beam("bogie", low_pivot, 0.6, 5.0);
      rocker_pivot[side] = machine.add_joint(revolute(name + " rocker", chassis, rocker[side], pivot, y));
      bogie_pivot[side] = machine.add_joint(revolute(name + " bogie", rocker[side], bogie[side], low_pivot, y));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::string wheel_name = fmt::format("{} {} wheel", name, wheel_names[k]);
        const Vec3 axle(wheel_x[k], at_y, radius);
        const double density = 5.0 / (std::numbers::pi * radius * radius * width);
        wheel[side][k] = machine.add_body(cylinder_body(wheel_name, radius, width, density).at(axle, axle_along_y));
        const JointId joint =
            machine.add_joint(revolute(wheel_name, k == 0 ? rocker[side] : bogie[side], wheel[side][k], axle, y));
        const Signal spin = Signal::smooth_step(0.0, speed / radius, start, start + 1.0);
        // N m s/rad; as much torque as it takes: a motor that stalls would have with_max_force.
        motor[side][k] = machine.add_actuator(speed_actuator(wheel_name, joint, 100.0, spin));
      }
    }
    machine.add_coupling({"differential", {{rocker_pivot[0], 1.0}, {rocker_pivot[1], 1.0}}});
  }

  [[nodiscard]] double mass() const {
    double sum = 0.0;
    for (const Body& b : machine.parts().bodies) sum += b.fixed ? 0.0 : b.mass;
    return sum;
  }
};

/// The soil under its wheels: a field for the path, with a rock of hard ground in the left wheels' way or none.
MachineColumns lay_soil(Rover& rover, const Drive& drive) {
  MachineColumns soil(rover.machine, {.low_x = -1.2,
                                      .low_y = -0.5 * track - 0.25,
                                      .length_x = drive.path + 2.4,
                                      .length_y = track + 0.5,
                                      .spacing = drive.spacing,
                                      .soil = drive.soil.soil,
                                      .damping = 2e4,       // Pa s/m: a tenth of the critical one under a wheel
                                      .bulldozing = 0.3});  // of the compacted volume lies beside the ruts
  if (drive.rock > 0.0) {
    const double x = wheel_x[0] + 0.5, y = 0.5 * track, half = 0.3;  // m: its middle, and half its length
    const auto rise = [=](double at_x, double at_y) {
      const double d = std::hypot(at_x - x, 0.7 * (at_y - y)) / half;
      return d < 1.0 ? 0.5 * (1.0 + std::cos(std::numbers::pi * d)) : 0.0;
    };
    soil.soil().shape_ground([&](double at_x, double at_y) { return drive.rock * rise(at_x, at_y); });
    const Soil hard[] = {known_soil("hard").soil};
    soil.soil().lay_soils(hard, [&](double at_x, double at_y) { return rise(at_x, at_y) > 0.0 ? 1 : 0; });
  }
  for (const int side : {0, 1}) {
    for (const BodyId id : rover.wheel[side]) {
      soil.add(id, std::make_shared<ColumnCylinder>(radius, width), rover.machine.body(id).position());
    }
  }
  return soil;
}

/// What is written of a drive, without endings. All but the table may be empty.
struct Files {
  std::string table, frames, map, angles;
};

/// Sets the rover down, tilts gravity as if the ground rose ahead, and drives.
Drove run(const Drive& drive, const Files& files) {
  constexpr double set_down = 1.5, tilted = 1.0, dt = 5e-4;  // s
  Rover rover(drive.speed, set_down + tilted);
  auto& machine = rover.machine;
  machine.gravity = {0, 0, -drive.gravity};
  const MachineColumns soil = lay_soil(rover, drive);

  const auto x_of_rover = [&] { return machine.body(rover.chassis).position().x(); };
  const auto power = [&] {
    double sum = 0.0;
    for (const auto& side : rover.motor) {
      for (const ActuatorId id : side) sum += machine.actuator(id).power();
    }
    return sum;
  };
  Recorder recorder(machine);
  recorder.add("time_s", [&] { return machine.time(); }).add("x_m", x_of_rover);
  recorder.add("pitch_rad", [&] {
    const Mat3 r = machine.reference_rotation(rover.chassis);
    return std::atan2(-r(2, 0), r(0, 0));  // nose down is positive, as turns about y are
  });
  for (const auto* pivots : {&rover.rocker_pivot, &rover.bogie_pivot}) {
    for (const JointId id : *pivots) {
      recorder.add(machine.parts().joint_specs[id.index()].name + "_rad",
                   [&machine, id] { return machine.coordinate(id); });
    }
  }
  for (std::size_t part = 0; part < 6; ++part) {
    recorder.add(fmt::format("load_{}_{}_N", part < 3 ? "left" : "right", wheel_names[part % 3]),
                 [&soil, part] { return soil.loads()[part].force.z; });
  }
  recorder.add("motors_W", power);
  io::CsvWriter csv(files.table + ".csv", recorder.columns());
  io::Columns samples(recorder.columns());
  std::optional<io::VtkSeries> frames, ruts;
  std::vector<io::SurfaceMesh> meshes;
  if (!files.frames.empty()) {
    frames.emplace(files.frames + ".pvd");
    ruts.emplace(files.frames + "_soil.pvd");
    meshes = {io::box_mesh({0.9, 0.7, 0.25}), io::box_mesh({0.9, 0.04, 0.05}), io::box_mesh({0.6, 0.04, 0.05}),
              io::cylinder_mesh(radius, width)};
  }
  const auto draw = [&] {
    std::vector<io::DrawnBody> drawn = {{rover.chassis, &meshes[0]}};
    for (const int side : {0, 1}) {
      drawn.push_back({rover.rocker[side], &meshes[1]});
      drawn.push_back({rover.bogie[side], &meshes[2]});
      for (const BodyId id : rover.wheel[side]) drawn.push_back({id, &meshes[3]});
    }
    io::add_vtk_frame(*frames, machine.time(), machine, drawn, "rover");
    add_vtk_frame(*ruts, machine.time(), soil.soil().field());
  };

  Drove d;
  double energy = 0.0, turned = 0.0, count = 0.0;
  int rows = 0;
  double half_x = 0.0, half_turned = 0.0, last_x = 0.0, last_turned = 0.0, next_look = 0.0;
  const double duration = set_down + tilted + 40.0 * drive.path / drive.speed;
  const auto report = machine.run(duration, dt, [&] {
    const double t = machine.time(), tilt = drive.slope * std::clamp((t - set_down) / tilted, 0.0, 1.0);
    machine.gravity = {-drive.gravity * std::sin(tilt), 0, -drive.gravity * std::cos(tilt)};
    const double x = x_of_rover();
    if (t < set_down) {
      for (std::size_t k = 0; k < 3; ++k) d.standing[k] = 0.5 * (soil.loads()[k].force.z + soil.loads()[k + 3].force.z);
    }
    for (const auto& side : rover.motor) {
      for (const ActuatorId id : side) turned += dt * machine.actuator(id).speed * radius / 6.0;
    }
    if (recorder.is_due(t, 0.05)) {
      const auto row = recorder.sample();
      csv.row(row);
      samples.row(row);
      if (frames && rows++ % 10 == 0) draw();
    }
    if (x < 0.5 * drive.path) half_x = x, half_turned = turned;
    else {
      energy += dt * power();
      ++count;
      for (std::size_t part = 0; part < 6; ++part) {
        d.load[part % 3] += 0.5 * soil.loads()[part].force.z;
        d.pull += soil.loads()[part].force.x;
        d.sinkage[part % 3] += 0.5 * (radius - machine.body(rover.wheel[part / 3][part % 3]).position().z());
      }
    }
    if (t > next_look) {  // each time the rims should have gone 0.3 m: does it go on?
      if (turned - last_turned > 0.25 && x - last_x < 0.05 * (turned - last_turned)) return false;
      last_x = x, last_turned = turned;
      next_look = t + 0.3 / drive.speed;
    }
    return x < drive.path;
  });
  csv.flush();
  if (!report) fail("on a slope of {:.0f} deg: {}", degrees(drive.slope), report.text);
  d.distance = x_of_rover();
  d.arrived = d.distance >= drive.path;
  if (count > 0.0) {
    for (std::size_t k = 0; k < 3; ++k) d.load[k] /= count, d.sinkage[k] /= count;
    d.pull /= count;
    d.energy = energy / (d.distance - half_x);
  }
  d.slip = 1.0 - (d.distance - half_x) / (turned - half_turned);
  if (!d.arrived) d.slip = 1.0 - (d.distance - last_x) / (turned - last_turned);
  if (frames) draw();
  if (!files.map.empty()) {
    const ColumnField& field = soil.soil().field();
    const ColumnGrid& g = field.grid;
    io::HeatMap map = {.title = "Ruts", .x_label = "x [m]", .y_label = "y [m]", .c_label = "height [mm]"};
    map.is_soil = map.same_scale = true;
    for (std::size_t i = 0; i < g.nx; ++i) map.x.push_back(g.x(i));
    for (std::size_t k = 0; k < g.ny; ++k) {
      map.y.push_back(g.y(k));
      for (std::size_t i = 0; i < g.nx; ++i) map.value.push_back(1e3 * field.surface(g.row(i, k)));
    }
    map.height = 460;
    io::render_map(map, files.map);
  }
  if (!files.angles.empty()) {
    io::Plot plot = {.title = "Suspension", .x_label = "way [m]", .y_label = "angle [rad], nose down is positive"};
    for (const char* angle : {"pitch", "left rocker", "right rocker", "left bogie", "right bogie"}) {
      plot.series.push_back(samples.series("x_m", fmt::format("{}_rad", angle), {.name = angle}));
    }
    io::render_plot(plot, files.angles);
  }
  return d;
}

/// Slip over slope, beside that of one wheel alone on such columns, on a sixth of the weight: where its pull is the
/// share of the slope.
void draw_slip(const std::string& output, const Drive& drive, double weight, io::Series driven) {
  io::Series alone = {.name = "one wheel alone", .style = io::SeriesStyle::LinePoints};
  for (const double slip : {0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
    try {
      const ColumnWheelRun wheel = roll_on_columns({.wheel = {.radius = radius, .width = width},
                                                    .soil = drive.soil.soil,
                                                    .load = weight / 6,
                                                    .spin = drive.speed / radius,
                                                    .spacing = drive.spacing},
                                                   slip);
      alone.x.push_back(degrees(std::atan(wheel.pull / (weight / 6))));
      alone.y.push_back(slip);
    } catch (const Error&) {  // the soil does not carry it at this slip: no point
    }
  }
  io::Plot plot = {.title = "Rover on " + drive.soil.name,
                   .x_label = "slope [deg]",
                   .y_label = "slip",
                   .series = {std::move(driven), std::move(alone)}};
  io::render_plot(plot, output + "/slip");
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(
      argc, argv, "A rover on a rocker-bogie suspension drives up slopes of soil, or over a rock.", [](Arguments& a) {
        Drive drive;
        const std::string output = a.take("--output", "rover_output", "folder for the results");
        drive.soil = find_soil(
            a.take("--soil", "dry-sand", "dry-sand, sandy-loam, lete-sand, clayey, snow, p1 or p3, or a soil's file"));
        drive.gravity = require_positive(a.number("--gravity", drive.gravity, "m/s^2"), "--gravity", "m/s^2");
        const std::vector<double> slopes = a.numbers("--slopes", {0, 5, 10, 15, 20, 25}, "in degrees, up to 40");
        drive.path = require_within(a.number("--path", drive.path, "m"), 0.5, 100.0, "--path (m)");
        drive.speed = require_within(a.number("--speed", drive.speed, "m/s, of the rims"), 0.01, 1.0, "--speed (m/s)");
        drive.rock = require_within(a.number("--rock", 0.0, "m, height of a rock in the way of the left wheels"), 0.0,
                                    0.2, "--rock (m)");
        drive.spacing = require_within(a.number("--spacing", drive.spacing, "m, of the soil's columns"), 2e-3, 0.05,
                                       "--spacing (m)");
        const std::string vtk = a.take("--vtk", "yes", "frames for ParaView of the last drive: yes or no");
        a.check();
        if (vtk != "yes" && vtk != "no") fail("--vtk is '{}', but must be yes or no", vtk);
        for (const double slope : slopes) require_within(slope, -40.0, 40.0, "--slopes (degrees)");

        const double weight = Rover(drive.speed, 0.0).mass() * drive.gravity;
        fmt::print("Rover of {:.0f} N on {} ({}): {:.1f} N a wheel\n", weight, drive.soil.name, drive.soil.source,
                   weight / 6);
        io::Table table = {
            .caption = "Means of the second half of the path; loads of one wheel, and its depth below the level ground",
            .header = {"slope [deg]", "ended", "slip", "pull / weight", "sin(slope)", "energy [J/m]", "front [N]",
                       "middle [N]", "rear [N]", "front [mm]", "middle [mm]", "rear [mm]"}};
        io::CsvWriter csv(output + "/slopes.csv",
                          {"slope_deg", "arrived", "distance_m", "slip", "pull_N", "energy_J_per_m", "load_front_N",
                           "load_middle_N", "load_rear_N", "sinkage_front_m", "sinkage_middle_m", "sinkage_rear_m"});
        io::Series driven = {.name = "rover", .style = io::SeriesStyle::LinePoints};
        for (const double slope : slopes) {
          drive.slope = radians(slope);
          const bool is_last = slope == slopes.back();
          const std::string name = fmt::format("{}/slope_{:g}", output, slope);
          const Drove d = run(drive, {.table = name,
                                      .frames = is_last && vtk == "yes" ? output + "/rover" : "",
                                      .map = is_last ? output + "/ruts" : "",
                                      .angles = is_last ? output + "/angles" : ""});
          if (slope == slopes.front()) {
            fmt::print("Standing on level ground: {:.1f} N on a front, {:.1f} on a middle, {:.1f} on a rear wheel\n\n",
                       d.standing[0], d.standing[1], d.standing[2]);
          }
          std::vector<double> numbers = {
              slope,     d.arrived ? 1.0 : 0.0, d.distance,   d.slip,      d.pull, d.energy, d.load[0], d.load[1],
              d.load[2], d.sinkage[0],          d.sinkage[1], d.sinkage[2]};
          if (!d.arrived) std::fill(numbers.begin() + 4, numbers.end(), std::nan(""));
          csv.row(numbers);
          driven.x.push_back(slope), driven.y.push_back(d.slip);
          std::vector<std::string> row = {fmt::format("{:g}", slope), d.arrived ? "arrived" : "dug in",
                                          fmt::format("{:.2f}", d.slip)};
          if (d.arrived) {
            row.insert(row.end(), {fmt::format("{:.3f}", d.pull / weight), fmt::format("{:.3f}", std::sin(drive.slope)),
                                   fmt::format("{:.0f}", d.energy)});
            for (const double load : d.load) row.push_back(fmt::format("{:.0f}", load));
            for (const double z : d.sinkage) row.push_back(fmt::format("{:.0f}", 1e3 * z));
          }
          row.resize(table.header.size(), "-");
          table.rows.push_back(row);
          fmt::print("{} deg: {}, {:.2f} m\n", slope, d.arrived ? "arrived" : "dug in", d.distance);
        }
        csv.flush();
        fmt::print("\n{}", io::to_text(table));
        draw_slip(output, drive, weight, std::move(driven));
      });
}
