#pragma once

// What ranks tell each other in a step (domain::Ranks). A contact belongs to the chunk of its lower row, so the motion
// of partners goes from higher ranks to lower ones, and loads of contacts go the other way. In worlds that are not
// shared all of this is nothing.

#include <dem/world/images.hpp>

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace dem {

namespace detail {

/// A chunk of another rank has no candidates but those that reach this rank: most have none.
template <class Model>
void forget_contacts(Chunk<Model>& chunk) {
  const bool has_lists = !chunk.candidate.empty() || !chunk.sleeps.empty() || !chunk.surface_loads.empty();
  if (!has_lists && chunk.pair_contacts.last.count == 0 && chunk.surface_contacts.last.count == 0 &&
      chunk.partner_load_first.size() == 1) {
    return chunk.around.clear();
  }
  chunk.candidate.clear();
  chunk.candidate_first.fill(0);
  chunk.pair_contacts.last.count = chunk.surface_contacts.last.count = 0;
  chunk.partner_loads.clear();
  chunk.sleeps.clear();
  chunk.surface_loads.clear();
  chunk.around.clear();
  grain::list_owners(chunk);
}

/// Marks, beside their number, loads of contacts between sleepers.
inline constexpr std::uint32_t sleeping_load = 0x8000;

/// Appends the bytes of n items to a message.
template <class T>
void append(std::vector<std::byte>& message, const T* items, std::size_t n) {
  const std::size_t at = message.size();
  message.resize(at + n * sizeof(T));
  if (n > 0) std::memcpy(message.data() + at, items, n * sizeof(T));
}
/// Reads the next n items of a message.
template <class T>
void read(const std::vector<std::byte>& message, std::size_t& at, T* items, std::size_t n) {
  if (n > 0) std::memcpy(static_cast<void*>(items), message.data() + at, n * sizeof(T));
  at += n * sizeof(T);
}

}  // namespace detail

/// Agrees with the other ranks on what goes over the borders in each step. To be called when this rank's chunks have
/// their candidates. The chunks of other ranks get those candidates that are grains of this rank, in their order: sums
/// of forces are made from them as if the chunks were here.
template <class Model>
void make_borders(WorldState<Model>& w) {
  auto& d = w.domain;
  const auto ranks = static_cast<std::size_t>(d.ranks());
  d.borders.assign(ranks, {});
  d.is_at_border.assign(w.chunks.size(), 0);
  d.is_complete = !d.is_shared();
  if (!d.is_shared()) return;
  const auto [begin, end] = d.own();
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    if (c < begin || c >= end) detail::forget_contacts(w.chunks[c]);
  }
  std::vector<std::vector<std::uint32_t>> wanted(ranks), lists(ranks);
  for (std::size_t c = begin; c < end; ++c) {
    const Chunk<Model>& chunk = w.chunks[c];
    for (std::uint32_t k = 0; k < chunk.candidate.size(); ++k) {
      const std::uint32_t j = chunk.candidate[k], grain = w.images.grain_of(j);
      const int owner = d.owner(grain / chunk_size);
      if (owner == d.rank()) continue;
      const auto r = static_cast<std::size_t>(owner);
      auto& border = d.borders[r];
      if (border.chunks_out.empty() || border.chunks_out.back() != c) {
        border.chunks_out.push_back(static_cast<std::uint32_t>(c));
        border.first_out.push_back(static_cast<std::uint32_t>(border.candidates_out.size()));
      }
      border.candidates_out.push_back(k);
      wanted[r].push_back(grain);
      lists[r].insert(lists[r].end(), {static_cast<std::uint32_t>(c), chunk.owner[k], j});
      d.is_at_border[c] = 1;
    }
  }
  for (std::size_t r = 0; r < ranks; ++r) {
    d.borders[r].first_out.push_back(static_cast<std::uint32_t>(d.borders[r].candidates_out.size()));
    std::sort(wanted[r].begin(), wanted[r].end());
    wanted[r].erase(std::unique(wanted[r].begin(), wanted[r].end()), wanted[r].end());
    d.borders[r].rows_in = wanted[r];
  }
  const auto [asked, asked_first] = d.exchanged(wanted);
  const auto [came, came_first] = d.exchanged(lists);
  for (std::size_t r = 0; r < ranks; ++r) {
    auto& border = d.borders[r];
    border.rows_out.assign(asked.begin() + asked_first[r], asked.begin() + asked_first[r + 1]);
    for (int at = came_first[r]; at < came_first[r + 1]; at += 3) {
      const std::uint32_t c = came[static_cast<std::size_t>(at)], i = came[static_cast<std::size_t>(at) + 1];
      Chunk<Model>& chunk = w.chunks[c];
      if (border.chunks_in.empty() || border.chunks_in.back() != c) border.chunks_in.push_back(c);
      chunk.candidate.push_back(came[static_cast<std::size_t>(at) + 2]);
      ++chunk.candidate_first[i + 1];
    }
    for (const std::uint32_t c : border.chunks_in) {
      Chunk<Model>& chunk = w.chunks[c];
      for (std::size_t k = 0; k < chunk_size; ++k) chunk.candidate_first[k + 1] += chunk.candidate_first[k];
      grain::list_owners(chunk);
    }
  }
}

/// How many numbers tell the motion of a grain: position, velocity, angular velocity, what its pose is made from, and
/// what it does where grains may sleep.
template <class Model>
inline constexpr std::size_t motion_width = Model::Shape::pose_size > 0 ? 19 : 10;

/// Tells the other ranks where the grains are that their contacts reach, and expects the same of them.
template <class Model>
void send_motion(WorldState<Model>& w) {
  auto& d = w.domain;
  if (!d.is_shared()) return;
  const auto watch = d.watch_step();
  const auto& p = w.grains;
  for (std::size_t r = 0; r < d.borders.size(); ++r) {
    auto& border = d.borders[r];
    if (border.rows_in.empty()) continue;
    border.motion_in.resize(border.rows_in.size() * motion_width<Model>);
    d.expect(static_cast<int>(r), Model::Domain::Tag::motion, border.motion_in.data(),
             border.motion_in.size() * sizeof(double));
  }
  for (std::size_t r = 0; r < d.borders.size(); ++r) {
    auto& border = d.borders[r];
    if (border.rows_out.empty()) continue;
    border.motion_out.resize(border.rows_out.size() * motion_width<Model>);
    double* to = border.motion_out.data();
    const auto put = [&](const Vector3<double>& v) { *to++ = v.x, *to++ = v.y, *to++ = v.z; };
    for (const std::uint32_t row : border.rows_out) {
      const PartnerView& view = p.view[row];
      put(view.position), put(view.velocity), put(view.angular_velocity);
      if constexpr (Model::Shape::pose_size > 0) put(p.row0[row]), put(p.row1[row]), put(p.row2[row]);
      *to++ = w.options.sleep ? w.sleepers.doing[row] : 0.0;
    }
    d.send(static_cast<int>(r), Model::Domain::Tag::motion, border.motion_out.data(),
           border.motion_out.size() * sizeof(double));
  }
}

/// Puts the grains of other ranks that this rank's contacts reach where they are now.
template <class Model>
void take_motion(WorldState<Model>& w) {
  auto& d = w.domain;
  if (!d.is_shared()) return;
  const auto watch = d.watch_step();
  d.wait_for_expected();
  auto& p = w.grains;
  for (const auto& border : d.borders) {
    const double* from = border.motion_in.data();
    const auto next = [&] { return from += 3, Vector3<double>{from[-3], from[-2], from[-1]}; };
    for (const std::uint32_t row : border.rows_in) {
      const Species<typename Model::Shape>& kind = w.species[p.species[row]];
      PartnerView& view = p.view[row];
      view.position = next();
      view.velocity = next();
      view.angular_velocity = next();
      view.radius = kind.shape.bounding_radius();
      view.inverse_mass = kind.inverse_mass;
      if constexpr (Model::Shape::pose_size > 0) {
        Matrix3<double> rotation;
        rotation.row0 = next();
        rotation.row1 = next();
        rotation.row2 = next();
        kind.shape.orient(rotation, p.pose_of(row));
      }
      const double does = *from++;
      if (w.options.sleep) w.sleepers.doing[row] = static_cast<std::uint8_t>(does);
    }
  }
  d.wait_for_sent();
}

/// Hands the loads of this rank's contacts on grains of other ranks to these, and takes those of theirs. Chunks that
/// were not evaluated keep theirs.
template <class Model>
void swap_loads(WorldState<Model>& w) {
  auto& d = w.domain;
  if (!d.is_shared()) return;
  const auto watch = d.watch_step();
  for (std::size_t r = 0; r < d.borders.size(); ++r) {
    auto& border = d.borders[r];
    if (border.chunks_out.empty()) continue;
    border.loads_out.clear();
    for (std::size_t m = 0; m < border.chunks_out.size(); ++m) {
      const std::uint32_t c = border.chunks_out[m];
      const Chunk<Model>& chunk = w.chunks[c];
      if (!chunk.evaluated) continue;
      const std::span candidates =
          std::span(border.candidates_out).subspan(border.first_out[m], border.first_out[m + 1] - border.first_out[m]);
      detail::append(border.loads_out, &c, 1);
      for (const std::uint32_t k : candidates) {
        const auto n = static_cast<std::uint16_t>(chunk.partner_load_first[k + 1] - chunk.partner_load_first[k]);
        const bool sleeps = n > 0 && k < chunk.sleeps.size() && chunk.sleeps[k] != 0;
        const auto told = static_cast<std::uint16_t>(n | (sleeps ? detail::sleeping_load : 0));
        detail::append(border.loads_out, &told, 1);
      }
      for (const std::uint32_t k : candidates) {
        const std::uint32_t first = chunk.partner_load_first[k];
        detail::append(border.loads_out, chunk.partner_loads.data() + first, chunk.partner_load_first[k + 1] - first);
      }
    }
    d.send(static_cast<int>(r), Model::Domain::Tag::loads, border.loads_out.data(), border.loads_out.size());
  }
  std::vector<std::byte> message;
  std::vector<std::uint16_t> counts;
  for (std::size_t r = 0; r < d.borders.size(); ++r) {
    if (d.borders[r].chunks_in.empty()) continue;
    d.receive(static_cast<int>(r), Model::Domain::Tag::loads, message);
    for (std::size_t at = 0; at < message.size();) {
      std::uint32_t c = 0;
      detail::read(message, at, &c, 1);
      Chunk<Model>& chunk = w.chunks[c];
      counts.resize(chunk.candidate.size());
      detail::read(message, at, counts.data(), counts.size());
      std::uint32_t loads = 0;
      chunk.sleeps.resize(counts.size());
      for (std::size_t k = 0; k < counts.size(); ++k) {
        chunk.sleeps[k] = (counts[k] & detail::sleeping_load) != 0 ? 1 : 0;
        loads += counts[k] & ~detail::sleeping_load;
        chunk.partner_load_first[k + 1] = loads;
      }
      chunk.partner_loads.resize(loads);
      detail::read(message, at, chunk.partner_loads.data(), loads);
    }
  }
  d.wait_for_sent();
}

/// Contacts of the working chunks where ranks share the grains. What touches no grain of other ranks is worked on while
/// these come. Chunks that are moved in turn wait for the loads of others (`move`, as for grain::Turns).
template <class Model, class Find, class Move>
void find_shared_contacts(WorldState<Model>& w, Find& find_contacts, Move& move) {
  w.domain.is_whole = !w.domain.is_shared();
  if (w.domain.is_whole) return find_contacts(w.sleepers.working);
  std::vector<std::uint32_t> inner, outer;
  for (const std::uint32_t c : w.sleepers.working) (w.domain.is_at_border[c] ? outer : inner).push_back(c);
  if (w.move.at_once) {
    for (const auto& border : w.domain.borders) w.turns.expect(border.chunks_in, w.chunks);
  }
  send_motion(w);
  find_contacts(inner);
  take_motion(w);
  place_images(w), tell_images(w);
  find_contacts(outer);
  swap_loads(w);
  if (!w.move.at_once) return;
  std::vector<std::uint32_t> elsewhere;
  for (const auto& border : w.domain.borders) {
    elsewhere.insert(elsewhere.end(), border.chunks_in.begin(), border.chunks_in.end());
  }
  w.executor.for_each(elsewhere.size(), [&](std::size_t k) { w.turns.found_elsewhere(elsewhere[k], w.chunks, move); });
}

}  // namespace dem
