#pragma once

// How fast a world is with different numbers of threads.

#include "works.hpp"

#include <dem/world/memory.hpp>

#include <array>
#include <chrono>
#include <ctime>

namespace bench {

/// What was measured with one number of threads.
struct Timing {
  int threads = 1;
  std::vector<double> rates;           ///< million grain-steps per second, a value each time
  std::vector<double> per_cpu_second;  ///< and per second of the processors: steadier where other programs run too
  double took = 0.0;                   ///< s, all times together, like what follows
  std::uint64_t lists = 0;
  std::array<double, dem::phase_names.size()> phases{};  ///< s
  double contacts = 0.0;                                 ///< a grain, in the mean over the times

  double rate() const { return median(rates); }
};

/// Times so many steps with each number of threads in turn, again and again: beds that fall or flow change while they
/// are timed, and so does what else the machine does.
template <class Model>
std::vector<Timing> time_in_turn(dem::World<Model>& world, const Settings& settings, int most_threads, int steps) {
  std::vector<Timing> timings;
  for (const int threads : thread_counts(settings.least_threads, most_threads)) timings.push_back({threads});
  const double work = 1e-6 * double(world.grain_count()) * steps;
  auto& watch = world.state().stopwatch;
  for (int k = 0; k < settings.repeats; ++k) {
    for (Timing& t : timings) {
      world.set_threads(t.threads);
      run_or_fail(world, 20);
      const std::uint64_t lists = world.state().rebuilds;
      watch.switch_on(true);
      const auto start = std::chrono::steady_clock::now();
      const std::clock_t cpu = std::clock();
      run_or_fail(world, steps);
      const double seconds = Seconds(std::chrono::steady_clock::now() - start).count();
      t.took += seconds;
      t.rates.push_back(work / seconds);
      t.per_cpu_second.push_back(work * CLOCKS_PER_SEC / double(std::clock() - cpu));
      t.lists += world.state().rebuilds - lists;
      for (std::size_t p = 0; p < t.phases.size(); ++p) t.phases[p] += watch.seconds(static_cast<dem::Phase>(p));
      t.contacts += contacts_a_grain(world) / settings.repeats;
      watch.switch_on(false);
    }
  }
  return timings;
}

}  // namespace bench
