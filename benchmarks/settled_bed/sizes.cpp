// Beds of 4,000 grains and of many more. A box of 4,000 grains is settled once, and put beside itself as often as the
// size asks for, with its velocities. So a grain of the largest bed has the surroundings of one of the smallest.

#include "boxes.hpp"
#include "timing.hpp"

#include <dem/dem.hpp>
#include <dem/report/ascii_table.hpp>

#include <cstdio>

namespace bench {

namespace {

/// Bytes that this machine can still give, as Linux counts them; 0 where nobody knows.
double free_bytes() {
  std::FILE* file = std::fopen("/proc/meminfo", "r");
  if (file == nullptr) return 0.0;
  char line[128];
  double kilobytes = 0.0;
  while (std::fgets(line, sizeof line, file) != nullptr) {
    if (std::sscanf(line, "MemAvailable: %lf kB", &kilobytes) == 1) break;
  }
  std::fclose(file);
  return 1024.0 * kilobytes;
}

/// Refuses a bed that does not fit, with what making a list and a copy of a column take besides.
void check_memory(std::size_t grains, double bytes_a_grain) {
  const double needed = 1.3 * bytes_a_grain * static_cast<double>(grains), there = free_bytes();
  if (there > 0.0 && needed > 0.9 * there) {
    dem::fail("a bed of {} grains needs {:.3g} GB of memory, but only {:.3g} GB are free; give smaller --sizes", grains,
              1e-9 * needed, 1e-9 * there);
  }
}

template <class Model>
void run(const char* name, const Settings& settings) {
  const double width = Model::width * per_row / Model::per_row;
  dem::World<Model> one = loose_bed<Model>(settings, grains_a_box, per_row, width);
  const int most_threads = settings.threads > 0 ? settings.threads : one.threads();
  one.set_threads(most_threads);
  fmt::print("{}: settling a box of {} grains for {} steps\n", name, grains_a_box, settings.settle);
  run_or_fail(one, settings.settle);
  if (settings.flow) {
    one.set_gravity(tilted());
    run_or_fail(one, 3000);
  }
  const double bytes_a_grain = double(dem::memory_bytes(one.state())) / grains_a_box;

  dem::io::Table table{
      .header = {"grains", "threads", "million grain-steps/s", "lowest", "highest", "ratio", "per CPU second",
                 "of the first size", "contacts and motion, ns a grain", "lists made", "s a list",
                 "lists, % of the time", "contacts a grain", "bytes a grain"},
      .digits = 3};
  std::vector<double> of_first;  // by numbers of threads
  for (const std::size_t grains : settings.sizes) {
    check_memory(grains, bytes_a_grain);
    dem::World<Model> world = boxes(one, grains, width, settings);
    world.set_threads(most_threads);
    run_or_fail(world, 200);  // friction springs are loaded anew
    // As much work as --steps of the first size.
    const double share = double(settings.sizes.front()) / double(grains);
    const int steps = std::max(std::min(100, settings.steps), static_cast<int>(settings.steps * share));
    const std::vector<Timing> timings = time_in_turn(world, settings, most_threads, steps);
    for (std::size_t k = 0; k < timings.size(); ++k) {
      const Timing& t = timings[k];
      if (of_first.size() == k) of_first.push_back(t.rate());
      const double lists_took = t.phases[std::size_t(dem::Phase::neighbours)];
      const double list = lists_took / double(std::max(t.lists, std::uint64_t{1}));
      const double step = 1e9 * t.phases[std::size_t(dem::Phase::grains)] / (double(grains) * steps * settings.repeats);
      table.row(grains, t.threads, t.rate(), *std::min_element(t.rates.begin(), t.rates.end()),
                *std::max_element(t.rates.begin(), t.rates.end()), t.rate() / timings.front().rate(),
                median(t.per_cpu_second), t.rate() / of_first[k], step, t.lists, list, 100.0 * lists_took / t.took,
                t.contacts, std::to_string(dem::memory_bytes(world.state()) / grains));
    }
    print(table);  // as far as it is: the next size may take long
  }
}

}  // namespace

void time_sizes(const Settings& settings) {
  if (settings.work != "spheres") run<Cubes>("cubes", settings);
  if (settings.work != "cubes") run<Spheres>("spheres", settings);
}

}  // namespace bench
