#include "catch.hpp"

#include <dem/geometry/mesh/bounding_volume_tree.hpp>

#include <functional>
#include <random>

using dem::Vec3;
using dem::surface::Aabb;
using dem::surface::BoundingVolumeTree;

TEST_CASE("a tree of boxes finds what a loop over all boxes finds, in the order of its places") {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> place(-1.0, 1.0), size(0.0, 0.2);
  for (const std::size_t n : {0u, 1u, 4u, 5u, 37u, 1000u}) {
    std::vector<Aabb> boxes;
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 low(place(engine), place(engine), place(engine));
      boxes.push_back({low, low + Vec3(size(engine), size(engine), size(engine))});
    }
    const BoundingVolumeTree tree(boxes);
    REQUIRE(tree.order().size() == n);
    // The boxes of the leaves, which are halves of halves of the places.
    std::vector<Aabb> leaf(n);
    const std::function<void(std::size_t, std::size_t)> halve = [&](std::size_t from, std::size_t to) {
      if (to - from > BoundingVolumeTree::items_in_a_leaf) {
        halve(from, from + (to - from) / 2);
        halve(from + (to - from) / 2, to);
        return;
      }
      Aabb all = boxes[tree.order()[from]];
      for (std::size_t k = from; k < to; ++k) {
        const Aabb& b = boxes[tree.order()[k]];
        all = {all.low.cwiseMin(b.low), all.high.cwiseMax(b.high)};
      }
      std::fill(leaf.begin() + static_cast<std::ptrdiff_t>(from), leaf.begin() + static_cast<std::ptrdiff_t>(to), all);
    };
    if (n > 0) halve(0, n);
    CHECK(tree.nodes() <= 2 * n);
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 p(place(engine), place(engine), place(engine));
      const double radius = 3.0 * size(engine), reach2 = radius * radius;
      std::vector<std::uint32_t> found;
      tree.for_each_near(dem::from_eigen(p), reach2, [&](std::uint32_t k) { found.push_back(k); });
      CHECK(std::is_sorted(found.begin(), found.end()));
      CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
      std::vector<std::uint32_t> in_box;
      tree.for_each_in(dem::from_eigen(p), dem::from_eigen(Vec3(p.array() + radius)),
                       [&](std::uint32_t k) { in_box.push_back(k); });
      const Vec3 tip(place(engine), place(engine), place(engine));
      std::vector<std::uint32_t> on_way;
      tree.for_each_along(dem::from_eigen(p), dem::from_eigen(tip), [&](std::uint32_t k) { on_way.push_back(k); });
      CHECK(std::is_sorted(on_way.begin(), on_way.end()));
      CHECK(std::adjacent_find(on_way.begin(), on_way.end()) == on_way.end());
      // What is wanted is there; what is there besides lies in a leaf that the question meets.
      for (std::uint32_t k = 0; k < n; ++k) {
        const auto away = [&](const Aabb& b) { return (p.cwiseMax(b.low).cwiseMin(b.high) - p).norm(); };
        const auto meets = [&](const Aabb& b) {
          return (b.low.array() <= p.array() + radius).all() && (b.high.array() >= p.array()).all();
        };
        const Aabb& b = boxes[tree.order()[k]];
        const bool near = std::binary_search(found.begin(), found.end(), k);
        const bool in = std::binary_search(in_box.begin(), in_box.end(), k);
        if (away(b) < radius) CHECK(near);
        if (meets(b)) CHECK(in);
        const auto on = [&](const Aabb& wanted) {  // some of the way in all three slabs at once
          const Vec3 d = tip - p, one = (wanted.low - p).cwiseQuotient(d), other = (wanted.high - p).cwiseQuotient(d);
          return std::max(0.0, one.cwiseMin(other).maxCoeff()) < std::min(1.0, one.cwiseMax(other).minCoeff());
        };
        CHECK(on(leaf[k]) == std::binary_search(on_way.begin(), on_way.end(), k));
        CHECK(near == (away(leaf[k]) <= radius));
        CHECK(in == meets(leaf[k]));
      }
    }
  }
}

TEST_CASE("boxes that lie on each other do not spoil a tree") {
  const std::vector<Aabb> boxes(1000, {Vec3(0, 0, 0), Vec3(1, 1, 1)});
  const BoundingVolumeTree tree(boxes);
  CHECK(tree.nodes() < 2000);
  std::size_t found = 0;
  const double reach2 = 0.01;
  tree.for_each_near({0.5, 0.5, 1.05}, reach2, [&](std::uint32_t) { ++found; });
  CHECK(found == 1000);
}
