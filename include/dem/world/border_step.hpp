#pragma once

// What ranks tell each other in a step (domain::Ranks). A contact belongs to the chunk of its lower row, so the motion
// of partners goes from higher ranks to lower ones, and loads of contacts go the other way. In worlds that are not
// shared all of this is nothing.

#include <dem/world/border.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dem {

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
}

/// Hands the loads of this rank's contacts on grains of other ranks to these.
template <class Model>
void send_loads(WorldState<Model>& w) {
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
}

/// Takes the loads of other ranks' contacts on this rank's grains. Chunks that were not evaluated keep theirs.
template <class Model>
void take_loads(WorldState<Model>& w) {
  auto& d = w.domain;
  if (!d.is_shared()) return;
  const auto watch = d.watch_step();
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
}

/// Contacts of the working chunks where ranks share the grains. Those that touch no grain of other ranks are worked on
/// in parts, between which it is seen whether the motion of others has come. Then those at the border are next, as
/// other ranks wait for their loads. Chunks that are moved in turn wait for the loads of others (`move`, as for
/// grain::Turns). The order decides nothing but the time it takes.
template <class Model, class Find, class Move>
void find_shared_contacts(WorldState<Model>& w, Find& find_contacts, Move& move) {
  auto& d = w.domain;
  d.is_whole = !d.is_shared();
  if (d.is_whole) return find_contacts(w.sleepers.working);
  std::vector<std::uint32_t> inner, outer;
  for (const std::uint32_t c : w.sleepers.working) (d.is_at_border[c] ? outer : inner).push_back(c);
  if (w.move.at_once) {
    for (const auto& border : d.borders) w.turns.expect(border.chunks_in, w.chunks);
  }
  send_motion(w);
  bool border_found = false;
  const auto find_at_border = [&] {
    take_motion(w);
    place_images(w), tell_images(w);
    find_contacts(outer);
    send_loads(w);
    border_found = true;
  };
  constexpr std::size_t parts = 8, least_pieces = 4;  // of a thread: less is not worth a call of all threads
  const std::size_t part =
      std::max(inner.size() / parts + 1, least_pieces * static_cast<std::size_t>(w.executor.threads()));
  for (std::size_t at = 0; at < inner.size(); at += part) {
    if (border_found) d.attend();
    else if (d.all_expected_came()) find_at_border();
    find_contacts(std::span(inner).subspan(at, std::min(part, inner.size() - at)));
  }
  if (!border_found) find_at_border();
  take_loads(w);
  if (w.move.at_once) {
    std::vector<std::uint32_t> elsewhere;
    for (const auto& border : d.borders) {
      elsewhere.insert(elsewhere.end(), border.chunks_in.begin(), border.chunks_in.end());
    }
    w.executor.for_each(elsewhere.size(),
                        [&](std::size_t k) { w.turns.found_elsewhere(elsewhere[k], w.chunks, move); });
  }
  const auto watch = d.watch_step();
  d.wait_for_sent();
}

}  // namespace dem
