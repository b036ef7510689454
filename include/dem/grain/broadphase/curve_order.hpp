#pragma once

#include <dem/core/compiled.hpp>
#include <dem/grain/broadphase/broad_phase.hpp>
#include <dem/grain/broadphase/morton.hpp>
#include <dem/math/vector.hpp>
#include <dem/parallel/any_executor.hpp>

namespace dem::broadphase {

/// Grains in the order of their cells along a Z-order (Morton) curve; those of one cell by their rows.
class CurveOrder {
 public:
  DEM_VALUE(CurveOrder)

  struct Entry {
    std::uint64_t code;  ///< of the cell
    std::uint32_t grain;
  };

  /// Where the cell of a grain is on the curve; `inverse_cell` in 1/m.
  static std::uint64_t code(const Vector3<double>& x, double inverse_cell) {
    const auto cell = [&](double along) { return morton::cell(along * inverse_cell); };
    return morton::code(cell(x.x), cell(x.y), cell(x.z));
  }

  /// Sorts anew; `inverse_cell` in 1/m. Costs little where rows are nearly in this order.
  void sort(const Positions& p, double inverse_cell, exec::AnyExecutor executor);

  const Entry& operator[](std::size_t k) const { return entries_[k]; }
  std::size_t memory_bytes() const { return (entries_.capacity() + scratch_.capacity()) * sizeof(Entry); }

 private:
  std::vector<Entry> entries_, scratch_;
};

}  // namespace dem::broadphase

#if DEM_DEFINES
#include <dem/grain/broadphase/nearly_sorted.hpp>

namespace dem::broadphase {

DEM_DEFINE_VALUE(CurveOrder)

DEM_INLINE void CurveOrder::sort(const Positions& p, double inverse_cell, exec::AnyExecutor executor) {
  entries_.resize(p.n);
  exec::for_each_block(executor, p.n, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      entries_[i] = {code({p.x[i], p.y[i], p.z[i]}, inverse_cell), static_cast<std::uint32_t>(i)};
    }
  });
  const auto less = [](const Entry& a, const Entry& b) {
    return a.code != b.code ? a.code < b.code : a.grain < b.grain;
  };
  sort_nearly_sorted(entries_, scratch_, less, executor);
}

}  // namespace dem::broadphase

#endif
