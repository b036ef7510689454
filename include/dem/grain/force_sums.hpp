#pragma once

#include <dem/grain/grain_columns.hpp>

#include <array>

namespace dem::grain {

/// Sums of the forces on the grains of one chunk while its contacts are found. What is added for a grain of another
/// chunk lands in a row that nobody reads, so that the loop over the contacts has no branches.
class ForceSums {
 public:
  /// `local`: row of the grain minus the first row of the chunk; chunk_size or more (also after wrapping) is elsewhere.
  DEM_HOT_HOST void add(std::size_t local, const Vector3<double>& force, const Vector3<double>& torque) {
    Row& row = rows_[local < chunk_size ? local : chunk_size];
    row.force += force;
    row.torque += torque;
  }
  /// Hands the sums to the grains of a chunk.
  template <class GrainColumns>
  void write(std::size_t chunk_index, GrainColumns& p) const {
    const std::size_t begin = chunk_index * chunk_size, rows = p.packs_end(begin) - begin;
    for (std::size_t k = 0; k < rows; ++k) {
      p.force.set(begin + k, rows_[k].force);
      p.torque.set(begin + k, rows_[k].torque);
    }
  }

  /// Adds columns of forces and torques, from row `begin` on.
  void add_columns(const Columns3& force, const Columns3& torque, std::size_t begin) {
    for (std::size_t k = 0; k < chunk_size; ++k)
      rows_[k].force += force[begin + k], rows_[k].torque += torque[begin + k];
  }

  const Vector3<double>& force(std::size_t local) const { return rows_[local].force; }
  const Vector3<double>& torque(std::size_t local) const { return rows_[local].torque; }

 private:
  struct Row {
    Vector3<double> force, torque;
  };
  std::array<Row, chunk_size + 1> rows_ = {};
};

}  // namespace dem::grain
