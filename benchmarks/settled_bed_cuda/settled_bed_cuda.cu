// Settled beds of cubes and of spheres on one GPU: whether a step there is the ordinary one, and how many grains it
// moves in a second. The works are those of settled_bed, which times the same beds on a processor.
//
//     settled_bed_cuda [--check] [--grains n] [--steps n] [--settle n] [--sizes n,n,...] [--work cubes|spheres]
//                      [--seconds s]
//
// After so many seconds no larger bed is begun. Without a GPU it says so and returns 77.

#include "checks.hpp"
#include "traffic.hpp"

#include <dem/flat/cuda.hpp>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <optional>
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
  double seconds = 1e9;
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

/// Times beds of one kind of grain, all made of one box that settles first.
template <class Model>
class Beds {
 public:
  Beds(const char* name, const Arguments& arguments, double bandwidth)
      : name_(name),
        arguments_(arguments),
        bandwidth_(bandwidth),
        one_(bench::loose_bed<Model>(settings_, bench::grains_a_box, bench::per_row, width())) {
    const auto start = Clock::now();
    bench::run_or_fail(one_, arguments.settle);
    std::printf("%s: a box of %d grains settled for %d steps in %.2f s, %llu lists\n", name, bench::grains_a_box,
                arguments.settle, bench::Seconds(Clock::now() - start).count(),
                static_cast<unsigned long long>(one_.state().rebuilds));
  }

  void time(std::size_t grains) {
    const auto making = Clock::now();
    dem::World<Model> world = bench::boxes(one_, grains, width(), settings_);
    bench::run_or_fail(world, 200);  // friction springs are loaded anew
    const double made = bench::Seconds(Clock::now() - making).count();
    const double share = double(arguments_.sizes.front()) / double(grains);
    const int steps = std::max(100, static_cast<int>(arguments_.steps * share));
    std::vector<double> rates, there_and_back;
    const std::uint64_t lists = world.state().rebuilds;
    for (int k = 0; k < 3; ++k) {
      // From the end of the first step on: what takes the grains to the GPU and back is not the step's.
      const auto start = Clock::now();
      auto first = start, last = start;
      int done = 0;
      const auto report = world.run(static_cast<std::uint64_t>(steps) + 1, [&] {
        last = Clock::now();
        if (done++ == 0) first = last;
        return true;
      });
      if (!report) dem::fail("{}", report.text);
      there_and_back.push_back(bench::Seconds((Clock::now() - last) + (first - start)).count());
      rates.push_back(double(grains) * steps / bench::Seconds(last - first).count());
    }
    const std::uint64_t lists_made = world.state().rebuilds - lists;
    const double rate = bench::median(rates), step = double(grains) / rate;
    const double bytes = bench::bytes_of_a_step(world);
    std::printf(
        "%s: %9zu grains: %7.1f million grain-steps/s (%.1f to %.1f), %.1f us a step, %.2f contacts and %.2f "
        "candidates a grain, at least %.0f bytes a grain and step, %.0f %% of the bandwidth of a copy; %llu lists in "
        "%d steps; made in %.1f s, brought there and back in %.3f s\n",
        name_, grains, 1e-6 * rate, 1e-6 * *std::min_element(rates.begin(), rates.end()),
        1e-6 * *std::max_element(rates.begin(), rates.end()), 1e6 * step, bench::contacts_a_grain(world),
        double(bench::candidates(world)) / double(grains), bytes / double(grains), 100.0 * bytes / step / bandwidth_,
        static_cast<unsigned long long>(lists_made), 3 * (steps + 1), made, bench::median(there_and_back));
    print_profile(world, std::max(20, steps / 20));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double width() { return Model::width * bench::per_row / Model::per_row; }

  const char* name_;
  const Arguments& arguments_;
  double bandwidth_;
  bench::Settings settings_;
  dem::World<Model> one_;
};

/// Whole numbers with commas between them, from 1 on.
std::vector<std::size_t> numbers(const char* text) {
  std::vector<std::size_t> result;
  const char* at = text;
  for (char* end = nullptr;; at = end + 1) {
    result.push_back(std::strtoull(at, &end, 10));
    if (end == at || *at == '-' || result.back() == 0 || (*end != ',' && *end != '\0')) {
      dem::fail("'{}' must be whole numbers from 1 on, with commas between them", text);
    }
    if (*end == '\0') return result;
  }
}
int number(const char* text) {
  const auto all = numbers(text);
  if (all.size() != 1 || all[0] > 1'000'000'000) dem::fail("'{}' must be a whole number from 1 to 1e9", text);
  return static_cast<int>(all[0]);
}

Arguments read(int argc, char** argv) {
  Arguments a;
  for (int k = 1; k < argc; ++k) {
    const auto is = [&](const char* name) { return std::strcmp(argv[k], name) == 0; };
    const bool has_value = k + 1 < argc;
    if (is("--check")) a.only_checks = true;
    else if (is("--grains") && has_value) a.grains = number(argv[++k]);
    else if (is("--steps") && has_value) a.steps = number(argv[++k]);
    else if (is("--settle") && has_value) a.settle = number(argv[++k]);
    else if (is("--sizes") && has_value) a.sizes = numbers(argv[++k]);
    else if (is("--work") && has_value) a.work = argv[++k];
    else if (is("--seconds") && has_value) a.seconds = std::atof(argv[++k]);
    else
      dem::fail("'{}' is no option; there are --check, --grains, --steps, --settle, --sizes, --work and --seconds",
                argv[k]);
  }
  if (a.work != "both" && a.work != "cubes" && a.work != "spheres") {
    dem::fail("--work is '{}', but must be cubes, spheres or both", a.work);
  }
  return a;
}

int run(const Arguments& a) {
  const auto start = std::chrono::steady_clock::now();
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
  std::optional<Beds<SpheresOnGpu>> of_spheres;
  std::optional<Beds<CubesOnGpu>> of_cubes;
  if (spheres) of_spheres.emplace("spheres", a, bandwidth);
  if (cubes) of_cubes.emplace("cubes", a, bandwidth);
  for (const std::size_t grains : a.sizes) {
    if (bench::Seconds(std::chrono::steady_clock::now() - start).count() > a.seconds) break;
    if (spheres) of_spheres->time(grains);
    if (cubes) of_cubes->time(grains);
  }
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
