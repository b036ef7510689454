#pragma once

// Neighbour lists of ranks that do not know all grains (domain::Ranks): each sorts its own, and hears of those that its
// own may touch. The rows are numbered as if one process had them all.

#include <dem/grain/broadphase/nearly_sorted.hpp>
#include <dem/grain/neighbours.hpp>
#include <dem/world/border.hpp>
#include <dem/world/choose_skin.hpp>
#include <dem/world/gather.hpp>
#include <dem/world/row_order.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace dem {

/// Whether ranks may list by parts. Images are made of all grains, and not every broad phase sorts each by itself.
template <class Model>
inline constexpr bool lists_parts =
    Model::Domain::has_ranks && !Model::Domain::has_images && broadphase::SortsByPlace<typename Model::BroadPhase>;

/// Whether this process has a part of the grains, and lists that alone: not between runs, when every rank knows all of
/// them, nor where machine parts hold grains, which every rank carries along.
template <class Model>
bool has_parts(const WorldState<Model>& w) {
  if constexpr (lists_parts<Model>) {
    return w.domain.is_shared() && !w.domain.is_whole && !w.chunks.empty() && w.held.empty();
  }
  return false;
}

namespace detail {

/// Of this process's grains, all but those that are gone: by what they are sorted among all, and in that order.
template <class Model>
std::vector<typename Model::Domain::SortKey> sort_keys(WorldState<Model>& w, double reach, bool sleepers_last) {
  const auto& p = w.grains;
  std::vector<typename Model::Domain::SortKey> keys, scratch;
  std::vector<float> work;
  const auto [begin, end] = w.own_chunks();
  for (std::size_t c = begin; c < end; ++c) append_work(w, c, work);
  const std::size_t first = begin * chunk_size;
  for (std::size_t k = 0; k < work.size(); ++k) {
    const std::uint32_t id = p.id[first + k];
    if (p.row_of[id] == p.gone) continue;
    keys.push_back({.place = Model::BroadPhase::place(p.position[first + k], reach),
                    .row = static_cast<std::uint32_t>(first + k),
                    .work = work[k],
                    .asleep = sleepers_last && is_asleep(w, id) ? 1u : 0u});
  }
  broadphase::sort_nearly_sorted(
      keys, scratch, [](const auto& a, const auto& b) { return a < b; }, w.executor);
  return keys;
}

/// Tells the other ranks, which remember contacts with grains of this one, their new rows (`gone`: taken out).
template <class Model>
void tell_new_rows(WorldState<Model>& w) {
  auto& d = w.domain;
  auto& p = w.grains;
  std::vector<std::vector<std::uint32_t>> to;
  for (const auto& border : d.borders) {
    auto& rows = to.emplace_back();
    for (const std::uint32_t row : border.rows_out) rows.push_back(p.row_of[p.id[row]]);
  }
  const auto came = d.exchanged(to).first;
  std::size_t next = 0;
  for (const auto& border : d.borders) {
    for (const std::uint32_t row : border.rows_in) p.row_of[p.id[row]] = came[next++];
  }
}

/// Puts this process's grains, and those that come from other ranks, into their new rows; those that go elsewhere are
/// sent there. `to[k]` is the new row of keys[k], `all` how many grains there are.
template <class Model, class Keys>
void move_parts(WorldState<Model>& w, const Keys& keys, const std::vector<std::uint32_t>& to, std::size_t all) {
  auto& d = w.domain;
  auto& p = w.grains;
  struct Mover {
    std::uint32_t row, id, species;
  };
  const auto ranks = static_cast<std::size_t>(d.ranks());
  std::vector<std::vector<Mover>> movers(ranks);
  std::vector<std::vector<double>> numbers(ranks);
  std::vector<std::vector<grain::Rest>> rests(ranks);
  std::vector<AlignedVector<double>*> columns;
  p.for_each_state_column([&](AlignedVector<double>& column) { columns.push_back(&column); });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stays;  // rows, before and after
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::uint32_t from = keys[k].row, id = p.id[from];
    if (d.owns(to[k] / chunk_size)) {
      stays.emplace_back(from, to[k]);
      continue;
    }
    const auto r = static_cast<std::size_t>(d.owner(to[k] / chunk_size));
    movers[r].push_back({to[k], id, p.species[from]});
    for (const auto* column : columns) numbers[r].push_back((*column)[from]);
    if (w.options.sleep) rests[r].push_back(id < w.sleepers.grains.size() ? w.sleepers.grains[id] : grain::Rest{});
  }
  const auto came = d.exchanged(movers).first;
  const auto came_numbers = d.exchanged(numbers).first;

  const std::size_t begin = d.own().first * chunk_size, end = std::min(d.own().second * chunk_size, all);
  // Each column is read before it is written, as new rows are old rows of other grains.
  const auto put = [&]<class T>(T* column, auto&& of_comer) {
    std::vector<T> values(end - std::min(begin, end));
    for (const auto& [from, after] : stays) values[after - begin] = column[from];
    for (std::size_t m = 0; m < came.size(); ++m) values[came[m].row - begin] = of_comer(m);
    std::copy(values.begin(), values.end(), column + begin);
  };
  w.executor.for_each(columns.size(), [&](std::size_t c) {
    put(columns[c]->data(), [&](std::size_t m) { return came_numbers[m * columns.size() + c]; });
  });
  put(p.id.data(), [&](std::size_t m) { return came[m].id; });
  put(p.species.data(), [&](std::size_t m) { return came[m].species; });
  if (w.options.sleep) {
    w.sleepers.grains.resize(p.row_of.size());
    const auto came_rests = d.exchanged(rests).first;
    for (std::size_t m = 0; m < came.size(); ++m) w.sleepers.grains[came[m].id] = came_rests[m];
  }
  p.resize(all);
  for (std::size_t i = begin; i < end; ++i) p.row_of[p.id[i]] = static_cast<std::uint32_t>(i);
  d.has_names = false;
}

/// What neighbours are listed of: this process's grains, then those of chunks behind them that these may touch.
struct NearRows {
  Columns3 position;  ///< m
  std::vector<std::uint32_t> species;
  std::vector<std::uint32_t> row;  ///< of each in the world, ascending
  std::size_t count = 0;

  void add(std::uint32_t at, const Vector3<double>& x, std::uint32_t kind) {
    position.x.push_back(x.x), position.y.push_back(x.y), position.z.push_back(x.z);
    species.push_back(kind);
    row.push_back(at);
    ++count;
  }
};

/// A box around grains; at first around none.
struct GrainBox {
  Vector3<double> low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void add(const Vector3<double>& from, const Vector3<double>& to) {
    low = {std::min(low.x, from.x), std::min(low.y, from.y), std::min(low.z, from.z)};
    high = {std::max(high.x, to.x), std::max(high.y, to.y), std::max(high.z, to.z)};
  }
  bool meets(const GrainBox& o, double gap) const {
    return low.x - gap <= o.high.x && o.low.x - gap <= high.x && low.y - gap <= o.high.y && o.low.y - gap <= high.y &&
           low.z - gap <= o.high.z && o.low.z - gap <= high.z;
  }
};

/// Boxes around the two parts of a chunk, before and behind the farthest jump of the curve in it.
struct ChunkBoxes {
  GrainBox before, behind;

  bool meets(const GrainBox& o, double gap) const { return before.meets(o, gap) || behind.meets(o, gap); }
  bool meets(const ChunkBoxes& o, double gap) const { return meets(o.before, gap) || meets(o.behind, gap); }
};

/// The boxes of this process's chunks; `cell` (m): the reach that grains were sorted by.
template <class Model>
std::vector<ChunkBoxes> boxes_of_chunks(const WorldState<Model>& w, double cell) {
  const auto& p = w.grains;
  std::vector<ChunkBoxes> boxes;
  const auto [first, last] = w.own_chunks();
  for (std::size_t c = first; c < last; ++c) {
    const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, p.count);
    std::size_t split = end;
    std::uint64_t jump = 0, place = Model::BroadPhase::place(p.position[begin], cell);
    for (std::size_t i = begin + 1; i < end; ++i) {
      const std::uint64_t next = Model::BroadPhase::place(p.position[i], cell);
      if ((place ^ next) > jump) jump = place ^ next, split = i;
      place = next;
    }
    ChunkBoxes& box = boxes.emplace_back();
    for (std::size_t i = begin; i < end; ++i) (i < split ? box.before : box.behind).add(p.position[i], p.position[i]);
  }
  return boxes;
}

/// The chunks of higher ranks whose grains those of this process may touch (m: `reach`): by the boxes of all chunks,
/// which all ranks tell each other.
template <class Model>
std::vector<std::uint32_t> chunks_within_reach(const WorldState<Model>& w, double reach, double cell) {
  const std::vector<ChunkBoxes> own = boxes_of_chunks(w, cell), all = w.domain.gathered(own, false);
  GrainBox around;
  for (const ChunkBoxes& box : own) {
    around.add(box.before.low, box.before.high), around.add(box.behind.low, box.behind.high);
  }
  std::vector<std::uint32_t> near;
  for (std::size_t c = w.own_chunks().second; c < all.size(); ++c) {
    if (!all[c].meets(around, reach)) continue;
    const auto meets = [&](const ChunkBoxes& box) { return box.meets(all[c], reach); };
    if (std::any_of(own.begin(), own.end(), meets)) near.push_back(static_cast<std::uint32_t>(c));
  }
  return near;
}

/// Asks the other ranks for the grains of chunks that this process's grains may touch (m: `reach`); `cell` (m): the
/// reach that grains were sorted by.
template <class Model>
NearRows find_near_rows(WorldState<Model>& w, double reach, double cell) {
  auto& d = w.domain;
  auto& p = w.grains;
  struct Told {
    Vector3<double> position;
    std::uint32_t id, species;
  };
  NearRows near;
  const auto [begin, end] = w.own_chunks();
  for (std::size_t i = begin * chunk_size; i < std::min(end * chunk_size, p.count); ++i) {
    near.add(static_cast<std::uint32_t>(i), p.position[i], p.species[i]);
  }
  std::vector<std::vector<std::uint32_t>> asked(static_cast<std::size_t>(d.ranks()));
  for (const std::uint32_t c : chunks_within_reach(w, reach, cell))
    asked[static_cast<std::size_t>(d.owner(c))].push_back(c);
  const auto wanted = d.exchanged(asked);
  std::vector<std::vector<Told>> told(asked.size());
  for (std::size_t r = 0; r < told.size(); ++r) {
    for (int k = wanted.second[r]; k < wanted.second[r + 1]; ++k) {
      const std::size_t c = wanted.first[static_cast<std::size_t>(k)];
      for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, p.count); ++i) {
        told[r].push_back({p.position[i], p.id[i], p.species[i]});
      }
    }
  }
  const auto came = d.exchanged(told).first;
  auto next = came.begin();
  for (const auto& of_rank : asked) {
    for (const std::size_t c : of_rank) {
      for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, p.count); ++i, ++next) {
        near.add(static_cast<std::uint32_t>(i), next->position, next->species);
        p.id[i] = next->id;
        p.species[i] = next->species;
        p.row_of[next->id] = static_cast<std::uint32_t>(i);
      }
    }
  }
  return near;
}

}  // namespace detail

/// Sorts the grains of all ranks, cuts their chunks by work, and lists the neighbours of those of this process, with
/// the skin that is returned (m). No rank looks at all grains.
template <class Model>
double list_part(WorldState<Model>& w) {
  auto& d = w.domain;
  auto& p = w.grains;
  p.note_gone(w.to_remove);
  const std::size_t all = p.count - w.to_remove.size();
  w.to_remove.clear();
  if (all == 0) {
    p.resize(0);
    w.chunks.clear();
    w.incoming.clear();
    cut_chunks(w), make_borders(w);
    return w.list_skin;
  }
  give_up_list(w);
  const auto rows = [&] {
    const auto [begin, end] = w.own_chunks();
    return std::pair(std::min(begin * chunk_size, p.count), std::min(end * chunk_size, p.count));
  };
  std::vector<double> kept(w.species.size(), 0.0), asleep(1, 0.0);
  for (auto [i, end] = rows(); i < end; ++i) {
    if (p.row_of[p.id[i]] == p.gone) continue;
    kept[p.species[i]] += 1.0;
    if (is_asleep(w, p.id[i])) asleep[0] += 1.0;
  }
  d.share_sums(kept), d.share_sums(asleep);
  const bool sleepers_last = w.options.sleep && sleepers_go_last(static_cast<std::size_t>(asleep[0]), all);
  const double skin = choose_skin(w, kept);
  const double range = w.materials.range() + skin, reach = list_reach(w, skin);

  const auto keys = detail::sort_keys(w, reach, sleepers_last);
  const auto sorted = d.sort_rows(keys, all, chunk_size);
  for (std::size_t k = 0; k < keys.size(); ++k) p.row_of[p.id[keys[k].row]] = sorted.row[k];
  detail::tell_new_rows(w);
  d.cut(sorted.work_of_chunks);
  detail::move_parts(w, keys, sorted.row, all);
  p.note_listed(rows().first, rows().second);
  p.pad();
  w.chunks.resize(p.chunks());

  // Sums in another order may be larger in the last bit.
  const detail::NearRows near = detail::find_near_rows(w, std::max(reach, 2.0 * w.largest_radius + range), reach);
  const broadphase::Positions at = {near.position.x.data(), near.position.y.data(), near.position.z.data(), near.count};
  broadphase::build(w.broad_phase, at, reach, w.executor);
  if (!sleepers_last)
    broadphase::reordered(w.broad_phase, w.executor);  // near rows are in the order of space, as all are
  const auto [begin, end] = w.own_chunks();
  w.executor.for_each(end - begin, [&, first = begin](std::size_t k) {
    Chunk<Model>& chunk = w.chunks[first + k];
    grain::list_candidates<Model>(k * chunk_size, chunk, near, w.broad_phase, w.images, w.species, w.largest_radius,
                                  range);
    for (std::uint32_t& j : chunk.candidate) j = near.row[j];
    grain::refresh_chunk<Model>(first + k, chunk, p, w.species);
  });
  make_borders(w);
  ++d.lists_of_parts;
  return skin;
}

}  // namespace dem
