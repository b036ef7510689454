#pragma once

// A cell that repeats itself, whose grains several processes share (MPI: link dem::mpi).

#include <dem/domain/periodic.hpp>
#include <dem/domain/ranks.hpp>

#include <array>

namespace dem::domain {

/// Periodic space whose grains several processes share: what is said of Periodic and of Ranks holds at once. The
/// results are the bits that Periodic has on one process, and a saved state of one goes on in the other.
///
///     struct Sand : dem::Model { using Domain = dem::domain::PeriodicRanks; };
///
/// Images of a grain are no traffic: a grain goes over once, and each rank places its images itself.
class PeriodicRanks : public Periodic, public Ranks {
 public:
  static constexpr bool has_images = true, has_ranks = true;

  PeriodicRanks() = default;
  PeriodicRanks(const surface::Aabb& cell, const std::array<bool, 3>& repeats) : Periodic(cell, repeats) {}
};

}  // namespace dem::domain
