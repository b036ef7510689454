#pragma once

#include <dem/grain/broadphase/broad_phase.hpp>

namespace dem::broadphase {

/// Every pair is a candidate: the O(n^2) reference that tests compare with.
class AllPairs {
 public:
  void build(const Positions& positions, double) { n_ = positions.n; }

  struct Finder {
    std::size_t n;
    template <class F>
    void for_each_candidate(std::size_t i, F&& f) const {
      for (std::size_t j = i + 1; j < n; ++j) f(static_cast<std::uint32_t>(j));
    }
  };
  Finder finder() const { return {n_}; }
  std::span<const std::uint32_t> order() const { return {}; }
  std::size_t memory_bytes() const { return 0; }

 private:
  std::size_t n_ = 0;
};

}  // namespace dem::broadphase
