#pragma once

#include <dem/flat/wide.hpp>
#include <dem/grain/grain_columns.hpp>
#include <dem/grain/partner_view.hpp>
#include <dem/grain/species.hpp>
#include <dem/integrator/motion.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>

// What kernels see of a world are views: structs of pointers and numbers, which are copied to the device by their
// bytes.

namespace dem::flat {

/// The numbers of a species that kernels read.
struct Kind {
  double radius;  ///< m, of the bounding sphere
  SpeciesInertia inertia;
};

/// Which column of the grains is what: the order of GrainColumns::for_each_column, a number for each coordinate.
struct ColumnNumbers {
  static constexpr std::size_t position = 0, velocity = 3, spin = 6, rotation = 9, force = 18, torque = 21, memory = 24;
};

/// What a shape caches of a grain. Packs load from it where there are any.
template <class Shape>
struct alignas(64) Pose {
  double number[Shape::pose_size > 0 ? Shape::pose_size : 1];
};

/// The grains in flat memory: columns one behind the other, and what contacts read.
template <class Model>
struct GrainsView {
  using Shape = typename Model::Shape;
  using Integrator = typename Model::Integrator;
  using Memory = typename Integrator::template Memory<double>;
  using At = ColumnNumbers;
  static constexpr std::size_t memory_size = contact::field_count<Memory>;
  static constexpr std::size_t listed_at = At::memory + memory_size, columns = listed_at + 3;

  std::size_t count;  ///< of grains
  std::size_t rows;   ///< of a column
  double* column;     ///< the first one
  PartnerView* view;
  Pose<Shape>* pose;  ///< none where shapes have none
  const std::uint32_t* species;
  const Shape* shapes;  ///< of the species
  const Kind* kinds;    ///< the same

  DEM_FN double& at(std::size_t c, std::size_t i) const { return column[c * rows + i]; }
  DEM_FN Vector3<double> vector(std::size_t c, std::size_t i) const { return {at(c, i), at(c + 1, i), at(c + 2, i)}; }
  DEM_FN void set_vector(std::size_t c, std::size_t i, const Vector3<double>& v) const {
    at(c, i) = v.x;
    at(c + 1, i) = v.y;
    at(c + 2, i) = v.z;
  }
  DEM_FN Pose<Shape> pose_of(std::size_t i) const {
    if constexpr (Shape::pose_size > 0) return load_wide(pose + i);
    else return {};
  }
  /// The same where it is, for those who read little of it.
  DEM_FN const double* pose_at(std::size_t i) const {
    if constexpr (Shape::pose_size > 0) return pose[i].number;
    else return nullptr;
  }
  DEM_FN const Shape& shape_of(std::size_t i) const { return shapes[species[i]]; }
  DEM_FN const Kind& kind_of(std::size_t i) const { return kinds[species[i]]; }

  DEM_FN integrator::Motion<double> motion(std::size_t i) const {
    if constexpr (Shape::has_orientation) {
      return {vector(At::position, i),
              vector(At::velocity, i),
              vector(At::spin, i),
              {vector(At::rotation, i), vector(At::rotation + 3, i), vector(At::rotation + 6, i)}};
    } else {
      return {vector(At::position, i), vector(At::velocity, i), vector(At::spin, i), Matrix3<double>::identity()};
    }
  }
  DEM_FN void set_motion(std::size_t i, const integrator::Motion<double>& m) const {
    set_vector(At::position, i, m.position);
    set_vector(At::velocity, i, m.velocity);
    set_vector(At::spin, i, m.angular_velocity);
    if constexpr (Shape::has_orientation) {
      set_vector(At::rotation, i, m.rotation.row0);
      set_vector(At::rotation + 3, i, m.rotation.row1);
      set_vector(At::rotation + 6, i, m.rotation.row2);
    }
  }
  DEM_FN Memory memory_of(std::size_t i) const {
    if constexpr (memory_size == 0) {
      return {};
    } else {
      Fields fields;
      for (std::size_t k = 0; k < memory_size; ++k) fields.value[k] = at(At::memory + k, i);
      return std::bit_cast<Memory>(fields);
    }
  }
  DEM_FN void set_memory(std::size_t i, const Memory& m) const {
    if constexpr (memory_size > 0) {
      const auto fields = std::bit_cast<Fields>(m);
      for (std::size_t k = 0; k < memory_size; ++k) at(At::memory + k, i) = fields.value[k];
    }
  }

 private:
  struct Fields {
    double value[memory_size > 0 ? memory_size : 1];
  };
};

}  // namespace dem::flat
