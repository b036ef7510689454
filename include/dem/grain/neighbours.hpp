#pragma once

#include <dem/grain/broadphase/broad_phase.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/grain/images.hpp>
#include <dem/grain/move.hpp>
#include <dem/grain/species.hpp>

#include <algorithm>
#include <span>
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

/// Candidates of one chunk: all j > i whose bounding spheres come within the skin, ascending; grains first, then
/// images. No two that are held.
template <class Model, class Particles, class BroadPhase>
void list_candidates(std::size_t chunk_index, Chunk<Model>& chunk, const Particles& p, const BroadPhase& broad_phase,
                     const Images<typename Model::Domain>& images,
                     std::span<const Species<typename Model::Shape>> species, double skin) {
  const std::size_t begin = chunk_index * chunk_size;
  const std::size_t end = std::min(begin + chunk_size, p.count);
  auto finder = broad_phase.finder();
  const bool one_species = species.size() == 1;
  std::vector<std::uint32_t> found(chunk.candidate.size() + 16 * chunk_size);
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t first = count;
    chunk.candidate_first[i - begin] = static_cast<std::uint32_t>(first);
    const auto& kind = species[p.species[i]];
    const double radius_i = kind.shape.bounding_radius();
    const bool held = kind.is_held();
    const Vector3<double> x = p.position[i];
    finder.for_each_candidate(i, [&](std::uint32_t j) {
      if (!images.may_pair(i, j)) return;  // nor is it read: another thread may be putting padding rows in their place
      if (count == found.size()) [[unlikely]]
        found.resize(2 * count);
      const Vector3<double> d = p.position[j] - x;
      const auto& other = one_species ? kind : species[p.species[j]];
      const double reach = radius_i + other.shape.bounding_radius() + skin;
      const bool near = dot(d, d) < reach * reach;
      const bool may_move = !(held && other.is_held());
      found[count] = j;  // whether it counts is a toss-up: without a branch
      count += std::size_t{near} & std::size_t{may_move};
    });
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.begin() + static_cast<std::ptrdiff_t>(count));
  }
  chunk.candidate.assign(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t k = end - begin; k <= chunk_size; ++k) {
    chunk.candidate_first[k] = static_cast<std::uint32_t>(chunk.candidate.size());
  }
  list_owners(chunk);
}

}  // namespace dem::grain
