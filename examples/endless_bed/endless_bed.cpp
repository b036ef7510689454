// A wheel rolls at a constant slip over a bed that never ends: a tile of it settles once, in a cell that repeats
// itself, and copies are laid ahead of the wheel and taken away behind it. With --compare 1 the same wheel rolls over a
// bed of copies that is as long as its way, too, which tells whether the patch is long enough.
//
//   endless_bed --tiles 10 --output out/endless_bed
//   endless_bed --load 0.1 --patch 6       load of the wheel (N), tiles of the patch
//   endless_bed --compare 1 --beds 24      ends with 1 if means differ by more than 2 % and two standard errors
//   endless_bed --beds 12 --seed 25        the first seed of the tiles
//   endless_bed --lay 100,83               no wheel: what it costs to lay so many tiles along x and y, and eleven steps
//
// The wheel is as wide as the cell, which repeats itself across the way: a plane problem. Writes rut.dat and
// picture.gp, and draws the picture where gnuplot is installed.

#include "arguments.hpp"

#include <dem/dem.hpp>
#include <dem/domain/periodic.hpp>
#include <dem/io/file.hpp>
#include <dem/io/process.hpp>
#include <dem/soil/moving_patch.hpp>
#include <dem/soil/rest.hpp>
#include <dem/world/memory.hpp>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <optional>

#include <sys/resource.h>

using namespace dem;

struct Beads : Model {
  using Shape = shape::Sphere;
  using Normal = contact::LinearSpringDashpot;
  using Friction = friction::CundallStrack;
  using Integrator = integrator::VelocityVerlet;
  using Domain = domain::Periodic;
};

namespace {

constexpr double d = 4e-3, length = 8 * d, width = 6 * d;                            // m: of a bead, and of a tile
constexpr double stiffness = 3e3, radius = 8 * d, speed = 0.8;                       // N/m, m, m/s
constexpr double ahead = 2.5 * length, first_place = 2.5 * length, interval = 1e-3;  // m, m, s

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// A cell of so many tiles; 0 along x: it does not repeat itself there.
World<Beads> ground(int along_x, int along_y) {
  const double low = along_x > 0 ? 0.0 : -1.0, high = along_x > 0 ? along_x * length : 1e3;
  World<Beads> world({.time_step_safety = 0.8,
                      .domain = surface::Aabb{{low, 0, -1}, {high, along_y * width, 1}},
                      .periodic = {.x = along_x > 0, .y = true},
                      .threads = 1});
  world.set_contact({.normal = contact::LinearSpringDashpot::with_restitution(stiffness, 0.3),
                     .friction = {0.6, 2.0 / 7 * stiffness, 0.1}});
  for (const double size : {0.85, 1.0, 1.15}) world.add_species(shape::Sphere(0.5 * size * d), {.density = 2500});
  world.add_surface(world.ground(), surface::Plane{}, {.name = "floor"});
  return world;
}

/// Beads fall into a cell that repeats itself along x and y, and come to rest.
soil::Tile settle(std::uint64_t seed) {
  World<Beads> cell = ground(1, 1);
  RandomStream random(seed);
  for (int k = 0; k < 8; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 6; ++i) {
        const Vec3 x((i + 0.5) * length / 6, (j + 0.5) * width / 5, (k + 0.6) * 1.2 * d);
        cell.add_grain({SpeciesId(random.bits() % 3), x, random.in_ball(0.2)});
      }
    }
  }
  soil::StaysBelow rests(0.01 * soil::rest_speed(d), 0.02);
  while (!rests(cell.time(), soil::rms_speed(cell)) && cell.time() < 2.0) (void)cell.run_for(0.01);
  return soil::take_tile(cell);
}

/// Lays so many copies of a tile in a cell, takes eleven steps, and prints what that costs.
void lay(const soil::Tile& tile, int along_x, int along_y) {
  const auto cpu = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const double start = cpu();
  World<Beads> world = ground(along_x, along_y);
  soil::lay_tiles(world, tile, {.along_x = along_x, .along_y = along_y});
  const double laid = cpu();
  if (const StepReport report = world.run(11); !report) fail("{}", report.text);
  const double end = cpu(), beads = static_cast<double>(world.grain_count());
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  const double most = 1024.0 * static_cast<double>(use.ru_maxrss);  // bytes, of the whole program
  fmt::print("{} x {} tiles, {:.0f} beads: laid in {:.2f} s of processor time, eleven steps in {:.2f} s\n", along_x,
             along_y, beads, laid - start, end - laid);
  fmt::print("memory {:.3f} GB at most, {:.0f} bytes a bead\n", 1e-9 * most, most / beads);
  fmt::print("beads move at {:.2g} m/s; in the tile they counted as at rest below {:.2g}\n", soil::rms_speed(world),
             0.01 * soil::rest_speed(d));
}

struct Sample {
  double way, pull, sinkage;
};
struct Run {
  std::vector<Sample> samples;
  std::size_t grains = 0, ids = 0, bytes = 0;
  double seconds = 0.0;
  std::optional<soil::MovingPatch<Beads>> patch;
  std::optional<World<Beads>> world;
  SurfaceId wheel;
};

/// Rolls the wheel with its load (N) over the way (m) at a slip, on a patch or on a bed that is long enough.
/// `doubles_at`: m, the way after which the patch doubles its length; negative: never.
Run roll(const soil::Tile& tile, double slip, double load, double way, int patch_tiles, bool on_patch,
         double doubles_at) {
  Run run;
  World<Beads>& world = run.world.emplace(ground(0, 1));
  const double start = now(), rim = 2.5 * d;
  if (on_patch) {
    run.patch.emplace(world, tile,
                      soil::PatchOptions{.tiles = patch_tiles, .rim = rim, .ahead = ahead, .rut_cell = 0.5 * d});
  } else {
    const int tiles = static_cast<int>(std::ceil((first_place + way + ahead) / length - 1e-9)) + 1;
    soil::lay_tiles(world, tile, {.along_x = tiles, .rim = rim});
  }
  double top = 0.0;  // under the wheel
  for (const GrainId p : world.grains()) {
    const Vec3 x = world.position(p);
    const double r = world.species(world.species_of(p)).shape.bounding_radius(), apart = x.x() - first_place;
    if (std::abs(apart) > radius) continue;
    top = std::max(top, x.z() + std::sqrt((radius + r) * (radius + r) - apart * apart));
  }
  auto& m = world.machine();
  Mat3 about_y;  // the wheel's axis, z of its own frame, along y
  about_y << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const Vec3 at(first_place, 0.5 * width, top);
  const double axle_width = width + 8 * d, mass = load / 9.81;
  const auto carriage = m.add_body(mbd::box_body("carriage", Vec3::Constant(0.02), 2000).at(at));
  const auto wheel = m.add_body(
      mbd::cylinder_body("wheel", radius, axle_width, 0.9 * mass / (std::numbers::pi * radius * radius * axle_width))
          .at(at, about_y));
  const auto shaft = m.add_body(mbd::box_body("shaft", Vec3::Constant(0.02), 0.1 * mass / 8e-6).at(at));
  const auto rail = m.add_joint(mbd::prismatic("rail", m.ground(), carriage, at, Vec3::UnitX()));
  const auto guide = m.add_joint(mbd::prismatic("guide", carriage, shaft, at, Vec3::UnitZ()));
  const auto axle = m.add_joint(mbd::revolute("axle", shaft, wheel, at, Vec3::UnitY()));
  m.add_actuator(mbd::joint_actuator("damper", guide, 0.0, load / 0.2));  // under which the load sinks at 0.2 m/s
  const double rest = 0.1, ramp = 0.05;                                   // s, to sink in, and to get going
  const auto gone = [=](double t) {                                       // of 1 m/s
    const double s = std::clamp((t - rest) / ramp, 0.0, 1.0);
    return t < rest ? 0.0 : ramp * (s * s * s - 0.5 * s * s * s * s) + std::max(0.0, t - rest - ramp);
  };
  const double spin = speed / ((1.0 - slip) * radius);
  m.add_motion(mbd::prescribed_joint("way", rail, mbd::Signal::function([=](double t) { return speed * gone(t); })));
  m.add_motion(mbd::prescribed_joint("turns", axle, mbd::Signal::function([=](double t) { return spin * gone(t); })));
  run.wheel = world.add_surface(wheel, surface::Cylinder(radius, axle_width), {.name = "wheel"});
  const auto sensor = world.add_surface_sensor(run.wheel, interval);
  const double level = tile.height;
  const auto place = [&] { return world.machine().body(wheel).position(); };
  while (place().x() - first_place < way) {
    if (const auto report = world.run_for(interval); !report) fmt::print("{}\n", report.text), std::exit(1);
    const double x = place().x() - first_place;
    if (run.patch) {
      if (doubles_at >= 0.0 && x > doubles_at && !run.patch->is_doubled()) run.patch->double_length();
      run.patch->follow(world, place().x());
      if (x > length) run.patch->note(world.surface_sensor(sensor).mean().force.x);
    }
    run.samples.push_back({x, world.surface_sensor(sensor).mean().force.x, level - (place().z() - radius)});
  }
  run.grains = world.grain_count();
  run.ids = world.state().grains.row_of.size();
  run.bytes = memory_bytes(world.state());
  run.seconds = now() - start;
  return run;
}

/// Mean over whole tiles of the way, but for the first, and how far that of another such run may be by chance.
struct Mean {
  double value, error;
};
Mean mean_of(const std::vector<Sample>& samples, double Sample::*member) {
  std::vector<double> sums, counts;
  for (const Sample& s : samples) {
    const auto k = static_cast<std::ptrdiff_t>(s.way / length) - 1;
    if (k < 0) continue;
    if (static_cast<std::size_t>(k) >= sums.size()) sums.push_back(0.0), counts.push_back(0.0);
    sums[static_cast<std::size_t>(k)] += s.*member, counts[static_cast<std::size_t>(k)] += 1.0;
  }
  if (counts.size() > 1 && counts.back() < 0.5 * counts[0]) sums.pop_back(), counts.pop_back();
  const auto n = static_cast<double>(sums.size());
  double mean = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < sums.size(); ++k) mean += sums[k] / counts[k] / n;
  for (std::size_t k = 0; k < sums.size(); ++k) squares += std::pow(sums[k] / counts[k] - mean, 2);
  return {mean, n > 1.0 ? std::sqrt(squares / (n * (n - 1.0))) : 0.0};
}

/// By how much the means of some beds differ from those of others with the same tiles, of the first, with its standard
/// error: from bed to bed, or of a single bed by that of its tiles.
Mean change_between(const std::vector<Mean>& first, const std::vector<Mean>& second) {
  const auto n = static_cast<double>(first.size());
  double base = 0.0, mean = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    base += first[k].value / n, mean += (second[k].value - first[k].value) / n;
  }
  for (std::size_t k = 0; k < first.size(); ++k) squares += std::pow(second[k].value - first[k].value - mean, 2);
  const double error = n > 1.0 ? std::sqrt(squares / (n * (n - 1.0))) : std::hypot(first[0].error, second[0].error);
  return {mean / std::abs(base), error / std::abs(base)};
}

void draw(const Run& run, const std::string& folder) {
  const World<Beads>& world = *run.world;
  const soil::HeightField field = run.patch->surface(world);
  std::string data, grains;
  for (std::size_t i = 0; i < field.along(); ++i) {
    double sum = 0.0, count = 0.0;
    for (std::size_t j = 0; j < field.across; ++j) {
      const double z = field.z[i * field.across + j];
      if (z == z) sum += z, count += 1.0;
    }
    if (count > 0.0) {
      data += fmt::format("{:.5g} {:.5g}\n", 1e3 * (field.x0 + (static_cast<double>(i) + 0.5) * field.cell),
                          1e3 * sum / count);
    }
  }
  for (const GrainId p : world.grains()) {
    const Vec3 x = world.position(p);
    const auto& kind = world.species(world.species_of(p));
    grains += fmt::format("{:.5g} {:.5g} {:.4g} {}\n", 1e3 * x.x(), 1e3 * x.z(), 1e3 * kind.shape.bounding_radius(),
                          kind.is_held() ? 0x808080 : 0xc8a060);
  }
  const Vec3 hub = world.machine().bodies()[world.state().surfaces[run.wheel.index()].body.index()].position();
  io::write_file(folder + "/rut.dat", data);
  io::write_file(
      folder + "/picture.gp",
      fmt::format("set terminal pngcairo size 1400,330 font ',12'\nset output 'picture.png'\nset size ratio -1\n"
                  "set xlabel 'way [mm]'\nset ylabel 'height [mm]'\nset xrange [0:{:.5g}]\nset yrange [-2:{:.5g}]\n"
                  "set style fill solid\n$grains << EOD\n{}EOD\n"
                  "plot $grains using 1:2:3:4 with circles lc rgb variable notitle, 'rut.dat' with lines lw 2 lc rgb "
                  "0x204080 title 'surface', '-' using 1:2:3 with circles lc rgb 0x405060 fs transparent solid 0.5 "
                  "title 'wheel'\n{:.5g} {:.5g} {:.5g}\ne\n",
                  1e3 * run.patch->front(), 1e3 * (hub.z() + 1.1 * radius), grains, 1e3 * hub.x(), 1e3 * hub.z(),
                  1e3 * radius));
  if (const auto gnuplot = io::find_program("gnuplot")) {
    const auto drawn = io::run_program(*gnuplot, {"--default-settings", "picture.gp"}, folder);
    if (drawn.exit_code != 0) fmt::print("gnuplot could not draw the picture: {}\n", drawn.errors);
  }
}

}  // namespace

int simulate(Arguments& arguments) {
  const double tiles = arguments.number("--tiles", 10.0, "that the wheel rolls over"),
               slip = arguments.number("--slip", 0.3, "of the wheel");
  const double load = arguments.number("--load", 1.0, "of the wheel [N]");
  const auto patch_tiles = static_cast<int>(arguments.number("--patch", 6.0, "tiles of the patch"));
  const double doubles_at =
      length * arguments.number("--double-at", -1.0, "tiles of the way after which the patch is doubled; -1: never");
  const auto beds = static_cast<int>(arguments.number("--beds", 1.0, "tiles of other seeds"));
  const auto first_seed = static_cast<int>(arguments.number("--seed", 1.0, "of the first of these tiles"));
  const bool compares = arguments.number("--compare", 0.0, "1: a bed as long as the way, too") != 0.0;
  const std::vector<double> laid = arguments.numbers("--lay", {0.0, 0.0}, "no wheel: tiles to lay along x and y");
  const std::string folder = arguments.take("--output", "endless_bed_output", "folder for the results");
  arguments.check();
  if (laid.size() != 2) fail("--lay has {} numbers, but must have two: tiles along x and y", laid.size());
  const bool lays = laid != std::vector<double>{0.0, 0.0};
  for (const double n : laid) {
    if (lays && !(n >= 1.0 && n == std::floor(n))) fail("--lay has {:g}, but must have two whole numbers from 1 on", n);
  }
  if (lays) {
    lay(settle(1), static_cast<int>(laid[0]), static_cast<int>(laid[1]));
    return 0;
  }

  std::vector<Mean> found[2][2];  // patch, long bed; pull, sinkage: of each tile
  for (int seed = first_seed; seed < first_seed + beds; ++seed) {
    const soil::Tile tile = settle(static_cast<std::uint64_t>(seed));
    fmt::print("tile {}: {}\n", seed, tile.in_words());
    for (const bool on_patch : {true, false}) {
      if (!on_patch && !compares) continue;
      const Run run = roll(tile, slip, load, (tiles + 1.0) * length, patch_tiles, on_patch, doubles_at);
      const Mean pull = mean_of(run.samples, &Sample::pull), sinkage = mean_of(run.samples, &Sample::sinkage);
      if (run.patch && run.patch->strays() > 0) fmt::print("{} beads lay where tiles came\n", run.patch->strays());
      fmt::print("{:9} pull {:.4f} +- {:.4f} N, sinkage {:.4f} +- {:.4f} mm; {} grains, {} ids, {:.2f} MB, {:.0f} s\n",
                 on_patch ? "patch:" : "long bed:", pull.value, pull.error, 1e3 * sinkage.value, 1e3 * sinkage.error,
                 run.grains, run.ids, 1e-6 * static_cast<double>(run.bytes), run.seconds);
      std::fflush(stdout);
      found[on_patch ? 0 : 1][0].push_back(pull);
      found[on_patch ? 0 : 1][1].push_back(sinkage);
      if (on_patch && doubles_at >= 0.0) {
        const auto effect = run.patch->length_effect();
        fmt::print("doubled: pull {:.4f} N before, {:.4f} N after, a shift of {:.1f} %\n", effect.before, effect.after,
                   100 * effect.shift());
      }
      if (on_patch && seed == first_seed) draw(run, folder);
    }
  }
  if (!compares) return 0;
  bool is_same = true;
  const char* names[] = {"pull", "sinkage"};
  for (int k = 0; k < 2; ++k) {
    const Mean change = change_between(found[1][k], found[0][k]);
    const double size = std::abs(change.value), unsure = 2.0 * change.error;
    fmt::print("{}: patch differs from the long bed by {:.2f} +- {:.2f} %; by less than 2 %: {}\n", names[k],
               100 * change.value, 100 * change.error,
               size + unsure < 0.02   ? "yes"
               : size - unsure > 0.02 ? "no"
                                      : "not told");
    is_same &= size - unsure <= 0.02;
  }
  return is_same ? 0 : 1;
}

int main(int argc, char** argv) {
  return run_example(argc, argv, "A wheel rolls over a bed of tiles that never ends", simulate);
}
