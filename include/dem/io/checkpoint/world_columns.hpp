#pragma once

// The state of a world as columns, and back.

#include <dem/core/type_name.hpp>
#include <dem/io/checkpoint/fields.hpp>
#include <dem/io/checkpoint/sleep_columns.hpp>
#include <dem/io/checkpoint/warm_starts.hpp>
#include <dem/world/complete.hpp>
#include <dem/world/world.hpp>

#include <string>
#include <vector>

namespace dem::io {

namespace detail {

/// Contact histories, block after block: those of the last step, from which the next one starts.
template <int Size, class Blocks, class Last>
void contact_fields(Fields& v, const char* name, Blocks& blocks, Last&& last) {
  v.group(name, [&] {
    std::vector<std::uint32_t> counts;
    std::vector<std::uint64_t> keys;
    std::vector<double> histories;
    const bool is_collecting = v.task() == Fields::Task::collect;
    if (is_collecting) {
      for (auto& block : blocks) {
        const ContactHistories<Size>& of_block = last(block);
        const auto n = static_cast<std::size_t>(of_block.count);
        counts.push_back(static_cast<std::uint32_t>(n));
        keys.insert(keys.end(), of_block.key.begin(), of_block.key.begin() + of_block.count);
        for (std::size_t c = 0; c < n; ++c) {
          for (const auto& column : of_block.history) histories.push_back(column[c]);
        }
      }
      v.copied("count", ColumnKind::natural32, 1, counts);
      v.copied("key", ColumnKind::natural, 1, keys);
      if (Size > 0) v.copied("history", ColumnKind::real, Size, histories);
    } else if (v.task() == Fields::Task::restore) {
      v.copied("count", ColumnKind::natural32, 1, counts);
      v.copied("key", ColumnKind::natural, 1, keys);
      if (Size > 0) v.copied("history", ColumnKind::real, Size, histories);
      std::size_t at = 0, k = 0;
      for (auto& block : blocks) {
        ContactHistories<Size>& of_block = last(block);
        const std::size_t n = counts.at(k++);
        if (at + n > keys.size()) fail("the contacts of '{}' in the saved state are fewer than their count", name);
        of_block.reserve(n + static_cast<std::size_t>(pack_width));
        of_block.count = static_cast<int>(n);
        for (std::size_t c = 0; c < n; ++c, ++at) {
          of_block.key[c] = keys[at];
          for (std::size_t h = 0; h < of_block.history.size(); ++h) {
            of_block.history[h][c] = histories[at * of_block.history.size() + h];
          }
        }
      }
    }
  });
}

/// The grains: what they are, where they are, how they move, and what the integrator remembers of them.
template <class GrainColumns>
void grain_fields(Fields& v, GrainColumns& p) {
  std::uint64_t count = p.count, ids = p.row_of.size();
  v("count", count);
  v("ids_given", ids);
  v("grains_given", p.given), v("number_of_id", p.number), v("ids_freed", p.freed), v("ids_free", p.free_again);
  if (v.task() == Fields::Task::restore) p.resize(0), p.resize(count);
  const auto columns = [&](const char* name, auto& c, const char* unit) {
    v.group(name, [&] {
      v.rows("x", ColumnKind::real, 1, c.x.data(), count, unit);
      v.rows("y", ColumnKind::real, 1, c.y.data(), count, unit);
      v.rows("z", ColumnKind::real, 1, c.z.data(), count, unit);
    });
  };
  v.rows("id", ColumnKind::natural32, 1, p.id.data(), count);
  v.rows("species", ColumnKind::natural32, 1, p.species.data(), count);
  columns("position", p.position, "m");
  columns("velocity", p.velocity, "m/s");
  columns("spin_in_body_frame", p.local_angular_velocity, "rad/s");
  columns("rotation_row0", p.row0, "");
  columns("rotation_row1", p.row1, "");
  columns("rotation_row2", p.row2, "");
  columns("force", p.force, "N");
  columns("torque", p.torque, "N m");
  columns("listed_at", p.listed_at, "m");
  for (std::size_t k = 0; k < p.memory.size(); ++k) {
    v.rows("integrator_memory" + std::to_string(k), ColumnKind::real, 1, p.memory[k].data(), count);
  }
  if (v.task() != Fields::Task::restore) return;
  if (!p.number.empty() && p.number.size() != ids) {
    fail("the saved state has the numbers of {} grains, but {} ids", p.number.size(), ids);
  }
  for (const auto* list : {&p.freed, &p.free_again}) {
    for (const std::uint32_t id : *list) {
      if (id >= ids) fail("the saved state gives the id {} again, but has only {} ids", id, ids);
    }
  }
  p.row_of.assign(ids, p.gone);
  for (std::size_t i = 0; i < count; ++i) p.row_of.at(p.id[i]) = static_cast<std::uint32_t>(i);
  p.pad();
}

/// Neighbour lists with what searches start from, and contact histories, chunk after chunk.
template <class Model>
void chunk_fields(Fields& v, WorldState<Model>& w) {
  std::uint64_t chunks = w.chunks.size();
  v("chunks", chunks);
  const bool is_restoring = v.task() == Fields::Task::restore;
  if (is_restoring) w.chunks.assign(chunks, {});
  std::vector<std::uint32_t> first, partner;
  if (v.task() == Fields::Task::collect) {
    for (const Chunk<Model>& c : w.chunks) {
      first.insert(first.end(), c.candidate_first.begin(), c.candidate_first.end());
      partner.insert(partner.end(), c.candidate.begin(), c.candidate.end());
    }
  }
  v.copied("neighbours_first", ColumnKind::natural32, chunk_size + 1, first);
  v.copied("neighbours", ColumnKind::natural32, 1, partner);
  if (is_restoring) {
    auto from = first.begin();
    auto next = partner.begin();
    for (Chunk<Model>& c : w.chunks) {
      if (first.end() - from < std::ptrdiff_t{chunk_size + 1}) fail("the saved neighbour lists are too short");
      std::copy_n(from, chunk_size + 1, c.candidate_first.begin());
      from += chunk_size + 1;
      if (partner.end() - next < std::ptrdiff_t{c.candidate_first.back()})
        fail("the saved neighbour lists are too short");
      c.candidate.assign(next, next + c.candidate_first.back());
      next += c.candidate_first.back();
      grain::list_owners(c);
    }
  }
  if constexpr (Model::Domain::has_images) {
    std::vector<double> shifts;
    for (const Vector3<double>& s : w.images.shift) shifts.insert(shifts.end(), {s.x, s.y, s.z});
    v("image_of", w.images.grain), v("image_shifts", shifts, "m");
    v("rows_of_grains", w.images.grains), v("first_image", w.images.first);  // grains may have come since
    if constexpr (domain::IsSheared<typename Model::Domain>) {
      v("image_levels", w.images.level), v("offset_listed", w.images.offset, "m");
      if (is_restoring && w.images.level.size() != w.images.grain.size()) fail("the saved images have no levels");
    }
    if (is_restoring) {
      w.images.shift.resize(w.images.grain.size());
      for (std::size_t k = 0; k < w.images.shift.size(); ++k) {
        w.images.shift[k] = {shifts.at(3 * k), shifts.at(3 * k + 1), shifts.at(3 * k + 2)};
      }
    }
  }
  if constexpr (shape::WarmStartedShape<typename Model::Shape>) {
    using Start = typename Model::Shape::WarmStart;
    std::vector<std::uint8_t> bytes(is_restoring ? 0 : partner.size() * sizeof(Start), 0);
    std::size_t at = 0;
    if (v.task() == Fields::Task::collect) {
      for (const Chunk<Model>& c : w.chunks) {
        for (const Start& start : c.searches.start) {
          put_warm_start(start, bytes.data() + at);
          at += sizeof(Start);
        }
      }
    }
    v.copied("searches", ColumnKind::byte, sizeof(Start), bytes);
    if (is_restoring) {
      for (Chunk<Model>& c : w.chunks) {
        if (at + c.candidate.size() * sizeof(Start) > bytes.size()) fail("the saved searches are too few");
        for (Start& start : c.searches.start) {
          get_warm_start(start, bytes.data() + at);
          at += sizeof(Start);
        }
      }
    }
  }
  constexpr int size = history_size<Model>;
  contact_fields<size>(
      v, "pairs", w.chunks, [](auto& c) -> auto& { return c.pair_contacts.last; });
  contact_fields<size>(
      v, "surfaces", w.chunks, [](auto& c) -> auto& { return c.surface_contacts.last; });
}

/// The policies that a world is made of.
template <class Model>
void model_fields(Fields& v) {
  const auto policy = [&](const char* name, std::string_view type) { v.given(name, std::string(type)); };
  policy("shape", type_name<typename Model::Shape>());
  policy("normal_law", type_name<typename Model::Normal>());
  policy("friction_law", type_name<typename Model::Friction>());
  policy("rolling_law", type_name<typename Model::Rolling>());
  policy("cohesion_law", type_name<typename Model::Cohesion>());
  policy("broad_phase", type_name<typename Model::BroadPhase>());
  policy("integrator", type_name<typename Model::Integrator>());
  if constexpr (Model::Joints::projects) policy("joints", type_name<typename Model::Joints>());
  if constexpr (Model::Domain::has_images) policy("domain", type_name<typename Model::Domain::Cell>());
}

template <class Model, class... Others>
void world_fields(Fields& v, World<Model>& world, Others&... others) {
  auto& w = world.state();
  v.group("model", [&] { model_fields<Model>(v); });
  v.group("world", [&] { world.fields(v); });
  v.group("grains", [&] { grain_fields(v, w.grains); });
  if (v.task() == Fields::Task::restore) {
    for (const std::uint32_t id : w.to_remove) w.grains.row_of.at(id) = w.grains.gone;
  }
  v.group("contacts", [&] { chunk_fields(v, w); });
  v.group("sleep", [&] { sleep_fields(v, w); });
  v.group("lost", [&] {
    std::vector<std::uint32_t> lost(w.known_lost.begin(), w.known_lost.end());
    v("ids", lost);
    if (v.task() == Fields::Task::restore) w.known_lost = {lost.begin(), lost.end()};
  });
  v.group("body_contacts", [&] {
    std::uint64_t blocks = w.body_contacts.histories.size();
    v("blocks", blocks);
    w.body_contacts.histories.resize(blocks);
    contact_fields<history_size<Model>>(
        v, "points", w.body_contacts.histories, [](auto& m) -> auto& { return m.last; });
  });
  int number = 0;
  (v.group("program" + std::to_string(number++), [&] { others.fields(v); }), ...);
}

/// Whether a state has columns of thing number k that a program keeps besides its world.
inline bool has_other(const StateColumns& columns, std::size_t k) {
  const std::string group = "program" + std::to_string(k) + "/";
  const auto next = columns.lower_bound(group);
  return next != columns.end() && next->first.starts_with(group);
}

/// Throws Error where a program gives more or fewer things besides its world than were saved.
template <class... Others>
void compare_others(const StateColumns& saved, Others&... others) {
  std::size_t count = 0, given = 0;
  while (has_other(saved, count)) ++count;
  StateColumns ours;
  Fields collect(Fields::Task::collect, ours);
  (collect.group("program" + std::to_string(given++), [&] { others.fields(collect); }), ...);
  bool same = count <= given;
  for (std::size_t k = 0; k < given; ++k) same &= has_other(saved, k) || !has_other(ours, k);
  if (same) return;
  fail(
      "{} things were saved besides the world, but this program gives load {}; give it the same ones in the same order",
      count, given);
}

/// What follows from the state that was restored.
template <class Model>
void settle_restored(WorldState<Model>& w, bool is_checked) {
  w.placed = {};
  for (auto& motion : w.machine.parts().motions) motion.was_loaded = true;
  w.new_surfaces = {};
  for (std::size_t s = 0; s < w.surfaces.size() && !is_checked; ++s) w.new_surfaces.add(s);
  if (is_checked) {
    find_points_deep_enough(w);
    coupling::list_pairs(w.body_contacts, std::span(std::as_const(w.surfaces)), w.materials);
  }
  if (!w.held.empty()) {
    w.carry_held = &carry_held<Model>;
    w.load_by_held = &load_by_held<Model>;
  }
  w.forget_moved2();
  // Also where the list is due: inlets look for room by the bounds of chunks. There may be more chunks of grains by
  // now.
  for (std::size_t c = 0; c < std::min(w.chunks.size(), w.grains.chunks()); ++c) {
    grain::refresh_chunk<Model>(c, w.chunks[c], w.grains, w.species);
  }
  for (const grain::ContactWork& c : w.ledger.last) {  // sleepers' contacts stay counted until they are evaluated again
    const std::size_t row = w.grains.row_of.at(c.i);
    if (row != w.grains.gone && row / chunk_size < w.chunks.size()) w.chunks[row / chunk_size].work.push_back(c);
  }
  if constexpr (Model::Domain::has_ranks) share_chunks(w);
  if (!w.list_valid || w.chunks.empty()) return;
  if constexpr (Model::Domain::has_images) {
    grain::make_rows(w.grains, w.images);
    place_images(w), tell_images(w);
  }
  grain::list_incoming<Model>(w.executor, std::span(w.chunks), w.grains.count, w.images, w.incoming_first, w.incoming);
  if (w.options.sleep) count_awake_beside(w);
}

}  // namespace detail

/// The state of a world, and of what else the program keeps (`others`, structs with fields: see Fields). The columns
/// refer to the world: they are good until it changes. Where ranks share the grains, all ranks call it at once, and
/// each gets all of it. Throws Error after a step that an exception broke off.
template <class Model, class... Others>
StateColumns columns_of(const World<Model>& world, const Others&... others) {
  StateColumns columns;
  Fields v(Fields::Task::collect, columns);
  if constexpr (Model::Domain::has_ranks) check_agreement(world.state(), domain::Call::state);
  if constexpr (Model::Domain::has_ranks) {  // no rank has all of it: a copy gets it, and what is borrowed of that is
                                             // kept
    if (world.state().domain.is_shared() && !world.state().domain.is_complete) {
      World<Model> copy = world;
      complete_chunks(copy.state());
      detail::world_fields(v, copy, const_cast<Others&>(others)...);
      for (auto& [name, column] : columns) {
        if (column.borrowed.empty()) continue;
        column.own.assign(column.borrowed.begin(), column.borrowed.end());
        column.borrowed = {};
      }
      return columns;
    }
  }
  // One list of fields serves both ways. Collecting changes nothing.
  detail::world_fields(v, const_cast<World<Model>&>(world), const_cast<Others&>(others)...);
  return columns;
}

/// Puts a world, which the program has set up as it did before, into a state. Grains are those of the state. Throws
/// Error where the set-up or the model differs, or the state has things of a program that are not given here, in words,
/// before anything is changed. A state that fits the set-up but lacks something is refused while it is being read: the
/// world is then good for nothing. Where ranks share the grains, all ranks call it at once, with the same state.
template <class Model, class... Others>
void restore(World<Model>& world, StateColumns& columns, Others&... others) {
  Fields compare(Fields::Task::compare, columns);
  detail::world_fields(compare, world, others...);
  compare.check_all_read("model/");
  detail::compare_others(columns, others...);
  if constexpr (Model::Domain::has_ranks) {
    check_agreement(world.state(), domain::Call::restore, {.asked = hash_of(columns)});
  }
  Fields v(Fields::Task::restore, columns);
  detail::world_fields(v, world, others...);
  v.check_all_read();
  detail::settle_restored(world.state(), columns.at("world/checked").bytes()[0] != std::byte{0});
}

}  // namespace dem::io
