// Mixtures of two sizes of spheres: what neighbour lists cost with a uniform grid, whose cells are as large as the
// largest grain's reach, and with a hierarchical one; and, with --steps, what a step of such a world costs. Half of the
// solid volume is large grains.

#include <dem/dem.hpp>
#include <dem/grain/broadphase/hierarchical_grid.hpp>
#include <dem/grain/broadphase/uniform_grid.hpp>
#include <dem/math/random.hpp>
#include <dem/report/ascii_table.hpp>
#include <dem/world/contacts.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>

namespace {

constexpr double radius = 1e-3, skin = 0.14e-3;  // m, of the small grains

struct Heap {
  std::vector<double> x = {}, y = {}, z = {}, radius_of_kind = {};
  std::vector<std::uint32_t> kind = {};
  void add(std::uint32_t k, const dem::Vec3& p) {
    x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z()), kind.push_back(k);
  }
  dem::broadphase::Positions positions() const { return {x.data(), y.data(), z.data(), x.size()}; }
  dem::broadphase::Sizes sizes() const { return {radius_of_kind, kind.data(), skin}; }
  double largest_reach() const { return 2.0 * radius_of_kind.back() + skin; }
  /// Rows are put in this order, as a world does.
  void put_in_order(std::vector<std::uint32_t> order) {
    const Heap old = *this;
    for (std::size_t k = 0; k < order.size(); ++k) {
      x[k] = old.x[order[k]], y[k] = old.y[order[k]], z[k] = old.z[order[k]], kind[k] = old.kind[order[k]];
    }
  }
};

/// A cubical heap: large grains on a lattice of their own, small ones on a tight one where these leave room.
Heap heap_of(std::size_t grains, double ratio) {
  dem::RandomStream random(7);
  Heap heap{.radius_of_kind = {radius, ratio * radius}};
  const double pitch = 2.06 * radius, large_pitch = 2.1 * ratio * radius;
  const double large = ratio > 1.0 ? std::max(1.0, std::round(double(grains) / (1.0 + std::pow(ratio, 3)))) : 0.0;
  const double volume = (double(grains) - large) * std::pow(pitch, 3) + large * std::pow(large_pitch, 3);
  const double width = std::max(std::cbrt(volume), large_pitch);
  const double n = std::floor(width / large_pitch), cell = width / n;
  std::vector<dem::Vec3> places;
  const auto of_lattice = [](double k, double a_row) {
    return dem::Vec3(std::fmod(k, a_row) + 0.5, std::fmod(std::floor(k / a_row), a_row) + 0.5,
                     std::floor(k / a_row / a_row) + 0.5);
  };
  for (double k = 0; k < large; ++k) {
    places.push_back(cell * of_lattice(k, n));
    heap.add(1, places.back());
  }
  const double m = std::floor(width / pitch), step = width / m, apart = (ratio + 1.0) * radius;
  for (double k = 0; heap.x.size() < grains; ++k) {
    const dem::Vec3 at = of_lattice(k, m);
    const dem::Vec3 x = dem::Vec3(step * at.x(), step * at.y(), pitch * at.z()) + random.in_ball(0.03 * radius);
    const bool is_free = std::none_of(places.begin(), places.end(),
                                      [&](const dem::Vec3& p) { return (p - x).squaredNorm() < apart * apart; });
    if (is_free) heap.add(0, x);
  }
  return heap;
}

/// Builds the grid and looks all candidates up one by one.
template <class Grid>
void time_grid(const char* name, Heap heap, double ratio, int repeats, dem::io::Table& table) {
  Grid grid;
  const auto build = [&] {
    if constexpr (dem::broadphase::KnowsSizes<Grid>) grid.build(heap.positions(), heap.sizes());
    else grid.build(heap.positions(), heap.largest_reach());
  };
  build();
  heap.put_in_order({grid.order().begin(), grid.order().end()});
  double building = 0.0, looking = 0.0;
  std::size_t tried = 0, near = 0;
  for (int k = 0; k < repeats; ++k) {
    const std::clock_t start = std::clock();
    build();
    const std::clock_t built = std::clock();
    tried = near = 0;
    auto finder = grid.finder();
    for (std::size_t i = 0; i < heap.x.size(); ++i) {
      const double x = heap.x[i], y = heap.y[i], z = heap.z[i], r = heap.radius_of_kind[heap.kind[i]] + skin;
      finder.for_each_candidate(i, [&](std::uint32_t j) {
        const double dx = heap.x[j] - x, dy = heap.y[j] - y, dz = heap.z[j] - z;
        const double reach = r + heap.radius_of_kind[heap.kind[j]];
        ++tried;
        near += dx * dx + dy * dy + dz * dz < reach * reach;
      });
    }
    building += double(built - start) / CLOCKS_PER_SEC / repeats;
    looking += double(std::clock() - built) / CLOCKS_PER_SEC / repeats;
  }
  const double n = double(heap.x.size());
  table.row(dem::text("1:{:g}", ratio), std::to_string(heap.x.size()), name, building, looking,
            1e6 * (building + looking) / n, double(tried) / n, double(near) / n);
}

template <class Grid>
struct Mixture : dem::Model {
  using BroadPhase = Grid;
  using Integrator = dem::integrator::SymplecticEuler;
};

/// The heap in a box, which settles for so many steps and is timed for as many again, on one thread.
template <class Grid>
void time_world(const char* name, const Heap& heap, double ratio, std::uint64_t steps, dem::io::Table& table) {
  dem::World<Mixture<Grid>> world({.gravity = {0, 0, -9.81}, .threads = 1});
  world.set_contact(
      {.normal = {.stiffness = 2e4, .damping = 0.1, .separation_factor = 1},
       .friction = {.coefficient = 0.4, .stiffness = 2e4, .velocity_stiffness = 0.05, .breaking_factor = 1}});
  const auto largest = [&](const std::vector<double>& at) {
    double far = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i) far = std::max(far, at[i] + heap.radius_of_kind[heap.kind[i]]);
    return far;
  };
  const double width = std::max(largest(heap.x), largest(heap.y)), height = 1.2 * largest(heap.z), wall = 0.05;
  const auto box = [&](const dem::Vec3& low, const dem::Vec3& high) {
    world.add_surface(world.ground(), dem::surface::Box(high - low), {.position = 0.5 * (low + high)});
  };
  box({-wall, -wall, -wall}, {width + wall, width + wall, 0.0});
  box({-wall, -wall, 0.0}, {0.0, width + wall, height});
  box({width, -wall, 0.0}, {width + wall, width + wall, height});
  box({0.0, -wall, 0.0}, {width, 0.0, height});
  box({0.0, width, 0.0}, {width, width + wall, height});
  std::vector<dem::SpeciesId> species;
  for (const double r : heap.radius_of_kind) species.push_back(world.add_species(dem::shape::Sphere(r)));
  for (std::size_t i = 0; i < heap.x.size(); ++i)
    world.add_grain({species[heap.kind[i]], {heap.x[i], heap.y[i], heap.z[i]}});
  const auto run = [&] {
    if (const auto report = world.run(steps); !report) dem::fail("{}", report.text);
  };
  run();
  const std::uint64_t lists = world.state().rebuilds;
  const std::clock_t start = std::clock();
  run();
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC, n = double(heap.x.size());
  table.row(dem::text("1:{:g}", ratio), std::to_string(heap.x.size()), name, 1e-6 * n * double(steps) / seconds,
            double(world.state().rebuilds - lists), double(dem::contacts_of(world).size()) / n);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::size_t> grains = {10'000, 100'000};
  std::vector<double> ratios = {1, 5, 20};
  int repeats = 3;
  std::uint64_t steps = 0;
  CLI::App app("Neighbour lists of mixtures of two sizes, with a uniform and a hierarchical grid");
  app.add_option("--grains", grains, "of both sizes together")->delimiter(',')->check(CLI::Range(1000, 10'000'000));
  app.add_option("--ratios", ratios, "of the sizes")->delimiter(',')->check(CLI::Range(1.0, 1000.0));
  app.add_option("--repeats", repeats, "lists that the times are means of")->check(CLI::Range(1, 1000));
  app.add_option("--steps", steps, "of worlds, as many to settle and to be timed; 0: lists alone");
  CLI11_PARSE(app, argc, argv);
  try {
    dem::io::Table table{.header = {"sizes", "grains", "grid", "CPU s to build", "to look up", "us a grain",
                                    "pairs tried a grain", "candidates a grain"},
                         .digits = 3};
    for (const std::size_t n : grains) {
      for (const double ratio : ratios) {
        const Heap heap = heap_of(n, ratio);
        time_grid<dem::broadphase::HierarchicalGrid>("hierarchical", heap, ratio, repeats, table);
        time_grid<dem::broadphase::UniformGrid>("uniform", heap, ratio, repeats, table);
      }
      print(table);  // as far as it is
    }
    if (steps == 0) return 0;
    dem::io::Table of_worlds{
        .header = {"sizes", "grains", "grid", "million grain-steps/CPU s", "lists", "contacts a grain"}, .digits = 3};
    for (const std::size_t n : grains) {
      for (const double ratio : ratios) {
        const Heap heap = heap_of(n, ratio);
        time_world<dem::broadphase::HierarchicalGrid>("hierarchical", heap, ratio, steps, of_worlds);
        time_world<dem::broadphase::UniformGrid>("uniform", heap, ratio, steps, of_worlds);
        print(of_worlds);
      }
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "mixed_sizes: {}\n", error.what());
    return 1;
  }
}
