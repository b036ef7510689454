#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/surface.hpp>
#include <dem/math/eager.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dem {

/// Balls in and around a box, and whether there is room for one more: cells of the size of the largest ball, made anew
/// for each use.
class FreeRoom {
 public:
  /// `largest`: m, radius of the largest ball, plus half of the gap that is to stay between two.
  FreeRoom(const surface::Aabb& region, double largest);
  const Vec3& low() const { return low_; }
  const Vec3& high() const { return high_; }

  /// A ball that is there; one that is too far away to matter is left out.
  void add(const Vec3& x, double radius);
  /// Whether a ball in the region is clear of all others by more than `gap` (m).
  bool has_room(const Vec3& x, double radius, double gap) const;

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  struct Ball {
    Vec3 position;
    double radius;
    std::uint32_t next;  // in the same cell
  };
  double cells(double size) const { return std::floor(size / cell_) + 1.0; }
  std::array<std::ptrdiff_t, 3> cell_of(const Vec3& x) const;
  std::size_t index(const std::array<std::ptrdiff_t, 3>& c) const {
    return static_cast<std::size_t>((c[2] * count_[1] + c[1]) * count_[0] + c[0]);
  }

  Vec3 low_, high_;
  double cell_;
  std::array<std::ptrdiff_t, 3> count_ = {};
  std::vector<std::uint32_t> first_;
  std::vector<Ball> balls_;
};

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE FreeRoom::FreeRoom(const surface::Aabb& region, double largest)
    : low_(region.low - filled(2.0 * largest)), high_(region.high + filled(2.0 * largest)), cell_(2.0 * largest) {
  // A region that is large beside its grains gets larger cells: their number is bounded, not the work in each.
  constexpr double most_cells = 1 << 18;
  const Vec3 size = high_ - low_;
  while (cells(size.x()) * cells(size.y()) * cells(size.z()) > most_cells) cell_ *= 1.25;
  for (int k = 0; k < 3; ++k) count_[static_cast<std::size_t>(k)] = static_cast<std::ptrdiff_t>(cells(size[k]));
  first_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]), none);
}

DEM_INLINE void FreeRoom::add(const Vec3& x, double radius) {
  if (!none_below(x, low_) || !none_below(high_, x)) return;
  std::uint32_t& first = first_[index(cell_of(x))];
  balls_.push_back({x, radius, first});
  first = static_cast<std::uint32_t>(balls_.size() - 1);
}

DEM_INLINE bool FreeRoom::has_room(const Vec3& x, double radius, double gap) const {
  const std::array<std::ptrdiff_t, 3> at = cell_of(x);
  std::array<std::ptrdiff_t, 3> from, to;
  for (std::size_t k = 0; k < 3; ++k) {
    from[k] = std::max<std::ptrdiff_t>(at[k] - 1, 0), to[k] = std::min(at[k] + 1, count_[k] - 1);
  }
  for (std::ptrdiff_t k = from[2]; k <= to[2]; ++k) {
    for (std::ptrdiff_t j = from[1]; j <= to[1]; ++j) {
      for (std::ptrdiff_t i = from[0]; i <= to[0]; ++i) {
        for (std::uint32_t b = first_[index({i, j, k})]; b != none; b = balls_[b].next) {
          const double reach = radius + balls_[b].radius + gap;
          const Vec3 d = balls_[b].position - x;
          if (!(eager::dot3(d.data(), 1, d.data()) > reach * reach)) return false;
        }
      }
    }
  }
  return true;
}

DEM_INLINE std::array<std::ptrdiff_t, 3> FreeRoom::cell_of(const Vec3& x) const {
  const auto of = [&](int k) {
    const double at = std::floor((x[k] - low_[k]) / cell_);
    return std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(at), 0, count_[static_cast<std::size_t>(k)] - 1);
  };
  return {of(0), of(1), of(2)};
}

}  // namespace dem

#endif
