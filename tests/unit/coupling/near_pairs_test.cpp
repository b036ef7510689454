#include "catch.hpp"
#include "random.hpp"

#include <dem/coupling/near_pairs.hpp>

#include <vector>

using dem::Vec3;
using dem::coupling::NearPairs;

namespace {

struct Box {
  Vec3 low, high;
};
struct Pair {
  std::uint32_t a, b;
  double gap;
};

/// All pairs looked at one by one.
std::vector<std::uint32_t> expected(const std::vector<Pair>& pairs, const std::vector<Box>& boxes) {
  std::vector<std::uint32_t> near;
  for (std::uint32_t k = 0; k < pairs.size(); ++k) {
    const Box &a = boxes[pairs[k].a], &b = boxes[pairs[k].b];
    bool meet = true;
    for (int axis = 0; axis < 3; ++axis) {
      meet &= a.low[axis] <= b.high[axis] + pairs[k].gap && b.low[axis] <= a.high[axis] + pairs[k].gap;
    }
    if (meet) near.push_back(k);
  }
  return near;
}

NearPairs listed(const std::vector<Pair>& pairs, std::size_t boxes) {
  NearPairs found;
  found.clear(boxes);
  for (std::uint32_t k = 0; k < pairs.size(); ++k) found.add(pairs[k].a, pairs[k].b, k, pairs[k].gap);
  found.finish();
  return found;
}

std::vector<std::uint32_t> find(NearPairs& all, const std::vector<Box>& boxes) {
  std::vector<std::uint32_t> near;
  all.find(std::span<const Box>(boxes), near);
  return near;
}

}  // namespace

TEST_CASE("the sweep finds the pairs that a look at all of them finds, while boxes move about") {
  Random random(5);
  const auto uniform = [&](double low, double high) { return random.between(low, high); };
  for (const int spread_axis : {0, 1, 2}) {
    Vec3 room = Vec3::Constant(2.0);
    room[spread_axis] = 9.0;
    std::vector<Box> boxes(120);
    for (Box& b : boxes) {
      for (int k = 0; k < 3; ++k) b.low[k] = uniform(0.0, room[k]);
      b.high = b.low + Vec3(uniform(0, 0.8), uniform(0, 0.8), uniform(0, 0.8));
    }
    for (const std::size_t endless : {std::size_t{0}, std::size_t{60}, std::size_t{119}}) {  // half spaces
      boxes[endless] = {Vec3::Constant(-1e150), Vec3(1e150, 1e150, endless == 60 ? 0.5 : 0.1)};
    }
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
      for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
        if (uniform(0, 1) < 0.7) pairs.push_back(uniform(0, 1) < 0.5 ? Pair{a, b, 0.0} : Pair{b, a, 0.0});
      }
    }
    pairs.push_back(pairs[17]);  // a pair that is known twice has two numbers
    NearPairs all = listed(pairs, boxes.size());
    for (int step = 0; step < 40; ++step) {
      const auto near = expected(pairs, boxes);
      REQUIRE(near.size() > 10);
      REQUIRE(near.size() < pairs.size() / 2);
      REQUIRE(find(all, boxes) == near);
      for (std::size_t k = 0; k < boxes.size(); ++k) {
        if (boxes[k].high.x() > 1e100) continue;
        const Vec3 by(uniform(-0.3, 0.3), uniform(-0.3, 0.3), uniform(-0.3, 0.3));
        boxes[k].low += by;
        boxes[k].high += by;
      }
    }
  }
}

TEST_CASE("gaps widen the boxes, and none is missed by it") {
  const std::vector<Box> boxes = {
      {Vec3(0, 0, 0), Vec3(1, 1, 1)}, {Vec3(1.5, 0, 0), Vec3(2, 1, 1)}, {Vec3(0, 0, 4), Vec3(1, 1, 5)}};
  const std::vector<Pair> pairs = {{0, 1, 0.5}, {0, 2, 2.9}, {1, 2, 3.0}};
  NearPairs all = listed(pairs, boxes.size());
  // Surfaces keep the widest of their gaps, so it may find more than do meet, never fewer.
  const auto near = find(all, boxes), least = expected(pairs, boxes);
  CHECK(std::includes(near.begin(), near.end(), least.begin(), least.end()));
  CHECK(std::find(least.begin(), least.end(), 0u) != least.end());
}

TEST_CASE("there may be no pairs, and surfaces without any") {
  const std::vector<Box> boxes(3, {Vec3(0, 0, 0), Vec3(1, 1, 1)});
  NearPairs none = listed({}, boxes.size());
  CHECK(find(none, boxes).empty());
  NearPairs one = listed({{2, 0, 0.0}}, boxes.size());
  CHECK(find(one, boxes) == std::vector<std::uint32_t>{0});
}
