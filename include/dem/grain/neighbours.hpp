#pragma once

#include <dem/core/sorted.hpp>
#include <dem/grain/broadphase/broad_phase.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/grain/images.hpp>
#include <dem/grain/move.hpp>
#include <dem/grain/species.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace dem::grain {

/// What belongs to each candidate of a chunk.
template <class Model>
void list_owners(Chunk<Model>& chunk) {
  chunk.owner.resize(chunk.candidate.size());
  for (std::size_t k = 0; k < chunk_size; ++k) {
    std::fill(chunk.owner.begin() + chunk.candidate_first[k], chunk.owner.begin() + chunk.candidate_first[k + 1],
              static_cast<std::uint8_t>(k));
  }
  chunk.partner_load_first.assign(chunk.candidate.size() + 1, 0);
  chunk.searches.reset(chunk.candidate.size());
}

/// Rows that are found one after the other, written without a branch.
struct FoundRows {
  std::vector<std::uint32_t> rows;  ///< the first `count` are those that are found
  std::size_t count = 0;

  void make_room(std::size_t n) {
    if (count + n > rows.size()) [[unlikely]]
      rows.resize(2 * (count + n));
  }
  /// There must be room, also for one that is not wanted.
  void add_if(bool is_wanted, std::uint32_t j) {
    rows[count] = j;
    count += is_wanted ? 1 : 0;
  }
};

/// Appends the rows first to last - 1, in order, whose centres lie within `reach` (m) of x: a pack at a time.
template <class GrainColumns>
DEM_HOT_HOST void append_within(const GrainColumns& p, std::uint32_t first, std::uint32_t last,
                                const Vector3<double>& x, double reach, FoundRows& found) {
  found.make_room(last - first + pack_width);
  std::uint32_t j = first;
  // Padding rows are not read: another thread may be putting them in their place.
  for (; j < last && j + pack_width <= p.count; j += pack_width) {
    const Pack dx = load_unaligned(&p.position.x[j]) - Pack(x.x), dy = load_unaligned(&p.position.y[j]) - Pack(x.y),
               dz = load_unaligned(&p.position.z[j]) - Pack(x.z);
    std::uint32_t near = bits(dx * dx + dy * dy + dz * dz < Pack(reach * reach));
    if (last - j < pack_width) near &= (1u << (last - j)) - 1u;
    for (std::uint32_t k = 0; k < pack_width; ++k) found.add_if((near >> k & 1u) != 0, j + k);
  }
  for (; j < last; ++j) {
    const Vector3<double> d = p.position[j] - x;
    found.add_if(dot(d, d) < reach * reach, j);
  }
}

/// Candidates of one chunk, whose rows begin with `begin`: all j > i whose bounding spheres come within the skin,
/// ascending; grains first, then images. No two that are held. `largest_radius` (m): of a bounding sphere. Of `p` it
/// reads positions and species, and how many rows are grains.
template <class Model, class GrainColumns, class BroadPhase>
void list_candidates(std::size_t begin, Chunk<Model>& chunk, const GrainColumns& p, const BroadPhase& broad_phase,
                     const Images<typename Model::Domain>& images,
                     std::span<const Species<typename Model::Shape>> species, double largest_radius, double skin) {
  const std::size_t end = std::min(begin + chunk_size, p.count);
  auto finder = broad_phase.finder();
  FoundRows found;
  found.make_room(chunk.candidate.size() / 2 + 8 * chunk_size);
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t first = found.count;
    chunk.candidate_first[i - begin] = static_cast<std::uint32_t>(first);
    const auto& kind = species[p.species[i]];
    const bool held = kind.is_held();
    const Vector3<double> x = p.position[i];
    const auto is_partner = [&](std::uint32_t j) {
      const auto& other = species.size() == 1 ? kind : species[p.species[j]];
      const double reach = kind.shape.bounding_radius() + other.shape.bounding_radius() + skin;
      const Vector3<double> d = p.position[j] - x;
      const bool is_near = dot(d, d) < reach * reach, both_held = held & other.is_held();
      return is_near & !both_held;
    };
    // Rows of images are no runs of grains that may all be partners.
    if constexpr (broadphase::FindsRuns<decltype(finder)> && !Model::Domain::has_images) {
      if (finder.has_runs()) {
        const double reach = kind.shape.bounding_radius() + largest_radius + skin;
        finder.for_each_run(i,
                            [&](std::uint32_t from, std::uint32_t to) { append_within(p, from, to, x, reach, found); });
        if (species.size() == 1 && !held) continue;
        // Which of those within the largest reach come near enough, and may move.
        const std::size_t within = std::exchange(found.count, first);
        for (std::size_t k = first; k < within; ++k) found.add_if(is_partner(found.rows[k]), found.rows[k]);
        continue;
      }
    }
    finder.for_each_candidate(i, [&](std::uint32_t j) {
      if (!images.may_pair(i, j)) return;  // nor is it read: another thread may be putting padding rows in their place
      found.make_room(1);
      found.add_if(is_partner(j), j);
    });
    sort_ascending(std::span(found.rows).subspan(first, found.count - first));
  }
  chunk.candidate.assign(found.rows.begin(), found.rows.begin() + static_cast<std::ptrdiff_t>(found.count));
  for (std::size_t k = end - begin; k <= chunk_size; ++k) {
    chunk.candidate_first[k] = static_cast<std::uint32_t>(chunk.candidate.size());
  }
  list_owners(chunk);
}

}  // namespace dem::grain
