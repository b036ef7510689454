#pragma once

// What ranks tell each other between steps, when neighbours are listed and as energy is counted (domain::Ranks): all of
// it by all ranks at once.

#include <dem/world/state.hpp>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace dem {

/// Appends the work that each grain of a chunk is, in candidates that are looked at. Counted, not measured: so every
/// rank cuts alike.
template <class Model>
void append_work(const WorldState<Model>& w, std::size_t c, std::vector<float>& to) {
  constexpr float motion = 10, contact = shape::BitShape<typename Model::Shape> ? 8 : 40, asleep = 1;
  const Chunk<Model>& chunk = w.chunks[c];
  const std::size_t rows = std::min((c + 1) * chunk_size, w.grains.count) - c * chunk_size, first = to.size();
  for (std::size_t k = 0; k < rows; ++k) {
    const auto candidates = static_cast<float>(chunk.candidate_first[k + 1] - chunk.candidate_first[k]);
    const std::uint32_t id = w.grains.id[c * chunk_size + k];
    to.push_back(is_asleep(w, id) ? asleep : motion + candidates);
  }
  if (chunk.asleep) return;
  const auto& contacts = chunk.pair_contacts.last;
  const auto& doing = w.sleepers.doing;
  for (int k = 0; k < contacts.count; ++k) {
    const std::size_t candidate = grain::PairKey{contacts.key[static_cast<std::size_t>(k)]}.candidate();
    const std::size_t i = c * chunk_size + chunk.owner[candidate], j = chunk.candidate[candidate];
    if (w.options.sleep && std::max(i, j) < doing.size() && grain::sleeps(doing, i, j)) continue;
    to[first + chunk.owner[candidate]] += contact;
  }
}

/// Counts the work that each grain of this rank's chunks is, and tells all ranks.
template <class Model>
void count_work(WorldState<Model>& w) {
  auto& d = w.domain;
  const auto& p = w.grains;
  d.work.resize(p.row_of.size(), 0.0f);
  if (!d.is_shared() || w.chunks.empty()) return;
  std::vector<float> mine;
  const auto [begin, end] = d.own();
  for (std::size_t c = begin; c < end; ++c) append_work(w, c, mine);
  const std::vector<float> all = d.gathered(mine, false);
  for (std::size_t row = 0; row < all.size(); ++row) d.work[p.id[row]] = all[row];
}

/// Cuts the chunks into the ranges of the ranks. Of a grain whose work was not counted yet nothing is known but the
/// mean.
template <class Model>
void cut_chunks(WorldState<Model>& w) {
  const auto& p = w.grains;
  auto& work = w.domain.work;
  work.resize(p.row_of.size(), 0.0f);
  double sum = 0.0, known = 0.0;
  for (const float x : work) sum += x, known += x > 0.0f ? 1.0 : 0.0;
  const double mean = known > 0.0 ? sum / known : 1.0;
  std::vector<double> of_chunks(w.chunks.size(), 0.0);
  for (std::size_t c = 0; c < of_chunks.size(); ++c) {
    for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, p.count); ++i) {
      of_chunks[c] += work[p.id[i]] > 0.0f ? work[p.id[i]] : mean;
    }
  }
  w.domain.cut(of_chunks);
}

/// What every rank knows of resting grains becomes what their owners know.
template <class Model>
void gather_resting(WorldState<Model>& w) {
  if (!w.options.sleep) return;
  const auto& p = w.grains;
  const auto [begin, end] = w.domain.own();
  auto& resting = w.sleepers.grains;
  std::vector<grain::Rest> rests;
  for (std::size_t i = begin * chunk_size; i < std::min(end * chunk_size, p.count); ++i) {
    rests.push_back(p.id[i] < resting.size() ? resting[p.id[i]] : grain::Rest{});
  }
  rests = w.domain.gathered(rests, false);
  for (std::size_t row = 0; row < rests.size(); ++row) {
    if (p.id[row] < resting.size()) resting[p.id[row]] = rests[row];
  }
}

/// Every rank knows which chunks are around each: grains that are moved or taken out wake the same ones on all ranks.
template <class Model>
void gather_around(WorldState<Model>& w) {
  if (!w.domain.is_shared()) return;
  std::vector<std::uint32_t> counts, chunks;
  const auto [begin, end] = w.domain.own();
  for (std::size_t c = begin; c < end; ++c) {
    const auto& around = w.chunks[c].around;
    counts.push_back(static_cast<std::uint32_t>(around.size()));
    chunks.insert(chunks.end(), around.begin(), around.end());
  }
  counts = w.domain.gathered(counts, false), chunks = w.domain.gathered(chunks, false);
  auto next = chunks.begin();
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    w.chunks[c].around.assign(next, next + counts[c]);
    next += counts[c];
  }
}

/// Every rank knows which grain each row holds, of which species it is, and where it was listed.
template <class Model>
void gather_names(WorldState<Model>& w) {
  auto& d = w.domain;
  if (d.has_names) return;
  auto& p = w.grains;
  d.gather_chunks(p.id.data(), chunk_size);
  d.gather_chunks(p.species.data(), chunk_size);
  p.listed_at.for_each_column([&](AlignedVector<double>& column) { d.gather_chunks(column.data(), chunk_size); });
  for (std::size_t row = 0; row < p.count; ++row) {
    std::uint32_t& at = p.row_of[p.id[row]];
    if (at != p.gone) at = static_cast<std::uint32_t>(row);
  }
  d.has_names = true;
}

/// Every rank's rows of all grains become those of their owners, and so do the bounds of chunks and what is known of
/// resting grains. Nothing where they are already.
template <class Model>
void gather_rows(WorldState<Model>& w) {
  auto& d = w.domain;
  if (d.is_whole) return;
  gather_names(w);
  auto& p = w.grains;
  p.for_each_state_column([&](AlignedVector<double>& column) { d.gather_chunks(column.data(), chunk_size); });

  struct Summary {
    double low[3], high[3], moved2;
    DeepestContact deepest;
    bool finite, asleep;
  };
  std::vector<Summary> summaries;
  const auto [begin, end] = d.own();
  for (std::size_t c = begin; c < end; ++c) {
    const Chunk<Model>& k = w.chunks[c];
    summaries.push_back({{k.low.x(), k.low.y(), k.low.z()},
                         {k.high.x(), k.high.y(), k.high.z()},
                         k.moved2,
                         k.deepest,
                         k.finite,
                         k.asleep});
  }
  summaries = d.gathered(summaries, false);
  for (std::size_t c = 0; c < summaries.size(); ++c) {
    const Summary& s = summaries[c];
    Chunk<Model>& chunk = w.chunks[c];
    chunk.low = Vec3(s.low[0], s.low[1], s.low[2]);
    chunk.high = Vec3(s.high[0], s.high[1], s.high[2]);
    chunk.moved2 = s.moved2;
    chunk.deepest = s.deepest;
    chunk.finite = s.finite;
    chunk.asleep = s.asleep;
  }

  gather_resting(w);
  d.is_whole = true;
}

/// Before grains are sorted: where they are, which is what every rank needs to know of all of them. Returns who has
/// all else of each grain, by id; empty where every rank does.
template <class Model>
std::vector<std::uint16_t> gather_positions(WorldState<Model>& w) {
  auto& d = w.domain;
  const auto& p = w.grains;
  if (d.is_whole) return {};
  gather_names(w);
  w.grains.position.for_each_column([&](AlignedVector<double>& column) { d.gather_chunks(column.data(), chunk_size); });
  gather_resting(w);
  std::vector<std::uint16_t> holders(p.row_of.size(), 0);
  for (std::size_t i = 0; i < p.count; ++i) {
    holders[p.id[i]] = static_cast<std::uint16_t>(d.owner(i / chunk_size));
  }
  return holders;
}

/// Sorts the rows, of which this rank has all but the position only where it holds them.
template <class Model>
void permute_rows(WorldState<Model>& w, const std::vector<std::uint32_t>& order,
                  const std::vector<std::uint16_t>& holders) {
  auto& p = w.grains;
  if (holders.empty()) return p.permute(order, w.executor);
  std::vector<std::uint32_t> held;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (holders[p.id[order[k]]] == w.domain.rank()) held.push_back(static_cast<std::uint32_t>(k));
  }
  p.permute(order, w.executor, &held);
}

/// When grains are sorted and chunks have new owners: the rows of grains that other ranks had come to these.
template <class Model>
void move_rows(WorldState<Model>& w, const std::vector<std::uint16_t>& holders) {
  if (holders.empty()) return;
  auto& d = w.domain;
  auto& p = w.grains;
  std::vector<AlignedVector<double>*> columns;
  p.for_each_state_column([&](AlignedVector<double>& column) { columns.push_back(&column); });
  const auto rows_of = [&](int rank) {
    const auto [first, last] = d.chunks_of(rank);
    return std::pair(std::min(first * chunk_size, p.count), std::min(last * chunk_size, p.count));
  };
  std::vector<std::vector<double>> to(static_cast<std::size_t>(d.ranks()));
  for (int r = 0; r < d.ranks(); ++r) {
    const auto [first, last] = rows_of(r);
    for (std::size_t i = first; r != d.rank() && i < last; ++i) {
      if (holders[p.id[i]] != d.rank()) continue;
      for (const auto* column : columns) to[static_cast<std::size_t>(r)].push_back((*column)[i]);
    }
  }
  auto [came, next] = d.exchanged(to);  // of each rank, in the order of rows
  const auto [first, last] = rows_of(d.rank());
  for (std::size_t i = first; i < last; ++i) {
    const std::uint16_t from = holders[p.id[i]];
    if (from == d.rank()) continue;
    for (auto* column : columns) (*column)[i] = came[static_cast<std::size_t>(next[from]++)];
  }
}

/// Contact histories that were collected, and know their new rows, go to the ranks that own these.
template <class Model, class Entry>
void send_home(WorldState<Model>& w, std::vector<Entry>& entries) {
  auto& d = w.domain;
  if (!d.is_shared()) return;
  std::vector<std::vector<Entry>> to(static_cast<std::size_t>(d.ranks()));
  for (const Entry& e : entries) {
    if (e.i != w.grains.gone) to[static_cast<std::size_t>(d.owner(e.i / chunk_size))].push_back(e);
  }
  entries = d.exchanged(to).first;
}

}  // namespace dem
