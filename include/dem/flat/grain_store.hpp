#pragma once

#include <dem/flat/grains_view.hpp>
#include <dem/flat/motion_kernels.hpp>
#include <dem/world/state.hpp>

#include <limits>
#include <vector>

namespace dem::flat {

/// The grains in the executor's memory, with their species and laws.
template <class Model>
class GrainStore {
 public:
  using Shape = typename Model::Shape;
  using View = GrainsView<Model>;

  void bring_up(WorldState<Model>& w) {
    auto& p = w.grains;
    count_ = p.count;
    rows_ = (count_ + 31) / 32 * 32;  // each column begins with a cache line
    columns_.make_room(View::columns * rows_);
    for_each_moved_column(
        p, [&](std::size_t k, AlignedVector<double>& column) { columns_.upload_to(k * rows_, column.data(), count_); });
    species_.upload(p.species.data(), count_);
    views_.make_room(count_);
    if constexpr (Shape::pose_size > 0) poses_.make_room(count_);
    bring_up_species(w);
    bring_up_known_lost(w);
  }
  void bring_down(WorldState<Model>& w) {
    for_each_moved_column(w.grains, [&](std::size_t k, AlignedVector<double>& column) {
      columns_.download(column.data(), count_, k * rows_);
    });
  }

  std::size_t count() const { return count_; }
  View view() {
    return {count_,
            rows_,
            columns_.data(),
            views_.data(),
            poses_.data(),
            species_.data(),
            reinterpret_cast<const Shape*>(shapes_.data()),
            kinds_.data()};
  }
  DomainView domain(const WorldState<Model>& w) {
    constexpr double far = std::numeric_limits<double>::infinity();
    DomainView d{{-far, -far, -far}, {far, far, far}, known_lost_any_ ? known_lost_.data() : nullptr};
    if (w.borders) d.low = from_eigen(w.borders->low), d.high = from_eigen(w.borders->high);
    return d;
  }
  std::size_t bytes() const {
    return columns_.bytes() + views_.bytes() + poses_.bytes() + species_.bytes() + known_lost_.bytes();
  }

 private:
  template <class T>
  using Array = typename Model::Executor::template Array<T>;

  /// Calls f(number, column) for those that change: a grain without an orientation does not turn.
  template <class Columns, class F>
  static void for_each_moved_column(Columns& p, F&& f) {
    std::size_t k = 0;
    p.for_each_column([&](AlignedVector<double>& column) {
      const bool turns = k >= ColumnNumbers::rotation && k < ColumnNumbers::force;
      if (Shape::has_orientation || !turns) f(k, column);
      ++k;
    });
  }
  void bring_up_species(const WorldState<Model>& w) {
    // Shapes are copied by their bytes: what kernels call of them reads plain numbers.
    shapes_.make_room(w.species.size() * sizeof(Shape));
    std::vector<Kind> kinds;
    for (std::size_t k = 0; k < w.species.size(); ++k) {
      shapes_.upload_to(k * sizeof(Shape), reinterpret_cast<const std::byte*>(&w.species[k].shape), sizeof(Shape));
      kinds.push_back({w.species[k].shape.bounding_radius(), w.inertia[k]});
    }
    kinds_.upload(kinds.data(), kinds.size());
  }
  void bring_up_known_lost(const WorldState<Model>& w) {
    known_lost_any_ = !w.known_lost.empty();
    if (!known_lost_any_) return;
    std::vector<std::uint8_t> lost(count_);
    for (std::size_t i = 0; i < count_; ++i) lost[i] = w.known_lost.count(w.grains.id[i]) > 0 ? 1 : 0;
    known_lost_.upload(lost.data(), lost.size());
  }

  std::size_t count_ = 0, rows_ = 0;
  Array<double> columns_;
  Array<Pose<Shape>> poses_;
  Array<PartnerView> views_;
  Array<std::uint32_t> species_;
  Array<std::byte> shapes_;
  Array<Kind> kinds_;
  Array<std::uint8_t> known_lost_;
  bool known_lost_any_ = false;
};

/// The constants of all contacts in the executor's memory.
template <class Model>
class LawStore {
 public:
  void bring_up(const WorldState<Model>& w) {
    table_.upload(w.materials.table().data(), w.materials.table().size());
    species_ = w.species.size();
    const auto rows_with = [&](const auto& partners) {
      std::vector<std::uint32_t> rows;
      for (const auto& partner : partners) {
        for (const auto& kind : w.species) rows.push_back(w.materials.row(kind.material, partner.material));
      }
      return rows;
    };
    const std::vector<std::uint32_t> pairs = rows_with(w.species), surfaces = rows_with(w.surfaces);
    pairs_.upload(pairs.data(), pairs.size());
    surfaces_.upload(surfaces.data(), surfaces.size());
  }
  LawsView<Model> of_pairs(double time_step) { return {table_.data(), pairs_.data(), species_, time_step}; }
  LawsView<Model> at_surfaces(double time_step) { return {table_.data(), surfaces_.data(), species_, time_step}; }

 private:
  template <class T>
  using Array = typename Model::Executor::template Array<T>;
  Array<ContactParameters<Model>> table_;
  Array<std::uint32_t> pairs_, surfaces_;
  std::size_t species_ = 0;
};

}  // namespace dem::flat
