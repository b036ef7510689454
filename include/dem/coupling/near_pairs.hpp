#pragma once

#include <dem/core/macros.hpp>
#include <dem/math/vector.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dem::coupling {

/// The broad phase of machine parts: which of any number of known pairs of surfaces have bounding boxes that meet. The
/// boxes are swept along one axis in the order of their low ends (sweep and prune: Baraff 1992), which hardly changes
/// from step to step, so it costs about as much as there are surfaces and boxes that meet.
class NearPairs {
 public:
  /// Forgets all pairs; makes room for surfaces 0 ... n - 1.
  void clear(std::size_t n);
  /// Pair number `pair`, of surfaces a and b that feel each other up to a gap (m). Pairs come in ascending order.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t pair, double gap);
  /// To be called when all pairs are there.
  DEM_LAZY void finish();

  /// The numbers of the pairs whose boxes, surfaces[s].low to .high (m), meet within their gaps, and perhaps of others
  /// that nearly do; ascending.
  template <class Surface>
  void find(std::span<const Surface> surfaces, std::vector<std::uint32_t>& found) {
    found.clear();
    const int axis = longest_axis(surfaces);
    for (Swept& s : order_) {
      s.low = surfaces[s.surface].low[axis] - reach_[s.surface];
      s.high = surfaces[s.surface].high[axis] + reach_[s.surface];
    }
    for (std::size_t k = 1; k < order_.size(); ++k) {
      for (std::size_t at = k; at > 0 && order_[at].low < order_[at - 1].low; --at)
        std::swap(order_[at], order_[at - 1]);
    }
    for (std::size_t i = 0; i < order_.size(); ++i) {
      for (std::size_t j = i + 1; j < order_.size() && order_[j].low <= order_[i].high; ++j) {
        const std::uint32_t a = order_[i].surface, b = order_[j].surface;
        if (meet(surfaces[a], surfaces[b], reach_[a] + reach_[b])) list_pairs(std::min(a, b), std::max(a, b), found);
      }
    }
    std::sort(found.begin(), found.end());
  }

 private:
  struct Partner {
    std::uint32_t other, pair;
  };
  struct Swept {
    std::uint32_t surface;
    double low, high;  ///< m, along the axis of the sweep
  };

  template <class Surface>
  static bool meet(const Surface& a, const Surface& b, double gap) {
    for (int k = 0; k < 3; ++k) {
      if (a.low[k] > b.high[k] + gap || b.low[k] > a.high[k] + gap) return false;
    }
    return true;
  }
  void list_pairs(std::uint32_t low, std::uint32_t high, std::vector<std::uint32_t>& found) const;

  /// The axis along which the boxes are spread the most; endless ones do not count.
  template <class Surface>
  int longest_axis(std::span<const Surface> surfaces) const {
    double sum[3] = {}, squares[3] = {}, count = 0.0;
    for (const Swept& s : order_) {
      const Vec3 middle = 0.5 * (surfaces[s.surface].low + surfaces[s.surface].high);
      const Vec3 size = surfaces[s.surface].high - surfaces[s.surface].low;
      if (!(size.x() + size.y() + size.z() < 1e100)) continue;
      count += 1.0;
      for (int k = 0; k < 3; ++k) {
        sum[k] += middle[k];
        squares[k] += middle[k] * middle[k];
      }
    }
    int longest = 0;
    for (int k = 1; k < 3; ++k) {
      const auto spread = [&](int axis) { return count * squares[axis] - sum[axis] * sum[axis]; };
      if (spread(k) > spread(longest)) longest = k;
    }
    return longest;
  }

  std::vector<std::vector<Partner>> partners_;  ///< of the surface with the lower number, ascending
  std::vector<double> reach_;                   ///< m, the widest gap of each surface's pairs
  std::vector<Swept> order_;                    ///< surfaces with pairs, in the order of the last sweep
};

}  // namespace dem::coupling

#if DEM_DEFINES

namespace dem::coupling {

DEM_INLINE void NearPairs::clear(std::size_t n) {
  partners_.assign(n, {});
  reach_.assign(n, 0.0);
  order_.clear();
}

DEM_INLINE void NearPairs::add(std::uint32_t a, std::uint32_t b, std::uint32_t pair, double gap) {
  partners_[std::min(a, b)].push_back({std::max(a, b), pair});
  for (const std::uint32_t s : {a, b}) reach_[s] = std::max(reach_[s], gap);
}

DEM_LAZY_INLINE void NearPairs::finish() {
  std::vector<char> has_pairs(partners_.size(), 0);
  for (std::uint32_t s = 0; s < partners_.size(); ++s) {
    for (const Partner& p : partners_[s]) has_pairs[s] = has_pairs[p.other] = 1;
    std::stable_sort(partners_[s].begin(), partners_[s].end(),
                     [](const Partner& a, const Partner& b) { return a.other < b.other; });
  }
  for (std::uint32_t s = 0; s < has_pairs.size(); ++s) {
    if (has_pairs[s]) order_.push_back({s, 0.0, 0.0});
  }
}

DEM_INLINE void NearPairs::list_pairs(std::uint32_t low, std::uint32_t high, std::vector<std::uint32_t>& found) const {
  const std::vector<Partner>& all = partners_[low];
  auto p = std::lower_bound(all.begin(), all.end(), high,
                            [](const Partner& partner, std::uint32_t other) { return partner.other < other; });
  for (; p != all.end() && p->other == high; ++p) found.push_back(p->pair);
}

}  // namespace dem::coupling

#endif
