// Beds of 4,000 grains and of many more. A box of 4,000 grains is settled once, and put beside itself as often as the
// size asks for, with its velocities. So a grain of the largest bed has the surroundings of one of the smallest.

#include "boxes.hpp"

#include <dem/dem.hpp>
#include <dem/report/ascii_table.hpp>

#include <cstdio>
#include <ctime>

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
    double fewest_threads = 0.0;
    std::size_t count = 0;
    for (const int threads : thread_counts(settings.least_threads, most_threads)) {
      world.set_threads(threads);
      run_or_fail(world, 20);
      std::vector<double> rates, per_cpu_second;
      double took = 0.0;  // s
      const std::uint64_t lists = world.state().rebuilds;
      world.state().stopwatch.switch_on(true);
      for (int k = 0; k < settings.repeats; ++k) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t cpu = std::clock();
        run_or_fail(world, steps);
        const double done = 1e-6 * double(grains) * steps;
        const double seconds = Seconds(std::chrono::steady_clock::now() - start).count();
        took += seconds;
        rates.push_back(done / seconds);
        per_cpu_second.push_back(done * CLOCKS_PER_SEC / double(std::clock() - cpu));
      }
      const double rate = median(rates), cpu_rate = median(per_cpu_second);
      if (count == 0) fewest_threads = rate;
      if (of_first.size() == count) of_first.push_back(rate);
      const std::uint64_t made = world.state().rebuilds - lists;
      const double lists_took = world.state().stopwatch.seconds(dem::Phase::neighbours);
      const double list = lists_took / double(std::max(made, 1ul));
      const double step =
          1e9 * world.state().stopwatch.seconds(dem::Phase::grains) / (double(grains) * steps * settings.repeats);
      table.row(grains, threads, rate, *std::min_element(rates.begin(), rates.end()),
                *std::max_element(rates.begin(), rates.end()), rate / fewest_threads, cpu_rate, rate / of_first[count],
                step, made, list, 100.0 * lists_took / took, contacts_a_grain(world),
                std::to_string(dem::memory_bytes(world.state()) / grains));
      world.state().stopwatch.switch_on(false);
      ++count;
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
