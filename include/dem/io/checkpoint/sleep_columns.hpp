#pragma once

#include <dem/grain/incoming.hpp>
#include <dem/io/checkpoint/fields.hpp>
#include <dem/world/sleep.hpp>

#include <vector>

namespace dem::io::detail {

inline void append(std::vector<double>& list, const Vector3<double>& x) { list.insert(list.end(), {x.x, x.y, x.z}); }
inline Vector3<double> vector_at(const std::vector<double>& list, std::size_t k) {
  return {list.at(k), list.at(k + 1), list.at(k + 2)};
}

/// What is known of resting grains, by id: a column for each quantity.
DEM_SETUP inline void rest_fields(Fields& v, std::vector<grain::Rest>& grains) {
  const bool is_restoring = v.task() == Fields::Task::restore;
  const auto vectors = [&](const char* name, const char* unit, auto&& of) {
    std::vector<double> list;
    if (!is_restoring) {
      for (grain::Rest& r : grains) append(list, of(r));
    }
    v.copied(name, ColumnKind::real, 3, list, unit);
    if (!is_restoring) return;
    grains.resize(list.size() / 3);
    for (std::size_t k = 0; k < grains.size(); ++k) of(grains[k]) = vector_at(list, 3 * k);
  };
  const auto values = [&]<class T>(const char* name, ColumnKind kind, T, auto&& of, const char* unit = "") {
    std::vector<T> list;
    if (!is_restoring) {
      for (grain::Rest& r : grains) list.push_back(of(r));
    }
    v.copied(name, kind, 1, list, unit);
    if (!is_restoring) return;
    for (std::size_t k = 0; k < grains.size(); ++k) of(grains[k]) = list.at(k);
  };
  using grain::Rest;
  vectors(
      "resting/position", "m", [](Rest & r) -> auto& { return r.position; });
  vectors(
      "resting/force", "N", [](Rest & r) -> auto& { return r.force; });
  vectors(
      "resting/torque", "N m", [](Rest & r) -> auto& { return r.torque; });
  vectors(
      "resting/force_since", "N", [](Rest & r) -> auto& { return r.more_force; });
  vectors(
      "resting/torque_since", "N m", [](Rest & r) -> auto& { return r.more_torque; });
  vectors(
      "resting/facing0", "", [](Rest & r) -> auto& { return r.facing.first; });
  vectors(
      "resting/facing1", "", [](Rest & r) -> auto& { return r.facing.second; });
  values(
      "resting/borne", ColumnKind::real, 0.0, [](Rest & r) -> auto& { return r.borne; }, "N");
  const std::uint8_t byte = 0;
  values(
      "resting/quiet_windows", ColumnKind::byte, byte, [](Rest & r) -> auto& { return r.quiet_windows; });
  values(
      "resting/asleep", ColumnKind::byte, byte, [](Rest & r) -> auto& { return r.asleep; });
}

/// Who sleeps, what wakes them, and the loads that go on while they sleep. To be called when the chunks have their
/// candidates.
template <class Model>
void sleep_fields(Fields& v, WorldState<Model>& w) {
  grain::Sleepers& s = w.sleepers;
  bool may_sleep = w.options.sleep.has_value();
  SleepOptions o = w.options.sleep.value_or(SleepOptions{});
  v("may_sleep", may_sleep), v("balance", o.balance), v("change", o.change), v("jolt", o.jolt), v("motion", o.motion),
      v("window", o.window), v("mean", o.mean);
  v("working_chunks", s.working), v("all_work", s.all_work);
  const bool is_restoring = v.task() == Fields::Task::restore;
  if (is_restoring) w.options.sleep = may_sleep ? std::optional(o) : std::nullopt;
  if (!may_sleep || v.task() == Fields::Task::compare) return;

  constexpr std::size_t kept_width = 12, load_width = 6;
  std::vector<double> kept, surface_loads, deepest;
  std::vector<std::uint32_t> surface_count, surfaces, deepest_of;
  std::vector<std::uint8_t> doing;  // of grains: their images are told of it
  if (!is_restoring) {
    const std::size_t rows = std::min(s.doing.size(), w.chunks.size() * chunk_size);
    doing.assign(s.doing.begin(), s.doing.begin() + static_cast<std::ptrdiff_t>(rows));
    for (std::size_t i = 0; i < s.kept_force.x.size(); ++i)
      for (const Columns3* x : {&s.kept_force, &s.kept_torque, &s.surface_force, &s.surface_torque})
        append(kept, (*x)[i]);
    for (const Chunk<Model>& c : w.chunks) {
      deepest.push_back(c.deepest.overlap);
      deepest_of.insert(deepest_of.end(), {c.deepest.i, c.deepest.partner, c.deepest.with_surface ? 1u : 0u});
      surface_count.push_back(static_cast<std::uint32_t>(c.surface_loads.size()));
      for (const SurfaceLoad& load : c.surface_loads) {
        surfaces.push_back(load.surface.value);
        append(surface_loads, load.force), append(surface_loads, load.torque);
      }
    }
  }
  rest_fields(v, s.grains);
  v("borne", s.borne, "N");
  v.copied("doing", ColumnKind::byte, 1, doing);
  v.copied("kept_loads", ColumnKind::real, kept_width, kept, "N, N m");
  v.copied("surface_load_count", ColumnKind::natural32, 1, surface_count);
  v.copied("surface_load_of", ColumnKind::natural32, 1, surfaces);
  v.copied("surface_loads", ColumnKind::real, load_width, surface_loads, "N, N m");
  v.copied("deepest", ColumnKind::real, 1, deepest, "m");
  v.copied("deepest_of", ColumnKind::natural32, 3, deepest_of);
  if (!is_restoring) return;

  s.doing = doing;
  const std::size_t rows = kept.size() / kept_width;
  std::size_t at = 0;
  for (Columns3* x : {&s.kept_force, &s.kept_torque, &s.surface_force, &s.surface_torque}) {
    x->for_each_column([&](AlignedVector<double>& column) { column.resize(rows); });
    for (std::size_t i = 0; i < rows; ++i) x->set(i, vector_at(kept, i * kept_width + at));
    at += 3;
  }
  s.acted_on.assign(rows, 0);
  std::size_t of_surface = 0;
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    Chunk<Model>& chunk = w.chunks[c];
    std::uint8_t some = 0;
    for (std::size_t i = c * chunk_size; i < std::min({(c + 1) * chunk_size, w.grains.count, s.doing.size()}); ++i)
      some |= s.doing[i];
    chunk.asleep = (some & grain::awake) == 0;
    chunk.changed = (some & grain::changed) != 0;
    chunk.watched = (some & grain::watched) != 0;
    chunk.touched = (some & grain::touched) != 0;
    chunk.asked = (some & grain::asked) != 0;
    chunk.deepest = {deepest.at(c), deepest_of.at(3 * c), deepest_of.at(3 * c + 1), deepest_of.at(3 * c + 2) != 0};
    chunk.surface_loads.resize(surface_count.at(c));
    for (SurfaceLoad& load : chunk.surface_loads) {
      load = {SurfaceId(surfaces.at(of_surface)), vector_at(surface_loads, of_surface * load_width),
              vector_at(surface_loads, of_surface * load_width + 3)};
      ++of_surface;
    }
  }
  // Here, as a list that is due is not turned round again, but grains around a place may still be woken.
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    grain::list_reached(c, w.chunks[c], grain::find_outgoing<Model>(c, w.chunks[c], w.images));
  }
  grain::list_chunks_around<Model>(w.chunks);
}

}  // namespace dem::io::detail
