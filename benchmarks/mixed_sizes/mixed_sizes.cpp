// Mixtures of two sizes of spheres: what neighbour lists and steps cost with a uniform grid, whose cells are as large
// as the largest grain, and with a hierarchical one. Half of the solid volume is large grains.

#include <dem/dem.hpp>
#include <dem/grain/broadphase/hierarchical_grid.hpp>
#include <dem/report/ascii_table.hpp>

#include <CLI/CLI.hpp>

#include <cmath>
#include <ctime>
#include <random>

namespace {

struct Uniform : dem::Model {
  using BroadPhase = dem::broadphase::UniformGrid;
  using Integrator = dem::integrator::SymplecticEuler;
};
struct Levels : Uniform {
  using BroadPhase = dem::broadphase::HierarchicalGrid;
};

struct Settings {
  std::size_t grains = 100'000;
  std::vector<double> ratios = {1, 5, 20};
  int settle = 1000, steps = 200, lists = 2, threads = 1;
};

constexpr double radius = 1e-3;  // m, of the small grains

template <class Model>
dem::World<Model> box(double width, double ratio, int threads) {
  dem::World<Model> world({.time_step = 1e-5, .threads = threads});
  world.set_contact({.normal = {2000, 0.02, 1.0}, .friction = {0.4, 600.0, 0.01, 1.0}});
  const double thick = 0.1, high = 2.0 * width;
  const auto wall = [&](const dem::Vec3& middle, const dem::Vec3& edges) {
    world.add_surface(world.ground(), dem::surface::Box(edges), {.position = middle});
  };
  wall({width / 2, width / 2, -thick / 2}, {width + 2 * thick, width + 2 * thick, thick});
  for (const double side : {-thick / 2, width + thick / 2}) {
    wall({side, width / 2, high / 2}, {thick, width + 2 * thick, high});
    wall({width / 2, side, high / 2}, {width + 2 * thick, thick, high});
  }
  world.add_species(dem::shape::Sphere(radius));
  world.add_species(dem::shape::Sphere(ratio * radius));
  return world;
}

/// A cubical heap: large grains on a lattice of their own, small ones on a tight one where these leave room.
std::vector<dem::NewParticle> loose_heap(std::size_t grains, double ratio, double& width) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.01, 0.01);
  const double r3 = ratio * ratio * ratio, pitch = 2.06 * radius;
  const double large = ratio > 1.0 ? std::max(1.0, std::round(double(grains) / (1.0 + r3))) : 0.0;
  // Small ones in their lattice, large ones in cells of their own; as high as it is wide.
  const double large_pitch = 2.1 * ratio * radius;
  width = std::cbrt((double(grains) - large) * std::pow(pitch, 3) + large * std::pow(large_pitch, 3));
  width = std::max(width, large_pitch);
  std::vector<dem::NewParticle> heap;
  const double n = std::floor(width / large_pitch), cell = width / std::max(n, 1.0);
  for (double k = 0; k < large; ++k) {
    const dem::Vec3 at(std::fmod(k, n) + 0.5, std::fmod(std::floor(k / n), n) + 0.5, std::floor(k / n / n) + 0.5);
    heap.push_back({.species = dem::SpeciesId(1), .position = cell * at});
  }
  const std::size_t of_large = heap.size();
  const double m = std::floor(width / pitch), step = width / m, apart = (ratio + 1.02) * radius;
  for (double k = 0; heap.size() < grains; ++k) {
    const dem::Vec3 at(std::fmod(k, m) + 0.5, std::fmod(std::floor(k / m), m) + 0.5, std::floor(k / m / m) + 0.5);
    const dem::Vec3 x(step * at.x() + shift(random) * radius, step * at.y() + shift(random) * radius, pitch * at.z());
    bool is_free = true;
    for (std::size_t b = 0; b < of_large && is_free; ++b) is_free = (heap[b].position - x).norm() > apart;
    if (is_free) heap.push_back({.species = dem::SpeciesId(0), .position = x});
  }
  return heap;
}

template <class World>
void run_or_fail(World& world, int steps) {
  if (const auto report = world.run(static_cast<std::uint64_t>(steps)); !report) dem::fail("{}", report.text);
}
double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

template <class Model>
void time_grid(const char* name, double ratio, double width, const std::vector<dem::NewParticle>& heap,
               const Settings& s, dem::io::Table& table) {
  auto world = box<Model>(width, ratio, s.threads);
  for (const auto& grain : heap) world.add_particle(grain);
  run_or_fail(world, 1);
  double lists = 0.0;
  for (int k = 0; k < s.lists; ++k) {
    world.state().list_valid = false;
    const double start = cpu_seconds();
    run_or_fail(world, 1);
    lists += (cpu_seconds() - start) / s.lists;
  }
  const auto made = world.state().rebuilds;
  const double start = cpu_seconds();
  run_or_fail(world, s.steps);
  const double seconds = cpu_seconds() - start;
  double candidates = 0.0, contacts = 0.0;
  for (const auto& chunk : world.state().chunks) {
    candidates += double(chunk.candidate.size());
    contacts += chunk.pair_contacts.committed() + chunk.surface_contacts.committed();
  }
  const double n = double(heap.size());
  table.row(dem::text("1:{:g}", ratio), std::to_string(heap.size()), name, lists, candidates / n, contacts / n,
            1e-6 * n * s.steps / seconds, std::to_string(world.state().rebuilds - made),
            std::to_string(dem::memory_bytes(world.state()) / heap.size()));
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  CLI::App app("Mixtures of two sizes, with a uniform and a hierarchical grid");
  app.add_option("--grains", s.grains, "of both sizes together")->capture_default_str();
  app.add_option("--ratios", s.ratios, "of the sizes")->delimiter(',')->check(CLI::Range(1.0, 1000.0));
  app.add_option("--settle", s.settle, "steps before the times are taken")->capture_default_str();
  app.add_option("--steps", s.steps, "that are timed")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--lists", s.lists, "new neighbour lists that are timed")->capture_default_str();
  app.add_option("--threads", s.threads, "of the worlds")->capture_default_str()->check(CLI::Range(1, 64));
  CLI11_PARSE(app, argc, argv);
  try {
    dem::io::Table table{.header = {"sizes", "grains", "grid", "CPU s a list", "candidates a grain", "contacts a grain",
                                    "million grain-steps/CPU s", "lists made", "bytes a grain"},
                         .digits = 3};
    for (const double ratio : s.ratios) {
      double width = 0.0;
      std::vector<dem::NewParticle> heap = loose_heap(s.grains, ratio, width);
      auto world = box<Levels>(width, ratio, s.threads);
      for (const auto& grain : heap) world.add_particle(grain);
      run_or_fail(world, s.settle);
      for (std::size_t k = 0; k < heap.size(); ++k) {
        const dem::ParticleId p(k);
        heap[k].position = world.position(p), heap[k].velocity = world.velocity(p);
      }
      time_grid<Levels>("hierarchical", ratio, width, heap, s, table);
      time_grid<Uniform>("uniform", ratio, width, heap, s, table);
      print(table);  // as far as it is
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "mixed_sizes: {}\n", error.what());
    return 1;
  }
}
