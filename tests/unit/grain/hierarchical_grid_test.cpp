#include "catch.hpp"

#include <dem/grain/broadphase/hierarchical_grid.hpp>
#include <dem/math/vector.hpp>

#include <random>
#include <set>
#include <vector>

using dem::broadphase::HierarchicalGrid;

namespace {

/// Grains of several kinds, at random places in a cube about a middle.
struct SizedPoints {
  std::vector<double> radius_of_kind;
  double gap = 0.0;
  std::vector<double> x = {}, y = {}, z = {};
  std::vector<std::uint32_t> kind = {};

  void add(std::uint32_t k, double px, double py, double pz) {
    x.push_back(px), y.push_back(py), z.push_back(pz), kind.push_back(k);
  }
  void fill(std::uint32_t k, std::size_t n, double half, const dem::Vec3& middle, std::mt19937& engine) {
    std::uniform_real_distribution<double> d(-half, half);
    for (std::size_t i = 0; i < n; ++i) {
      const double px = d(engine), py = d(engine), pz = d(engine);
      add(k, middle.x() + px, middle.y() + py, middle.z() + pz);
    }
  }
  dem::broadphase::Positions positions() const { return {x.data(), y.data(), z.data(), x.size()}; }
  dem::broadphase::Sizes sizes() const { return {radius_of_kind, kind.data(), gap}; }
  bool reach_each_other(std::size_t i, std::size_t j) const {
    const double dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
    const double reach = radius_of_kind[kind[i]] + radius_of_kind[kind[j]] + gap;
    return dx * dx + dy * dy + dz * dz < reach * reach;
  }
};

using MixedPairs = std::set<std::pair<std::size_t, std::size_t>>;

MixedPairs pairs_by_trying_all(const SizedPoints& m) {
  MixedPairs found;
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    for (std::size_t j = i + 1; j < m.x.size(); ++j) {
      if (m.reach_each_other(i, j)) found.insert({i, j});
    }
  }
  return found;
}

MixedPairs pairs_of_grid(const SizedPoints& m, const HierarchicalGrid& grid, std::size_t* candidates = nullptr) {
  MixedPairs found, all;
  auto finder = grid.finder();
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    finder.for_each_candidate(i, [&](std::uint32_t j) {
      REQUIRE(j > i);
      REQUIRE(j < m.x.size());
      REQUIRE(all.insert({i, j}).second);
      if (m.reach_each_other(i, j)) found.insert({i, j});
    });
  }
  if (candidates != nullptr) *candidates = all.size();
  return found;
}

/// The pairs, with the grains as they are and put in order. Returns how many there are.
std::size_t check_mixture(SizedPoints m, HierarchicalGrid& grid) {
  grid.build(m.positions(), m.sizes());
  CHECK(pairs_of_grid(m, grid) == pairs_by_trying_all(m));
  const std::vector<std::uint32_t> order(grid.order().begin(), grid.order().end());
  REQUIRE(std::set<std::uint32_t>(order.begin(), order.end()).size() == m.x.size());
  const SizedPoints old = m;
  for (std::size_t k = 0; k < order.size(); ++k) {
    m.x[k] = old.x[order[k]], m.y[k] = old.y[order[k]], m.z[k] = old.z[order[k]], m.kind[k] = old.kind[order[k]];
  }
  // `old` has gone elsewhere, and the grid reads where it was built from: so it is built from m, as a world does.
  grid.build(m.positions(), m.sizes());
  const MixedPairs expected = pairs_by_trying_all(m);
  CHECK(pairs_of_grid(m, grid) == expected);
  return expected.size();
}

}  // namespace

TEST_CASE("a grid of levels finds what all pairs find, whatever the sizes") {
  HierarchicalGrid grid;
  std::mt19937 engine(3);
  for (const double ratio : {1.0, 1.5, 2.0, 5.0, 20.0, 300.0}) {
    for (const double gap : {0.0, 0.02, 0.3}) {
      for (const double shift : {0.0, 1e4}) {
        const dem::Vec3 middle(shift, -0.3 * shift, 7 * shift);
        CAPTURE(ratio, gap, shift);
        SizedPoints m{{0.05, 0.05 * std::sqrt(ratio), 0.05 * ratio}, gap};
        m.fill(0, 300, 1.0, middle, engine);
        m.fill(1, 40, 1.0, middle, engine);
        m.fill(2, 10, 1.0, middle, engine);
        CHECK(check_mixture(m, grid) > 0);
      }
    }
  }
}

TEST_CASE("a grid of levels has as many as the sizes ask for") {
  HierarchicalGrid grid;
  const auto levels = [&](std::vector<double> radii, double gap) {
    SizedPoints m{std::move(radii), gap};
    for (std::uint32_t k = 0; k < m.radius_of_kind.size(); ++k) m.add(k, k, 0, 0);
    grid.build(m.positions(), m.sizes());
    return grid.levels();
  };
  CHECK(levels({1.0}, 0.1) == 1);
  CHECK(levels({1.0, 1.9}, 0.0) == 1);
  CHECK(levels({1.0, 2.0}, 0.0) == 2);  // cells of 2 and 4
  CHECK(levels({1.0, 20.0}, 0.0) == 5);
  CHECK(levels({1.0, 2.0}, 1.0) == 1);    // reaches of 3 and 5
  CHECK(levels({1e-9, 1.0}, 0.0) == 16);  // and no more
  CHECK(levels({0.0, 1.0}, 0.0) == 16);
  // A kind of which there is no grain asks for nothing.
  SizedPoints m{{1.0, 20.0}, 0.0};
  m.add(0, 0, 0, 0);
  grid.build(m.positions(), m.sizes());
  CHECK(grid.levels() == 1);
}

TEST_CASE("a grid of levels that was put in order finds the same") {
  std::mt19937 engine(5);
  SizedPoints m{{0.03, 0.6}, 0.01};
  m.fill(0, 800, 1.0, dem::Vec3::Zero(), engine);
  m.fill(1, 6, 1.0, dem::Vec3::Zero(), engine);
  HierarchicalGrid grid;
  grid.build(m.positions(), m.sizes());
  const std::vector<std::uint32_t> order(grid.order().begin(), grid.order().end());
  const std::vector<double> x = m.x, y = m.y, z = m.z;
  const std::vector<std::uint32_t> kind = m.kind;
  for (std::size_t k = 0; k < order.size(); ++k) {
    m.x[k] = x[order[k]], m.y[k] = y[order[k]], m.z[k] = z[order[k]], m.kind[k] = kind[order[k]];
  }
  grid.reordered();
  CHECK(pairs_of_grid(m, grid) == pairs_by_trying_all(m));
  for (std::size_t k = 0; k < order.size(); ++k) REQUIRE(grid.order()[k] == k);
}

TEST_CASE("a large grain costs the small ones no candidates") {
  // 4,000 small grains in a cube of edge 2: with cells of their own reach, 0.1, each pair of 27 cells once makes
  // 4000^2/2 * 27/8000 = 27,000. The large grain adds its 4,000. In cells of 2.1 all 8,000,000 pairs were candidates.
  std::mt19937 engine(7);
  SizedPoints m{{0.05, 1.0}, 0.0};
  m.fill(0, 4000, 1.0, dem::Vec3::Zero(), engine);
  m.add(1, 0, 0, 0);
  HierarchicalGrid grid;
  grid.build(m.positions(), m.sizes());
  std::size_t candidates = 0;
  pairs_of_grid(m, grid, &candidates);
  // Cells are halves of the large grain's 2.0: 0.125, which makes 27 * 0.125^3/8 of the pairs, 52,700.
  CHECK(candidates < 60'000);
  CHECK(candidates > 40'000);
}

TEST_CASE("a grid of levels loses no grain far away") {
  std::mt19937 engine(9);
  SizedPoints m{{0.05, 1.0}, 0.0};
  m.fill(0, 300, 1.0, dem::Vec3::Zero(), engine);
  m.fill(1, 3, 1.0, dem::Vec3::Zero(), engine);
  HierarchicalGrid grid;
  const std::size_t near = check_mixture(m, grid);
  for (const double far : {1e6, -1e12, 1e300}) {
    for (const std::uint32_t k : {0u, 1u}) {
      SizedPoints with = m;
      with.add(k, far, -far, far);
      CHECK(check_mixture(with, grid) == near);
    }
  }
}
