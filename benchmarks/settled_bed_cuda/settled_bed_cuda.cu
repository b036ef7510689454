// Settled beds of cubes and of spheres on one GPU: whether a step there is the ordinary one, and how many grains it
// moves in a second. The works are those of settled_bed, which times the same beds on a processor.
//
//     settled_bed_cuda [--check] [--grains n] [--steps n] [--settle n] [--sizes n,n,...] [--work cubes|spheres]
//
// Without a GPU it says so and returns 77.

#include "checks.hpp"
#include "traffic.hpp"

#include <dem/flat/cuda.hpp>

#include <cstdlib>
#include <cstring>
#include <string>

namespace {

struct CubesOnGpu : bench::Cubes {
  using Executor = dem::exec::Cuda;
};
struct SpheresOnGpu : bench::Spheres {
  using Executor = dem::exec::Cuda;
};

struct Arguments {
  bool only_checks = false;
  int grains = 4000, steps = 2000;  // of the checks; of the smallest bed
  int settle = 30000;
  std::vector<std::size_t> sizes = {4000, 40000, 300000, 1000000, 2000000};
  std::string work = "both";
};

/// Bytes a second that a copy within the GPU's memory reads and writes, counted together.
double copy_bandwidth() {
  constexpr std::size_t bytes = std::size_t{1} << 30;
  dem::cuda::Array<char> from, to;
  from.make_room(bytes);
  to.make_room(bytes);
  cudaEvent_t begin, end;
  dem::cuda::check(cudaEventCreate(&begin), "an event is made");
  dem::cuda::check(cudaEventCreate(&end), "an event is made");
  std::vector<double> rates;
  for (int k = 0; k < 8; ++k) {
    dem::cuda::check(cudaEventRecord(begin), "an event is set");
    dem::cuda::check(cudaMemcpyAsync(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice), "a copy");
    dem::cuda::check(cudaEventRecord(end), "an event is set");
    dem::cuda::check(cudaEventSynchronize(end), "a copy");
    float milliseconds = 0.0f;
    dem::cuda::check(cudaEventElapsedTime(&milliseconds, begin, end), "events are read");
    if (k > 2) rates.push_back(2e3 * double(bytes) / double(milliseconds));
  }
  cudaEventDestroy(begin), cudaEventDestroy(end);
  return bench::median(rates);
}

template <class Model>
void print_profile(dem::World<Model>& world, int steps) {
  auto& profile = world.state().executor.profile();
  profile.switch_on(true);
  bench::run_or_fail(world, steps);
  double sum = 0.0;
  for (const auto& e : profile.entries()) sum += e.seconds;
  for (const auto& e : profile.entries()) {
    std::printf("    %-28s %8.1f us a step, %4.1f %%\n", e.name.c_str(), 1e6 * e.seconds / steps,
                100.0 * e.seconds / sum);
  }
  std::printf("    %-28s %8.1f us a step\n", "all kernels", 1e6 * sum / steps);
  profile.switch_on(false);
}

template <class Model>
void time_beds(const char* name, const Arguments& arguments, double bandwidth) {
  const bench::Settings settings;
  const double width = Model::width * bench::per_row / Model::per_row;
  dem::World<Model> one = bench::loose_bed<Model>(settings, bench::grains_a_box, bench::per_row, width);
  const auto settling = std::chrono::steady_clock::now();
  bench::run_or_fail(one, arguments.settle);
  std::printf("%s: a box of %d grains settled for %d steps in %.2f s, %llu lists\n", name, bench::grains_a_box,
              arguments.settle, bench::Seconds(std::chrono::steady_clock::now() - settling).count(),
              static_cast<unsigned long long>(one.state().rebuilds));
  for (const std::size_t grains : arguments.sizes) {
    const auto making = std::chrono::steady_clock::now();
    dem::World<Model> world = bench::boxes(one, grains, width, settings);
    bench::run_or_fail(world, 200);  // friction springs are loaded anew
    const double made = bench::Seconds(std::chrono::steady_clock::now() - making).count();
    const double share = double(arguments.sizes.front()) / double(grains);
    const int steps = std::max(100, static_cast<int>(arguments.steps * share));
    std::vector<double> rates;
    const std::uint64_t lists = world.state().rebuilds;
    for (int k = 0; k < 3; ++k) {
      // The difference of a long and a short run: what takes the grains to the GPU and back is in both.
      const auto start = std::chrono::steady_clock::now();
      bench::run_or_fail(world, 1);
      const auto between = std::chrono::steady_clock::now();
      bench::run_or_fail(world, 1 + steps);
      const auto end = std::chrono::steady_clock::now();
      rates.push_back(double(grains) * steps / bench::Seconds((end - between) - (between - start)).count());
    }
    const std::uint64_t lists_made = world.state().rebuilds - lists;
    const double rate = bench::median(rates), step = double(grains) / rate;
    const double bytes = bench::bytes_of_a_step(world);
    std::printf(
        "%s: %9zu grains: %7.1f million grain-steps/s (%.1f to %.1f), %.1f us a step, %.2f contacts and %.2f "
        "candidates a grain, at least %.0f bytes a grain and step, %.0f %% of the bandwidth of a copy; %llu lists in "
        "%d steps; made in %.1f s\n",
        name, grains, 1e-6 * rate, 1e-6 * *std::min_element(rates.begin(), rates.end()),
        1e-6 * *std::max_element(rates.begin(), rates.end()), 1e6 * step, bench::contacts_a_grain(world),
        double(bench::candidates(world)) / double(grains), bytes / double(grains), 100.0 * bytes / step / bandwidth,
        static_cast<unsigned long long>(lists_made), 3 * (steps + 2), made);
    print_profile(world, std::max(20, steps / 20));
  }
}

std::vector<std::size_t> numbers(const char* text) {
  std::vector<std::size_t> result;
  for (char* end = nullptr;; text = end + 1) {
    result.push_back(std::strtoull(text, &end, 10));
    if (*end != ',') return result;
  }
}

Arguments read(int argc, char** argv) {
  Arguments a;
  for (int k = 1; k < argc; ++k) {
    const auto is = [&](const char* name) { return std::strcmp(argv[k], name) == 0; };
    const bool has_value = k + 1 < argc;
    if (is("--check")) a.only_checks = true;
    else if (is("--grains") && has_value) a.grains = std::atoi(argv[++k]);
    else if (is("--steps") && has_value) a.steps = std::atoi(argv[++k]);
    else if (is("--settle") && has_value) a.settle = std::atoi(argv[++k]);
    else if (is("--sizes") && has_value) a.sizes = numbers(argv[++k]);
    else if (is("--work") && has_value) a.work = argv[++k];
    else dem::fail("'{}' is no option; there are --check, --grains, --steps, --settle, --sizes and --work", argv[k]);
  }
  return a;
}

int run(const Arguments& a) {
  cudaDeviceProp properties;
  dem::cuda::check(cudaGetDeviceProperties(&properties, 0), "the GPU is asked");
  std::printf("%s, %.1f GiB, %d multiprocessors\n", properties.name, double(properties.totalGlobalMem) / (1 << 30),
              properties.multiProcessorCount);
  const bool cubes = a.work != "spheres", spheres = a.work != "cubes";
  bool good = true;
  if (spheres) good = bench::check<SpheresOnGpu>("spheres", a.grains, a.steps) && good;
  if (cubes) good = bench::check<CubesOnGpu>("cubes", a.grains, a.steps) && good;
  if (a.only_checks) return good ? 0 : 1;
  const double bandwidth = copy_bandwidth();
  std::printf("a copy within the GPU's memory reads and writes %.0f GB/s\n", 1e-9 * bandwidth);
  if (spheres) time_beds<SpheresOnGpu>("spheres", a, bandwidth);
  if (cubes) time_beds<CubesOnGpu>("cubes", a, bandwidth);
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (dem::exec::Cuda::devices() == 0) {
    std::printf("no GPU: skipped\n");
    return 77;
  }
  try {
    return run(read(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "settled_bed_cuda: %s\n", error.what());
    return 1;
  }
}
