#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/ids.hpp>
#include <dem/geometry/shape.hpp>
#include <dem/grain/contact_list.hpp>
#include <dem/grain/energy_ledger.hpp>
#include <dem/grain/grain_columns.hpp>

#include <span>

namespace dem {

/// Force and torque (about the centre of mass of the surface's body) that one chunk's grains exert on one surface.
struct SurfaceLoad {
  SurfaceId surface;
  Vector3<double> force;   ///< N
  Vector3<double> torque;  ///< N m
};

/// What a contact does to its partner j, for the chunk that j belongs to.
struct PartnerLoad {
  Vector3<double> force;   ///< N
  Vector3<double> torque;  ///< N m, about the centre of j
};

/// The deepest contact of a chunk's grains in a step.
struct DeepestContact {
  double overlap = 0.0;       ///< in effective diameters
  std::uint32_t i = 0;        ///< row of the grain
  std::uint32_t partner = 0;  ///< row of the other grain, or number of the surface
  bool with_surface = false;
};

/// What belongs to chunk_size consecutive grains whatever the model: their candidates, loads and bounds.
struct ChunkCommon {
  DEM_VALUE(ChunkCommon)

  std::array<std::uint32_t, chunk_size + 1> candidate_first = {};  ///< candidates of the k-th grain of the chunk
  std::vector<std::uint32_t> candidate;                            ///< partners j > i, ascending for each i
  std::vector<std::uint8_t> owner;                                 ///< of each candidate: its i in the chunk

  std::vector<PartnerLoad> partner_loads;         ///< of the contacts whose partner is in another chunk, in their order
  std::vector<std::uint32_t> partner_load_first;  ///< for each candidate, and one entry more
  std::vector<SurfaceLoad> surface_loads;
  std::vector<grain::ContactWork> work;  ///< all of its contacts, while energy is counted

  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< of the grains' centres
  double moved2 = 0.0;  ///< m^2, largest squared displacement since the neighbour list was made
  DeepestContact deepest;
  double stopped = 0.0;              ///< J, motion of grains that fell asleep in this step
  double surface_seconds = 0.0;      ///< s, spent on contacts with surfaces while the stopwatch was on
  bool finite = true;                ///< no position or velocity is NaN or infinite
  bool asleep = false;               ///< all of its grains sleep
  bool watched = false;              ///< some of them are watched (grain::watched)
  bool asked = false;                ///< some of them are beside one that is watched (grain::asked)
  std::uint32_t awake_beside = 0;    ///< the sum of Sleepers::awake_beside over its grains
  bool touched = false;              ///< some of them are touched (grain::touched)
  bool meets_moving = false;         ///< a surface that moves may touch some of its grains, or did before
  bool evaluated = true;             ///< some of its contacts are, in this evaluation; true of other ranks' chunks
  bool changed = false;              ///< some of them fell asleep or woke since contacts were evaluated
  std::vector<std::uint8_t> sleeps;  ///< where grains may sleep, by candidate: both grains slept when it was evaluated
  std::vector<std::uint32_t> reached;  ///< other chunks of whose grains it has candidates
  std::vector<std::uint32_t> around;   ///< chunks with which it has candidates; listed where grains may sleep
};

/// The same with what their contacts remember.
template <class Model>
struct Chunk : ChunkCommon {
  [[no_unique_address]] shape::WarmStarts<typename Model::Shape> searches;  ///< of the candidates
  HistoriesOfSteps<history_size<Model>> pair_contacts, surface_contacts;

  /// The contact histories of pairs of this evaluation become the ones that the next starts from. To be called while
  /// the chunk has the memory that they were written to (ContactScratch::lend). If only some candidates were evaluated,
  /// `renews` says which, and `spare` is used on the way; else it is empty.
  void commit_pairs(std::span<const std::uint8_t> renews, ContactHistories<history_size<Model>>& spare) {
    if (renews.empty()) pair_contacts.commit_copy();
    else pair_contacts.commit_some(renews, spare);
  }
};

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_DEFINE_VALUE(ChunkCommon)

}  // namespace dem

#endif
