#pragma once

#include <compare>
#include <cstdint>

namespace dem {

/// An index that cannot be mixed up with an index of another kind. `Tag` only tells the kinds apart.
template <class Tag>
struct Id {
  std::uint32_t value = 0xffffffffu;

  constexpr Id() = default;
  constexpr explicit Id(std::size_t index) : value(static_cast<std::uint32_t>(index)) {}
  constexpr std::size_t index() const { return value; }
  constexpr bool valid() const { return value != 0xffffffffu; }
  constexpr auto operator<=>(const Id&) const = default;
};

using MaterialId = Id<struct MaterialTag>;        ///< a row of the material-pair table
using SpeciesId = Id<struct SpeciesTag>;          ///< shape, size, mass and material of grains
using BodyId = Id<struct BodyTag>;                ///< a rigid body of a machine
using SurfaceId = Id<struct SurfaceTag>;          ///< a surface that a body shows to the grains
using BodyContactId = Id<struct BodyContactTag>;  ///< two surfaces of bodies that may touch each other

/// A grain; stays the same when storage is re-sorted. The number of a grain that was removed is given again, to a grain
/// of another generation: so an id that is out of date is told from that of the grain that has its number now.
struct ParticleId {
  std::uint32_t value = 0xffffffffu;  ///< its number
  std::uint32_t generation = 0;       ///< how many grains had the number before

  constexpr ParticleId() = default;
  constexpr explicit ParticleId(std::size_t index, std::uint32_t generation_of_number = 0)
      : value(static_cast<std::uint32_t>(index)), generation(generation_of_number) {}
  constexpr std::size_t index() const { return value; }
  constexpr bool valid() const { return value != 0xffffffffu; }
  constexpr auto operator<=>(const ParticleId&) const = default;
};

}  // namespace dem
