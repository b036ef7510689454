#pragma once

// A cell in steady shear, whose grains several processes share (MPI: link dem::mpi).

#include <dem/domain/ranks.hpp>
#include <dem/domain/sheared.hpp>

#include <array>

namespace dem::domain {

/// A sheared cell whose grains several processes share: what is said of Sheared and of Ranks holds at once. The results
/// are the bits that Sheared has on one process, and a saved state of one goes on in the other.
///
///     struct Sand : dem::Model { using Domain = dem::domain::ShearedRanks; };
class ShearedRanks : public Sheared, public Ranks {
 public:
  static constexpr bool has_images = true, has_ranks = true;

  ShearedRanks() = default;
  ShearedRanks(const surface::Aabb& cell, const std::array<bool, 3>& repeats) : Sheared(cell, repeats) {}
};

}  // namespace dem::domain
