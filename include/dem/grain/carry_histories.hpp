#pragma once

#include <dem/core/sorted.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/grain/contact_key.hpp>
#include <dem/grain/images.hpp>
#include <dem/parallel/blocks.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>
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

/// Carries the contact histories from one neighbour list to the next: collect(), while the old list is there, and
/// hand_out(), when the new one is. Grains may be sorted and removed in between. Threads share the work by chunks.
template <class Model>
class HistoryCarrier {
  static constexpr int size = history_size<Model>;
  using Entry = Remembered<size>;
  using Histories = ContactHistories<size>;

 public:
  /// Reads the committed histories of all contacts.
  template <class Executor, class GrainColumns>
  void collect(Executor& executor, std::span<const Chunk<Model>> chunks, const GrainColumns& p,
               const Images<typename Model::Domain>& images) {
    const auto pairs_first = counts(chunks, [](const Chunk<Model>& c) { return c.pair_contacts.last.count; });
    const auto surfaces_first = counts(chunks, [](const Chunk<Model>& c) { return c.surface_contacts.last.count; });
    pairs_.resize(pairs_first.back());
    surfaces_.resize(surfaces_first.back());
    executor.for_each(chunks.size(), [&](std::size_t index) {
      const Chunk<Model>& chunk = chunks[index];
      const Histories& of_pairs = chunk.pair_contacts.last;
      std::size_t k = 0;  // owner of the candidate, found by walking along: keys ascend
      for (int c = 0; c < of_pairs.count; ++c) {
        const PairKey key = {of_pairs.key[static_cast<std::size_t>(c)]};
        const std::size_t candidate = key.candidate();
        DEM_ASSERT(candidate < chunk.candidate.size(), "what is remembered is of a candidate");
        while (chunk.candidate_first[k + 1] <= candidate) ++k;
        pairs_[pairs_first[index] + static_cast<std::size_t>(c)] = {
            p.id[index * chunk_size + k], p.id[images.grain_of(chunk.candidate[candidate])], key.feature(),
            history_of<Histories, size>(of_pairs, c)};
      }
      const Histories& of_surfaces = chunk.surface_contacts.last;
      for (int c = 0; c < of_surfaces.count; ++c) {
        const SurfaceKey key = {of_surfaces.key[static_cast<std::size_t>(c)]};
        surfaces_[surfaces_first[index] + static_cast<std::size_t>(c)] = {p.id[index * chunk_size + key.local()],
                                                                          key.upper(), key.lower(),
                                                                          history_of<Histories, size>(of_surfaces, c)};
      }
    });
  }

  /// Forgets the contacts of grains that are gone, so that their ids may be given again.
  template <class GrainColumns>
  void forget_gone(const GrainColumns& p) {
    std::erase_if(pairs_, [&](const Entry& r) { return p.row_of[r.i] == p.gone || p.row_of[r.j] == p.gone; });
    std::erase_if(surfaces_, [&](const Entry& r) { return p.row_of[r.i] == p.gone; });
  }
  /// The history of a contact that grains bring with them: of grains i and j (ids), as i sees it.
  void add_pair(std::uint32_t i, std::uint32_t j, std::uint32_t feature,
                const std::array<double, static_cast<std::size_t>(size)>& history) {
    pairs_.push_back({i, j, feature, history});
  }
  /// The same of grain i on a surface; of the key, the grain's place in its chunk does not count.
  void add_surface(std::uint32_t i, SurfaceKey key, const std::array<double, static_cast<std::size_t>(size)>& history) {
    surfaces_.push_back({i, key.upper(), key.lower(), history});
  }

  /// Hands them to the chunks that own the contacts now, with the keys of the new candidate lists. Those of grains that
  /// were removed or have parted are dropped. `send_home(entries)` puts entries, which know their rows, into the
  /// process that has the chunk.
  template <class Executor, class GrainColumns, class SendHome>
  void hand_out(Executor& executor, std::span<Chunk<Model>> chunks, const GrainColumns& p,
                const Images<typename Model::Domain>& images, SendHome&& send_home) {
    const auto by_chunk = [&](std::vector<Entry>& entries, auto&& rename) {
      exec::for_each_block(executor, entries.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) rename(entries[k]);
      });
      send_home(entries);
      std::vector<std::uint32_t> chunk_of(entries.size());
      exec::for_each_block(executor, entries.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
          const auto none = static_cast<std::uint32_t>(chunks.size());
          chunk_of[k] = entries[k].i == p.gone ? none : static_cast<std::uint32_t>(entries[k].i / chunk_size);
        }
      });
      return group(chunk_of, chunks.size());
    };
    const Groups of_pairs = by_chunk(pairs_, [&](Entry& r) {
      r.i = p.row_of[r.i];
      r.j = p.row_of[r.j];
      if (r.j == p.gone) r.i = p.gone;
      if (r.i != p.gone && r.i > r.j) mirror<Model>(r);
    });
    const Groups of_surfaces = by_chunk(surfaces_, [&](Entry& r) { r.i = p.row_of[r.i]; });

    executor.for_each(chunks.size(), [&](std::size_t c) {
      Chunk<Model>& chunk = chunks[c];
      std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;  // and the entry
      for (std::uint32_t k = of_pairs.first[c]; k < of_pairs.first[c + 1]; ++k) {
        const Entry& r = pairs_[of_pairs.entry[k]];
        const std::uint32_t from = chunk.candidate_first[r.i % chunk_size];
        const std::uint32_t to = chunk.candidate_first[r.i % chunk_size + 1];
        const std::size_t at = candidate_of(std::span(chunk.candidate).subspan(from, to - from), r.j, images);
        if (at == to - from) continue;  // parted since
        keys.emplace_back(PairKey::make(from + at, r.feature).value, of_pairs.entry[k]);
      }
      remember(chunk.pair_contacts.last, keys, pairs_);
      keys.clear();
      for (std::uint32_t k = of_surfaces.first[c]; k < of_surfaces.first[c + 1]; ++k) {
        const Entry& r = surfaces_[of_surfaces.entry[k]];
        const SurfaceKey old = SurfaceKey::whole(r.j, r.feature);  // with the old place in the chunk
        keys.emplace_back(old.with_local(r.i % chunk_size).value, of_surfaces.entry[k]);
      }
      remember(chunk.surface_contacts.last, keys, surfaces_);
    });
  }

 private:
  /// The entries of each chunk: entry[first[c]] to entry[first[c + 1]].
  struct Groups {
    std::vector<std::uint32_t> first, entry;
  };
  /// From the chunk of each entry, which is `chunks` for those that are in none.
  static Groups group(const std::vector<std::uint32_t>& chunk_of, std::size_t chunks) {
    Groups g;
    g.first.assign(chunks + 1, 0);
    for (const std::uint32_t c : chunk_of) ++g.first[c];
    std::uint32_t total = 0;
    for (std::uint32_t& n : g.first) total += std::exchange(n, total);  // those in no chunk come last
    g.entry.resize(g.first[chunks]);
    std::vector<std::uint32_t> next(g.first.begin(), g.first.end() - 1);
    for (std::size_t k = 0; k < chunk_of.size(); ++k) {
      if (chunk_of[k] < chunks) g.entry[next[chunk_of[k]]++] = static_cast<std::uint32_t>(k);
    }
    return g;
  }
  /// Where each chunk's entries begin, and how many there are.
  template <class Count>
  static std::vector<std::size_t> counts(std::span<const Chunk<Model>> chunks, Count&& count) {
    std::vector<std::size_t> first(chunks.size() + 1, 0);
    for (std::size_t c = 0; c < chunks.size(); ++c)
      first[c + 1] = first[c] + static_cast<std::size_t>(count(chunks[c]));
    return first;
  }
  static void remember(Histories& histories, std::vector<std::pair<std::uint64_t, std::uint32_t>>& keys,
                       const std::vector<Entry>& entries) {
    sort_ascending(keys);
    histories.count = static_cast<int>(keys.size());
    if (histories.key.size() < keys.size()) histories.reserve(keys.size() * 5 / 4);
    for (std::size_t at = 0; at < keys.size(); ++at) {
      histories.key[at] = keys[at].first;
      const auto& history = entries[keys[at].second].history;
      for (std::size_t k = 0; k < history.size(); ++k) histories.history[k][at] = history[k];
    }
  }

  std::vector<Entry> pairs_, surfaces_;
};

}  // namespace dem::grain
