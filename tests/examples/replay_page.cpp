// A report with a replay of made-up motion, for the test of the page in a browser: cubes fall into a split box, are
// sheared by its upper half, and a wheel rolls over them.
//
//   replay_page <output folder>

#include <dem/report/html_report.hpp>
#include <dem/report/replay_page.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

using dem::Mat3;
using dem::Vec3;
using dem::report::Replay;
using dem::report::ReplayGrain;
using dem::report::ReplayPose;

namespace {

constexpr int kAlong = 5, kUp = 4;          // cubes
constexpr double kEdge = 2e-3;              // m, of a cube
constexpr double kPlace = 1.06 * kEdge;     // m, from one to the next
constexpr double kFall = 0.08, kEnd = 0.4;  // s

Mat3 turned(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }

/// Where the cube i, j, k (k layers up) is at a time: it falls, lies, and goes along with its half of the box.
ReplayGrain cube(int i, int j, int k, double time) {
  const auto number = static_cast<std::size_t>((k * kAlong + j) * kAlong + i);
  const double landed = std::min(kFall, 0.03 + 0.006 * k), before = std::max(0.0, landed - time);
  const double sheared = k < kUp / 2 ? 0.0 : 3e-3 * std::max(0.0, time - kFall) / (kEnd - kFall);
  const double wobble = 0.2 * std::sin(2.4 * static_cast<double>(number));
  ReplayGrain g{.number = number, .shape = number % 3 == 0 ? std::size_t{1} : std::size_t{0}};
  g.position = {(i - 0.5 * (kAlong - 1)) * kPlace + sheared, (j - 0.5 * (kAlong - 1)) * kPlace,
                (k + 0.5) * kPlace + 0.5 * 9.81 * before * before};
  g.rotation = turned(wobble + 30.0 * before, Vec3(std::cos(1.0 * i), std::sin(1.0 * j), 1.0));
  g.speed = before > 0.0 ? 9.81 * (landed - before) : sheared > 0.0 ? 3e-3 / (kEnd - kFall) : 0.0;
  g.force = before > 0.0 ? 0.0 : 2e-4 * (kUp - k);
  g.is_asleep = before == 0.0 && sheared == 0.0;
  return g;
}

/// What a cube that has landed bears down with, on the cube below it or on the floor: the weight of its column.
dem::report::ReplayForce load(const ReplayGrain& g, int k) {
  constexpr std::size_t layer = kAlong * kAlong;
  const bool lowest = g.number < layer;
  return {.grain = g.number,
          .partner = lowest ? 0 : g.number - layer,
          .on_surface = lowest,
          .from = g.position,
          .to = g.position - Vec3(0, 0, lowest ? 0.5 * kPlace : kPlace),
          .force = 2e-4 * (kUp - k)};
}

/// Four walls that are open above and below, centred at the origin.
dem::io::SurfaceMesh walls(double edge, double height) {
  dem::io::SurfaceMesh mesh = dem::io::box_mesh({edge, edge, height});
  std::erase_if(mesh.quads, [&](const auto& q) {
    return std::all_of(q.begin(), q.end(), [&](int v) {
      return mesh.vertices[static_cast<std::size_t>(v)].z() == mesh.vertices[static_cast<std::size_t>(q[0])].z();
    });
  });
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return fmt::print(stderr, "usage: {} <output folder>\n", argv[0]), 2;

  Replay replay({.frames = 50, .interval = 4e-3});
  dem::report::ReplayShape cube8;
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
    cube8.balls.push_back({0.25 * kEdge * corner, 0.25 * kEdge});
  }
  replay.add_shape(cube8);
  replay.add_shape({.balls = {}, .mesh = dem::io::box_mesh({kEdge, kEdge, kEdge}), .smooth_angle = 0.0});
  const double inside = kAlong * kPlace, half = 0.5 * kUp * kPlace;
  replay.add_part("floor", dem::io::box_mesh({inside, inside, 1e-3}));
  replay.add_part("bottom box", walls(inside, half));
  replay.add_part("top box", walls(inside, half));
  replay.add_part("wheel <of tin>", dem::io::cylinder_mesh(2e-3, 4e-3));

  std::vector<ReplayGrain> grains;
  std::vector<dem::report::ReplayForce> forces;
  for (int step = 0; step <= 400; ++step) {
    const double time = step * 1e-3;
    grains.clear();
    forces.clear();
    for (int n = 0; n < kAlong * kAlong * kUp; ++n) {
      const int k = n / kAlong / kAlong;
      grains.push_back(cube(n % kAlong, n / kAlong % kAlong, k, time));
      if (grains.back().force > 0.0) forces.push_back(load(grains.back(), k));
    }
    const double sheared = 3e-3 * std::max(0.0, time - kFall) / (kEnd - kFall),
                 rolled = 0.8 * inside * (time - 0.25) / kEnd;
    replay.record(time, grains,
                  std::vector<ReplayPose>{{.position = {0, 0, -0.5e-3}},
                                          {.position = {0, 0, 0.5 * half}},
                                          {.position = {sheared, 0, 1.5 * half}},
                                          {.position = {rolled, 0, 2 * half + 2e-3},
                                           .rotation = turned(rolled / 2e-3, Vec3::UnitY()),
                                           .shown = time >= kFall}},
                  forces);
  }
  dem::io::HtmlReport report("A replay");
  report.paragraph("Cubes fall into a split box, are sheared by its upper half, and a wheel rolls over them.")
      .replay(replay, "Made-up motion.");
  report.save(std::string(argv[1]) + "/report.html");
}
