#pragma once

#include <dem/flat/surface_kernels.hpp>
#include <dem/world/state.hpp>

#include <cstddef>

namespace dem::flat {

/// Sums what grains put on each surface, in an order that depends on the contacts alone.
template <class Model>
class SurfaceLoads {
 public:
  /// Launches the sums over so many contacts.
  void sum(WorldState<Model>& w, const std::uint64_t* key, const ContactResult* results, std::size_t contacts) {
    surfaces_ = w.surfaces.size();
    total_.make_room(surfaces_);
    if (surfaces_ == 0) return;
    std::size_t sums = (contacts + SumStretches::stretch - 1) / SumStretches::stretch;
    for (auto& array : loads_) array.make_room(std::max<std::size_t>(sums, 1) * surfaces_);
    std::size_t at = 0;
    w.executor.launch("sum loads of surfaces", sums * surfaces_,
                      SumStretches{key, results, contacts, surfaces_, loads_[at].data()});
    while (sums > SumLoads::fan) {
      const std::size_t fewer = (sums + SumLoads::fan - 1) / SumLoads::fan;
      w.executor.launch("sum loads of surfaces", fewer * surfaces_,
                        SumLoads{loads_[at].data(), sums, surfaces_, loads_[1 - at].data()});
      sums = fewer;
      at = 1 - at;
    }
    w.executor.launch("sum loads of surfaces", surfaces_, SumLoads{loads_[at].data(), sums, surfaces_, total_.data()});
  }
  /// Hands the sums to the surfaces, when the launches are done.
  void hand_over(WorldState<Model>& w) const {
    for (std::size_t s = 0; s < surfaces_; ++s) {
      w.surfaces[s].force = total_[s].force;
      w.surfaces[s].torque = total_[s].torque;
    }
  }

 private:
  template <class T>
  using Array = typename Model::Executor::template Array<T>;

  std::size_t surfaces_ = 0;
  Array<LoadOfGrains> loads_[2];
  typename Model::Executor::template Shared<LoadOfGrains> total_;
};

}  // namespace dem::flat
