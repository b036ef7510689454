#include "world/scenes.hpp"

#include <dem/soil/mixing.hpp>

#include "core/error_of.hpp"

#include <random>

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using dem::soil::mixing_of;

namespace {

/// 16 x 16 x 16 grains on a lattice of 1 cm, in a box of 16 cm; two parts of which `is_red` says one by the place.
template <class F>
std::pair<dem::World<Balls>, std::vector<bool>> lattice(F&& is_red) {
  dem::World<Balls> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Balls>());
  const auto kind = w.add_species(Sphere(1e-3));
  std::vector<bool> red;
  for (int k = 0; k < 4096; ++k) {
    const int x = k % 16, y = k / 16 % 16, z = k / 256;
    w.add_grain({kind, 0.01 * Vec3(x + 0.5, y + 0.5, z + 0.5)});
    red.push_back(is_red(x, y, z));
  }
  return {std::move(w), std::move(red)};
}
dem::soil::AverageGrid grid(int n) { return {{Vec3(0, 0, 0), Vec3(0.16, 0.16, 0.16)}, {n, n, n}}; }
const auto of = [](const std::vector<bool>& red) { return [&red](GrainId g) { return red[g.index()]; }; };

}  // namespace

TEST_CASE("Lacey's index is 0 of parts that are apart, and above 1 of those that alternate") {
  const auto [apart, lower] = lattice([](int, int, int z) { return z < 4; });
  const auto m = mixing_of(apart, grid(4), of(lower));
  CHECK(m.share == 0.25);
  CHECK(m.cells == 64);
  CHECK(m.grains == 4096);
  CHECK(m.variance == Approx(0.25 * 0.75).epsilon(1e-13));
  CHECK(m.index == Approx(0.0).margin(1e-13));

  const auto [even, alternating] = lattice([](int x, int y, int z) { return (x + y + z) % 2 == 0; });
  const auto e = mixing_of(even, grid(4), of(alternating));
  CHECK(e.variance == Approx(0.0).margin(1e-15));
  CHECK(e.by_chance == Approx(0.25 * 63.0 / 4095.0).epsilon(1e-13));
  CHECK(e.index == Approx(1.0 / (1.0 - 63.0 / 4095.0)).epsilon(1e-13));
}

TEST_CASE("Lacey's index of grains that are dealt out by chance has the mean 1, whatever the cells") {
  std::mt19937 random(7);
  for (const int n : {2, 5, 8}) {  // 5: cells of 27 to 64 grains
    double sum = 0.0, squares = 0.0;
    constexpr int times = 30;
    const auto [w, none] = lattice([](int, int, int) { return false; });
    std::vector<bool> red(4096, false);
    std::fill_n(red.begin(), 1000, true);
    for (int k = 0; k < times; ++k) {
      std::shuffle(red.begin(), red.end(), random);
      const double index = mixing_of(w, grid(n), of(red)).index;
      sum += index, squares += index * index;
    }
    const double mean = sum / times, error = std::sqrt((squares / times - mean * mean) / (times - 1));
    CHECK(std::abs(mean - 1.0) < 3.5 * error);  // one in 2,000 draws of one grid is beyond; these are always the same
    CHECK(error < 0.01);
  }
}

TEST_CASE("grains outside the grid do not count, and what is no mixture is refused in words") {
  const auto made = lattice([](int, int, int z) { return z < 4; });
  const auto& w = made.first;
  const auto& lower = made.second;
  dem::soil::AverageGrid half = {{Vec3(0, 0, 0.02), Vec3(0.16, 0.16, 0.06)}, {1, 1, 2}};
  const auto m = mixing_of(w, half, of(lower));
  CHECK(m.outside == 3072);
  CHECK(m.share == 0.5);
  CHECK(m.index == Approx(0.0).margin(1e-13));

  half.cells = {1, 1, 1};
  CHECK_THAT(message_of([&] { mixing_of(w, half, of(lower)); }), ContainsSubstring("one cell"));
  CHECK_THAT(message_of([&] { mixing_of(w, grid(4), [](GrainId) { return false; }); }),
             ContainsSubstring("0 of the 4096 grains"));
  CHECK_THAT(message_of([&] { mixing_of(w, grid(16), of(lower)); }), ContainsSubstring("make cells larger"));
  CHECK_THAT(message_of([&] { mixing_of(w, grid(0), of(lower)); }), ContainsSubstring("0 cells along x"));
}
