#pragma once

#include <dem/core/macros.hpp>
#include <dem/grain/grain_columns_common.hpp>
#include <dem/integrator/motion.hpp>
#include <dem/law/state.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace dem {

/// The grains of a world: what all grains have, and what their shape and the integrator add.
template <class Shape, class Integrator>
struct GrainColumns : GrainColumnsCommon {
  using Motion = integrator::Motion<Pack>;
  static constexpr bool has_orientation = Shape::has_orientation;
  static constexpr std::size_t pose_size = Shape::pose_size;
  template <class T>
  using Memory = typename Integrator::template Memory<T>;
  static constexpr int memory_size = contact::field_count<Memory<double>>;
  static_assert(sizeof(Memory<Pack>) == sizeof(Pack) * (memory_size > 0 ? memory_size : 1) || memory_size == 0);

  std::array<AlignedVector<double>, static_cast<std::size_t>(memory_size)> memory;  ///< of the integrator

  const double* pose_of(std::size_t i) const { return pose.data() + i * Shape::pose_size; }
  double* pose_of(std::size_t i) { return pose.data() + i * Shape::pose_size; }

  /// rad/s, global axes.
  Vector3<double> angular_velocity(std::size_t i) const {
    if constexpr (has_orientation) return rotation(i) * local_angular_velocity[i];
    return local_angular_velocity[i];
  }

  Motion motion(std::size_t i) const {
    if constexpr (Shape::has_orientation) {
      return {position.pack(i),
              velocity.pack(i),
              local_angular_velocity.pack(i),
              {row0.pack(i), row1.pack(i), row2.pack(i)}};
    } else {
      return {position.pack(i), velocity.pack(i), local_angular_velocity.pack(i), Matrix3<Pack>::identity()};
    }
  }
  void set_motion(std::size_t i, const Motion& m) {
    position.set_pack(i, m.position);
    velocity.set_pack(i, m.velocity);
    local_angular_velocity.set_pack(i, m.angular_velocity);
    if constexpr (Shape::has_orientation) {
      row0.set_pack(i, m.rotation.row0);
      row1.set_pack(i, m.rotation.row1);
      row2.set_pack(i, m.rotation.row2);
    }
  }
  Memory<Pack> memory_pack(std::size_t i) const {
    Memory<Pack> result{};
    if constexpr (memory_size > 0) {
      std::array<Pack, static_cast<std::size_t>(memory_size)> packs;
      for (std::size_t k = 0; k < memory.size(); ++k) packs[k] = load(&memory[k][i]);
      result = std::bit_cast<Memory<Pack>>(packs);
    }
    return result;
  }
  void set_memory_pack(std::size_t i, const Memory<Pack>& m) {
    if constexpr (memory_size > 0) {
      const auto packs = std::bit_cast<std::array<Pack, static_cast<std::size_t>(memory_size)>>(m);
      for (std::size_t k = 0; k < memory.size(); ++k) store(packs[k], &memory[k][i]);
    }
  }

  Memory<double> memory_at(std::size_t i) const requires(memory_size > 0) {
    std::array<double, static_cast<std::size_t>(memory_size)> fields;
    for (std::size_t k = 0; k < memory.size(); ++k) fields[k] = memory[k][i];
    return std::bit_cast<Memory<double>>(fields);
  }
  void set_memory(std::size_t i, const Memory<double>& m) {
    if constexpr (memory_size > 0) {
      const auto fields = std::bit_cast<std::array<double, static_cast<std::size_t>(memory_size)>>(m);
      for (std::size_t k = 0; k < memory.size(); ++k) memory[k][i] = fields[k];
    }
  }

  /// Calls f(column) for every column of doubles that has one entry a grain.
  template <class F>
  void for_each_column(F&& f) {
    for_each_state_column(f);
    listed_at.for_each_column(f);
  }
  /// All but listed_at, which is made of the positions; those of position come first.
  template <class F>
  void for_each_state_column(F&& f) {
    for (Columns3* c : {&position, &velocity, &local_angular_velocity, &row0, &row1, &row2, &force, &torque})
      c->for_each_column(f);
    for (auto& column : memory) f(column);
  }

  /// Makes room for n grains and pads to whole chunks. Padding rows stay where they are put: see pad().
  void resize(std::size_t n) { GrainColumnsCommon::resize(n, pose_size, columns()); }

  /// Rows behind the padding, for images of grains: they have a position, a view, a pose, a species and an id only. The
  /// next resize() drops them.
  void add_rows(std::size_t n) { GrainColumnsCommon::add_rows(n, pose_size); }

  /// Adds a grain, at rest in what integrators remember; `turning` in rad/s, body frame.
  /// Returns its row.
  std::size_t append(std::uint32_t kind, const Vector3<double>& x, const Vector3<double>& v,
                     const Matrix3<double>& rotation, const Vector3<double>& turning) {
    const std::size_t row = count;
    resize(row + 1);
    position.set(row, x);
    velocity.set(row, v);
    local_angular_velocity.set(row, turning);
    set_rotation(row, rotation);
    for (Columns3* c : {&force, &torque}) c->set(row, {0, 0, 0});
    set_memory(row, {});
    species[row] = kind;
    give_id(row);
    return row;
  }

  /// Takes grains (ids) out; the others keep their order. listed_at is to be written anew.
  void remove(std::span<const std::uint32_t> ids, exec::AnyExecutor executor) {
    note_gone(ids);
    const std::vector<std::uint32_t> kept = rows_left();
    permute(kept, executor);
    resize(kept.size());
  }

  /// Row k becomes what was row order[k]. Threads share the work. Views and poses follow from the columns when the rows
  /// are next refreshed; listed_at is to be written anew. Where `held_rows` is given, all but
  /// position, species and id is right afterwards only in these new rows.
  void permute(std::span<const std::uint32_t> order, exec::AnyExecutor executor,
               const std::vector<std::uint32_t>* held_rows = nullptr) {
    const auto all = columns();
    GrainColumnsCommon::permute(order, executor, held_rows, Columns(all).first(state_columns));
  }

 private:
  static constexpr std::size_t state_columns = 24 + static_cast<std::size_t>(memory_size);

  /// Where the columns of for_each_column are: first those of for_each_state_column.
  std::array<AlignedVector<double>*, state_columns + 3> columns() {
    std::array<AlignedVector<double>*, state_columns + 3> list;
    std::size_t k = 0;
    for_each_column([&](AlignedVector<double>& column) { list.at(k++) = &column; });
    DEM_ASSERT(k == list.size(), "each column is in the list");
    return list;
  }
};

}  // namespace dem
