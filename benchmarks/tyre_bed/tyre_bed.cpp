// A tyre of 0.97 m, a closed mesh of 6,650 triangles, rolls through a settled bed of spheres or of cubes of 8 spheres:
// what the contacts of grains with the mesh cost, as a share of the step.

#include <dem/dem.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/report/ascii_table.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <random>

namespace {

constexpr double tyre_radius = 0.485, speed = 0.3;

struct Spheres : dem::Model {
  using Integrator = dem::integrator::SymplecticEuler;
  static Shape grain() { return dem::shape::Sphere(8e-3); }
  static constexpr double pitch = 0.0165, lattice_height = 0.2, settle = 0.35, sunk = 0.03;
  static constexpr double stiffer = 1.0;
};
struct Cubes : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Integrator = dem::integrator::SymplecticEuler;
  static Shape grain() { return dem::shape::cube8(8e-3); }
  static constexpr double pitch = 0.03, lattice_height = 0.6, settle = 1.0, sunk = 0.02;
  /// Cubes interlock: they carry more at less sinkage, on smaller spheres.
  static constexpr double stiffer = 4.0;
};

struct Settings {
  std::string work = "both";
  int steps = 300, triangles = 6662, threads = 1;
  double settle = 0.0, length = 1.0, width = 0.4;
};

/// A loose lattice of grains in an open box.
template <class Model>
dem::World<Model> loose_bed(const Settings& s) {
  dem::World<Model> world({.time_step = 3.5e-5 / std::sqrt(Model::stiffer), .threads = s.threads});
  const auto grain = world.add_species(Model::grain());
  const double stiffer = Model::stiffer, c = std::sqrt(stiffer);
  world.set_contact({{1e5 * stiffer, 15.0 * c, 1.0}, {0.5, 4e4 * stiffer, 7.0 * c, 0.975}});
  const double thick = 0.1, high = 1.0;
  const auto wall = [&](const dem::Vec3& middle, const dem::Vec3& edges) {
    world.add_surface(world.ground(), dem::surface::Box(edges), {.position = middle});
  };
  wall({s.length / 2, 0, -thick / 2}, {s.length + 2 * thick, s.width + 2 * thick, thick});
  for (const double side : {-1.0, 1.0}) {
    wall({s.length / 2 + side * (s.length + thick) / 2, 0, high / 2}, {thick, s.width + 2 * thick, high});
    wall({s.length / 2, side * (s.width + thick) / 2, high / 2}, {s.length + 2 * thick, thick, high});
  }
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const double pitch = Model::pitch;
  const int nx = int(s.length / pitch), ny = int(s.width / pitch), nz = int(Model::lattice_height / pitch);
  for (int k = 0; k < nx * ny * nz; ++k) {
    const dem::Quaternion turn(normal(random), normal(random), normal(random), normal(random));
    const dem::Vec3 cell(k % nx + 0.5, k / nx % ny + 0.5 - 0.5 * ny, k / (nx * ny) + 0.5);
    world.add_grain({.species = grain,
                     .position = pitch * cell,
                     .velocity = 0.1 * dem::Vec3(normal(random), normal(random), normal(random)),
                     .rotation = turn.normalized().toRotationMatrix()});
  }
  return world;
}

/// Height (m) below which a share of the grains lies.
double height_of(const auto& world, double share) {
  std::vector<double> z;
  for (const dem::GrainId p : world.grains()) z.push_back(world.position(p).z());
  std::sort(z.begin(), z.end());
  return z[static_cast<std::size_t>(share * static_cast<double>(z.size() - 1))];
}

template <class Model>
void run(const char* name, const Settings& s) {
  dem::World<Model> world = loose_bed<Model>(s);
  const double time = s.settle > 0.0 ? s.settle : Model::settle;
  fmt::print("{}: settling {} grains for {:g} s\n", name, world.grain_count(), time);
  if (const auto report = world.run_for(time); !report) dem::fail("{}", report.text);

  const double top = height_of(world, 1.0), way_down = top - height_of(world, 0.95) + Model::sunk + 0.02;
  const dem::Vec3 start(0.4, 0, top + tyre_radius + 0.02);
  const auto tyre = world.machine().add_fixed_body("tyre", start);
  const auto mesh = dem::mesh::tyre(2 * tyre_radius, 0.254, s.triangles);
  const auto mesh_surface = world.add_surface(tyre, dem::surface::TriangleMesh(mesh));
  const dem::Mat3 lie = Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const double dt = world.time_step();
  double travel = 0.0;
  const auto roll = [&](int steps) {  // its axis along y, without slip
    for (int k = 0; k < steps; ++k) {
      auto& motion = world.machine().body(tyre).motion;
      travel += speed * dt;
      const bool lowering = travel < way_down;  // on its first way it goes down as fast as it rolls
      motion.position = dem::from_eigen(dem::Vec3(start + dem::Vec3(travel, 0, -std::min(travel, way_down))));
      motion.velocity = {speed, 0, lowering ? -speed : 0.0};
      const dem::Mat3 turned =
          Eigen::AngleAxisd(travel / tyre_radius, Eigen::Vector3d::UnitY()).toRotationMatrix() * lie;
      motion.rotation = dem::from_eigen(turned);
      motion.angular_velocity = dem::from_eigen(dem::Vec3(turned.transpose() * dem::Vec3(0, speed / tyre_radius, 0)));
      if (const auto report = world.step(); !report) dem::fail("{}", report.text);
    }
  };
  roll(static_cast<int>((way_down + 0.02) / (speed * dt)));

  dem::io::Table table;
  double load = 0.0;
  table.header = {"tyre", "us/step", "surfaces, us/step", "share", "contacts with it"};
  // Without the tyre at the end: grains fall to where it was, and would be in it.
  for (const bool active : {true, true, false}) {
    world.set_active(mesh_surface, active);
    roll(50);
    const auto seconds_on_surfaces = [&] {
      double sum = 0.0;
      for (const auto& chunk : world.state().chunks) sum += chunk.surface_seconds;
      return sum / world.threads();
    };
    world.state().stopwatch.switch_on(true);
    const double before = seconds_on_surfaces();
    const auto from = std::chrono::steady_clock::now();
    roll(s.steps);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
    const double on_surfaces = seconds_on_surfaces() - before;
    world.state().stopwatch.switch_on(false);
    std::size_t contacts = 0;
    for (const auto& chunk : world.state().chunks) {
      for (int c = 0; c < chunk.surface_contacts.committed(); ++c) {
        const auto key = chunk.surface_contacts.last.key[static_cast<std::size_t>(c)];
        contacts += dem::grain::SurfaceKey{key}.surface() == mesh_surface.index();
      }
    }
    if (active) load = world.surface_force(mesh_surface).z();
    table.rows.push_back({active ? "touches" : "absent", fmt::format("{:.1f}", 1e6 * seconds / s.steps),
                          fmt::format("{:.1f}", 1e6 * on_surfaces / s.steps),
                          fmt::format("{:.1f} %", 100.0 * on_surfaces / seconds), fmt::format("{}", contacts)});
  }
  fmt::print("{} triangles, load on the tyre {:.0f} N\n", mesh.triangles.size(), load);
  print(table);
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  CLI::App app("Times a tyre of triangles that rolls through a bed of grains.");
  app.add_option("--work", s.work, "cubes, spheres or both")->check(CLI::IsMember({"cubes", "spheres", "both"}));
  app.add_option("--steps", s.steps, "steps that are timed")->check(CLI::PositiveNumber);
  app.add_option("--settle", s.settle, "time to settle first [s]; 0: by work")->check(CLI::NonNegativeNumber);
  app.add_option("--triangles", s.triangles, "triangles of the tyre, about")->check(CLI::Range(60, 10000000));
  app.add_option("--threads", s.threads, "threads")->check(CLI::PositiveNumber);
  app.add_option("--length", s.length, "length of the bed in m")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    if (s.work != "cubes") run<Spheres>("spheres", s);
    if (s.work != "spheres") run<Cubes>("cubes", s);
  } catch (const std::exception& error) {
    fmt::print(stderr, "tyre_bed: {}\n", error.what());
    return 1;
  }
}
