#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/prefetch.hpp>
#include <dem/geometry/shape.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/grain/contact_evaluator.hpp>
#include <dem/grain/force_sums.hpp>
#include <dem/grain/species.hpp>
#include <dem/grain/wakefulness.hpp>

#include <algorithm>
#include <span>

namespace dem::grain {

/// Lists that a thread uses again for each chunk, whatever the model.
struct PairScratchCommon {
  DEM_VALUE(PairScratchCommon)

  std::vector<std::uint32_t> close;         ///< candidates whose bounding spheres overlap
  std::vector<std::uint64_t> contact_bits;  ///< BitShape: answers that are not zero
  std::vector<Hit> hits;
  ContactForces forces;
  // Where grains may sleep:
  bool chooses = false;               ///< not all candidates are evaluated
  std::vector<std::uint32_t> listed;  ///< those that are, if not all are
  std::vector<std::uint8_t> renews;   ///< by candidate: see list_evaluated; empty where all are
  ForceSums asleep;                   ///< of contacts between sleepers
};

/// The same with what contacts are and remember.
template <class Model>
struct PairScratch : PairScratchCommon {
  std::vector<typename Model::Shape::template PairContactPoint<double>>
      contact_points;                            ///< other shapes: one for each hit
  ContactHistories<history_size<Model>> merged;  ///< for Chunk::commit_pairs, where grains may sleep
};

/// The candidates of a chunk as pairs of grains.
template <class Model, class GrainColumns>
struct ChunkPairs {
  using Shape = typename Model::Shape;
  Chunk<Model>& chunk;
  const GrainColumns& p;
  std::span<const Species<Shape>> species;
  const Materials<Model>& materials;
  std::size_t begin;  ///< first grain of the chunk

  /// How far apart grains may be and still be a contact.
  DEM_HOT_HOST auto gap() const {
    if constexpr (cohesion::reaches<typename Model::Cohesion>) {
      return materials.range();
    } else {
      return shape::NoGap{};
    }
  }
  DEM_HOT_HOST std::size_t i(std::uint32_t candidate) const { return begin + chunk.owner[candidate]; }
  DEM_HOT_HOST std::size_t j(std::uint32_t candidate) const { return chunk.candidate[candidate]; }
  DEM_HOT_HOST const Species<Shape>& kind(std::size_t grain) const { return species[p.species[grain]]; }
  DEM_HOT_HOST Vector3<double> separation(std::size_t i, std::size_t j) const {
    return p.view[j].position - p.view[i].position;
  }
  DEM_HOT_HOST Hit hit(std::uint32_t candidate, std::uint32_t feature) const {
    const auto a = static_cast<std::uint32_t>(i(candidate)), b = static_cast<std::uint32_t>(j(candidate));
    const std::uint32_t law = materials.table().size() == 1 ? 0 : materials.row(kind(a).material, kind(b).material);
    return {PairKey::make(candidate, feature).value, a, b, law};
  }
};

/// Those of the candidates candidate(0), candidate(1), ... whose bounding spheres overlap, a pack at a time and without
/// branches, as the answer is a coin toss.
template <class Pairs, class Candidate>
std::size_t list_close(const Pairs& pairs, std::uint32_t candidates, const Candidate& candidate,
                       std::vector<std::uint32_t>& close) {
  constexpr std::uint32_t ahead = 4 * pack_width;  // how many candidates ahead views are asked for
  close.resize(candidates + std::size_t{pack_width});
  std::size_t count = 0;
  PartnerLanes partners;
  std::uint32_t of_lane[pack_width];
  for (std::uint32_t at = 0; at < candidates; at += pack_width) {
    for (std::uint32_t lane = 0; lane < pack_width; ++lane) {
      prefetch(&pairs.p.view[pairs.j(candidate(std::min(at + lane + ahead, candidates - 1)))], sizeof(PartnerView));
    }
    for (std::uint32_t lane = 0; lane < pack_width; ++lane) {
      const std::uint32_t k = of_lane[lane] = candidate(std::min(at + lane, candidates - 1));
      partners.set(static_cast<int>(lane), pairs.p.view[pairs.i(k)], pairs.p.view[pairs.j(k)]);
    }
    const auto [x, y, z, radii] = separations(partners);
    const Pack reach = shape::widened(radii, pairs.gap());
    const std::uint32_t near = bits(x * x + y * y + z * z < reach * reach);
    for (std::uint32_t lane = 0; lane < pack_width; ++lane) {
      close[count] = of_lane[lane];
      count += near >> lane & (at + lane < candidates ? 1u : 0u);
    }
  }
  return count;
}

/// Which points of grain i touch which of grain j, or come within the reach of cohesion, as bits.
template <class Model, class Pairs>
DEM_HOT_HOST std::uint64_t contact_bits(const Pairs& pairs, std::size_t i, std::size_t j) {
  using Shape = typename Model::Shape;
  const auto& a = pairs.kind(i).shape;
  const auto& b = pairs.kind(j).shape;
  if constexpr (cohesion::reaches<typename Model::Cohesion>) {
    return Shape::contact_bits(a, pairs.p.pose_of(i), b, pairs.p.pose_of(j), pairs.separation(i, j), pairs.gap());
  } else {
    return Shape::contact_bits(a, pairs.p.pose_of(i), b, pairs.p.pose_of(j), pairs.separation(i, j));
  }
}

/// Narrow phase of shapes that answer in bits: bits of all close pairs first, then one loop over the contacts, which
/// steps to the next pair by a conditional move.
template <class Model, class Pairs>
void find_hits_by_bits(const Pairs& pairs, std::size_t close_count, PairScratch<Model>& s) {
  using Shape = typename Model::Shape;
  if constexpr (!Shape::has_orientation) {  // a sphere is its own bounding sphere: the question is answered
    s.hits.resize(close_count);
    for (std::size_t c = 0; c < close_count; ++c) s.hits[c] = pairs.hit(s.close[c], 0);
    return;
  }
  s.contact_bits.resize(close_count + 1);
  std::size_t pairs_in_contact = 0, total = 0;
  for (std::size_t c = 0; c < close_count; ++c) {
    const std::uint32_t k = s.close[c];
    const std::size_t i = pairs.i(k), j = pairs.j(k);
    constexpr std::size_t ahead = 8;  // how many pairs ahead poses are asked for
    const std::size_t later = pairs.j(s.close[std::min(c + ahead, close_count - 1)]);
    prefetch(pairs.p.pose_of(later), Shape::pose_size * sizeof(double));
    const std::uint64_t bits = contact_bits<Model>(pairs, i, j);
    total += static_cast<std::size_t>(std::popcount(bits));
    s.close[pairs_in_contact] = k;
    s.contact_bits[pairs_in_contact] = bits;
    pairs_in_contact += bits != 0 ? 1 : 0;
  }
  s.contact_bits[pairs_in_contact] = 0;

  s.hits.resize(total);
  std::size_t pair = 0;
  std::uint64_t bits = s.contact_bits[0];
  for (Hit& hit : s.hits) {
    hit = pairs.hit(s.close[pair], Shape::feature_of(std::countr_zero(bits)));
    bits &= bits - 1;
    pair += bits == 0 ? 1 : 0;
    bits = bits == 0 ? s.contact_bits[pair] : bits;
  }
}

/// Narrow phase of all other shapes.
template <class Model, class Pairs>
void find_hits_one_by_one(const Pairs& pairs, std::size_t close_count,
                          shape::WarmStarts<typename Model::Shape>& searches, PairScratch<Model>& s) {
  using Shape = typename Model::Shape;
  s.hits.clear();
  s.contact_points.clear();
  for (std::size_t c = 0; c < close_count; ++c) {
    const std::uint32_t k = s.close[c];
    const std::size_t i = pairs.i(k), j = pairs.j(k);
    const Shape &a = pairs.kind(i).shape, &b = pairs.kind(j).shape;
    const auto callback = [&](std::uint32_t feature, const auto& point) {
      s.hits.push_back(pairs.hit(k, feature));
      s.contact_points.push_back(point);
    };
    const auto collide = [&](auto&&... more) {
      Shape::collide(a, pairs.p.pose_of(i), b, pairs.p.pose_of(j), pairs.separation(i, j), more...);
    };
    constexpr bool reaches = cohesion::reaches<typename Model::Cohesion>;
    if constexpr (shape::WarmStartedShape<Shape>) {
      if constexpr (reaches) collide(searches.start[k], callback, pairs.gap());
      else collide(searches.start[k], callback);
    } else {
      if constexpr (reaches) collide(callback, pairs.gap());
      else collide(callback);
    }
  }
}

/// Adds the forces of the contacts to the chunk's own grains and keeps what partners in other chunks feel. To avoid a
/// branch that is a coin toss, both are written for every contact; what does not apply is overwritten or never read.
/// `sums_for(hit)` are the sums in which a contact counts.
template <class Model, class SumsFor>
void share_forces(std::size_t begin, Chunk<Model>& chunk, const PairScratch<Model>& s, SumsFor&& sums_for) {
  chunk.partner_loads.resize(s.hits.size() + 1);
  std::fill(chunk.partner_load_first.begin(), chunk.partner_load_first.end(), 0u);
  std::size_t foreign = 0;
  for (std::size_t c = 0; c < s.hits.size(); ++c) {
    const Hit& hit = s.hits[c];
    const Vector3<double> force = ContactForces::at(s.forces.force, c);
    const PartnerLoad load = {-force, ContactForces::at(s.forces.torque_j, c)};
    ForceSums& sums = sums_for(hit);
    sums.add(hit.i - begin, force, ContactForces::at(s.forces.torque_i, c));
    sums.add(hit.partner - begin, load.force, load.torque);
    chunk.partner_loads[foreign] = load;
    const std::uint32_t elsewhere = hit.partner - begin >= chunk_size ? 1 : 0;
    foreign += elsewhere;
    chunk.partner_load_first[PairKey{hit.key}.candidate() + 1] += elsewhere;
  }
  std::uint32_t total = 0;
  for (std::uint32_t& first : chunk.partner_load_first) first = total += first;
}

/// The contact point of hit c of a chunk.
template <class Model, class Pairs>
DEM_HOT_HOST typename Model::Shape::template PairContactPoint<double> contact_point_of_hit(const Pairs& pairs,
                                                                                           const PairScratch<Model>& s,
                                                                                           std::size_t c) {
  using Shape = typename Model::Shape;
  if constexpr (shape::BitShape<Shape>) {
    const std::size_t i = s.hits[c].i, j = s.hits[c].partner;
    return Shape::contact_point(pairs.kind(i).shape, pairs.p.pose_of(i), pairs.kind(j).shape, pairs.p.pose_of(j),
                                pairs.separation(i, j), PairKey{s.hits[c].key}.feature());
  } else {
    return s.contact_points[c];
  }
}

/// Chooses the candidates of a chunk whose contacts are evaluated: where grains may sleep (`doing` is not empty), not
/// those between sleepers, but for those of grains that are watched, and where most grains are awake. Returns how many.
template <class Model>
std::size_t choose_candidates(std::size_t begin, std::size_t end, const Chunk<Model>& chunk, Wakefulness doing,
                              std::span<const std::uint16_t> awake_beside, PairScratch<Model>& s) {
  s.renews.clear();
  s.chooses = !doing.empty() && !evaluates_all(begin, end, doing);
  if (!s.chooses) return chunk.candidate.size();
  list_evaluated(chunk, begin, doing, awake_beside, s.listed, s.renews);
  return s.listed.size();
}

/// Contacts of the grains of one chunk with their candidates: narrow phase, laws, forces. Writes to the chunk and its
/// own grains' sums only, so chunks may run at the same time. To be called after choose_candidates(); contacts that
/// were not chosen are left as they are.
template <class Model, class GrainColumns>
void find_pair_contacts(const ChunkPairs<Model, GrainColumns> pairs, double dt, Wakefulness doing, ForceSums& sums,
                        PairScratch<Model>& s) {
  using Shape = typename Model::Shape;
  Chunk<Model>& chunk = pairs.chunk;
  std::size_t close_count = 0;
  if (!s.chooses) {
    const auto all = static_cast<std::uint32_t>(chunk.candidate.size());
    close_count = list_close(
        pairs, all, [](std::uint32_t k) { return k; }, s.close);
  } else {
    const auto some = static_cast<std::uint32_t>(s.listed.size());
    close_count = list_close(
        pairs, some, [&](std::uint32_t k) { return s.listed[k]; }, s.close);
  }

  if constexpr (shape::BitShape<Shape>) {
    find_hits_by_bits<Model>(pairs, close_count, s);
  } else {
    find_hits_one_by_one<Model>(pairs, close_count, chunk.searches, s);
  }

  const auto contact_point_of = [&](std::size_t c) { return contact_point_of_hit<Model>(pairs, s, c); };
  ContactEvaluator<Model, Shape::template PairContactPoint, Shape> evaluator(pairs.materials.table(), dt);
  const Deepest deepest = evaluator.run(
      s.hits, chunk.pair_contacts, s.forces, contact_point_of,
      [&](std::size_t c) -> const PartnerView& { return pairs.p.view[s.hits[c].i]; },
      [&](std::size_t c) -> const PartnerView& { return pairs.p.view[s.hits[c].partner]; });
  const DeepestContact before = chunk.deepest;
  chunk.deepest = {deepest.overlap, 0, 0, false};
  if (deepest.overlap > 0.0)
    chunk.deepest = {deepest.overlap, s.hits[deepest.hit].i, s.hits[deepest.hit].partner, false};
  if (doing.empty()) {
    share_forces(pairs.begin, chunk, s, [&](const Hit&) -> ForceSums& { return sums; });
  } else {
    // What contacts between sleepers bear is summed apart.
    chunk.sleeps.resize(chunk.candidate.size());
    s.asleep = {};
    share_forces(pairs.begin, chunk, s, [&](const Hit& hit) -> ForceSums& {
      const bool asleep = sleeps(doing, hit.i, hit.partner);
      chunk.sleeps[PairKey{hit.key}.candidate()] = asleep ? 1 : 0;
      return asleep ? s.asleep : sums;
    });
    // One that was the deepest and was left as it is still counts.
    const bool stays = !before.with_surface && before.overlap > deepest.overlap && before.partner < doing.size() &&
                       !is_evaluated(doing, before.i, before.partner);
    if (stays) chunk.deepest = before;
  }
}

}  // namespace dem::grain

#if DEM_DEFINES

namespace dem::grain {

DEM_DEFINE_VALUE(PairScratchCommon)

}  // namespace dem::grain

#endif
