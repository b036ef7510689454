#pragma once

#include <dem/grain/broadphase/broad_phase.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/grain/contact_key.hpp>
#include <dem/grain/images.hpp>
#include <dem/grain/move.hpp>
#include <dem/grain/species.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace dem::grain {

/// A contact history on its way from one neighbour list to the next. It is named by the ids of the grains, which
/// sorting does not change.
template <int HistorySize>
struct Remembered {
  std::uint32_t i, j;     ///< id of the owner; id of the partner, or the upper half of a surface contact's key
  std::uint32_t feature;  ///< lower half of the key
  std::array<double, static_cast<std::size_t>(HistorySize)> history;
};

template <class Block, int HistorySize>
std::array<double, static_cast<std::size_t>(HistorySize)> history_of(const Block& last, int c) {
  std::array<double, static_cast<std::size_t>(HistorySize)> h;
  for (std::size_t k = 0; k < h.size(); ++k) h[k] = last.history[k][static_cast<std::size_t>(c)];
  return h;
}

/// Turns the vectors of a law's history round; `fields` is where it begins.
template <class Law>
void mirror_history(double* fields) {
  using History = typename Law::template History<double>;
  if constexpr (!std::is_empty_v<History>) {
    History h;
    std::memcpy(&h, fields, sizeof(h));
    Law::carry(h, [](const Vector3<double>& v) { return -v; });
    std::memcpy(fields, &h, sizeof(h));
  }
}

/// Turns the history of a pair contact round: seen from the other grain, its vectors point the other way.
template <class Model>
void mirror(Remembered<history_size<Model>>& r) {
  std::swap(r.i, r.j);
  r.feature = Model::Shape::mirrored(r.feature);
  double* fields = r.history.data() + normal_history_size<Model>;
  mirror_history<typename Model::Friction>(fields);
  mirror_history<typename Model::Rolling>(fields + friction_history_size<Model>);
}

/// Reads the committed histories of all contacts, those of pairs and those with surfaces apart.
template <class Model, class Particles>
void collect_memories(std::span<const Chunk<Model>> chunks, const Particles& p,
                      const Images<typename Model::Domain>& images, std::vector<Remembered<history_size<Model>>>& pairs,
                      std::vector<Remembered<history_size<Model>>>& surfaces) {
  constexpr int size = history_size<Model>;
  using Memory = ContactMemory<size>;
  pairs.clear();
  surfaces.clear();
  for (std::size_t index = 0; index < chunks.size(); ++index) {
    const Chunk<Model>& chunk = chunks[index];
    const Memory& of_pairs = chunk.pair_contacts.last;
    std::size_t k = 0;  // owner of the candidate, found by walking along: keys ascend
    for (int c = 0; c < of_pairs.count; ++c) {
      const std::uint64_t key = of_pairs.key[static_cast<std::size_t>(c)];
      const auto candidate = static_cast<std::uint32_t>(key >> 32);
      DEM_ASSERT(candidate < chunk.candidate.size(), "what is remembered is of a candidate");
      while (chunk.candidate_first[k + 1] <= candidate) ++k;
      pairs.push_back({p.id[index * chunk_size + k], p.id[images.grain_of(chunk.candidate[candidate])],
                       static_cast<std::uint32_t>(key), history_of<Memory, size>(of_pairs, c)});
    }
    const Memory& of_surfaces = chunk.surface_contacts.last;
    for (int c = 0; c < of_surfaces.count; ++c) {
      const std::uint64_t key = of_surfaces.key[static_cast<std::size_t>(c)];
      surfaces.push_back({p.id[index * chunk_size + SurfaceKey::local(key)], static_cast<std::uint32_t>(key >> 32),
                          static_cast<std::uint32_t>(key), history_of<Memory, size>(of_surfaces, c)});
    }
  }
}

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
/// images.
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
    const double radius_i = species[p.species[i]].shape.bounding_radius();
    const Vector3<double> x = p.position[i];
    finder.for_each_candidate(i, [&](std::uint32_t j) {
      if (!images.may_pair(i, j)) return;
      const Vector3<double> d = p.position[j] - x;
      const double reach = radius_i + species[p.species[j]].shape.bounding_radius() + skin;
      if (dot(d, d) < reach * reach) chunk.candidate.push_back(j);
    });
    std::sort(chunk.candidate.begin() + chunk.candidate_first[i - begin], chunk.candidate.end());
  }
  for (std::size_t k = end - begin; k <= chunk_size; ++k) {
    chunk.candidate_first[k] = static_cast<std::uint32_t>(chunk.candidate.size());
  }
  list_owners(chunk);
}

/// The reverse of the candidate lists: for each grain, where it is a partner in another chunk; owners ascending.
template <class Model>
void list_incoming(std::span<const Chunk<Model>> chunks, std::size_t grains,
                   const Images<typename Model::Domain>& images, std::vector<std::uint32_t>& first,
                   std::vector<Incoming>& incoming) {
  const auto for_each_foreign = [&](auto&& f) {
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      for (std::size_t k = 0; k < chunks[c].candidate.size(); ++k) {
        const std::uint32_t j = chunks[c].candidate[k];
        if (j / chunk_size != c)
          f(images.grain_of(j), Incoming{static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(k)});
      }
    }
  };
  first.assign(grains + 1, 0);
  for_each_foreign([&](std::uint32_t j, const Incoming&) { ++first[j + 1]; });
  for (std::size_t i = 0; i < grains; ++i) first[i + 1] += first[i];
  incoming.resize(first[grains]);
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for_each_foreign([&](std::uint32_t j, const Incoming& entry) { incoming[next[j]++] = entry; });
}

/// Drops the contact histories of grains that were removed.
template <class Particles, class Entries>
void forget_removed(const Particles& p, Entries& pairs, Entries& surfaces) {
  const auto is_gone = [&](std::uint32_t id) { return p.row_of[id] == p.gone; };
  std::erase_if(pairs, [&](const auto& r) { return is_gone(r.i) || is_gone(r.j); });
  std::erase_if(surfaces, [&](const auto& r) { return is_gone(r.i); });
}

template <class Memory, class Entry>
void remember(Memory& memory, std::uint64_t key, const Entry& entry) {
  const auto at = static_cast<std::size_t>(memory.count++);
  if (memory.key.size() <= at) memory.reserve((at + 1) * 2);
  memory.key[at] = key;
  for (std::size_t k = 0; k < entry.history.size(); ++k) memory.history[k][at] = entry.history[k];
}

/// The candidate among those of one grain that is grain j or an image of it; as many as there are if none is.
template <class Images>
std::size_t candidate_of(std::span<const std::uint32_t> candidates, std::uint32_t j, const Images& images) {
  const auto at = std::lower_bound(candidates.begin(), candidates.end(), j);
  if (at != candidates.end() && *at == j) return static_cast<std::size_t>(at - candidates.begin());
  if constexpr (std::is_same_v<Images, ImageRows>) {
    for (std::size_t k = candidates.size(); k-- > 0 && candidates[k] >= images.first;) {
      if (images.grain_of(candidates[k]) == j) return k;
    }
  }
  return candidates.size();
}

/// Hands the contact histories to the chunks that own the contacts now, with the keys of the new candidate lists.
template <class Model, class Particles>
void return_memories(std::span<Chunk<Model>> chunks, const Particles& p, const Images<typename Model::Domain>& images,
                     std::vector<Remembered<history_size<Model>>>& pairs,
                     std::vector<Remembered<history_size<Model>>>& surfaces) {
  using Entry = Remembered<history_size<Model>>;
  for (Entry& r : pairs) {
    if (p.row_of[r.i] > p.row_of[r.j]) mirror<Model>(r);
    r.i = p.row_of[r.i];
    r.j = p.row_of[r.j];
  }
  for (Entry& r : surfaces) r.i = p.row_of[r.i];
  const auto by_place = [](const Entry& a, const Entry& b) {
    return std::tie(a.i, a.j, a.feature) < std::tie(b.i, b.j, b.feature);
  };
  std::sort(pairs.begin(), pairs.end(), by_place);
  // A surface contact's key holds the old place in the chunk; then sort by chunk and key.
  for (Entry& r : surfaces) {
    const std::uint64_t key = SurfaceKey::with_local(std::uint64_t{r.j} << 32 | r.feature, r.i % chunk_size);
    r = {r.i / static_cast<std::uint32_t>(chunk_size), static_cast<std::uint32_t>(key >> 32),
         static_cast<std::uint32_t>(key), r.history};
  }
  std::sort(surfaces.begin(), surfaces.end(), by_place);

  for (Chunk<Model>& chunk : chunks) chunk.pair_contacts.last.count = chunk.surface_contacts.last.count = 0;
  for (const Entry& r : pairs) {
    Chunk<Model>& chunk = chunks[r.i / chunk_size];
    const std::uint32_t from = chunk.candidate_first[r.i % chunk_size],
                        to = chunk.candidate_first[r.i % chunk_size + 1];
    const std::size_t at = candidate_of(std::span(chunk.candidate).subspan(from, to - from), r.j, images);
    if (at == to - from) continue;  // parted since
    remember(chunk.pair_contacts.last, std::uint64_t(from + at) << 32 | r.feature, r);
  }
  for (const Entry& r : surfaces) {
    remember(chunks[r.i].surface_contacts.last, std::uint64_t{r.j} << 32 | r.feature, r);
  }
}

}  // namespace dem::grain
