#pragma once

#include <dem/core/aligned.hpp>
#include <dem/core/compiled.hpp>
#include <dem/core/ids.hpp>
#include <dem/grain/partner_view.hpp>
#include <dem/parallel/any_executor.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dem {

/// Grains are worked on in chunks of this many: one chunk's contacts fit the first-level cache, and a chunk, not a
/// thread, is the unit of work, so that results do not depend on the number of threads.
inline constexpr std::size_t chunk_size = 256;

/// Three columns x, y, z.
struct Columns3 {
  AlignedVector<double> x, y, z;

  Vector3<double> operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vector3<double>& v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
  Vector3<Pack> pack(std::size_t i) const { return {load(&x[i]), load(&y[i]), load(&z[i])}; }
  void set_pack(std::size_t i, const Vector3<Pack>& v) {
    store(v.x, &x[i]);
    store(v.y, &y[i]);
    store(v.z, &z[i]);
  }
  template <class F>
  void for_each_column(F&& f) {
    f(x);
    f(y);
    f(z);
  }
};

/// What grains of any shape have, as structure of arrays. Rows are re-sorted in space now and then; `id` tells which
/// grain a row holds and `row_of` where a grain is. The columns are padded to whole chunks: see pad().
struct GrainColumnsCommon {
  DEM_VALUE(GrainColumnsCommon)

  std::size_t count = 0;            ///< grains, padding not counted
  Columns3 position, velocity;      ///< m, m/s
  Columns3 local_angular_velocity;  ///< rad/s, body frame (what the integrator advances)
  Columns3 row0, row1, row2;        ///< rotation, body -> global, by rows
  Columns3 force, torque;           ///< N, N m of the last force evaluation, gravity not included; global axes
  Columns3 listed_at;               ///< m, position when the neighbour list was made
  AlignedVector<PartnerView> view;  ///< what contacts read
  AlignedVector<double> pose;       ///< Shape::pose_size a grain
  std::vector<std::uint32_t> species, id;
  std::vector<std::uint32_t> row_of;  ///< by id; `gone` for grains that were removed
  // An id is a slot of tables. Those of grains whose rows are gone are used again, the last one first.
  std::uint32_t given = 0;                       ///< grains that were added so far
  std::vector<std::uint32_t> number;             ///< by id: which of them it is; empty while that is the id
  std::vector<std::uint32_t> freed, free_again;  ///< ids: since the last release_ids(); that may be used again
  static constexpr std::uint32_t gone = 0xffffffffu;

  std::uint32_t number_of(std::uint32_t of) const { return number.empty() ? of : number[of]; }
  /// The same by row: which of the grains that were added it is. Messages say this one.
  std::uint32_t number_at(std::size_t row) const { return number_of(id[row]); }
  /// What the grain of an id is called outside.
  GrainId name(std::uint32_t of) const { return GrainId(number_of(of), of); }
  /// The id of a grain, which may be gone; `gone` if its id has another grain now, or it never was.
  std::uint32_t find(GrainId p) const;

  std::size_t chunks() const { return (count + chunk_size - 1) / chunk_size; }
  /// One past the last row of the packs that hold grains of the chunk whose first row is `begin`.
  std::size_t packs_end(std::size_t begin) const {
    constexpr auto width = static_cast<std::size_t>(pack_width);
    return std::min(begin + chunk_size, (count + width - 1) / width * width);
  }

  Matrix3<double> rotation(std::size_t i) const { return {row0[i], row1[i], row2[i]}; }
  void set_rotation(std::size_t i, const Matrix3<double>& r) {
    row0.set(i, r.row0);
    row1.set(i, r.row1);
    row2.set(i, r.row2);
  }

  /// Gives the grain of a new row an id and the next number.
  void give_id(std::size_t row);
  /// Grains (ids) are gone; their rows are still there.
  void note_gone(std::span<const std::uint32_t> ids);
  /// The rows that are not gone, in order.
  std::vector<std::uint32_t> rows_left() const;
  /// From here on, the ids of grains whose rows are gone may be used again. Nobody may know them any more.
  void release_ids();

  /// Puts the padding rows where the last grain is and stops them, so that bounds and displacements stay right. A step
  /// puts back those of the last pack, which it moves; the rows behind stay where a new neighbour list put them.
  void pad() { pad(chunks() * chunk_size); }
  /// Those before row `stop`.
  void pad(std::size_t stop);

  /// The neighbour list is made of grains where they are now: those of all rows, or of the rows first to last - 1.
  void note_listed(exec::AnyExecutor executor);
  void note_listed(std::size_t first, std::size_t last);

 protected:
  using Columns = std::span<AlignedVector<double>* const>;

  // What GrainColumns says of them. `columns` are those of doubles with one entry a grain: all of them for resize; for
  // permute all but listed_at, those of the position first.
  void resize(std::size_t n, std::size_t pose_size, Columns columns);
  void add_rows(std::size_t n, std::size_t pose_size);
  void permute(std::span<const std::uint32_t> order, exec::AnyExecutor executor,
               const std::vector<std::uint32_t>* held_rows, Columns columns);
};

}  // namespace dem

#if DEM_DEFINES
#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/parallel/blocks.hpp>

#include <numeric>

namespace dem {

DEM_DEFINE_VALUE(GrainColumnsCommon)

DEM_INLINE std::uint32_t GrainColumnsCommon::find(GrainId p) const {
  const auto holds = [&](std::uint32_t at) { return at < row_of.size() && number_of(at) == p.value; };
  if (holds(p.slot)) return p.slot;
  if (holds(p.value)) return p.value;
  if (p.slot != GrainId::anywhere) return gone;
  const auto at = std::find(number.begin(), number.end(), p.value);
  return at == number.end() ? gone : static_cast<std::uint32_t>(at - number.begin());
}

DEM_INLINE void GrainColumnsCommon::give_id(std::size_t row) {
  if (free_again.empty()) {
    id[row] = static_cast<std::uint32_t>(row_of.size());
    row_of.push_back(0);
    if (!number.empty()) number.push_back(0);
  } else {
    if (number.empty()) {
      number.resize(row_of.size());
      std::iota(number.begin(), number.end(), 0u);
    }
    id[row] = free_again.back();
    free_again.pop_back();
  }
  if (!number.empty()) number[id[row]] = given;
  ++given;
  row_of[id[row]] = static_cast<std::uint32_t>(row);
}

DEM_INLINE void GrainColumnsCommon::note_gone(std::span<const std::uint32_t> ids) {
  for (const std::uint32_t k : ids) row_of[k] = gone;
  freed.insert(freed.end(), ids.begin(), ids.end());
}

DEM_INLINE std::vector<std::uint32_t> GrainColumnsCommon::rows_left() const {
  std::vector<std::uint32_t> left;
  for (std::size_t i = 0; i < count; ++i) {
    if (row_of[id[i]] != gone) left.push_back(static_cast<std::uint32_t>(i));
  }
  return left;
}

DEM_INLINE void GrainColumnsCommon::release_ids() {
  free_again.insert(free_again.end(), freed.begin(), freed.end());
  freed.clear();
}

DEM_INLINE void GrainColumnsCommon::pad(std::size_t stop) {
  if (count == 0) return;
  for (std::size_t i = count; i < stop; ++i) {
    position.set(i, position[count - 1]);
    listed_at.set(i, listed_at[count - 1]);
    for (Columns3* c : {&velocity, &local_angular_velocity, &force, &torque}) c->set(i, {0, 0, 0});
    set_rotation(i, Matrix3<double>::identity());
  }
}

DEM_INLINE void GrainColumnsCommon::note_listed(exec::AnyExecutor executor) {
  listed_at.for_each_column([&](AlignedVector<double>& column) { column.resize(position.x.size()); });
  exec::for_each_block(executor, position.x.size(),
                       [&](std::size_t first, std::size_t last) { note_listed(first, last); });
}

DEM_INLINE void GrainColumnsCommon::note_listed(std::size_t first, std::size_t last) {
  const auto copy = [&](const AlignedVector<double>& from, AlignedVector<double>& to) {
    std::copy(from.begin() + static_cast<std::ptrdiff_t>(first), from.begin() + static_cast<std::ptrdiff_t>(last),
              to.begin() + static_cast<std::ptrdiff_t>(first));
  };
  copy(position.x, listed_at.x), copy(position.y, listed_at.y), copy(position.z, listed_at.z);
}

DEM_INLINE void GrainColumnsCommon::resize(std::size_t n, std::size_t pose_size, Columns columns) {
  const std::size_t rows = (n + chunk_size - 1) / chunk_size * chunk_size;
  for (AlignedVector<double>* column : columns) column->resize(rows, 0.0);
  view.resize(rows);
  pose.resize(rows * pose_size, 0.0);
  species.resize(rows, 0);
  id.resize(rows, 0xffffffffu);
  count = n;
}

DEM_INLINE void GrainColumnsCommon::add_rows(std::size_t n, std::size_t pose_size) {
  const std::size_t rows = chunks() * chunk_size + n;
  position.for_each_column([&](AlignedVector<double>& column) { column.resize(rows, 0.0); });
  view.resize(rows);
  pose.resize(rows * pose_size, 0.0);
  species.resize(rows, 0);
  id.resize(rows, 0xffffffffu);
}

DEM_INLINE void GrainColumnsCommon::permute(std::span<const std::uint32_t> order, exec::AnyExecutor executor,
                                            const std::vector<std::uint32_t>* held_rows, Columns columns) {
  DEM_ASSERT(order.size() <= count, "rows are moved or dropped, and none is made");
  executor.for_each(columns.size(), [&](std::size_t c) {
    AlignedVector<double>& column = *columns[c];
    if (held_rows != nullptr && c >= 3) {
      std::vector<double> values;
      values.reserve(held_rows->size());
      for (const std::uint32_t k : *held_rows) values.push_back(column[order[k]]);
      for (std::size_t m = 0; m < held_rows->size(); ++m) column[(*held_rows)[m]] = values[m];
      return;
    }
    const AlignedVector<double> old = column;
    for (std::size_t k = 0; k < order.size(); ++k) column[k] = old[order[k]];
  });
  const auto old_species = species, old_id = id;
  exec::for_each_block(executor, order.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      species[k] = old_species[order[k]];
      id[k] = old_id[order[k]];
      row_of[id[k]] = static_cast<std::uint32_t>(k);
    }
  });
}

}  // namespace dem

#endif
