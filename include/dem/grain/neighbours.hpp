#pragma once

#include <dem/grain/broadphase/broad_phase.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/grain/images.hpp>
#include <dem/grain/move.hpp>
#include <dem/grain/species.hpp>
#include <dem/grain/turns.hpp>

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
  chunk.candidate.clear();
  for (std::size_t i = begin; i < end; ++i) {
    chunk.candidate_first[i - begin] = static_cast<std::uint32_t>(chunk.candidate.size());
    const auto& kind = species[p.species[i]];
    const double radius_i = kind.shape.bounding_radius();
    const Vector3<double> x = p.position[i];
    finder.for_each_candidate(i, [&](std::uint32_t j) {
      if (!images.may_pair(i, j)) return;
      const Vector3<double> d = p.position[j] - x;
      const auto& other = species[p.species[j]];
      const double reach = radius_i + other.shape.bounding_radius() + skin;
      if (dot(d, d) < reach * reach && !(kind.is_held() && other.is_held())) chunk.candidate.push_back(j);
    });
    std::sort(chunk.candidate.begin() + chunk.candidate_first[i - begin], chunk.candidate.end());
  }
  for (std::size_t k = end - begin; k <= chunk_size; ++k) {
    chunk.candidate_first[k] = static_cast<std::uint32_t>(chunk.candidate.size());
  }
  list_owners(chunk);
}

/// The reverse of the candidate lists: for each grain, where it is a partner in another chunk; owners ascending. Lists
/// which chunks each chunk reaches, too.
template <class Model>
void list_incoming(std::span<Chunk<Model>> chunks, std::size_t grains, const Images<typename Model::Domain>& images,
                   std::vector<std::uint32_t>& first, std::vector<Incoming>& incoming) {
  const auto for_each_foreign = [&](auto&& f) {
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      for (std::size_t k = 0; k < chunks[c].candidate.size(); ++k) {
        const std::uint32_t j = chunks[c].candidate[k];
        if (j / chunk_size != c)
          f(images.grain_of(j), Incoming{static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(k)});
      }
    }
  };
  for (std::size_t c = 0; c < chunks.size(); ++c) list_reached(c, chunks[c], images);
  first.assign(grains + 1, 0);
  for_each_foreign([&](std::uint32_t j, const Incoming&) { ++first[j + 1]; });
  for (std::size_t i = 0; i < grains; ++i) first[i + 1] += first[i];
  incoming.resize(first[grains]);
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for_each_foreign([&](std::uint32_t j, const Incoming& entry) { incoming[next[j]++] = entry; });
}

}  // namespace dem::grain
