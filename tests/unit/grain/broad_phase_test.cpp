#include "catch.hpp"

#include <dem/grain/broadphase/all_pairs.hpp>
#include <dem/grain/broadphase/hierarchical_grid.hpp>
#include <dem/grain/broadphase/nearly_sorted.hpp>
#include <dem/grain/broadphase/uniform_grid.hpp>
#include <dem/math/vector.hpp>
#include <dem/parallel/threads.hpp>

#include <algorithm>
#include <functional>
#include <random>
#include <set>
#include <span>

using dem::Vec3;
using dem::broadphase::AllPairs;
using dem::broadphase::UniformGrid;

namespace {

using Pairs = std::set<std::pair<std::size_t, std::size_t>>;

struct Scene {
  std::vector<double> x, y, z;
  void add(const Vec3& p) {
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  dem::broadphase::Positions positions() const { return {x.data(), y.data(), z.data(), x.size()}; }
  Vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Candidates that are within reach. Checks the promises of the concept on the way: j > i, none twice.
template <class BroadPhase>
Pairs pairs_of_built(const Scene& s, const BroadPhase& b, double reach, std::size_t* candidates = nullptr) {
  Pairs found, all;
  auto finder = b.finder();
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    finder.for_each_candidate(i, [&](std::uint32_t j) {
      REQUIRE(j > i);
      REQUIRE(j < s.x.size());
      REQUIRE(all.insert({i, j}).second);
      if ((s.at(i) - s.at(j)).norm() <= reach) found.insert({i, j});
    });
  }
  if (candidates != nullptr) *candidates = all.size();
  return found;
}
template <class BroadPhase>
Pairs pairs_within(const Scene& s, BroadPhase& b, double reach, std::size_t* candidates = nullptr) {
  b.build(s.positions(), reach);
  return pairs_of_built(s, b, reach, candidates);
}

std::size_t check_same(const Scene& s, double reach) {
  UniformGrid grid;
  AllPairs all;
  const Pairs expected = pairs_within(s, all, reach), found = pairs_within(s, grid, reach);
  CHECK(found == expected);
  // The order is a permutation.
  const std::set<std::uint32_t> rows(grid.order().begin(), grid.order().end());
  CHECK(grid.order().size() == s.x.size());
  CHECK(rows.size() == s.x.size());
  CHECK((rows.empty() || *rows.rbegin() == s.x.size() - 1));
  // With grains of one size the hierarchical grid is this one.
  dem::broadphase::HierarchicalGrid levels;
  CHECK(pairs_within(s, levels, reach) == expected);
  CHECK(std::equal(grid.order().begin(), grid.order().end(), levels.order().begin(), levels.order().end()));
  // Put in order, the grains have the same pairs, under their new numbers.
  Scene in_order;
  for (const std::uint32_t k : grid.order()) in_order.add(s.at(k));
  grid.reordered();
  CHECK(pairs_of_built(in_order, grid, reach) == pairs_within(in_order, all, reach));
  return expected.size();
}

Scene random_scene(std::size_t n, const std::function<Vec3(std::mt19937&)>& place, unsigned seed) {
  std::mt19937 engine(seed);
  Scene s;
  for (std::size_t k = 0; k < n; ++k) s.add(place(engine));
  return s;
}

Vec3 in_box(std::mt19937& engine, const Vec3& half, const Vec3& centre = Vec3::Zero()) {
  std::uniform_real_distribution<double> d(-1.0, 1.0);
  return {centre.x() + half.x() * d(engine), centre.y() + half.y() * d(engine), centre.z() + half.z() * d(engine)};
}
Vec3 in_cube(std::mt19937& engine, double half, const Vec3& centre = Vec3::Zero()) {
  return in_box(engine, Vec3::Constant(half), centre);
}

}  // namespace

TEST_CASE("the grid finds what all pairs find") {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    // About zero, so that cells of negative coordinates meet those of positive ones.
    CHECK(check_same(random_scene(
                         400, [](auto& e) { return in_cube(e, 1.0); }, seed),
                     0.3) > 100);
    // Everything in one cell, and hardly anything near anything.
    CHECK(check_same(random_scene(
                         50, [](auto& e) { return in_cube(e, 0.1); }, seed),
                     1.0) == 50 * 49 / 2);
    CHECK(check_same(random_scene(
                         400, [](auto& e) { return in_cube(e, 1e4); }, seed),
                     1.0) < 10);
    // Far from the origin, where a cell is still 1e9 roundings wide.
    CHECK(check_same(random_scene(
                         400,
                         [](auto& e) {
                           return in_cube(e, 1.0, {1e6, -3e5, 7e6});
                         },
                         seed),
                     0.3) > 100);
    // Flat, and in a line.
    CHECK(check_same(random_scene(
                         400,
                         [](auto& e) {
                           return in_box(e, {1, 1, 0});
                         },
                         seed),
                     0.1) > 100);
    CHECK(check_same(random_scene(
                         400,
                         [](auto& e) {
                           return in_box(e, {0, 0, 1});
                         },
                         seed),
                     0.02) > 100);
  }
}

TEST_CASE("the grid finds clusters that are far apart") {
  const auto clustered = [](std::mt19937& e) {
    static const Vec3 centres[] = {{0, 0, 0}, {1e3, 0, -1e3}, {-5e5, 2e5, 1e6}};
    return in_cube(e, 0.5, centres[e() % 3]);
  };
  CHECK(check_same(random_scene(300, clustered, 9), 0.2) > 100);
}

TEST_CASE("one grain far away changes nothing for the others") {
  Scene s = random_scene(
      300, [](auto& e) { return in_cube(e, 1.0); }, 4);
  const std::size_t near_pairs = check_same(s, 0.3);
  // The last is beyond what the cell numbers of a 64-bit integer hold.
  for (const double far : {1e6, -1e6, 1e12, 1e300}) {
    Scene with = s;
    with.add({far, -far, far});
    CHECK(check_same(with, 0.3) == near_pairs);
  }
}

TEST_CASE("grains on the borders of cells are found") {
  Scene s;
  const double reach = 0.25;  // exact in binary, so the grains are exactly on the borders and exactly at reach
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) {
      for (int z = -3; z <= 3; ++z) s.add({x * reach, y * reach, z * reach});
    }
  }
  CHECK(check_same(s, reach) == 3 * 7 * 7 * 6);
}

TEST_CASE("cells so far apart that their numbers coincide only cost candidates") {
  // Coordinates wrap round after 2^21 cells: the second cluster lands on the cells of the first.
  Scene s;
  std::mt19937 engine(6);
  const double period = 2097152.0;
  for (int k = 0; k < 100; ++k) {
    const Vec3 p = in_cube(engine, 2.0);
    s.add(p);
    s.add(p + Vec3(period, 0, 0));
  }
  CHECK(check_same(s, 1.0) > 100);
  // And the neighbours across the seam of the numbering are neighbours still.
  Scene seam;
  for (int k = -5; k < 5; ++k) seam.add({period / 2 + 0.4 * k, 0, period / 2 - 0.4 * k});
  CHECK(check_same(seam, 1.0) > 8);
}

TEST_CASE("the grid spares most pairs") {
  const Scene s = random_scene(
      2000, [](auto& e) { return in_cube(e, 1.0); }, 8);
  UniformGrid grid;
  std::size_t candidates = 0;
  pairs_within(s, grid, 0.1, &candidates);
  // 27 cells of 0.1^3 in a volume of 8, each pair once: 2000 * 2000/2 * 27/8000 = 6750.
  CHECK(candidates < 7500);
  CHECK(candidates > 5000);
}

TEST_CASE("no grains and one grain have no pairs") {
  Scene s;
  CHECK(check_same(s, 1.0) == 0);
  s.add({1, 2, 3});
  CHECK(check_same(s, 1.0) == 0);
}

TEST_CASE("entries that are nearly in order are sorted as others are") {
  using Entry = std::pair<std::uint64_t, std::uint32_t>;
  std::mt19937 engine(3);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(engine() % n); };
  for (int run = 0; run < 2000; ++run) {
    const std::uint32_t n = below(200);
    std::vector<Entry> entries;
    std::uint64_t rising = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      rising += below(3);
      const std::uint64_t in_steps = i / 20 % 2 != 0 ? rising + 100 : rising;
      const std::uint64_t keys[] = {rising, below(4) == 0 ? below(300) : rising, in_steps, below(50), n - i};
      entries.emplace_back(keys[run % 5], i);
    }
    std::vector<Entry> expected = entries;
    std::sort(expected.begin(), expected.end());
    dem::broadphase::sort_nearly_sorted(std::span(entries), std::less<>());
    REQUIRE(entries == expected);
  }
}

TEST_CASE("what comes after entries that are in order costs little to sort in") {
  std::mt19937 engine(4);
  std::vector<std::uint32_t> entries;
  for (std::uint32_t k = 0; k < 10'000; ++k) entries.push_back(2 * k);
  for (std::uint32_t k = 0; k < 200; ++k) entries.push_back(2 * static_cast<std::uint32_t>(engine() % 10'000) + 1);
  std::size_t comparisons = 0;
  dem::broadphase::sort_nearly_sorted(std::span(entries),
                                      [&](std::uint32_t a, std::uint32_t b) { return ++comparisons, a < b; });
  CHECK(std::is_sorted(entries.begin(), entries.end()));
  // One a step of the pass, two where an entry strays; 200 log2(200) and as much again for their sort; one a step of
  // the merge. std::sort takes 13 for each entry.
  CHECK(comparisons < 10'000 + 2 * 200 + 2 * 200 * 8 + 10'200);
}

TEST_CASE("threads sort entries as one thread does") {
  using Entry = std::pair<std::uint64_t, std::uint32_t>;
  std::mt19937 engine(5);
  constexpr std::uint32_t n = 40'000;  // more than is left to one thread
  for (int run = 0; run < 5; ++run) {
    CAPTURE(run);
    std::vector<Entry> entries, scratch;
    for (std::uint32_t i = 0; i < n; ++i) {
      const auto anywhere = static_cast<std::uint64_t>(engine() % n);
      const std::uint64_t keys[] = {i / 3, i % 50 == 0 ? anywhere : i, anywhere, n - i, 7};
      entries.emplace_back(keys[run], i);
    }
    std::vector<Entry> expected = entries;
    std::sort(expected.begin(), expected.end());
    for (const int threads : {1, 2, 3}) {
      CAPTURE(threads);
      dem::exec::Threads executor;
      executor.set_threads(threads);
      std::vector<Entry> sorted = entries;
      dem::broadphase::sort_nearly_sorted(sorted, scratch, std::less<>(), executor);
      REQUIRE(sorted == expected);
    }
  }
}

TEST_CASE("threads build a grid as one thread does") {
  Scene s = random_scene(
      20'000, [](auto& e) { return in_cube(e, 1.0); }, 11);
  const double reach = 0.05;
  UniformGrid alone, shared;
  dem::exec::Threads executor;
  executor.set_threads(3);
  const auto same_order = [&] {
    return std::equal(alone.order().begin(), alone.order().end(), shared.order().begin());
  };
  alone.build(s.positions(), reach);
  shared.build(s.positions(), reach, executor);
  REQUIRE(same_order());
  CHECK(pairs_of_built(s, shared, reach) == pairs_of_built(s, alone, reach));
  Scene in_order;
  for (const std::uint32_t k : alone.order()) in_order.add(s.at(k));
  alone.reordered();
  shared.reordered(executor);
  CHECK(pairs_of_built(in_order, shared, reach) == pairs_of_built(in_order, alone, reach));
}

TEST_CASE("runs of candidates come in rising order") {
  Scene s = random_scene(
      2000, [](auto& e) { return in_cube(e, 1.0); }, 12);
  UniformGrid grid;
  grid.build(s.positions(), 0.1);
  Scene in_order;
  for (const std::uint32_t k : grid.order()) in_order.add(s.at(k));
  grid.reordered();
  auto finder = grid.finder();
  REQUIRE(finder.has_runs());
  std::size_t runs = 0;
  for (std::uint32_t i = 0; i < s.x.size(); ++i) {
    std::uint32_t after = i + 1;
    finder.for_each_run(i, [&](std::uint32_t first, std::uint32_t last) {
      REQUIRE(first >= after);
      REQUIRE(last > first);
      after = last;
      ++runs;
    });
  }
  CHECK(runs > 2 * s.x.size());
}

TEST_CASE("a grid forgets what it was built from before") {
  UniformGrid grid;
  AllPairs all;
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Scene s = random_scene(
        500 / seed, [](auto& e) { return in_cube(e, 1.0); }, seed);
    const double reach = 0.1 * seed;
    const Pairs expected = pairs_within(s, all, reach);
    CHECK(pairs_within(s, grid, reach) == expected);
  }
}
