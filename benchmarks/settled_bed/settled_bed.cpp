// Whole-scene benchmark: settled beds of cubes and of spheres, of 4,000 grains and of many more, timed for a number of
// steps and threads. With --one a single bed, as large as those of other programs in benchmarks/RESULTS.md; with
// --shape one of other cubes. The laws are theirs: linear spring and dashpot, restitution 0.3, friction 0.4 with
// history.

#include "timing.hpp"
#include "works.hpp"

#include <dem/dem.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/shapes.hpp>
#include <dem/report/ascii_table.hpp>

#include <CLI/CLI.hpp>

#include <exception>

namespace {

using namespace bench;

struct SharpCubes : Cubes {
  using Shape = dem::shape::Polyhedron;
  static Shape grain() { return dem::shape::cube(1.2e-3); }
};
/// Rounded cubes as wide as those of spheres, with a contact a pair or with points.
template <class S>
struct RoundedCubes : Cubes {
  using Shape = S;
  static Shape grain() { return Shape(dem::Vec3::Constant(1.2e-3), dem::Vec3::Constant(8)); }
};
struct Superquadrics : RoundedCubes<dem::shape::Superquadric> {};
struct Points : RoundedCubes<dem::shape::SuperquadricPoints> {
  static Shape grain() { return Shape(dem::Vec3::Constant(1.2e-3), dem::Vec3::Constant(8), 4); }
};

template <class Model>
void run(const char* name, const Settings& settings) {
  dem::World<Model> world = loose_bed<Model>(settings);
  const int most_threads = settings.threads > 0 ? settings.threads : world.threads();
  world.set_threads(most_threads);
  fmt::print("{}: settling {} grains for {} steps\n", name, Model::grains, settings.settle);
  run_or_fail(world, settings.settle);

  double energy = 0.0;
  std::size_t contacts = 0, wall_contacts = 0;
  for (int k = 0; k < Model::grains; ++k) {
    const dem::GrainId p{static_cast<std::size_t>(k)};
    energy += 0.5 * world.species(world.species_of(p)).mass * world.velocity(p).squaredNorm();
  }
  for (const auto& chunk : world.state().chunks) {
    contacts += static_cast<std::size_t>(chunk.pair_contacts.committed());
    wall_contacts += static_cast<std::size_t>(chunk.surface_contacts.committed());
  }
  fmt::print("kinetic energy {:.2g} J, {} contacts and {} wall contacts ({:.2f} a grain), {} bytes a grain\n", energy,
             contacts, wall_contacts, double(contacts + wall_contacts) / Model::grains,
             dem::memory_bytes(world.state()) / Model::grains);

  dem::io::Table table;
  table.header = {"threads", "million grain-steps/s", "lowest", "highest", "ratio", "per CPU second", "lists made"};
  for (const char* phase : dem::phase_names) table.header.push_back(fmt::format("{}, us/step", phase));
  const std::vector<Timing> timings = time_in_turn(world, settings, most_threads, settings.steps);
  for (const Timing& t : timings) {
    std::vector<std::string> row = {fmt::format("{}", t.threads),
                                    fmt::format("{:.2f}", t.rate()),
                                    fmt::format("{:.2f}", *std::min_element(t.rates.begin(), t.rates.end())),
                                    fmt::format("{:.2f}", *std::max_element(t.rates.begin(), t.rates.end())),
                                    fmt::format("{:.2f}", t.rate() / timings.front().rate()),
                                    fmt::format("{:.2f}", median(t.per_cpu_second)),
                                    fmt::format("{}", t.lists)};
    for (const double seconds : t.phases) {
      row.push_back(fmt::format("{:.1f}", 1e6 * seconds / settings.repeats / settings.steps));
    }
    table.rows.push_back(row);
  }
  print(table);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  bool one = false;
  CLI::App app("Times settled beds of cubes and of spheres.");
  app.add_flag("--one", one, "a single bed of 4,000 cubes or 20,000 spheres, as other programs have it");
  app.add_option("--work", settings.work, "cubes, spheres or both")->check(CLI::IsMember({"cubes", "spheres", "both"}));
  const auto* const shape =
      app.add_option(
             "--shape", settings.shape,
             "of the cubes of a single bed: cube8 (eight spheres), polyhedron, superquadric (one contact a pair) "
             "or points")
          ->check(CLI::IsMember({"cube8", "polyhedron", "superquadric", "points"}));
  app.add_option("--steps", settings.steps, "steps that are timed")->check(CLI::PositiveNumber);
  app.add_option("--settle", settings.settle, "steps to settle first")->check(CLI::NonNegativeNumber);
  app.add_option("--repeats", settings.repeats,
                 "how often the steps are timed with each number of threads, in turn; the median counts")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", settings.threads, "most threads (0: all); 1, 2, 4 ... are timed too")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--least-threads", settings.least_threads, "fewest threads")->check(CLI::PositiveNumber);
  app.add_option("--skin", settings.skin, "reach of the neighbour list in m (0: automatic)")
      ->check(CLI::NonNegativeNumber);
  app.add_option(
         "--sizes", settings.sizes,
         "grains of beds of cubes and of spheres: boxes of 4,000 beside each other, so that only their number differs. "
         "--settle is of the first box, --steps of the first size: larger ones are timed for fewer, at least 100 if "
         "--steps is no less")
      ->delimiter(',')
      ->default_str("4000,40000,300000,2000000")
      ->excludes("--one")
      ->excludes("--shape")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
  app.add_flag("--flow", settings.flow, "the beds flow: gravity has been tilted by 45 degrees for 3,000 steps")
      ->excludes("--one")
      ->excludes("--shape");
  CLI11_PARSE(app, argc, argv);
  try {
    if (settings.threads > 0 && settings.least_threads > settings.threads) {
      dem::fail("--least-threads is {}, but --threads is {}; give no more than that", settings.least_threads,
                settings.threads);
    }
    if (!one && shape->empty()) {
      time_sizes(settings);
      return 0;
    }
    const bool cubes = settings.work != "spheres";
    if (cubes && settings.shape == "cube8") run<Cubes>("cubes", settings);
    if (cubes && settings.shape == "polyhedron") run<SharpCubes>("polyhedra", settings);
    if (cubes && settings.shape == "superquadric") run<Superquadrics>("superquadrics, one contact a pair", settings);
    if (cubes && settings.shape == "points") run<Points>("superquadrics, 98 points each", settings);
    if (settings.work != "cubes") run<Spheres>("spheres", settings);
  } catch (const std::exception& error) {
    fmt::print(stderr, "settled_bed: {}\n", error.what());
    return 1;
  }
}
