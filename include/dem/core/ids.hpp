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

/// A grain; stays the same when storage is re-sorted. Grains are numbered in the order in which they are added, and no
/// number is given twice. Where a world keeps what it knows of a grain is used again when the grain is gone; an id that
/// is out of date is told by its number.
struct GrainId {
  static constexpr std::uint32_t anywhere = 0xffffffffu;
  std::uint32_t value = 0xffffffffu;  ///< the grain's number
  std::uint32_t slot = anywhere;      ///< of the world's tables; an id that is made from a number is looked for

  constexpr GrainId() = default;
  constexpr explicit GrainId(std::size_t number, std::uint32_t slot_of_world = anywhere)
      : value(static_cast<std::uint32_t>(number)), slot(slot_of_world) {}
  constexpr std::size_t index() const { return value; }
  constexpr bool valid() const { return value != 0xffffffffu; }
  constexpr bool operator==(const GrainId& other) const { return value == other.value; }
  constexpr auto operator<=>(const GrainId& other) const { return value <=> other.value; }
};

}  // namespace dem
