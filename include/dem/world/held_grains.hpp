#pragma once

#include <dem/core/sorted.hpp>
#include <dem/world/sleep.hpp>

#include <algorithm>
#include <cstring>

namespace dem {

/// Puts grains that are attached to machine parts where their parts are, with the velocities of these. To be called
/// before forces are found, and at the end of a step.
template <class Model>
void carry_held(WorldState<Model>& w) {
  auto& p = w.grains;
  std::vector<std::uint32_t> chunks;  // whose grains moved
  for (grain::HeldGrains& held : w.held) {
    const auto& motion = w.machine.bodies()[held.body.index()].motion;
    const Vector3<double> turning = motion.rotation * motion.angular_velocity;
    const bool rests = dot(motion.velocity, motion.velocity) + dot(turning, turning) == 0.0;
    if (rests && std::memcmp(&held.carried_to, &motion, sizeof(motion)) == 0) continue;
    held.carried_to = motion;
    std::erase_if(held.grains, [&](const auto& g) { return p.row_of[g.id] == p.gone; });
    for (const grain::HeldGrain& g : held.grains) {
      const std::size_t row = p.row_of[g.id];
      const Vector3<double> arm = motion.rotation * g.place;
      const Matrix3<double> rotation = motion.rotation * g.turn;
      Vector3<double> x = motion.position + arm;
      if constexpr (Model::Domain::has_images) x = w.domain.beside(x, p.position[row]);
      p.position.set(row, x);
      p.velocity.set(row, motion.velocity + cross(turning, arm));
      p.local_angular_velocity.set(row, GrainColumns<typename Model::Shape, typename Model::Integrator>::has_orientation
                                            ? transpose_times(rotation, turning)
                                            : turning);
      if constexpr (Model::Shape::has_orientation) p.set_rotation(row, rotation);
      if (w.options.sleep) wake_row(w, row);
      const auto c = static_cast<std::uint32_t>(row / chunk_size);
      if (c < w.chunks.size() && (chunks.empty() || chunks.back() != c)) chunks.push_back(c);
    }
  }
  if (chunks.empty()) return;
  sort_and_drop_doubles(chunks);
  if (!w.list_valid) return;  // all is refreshed when neighbours are listed
  w.executor.for_each(
      chunks.size(), [&](std::size_t k) { grain::refresh_chunk<Model>(chunks[k], w.chunks[chunks[k]], p, w.species); });
}

/// Force (N) and torque (N m) of the contacts of an attached grain.
struct HeldLoad {
  Vector3<double> force, torque;
};
template <class Model>
HeldLoad load_of_held(const WorldState<Model>& w, std::size_t row) {
  const std::span<const Chunk<Model>> chunks = w.chunks;
  HeldLoad load = {w.grains.force[row], w.grains.torque[row]};
  const auto c = static_cast<std::uint32_t>(row / chunk_size);
  if (!w.options.sleep || (w.sleepers.doing[row] & grain::awake) != 0) {
    grain::add_incoming<Model>(row, chunks, w.incoming_first, w.incoming, load.force, load.torque);
  } else if (std::binary_search(w.sleepers.working.begin(), w.sleepers.working.end(), c)) {
    // One on which nothing new acts keeps the whole sum of the last time.
    if (!w.chunks[c].evaluated && w.sleepers.awake_beside[row] == 0) return load;
    const auto sums = grain::complete_sums<Model>(row, chunks, w.grains, w.incoming_first, w.incoming, w.sleepers);
    load = {sums.force + sums.kept_force, sums.torque + sums.kept_torque};
  }
  return load;
}

/// Those of all attached grains, in the order in which they were attached. Each is known to the rank that owns the
/// grain.
template <class Model>
std::vector<HeldLoad> loads_of_held(const WorldState<Model>& w) {
  std::vector<double> numbers;
  std::vector<HeldLoad> loads;
  for (const grain::HeldGrains& held : w.held) {
    for (const grain::HeldGrain& g : held.grains) {
      const std::size_t row = w.grains.row_of[g.id];
      HeldLoad load = {{0, 0, 0}, {0, 0, 0}};
      if constexpr (Model::Domain::has_ranks) {
        if (row != w.grains.gone && w.domain.owns(row / chunk_size)) load = load_of_held(w, row);
        for (const auto* v : {&load.force, &load.torque}) numbers.insert(numbers.end(), {v->x, v->y, v->z});
      } else if (row != w.grains.gone) {
        load = load_of_held(w, row);
      }
      loads.push_back(load);
    }
  }
  if constexpr (Model::Domain::has_ranks) {
    w.domain.share_sums(numbers);
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const double* n = &numbers[6 * k];
      loads[k] = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    }
  }
  return loads;
}

/// Hands the forces of the contacts of attached grains to their parts. Forces are summed by grain, in the order in
/// which grains were attached: the same sum whatever thread found them.
template <class Model>
void load_by_held(WorldState<Model>& w) {
  const std::vector<HeldLoad> loads = loads_of_held(w);
  std::size_t next = 0;
  for (const grain::HeldGrains& held : w.held) {
    Body& body = w.machine.body(held.body);
    Vector3<double> force = {0, 0, 0}, torque = {0, 0, 0};
    for (const grain::HeldGrain& g : held.grains) {
      const HeldLoad& load = loads[next++];
      if (w.grains.row_of[g.id] == w.grains.gone) continue;
      force += load.force;
      torque += load.torque + cross(body.motion.rotation * g.place, load.force);
    }
    body.force += force;
    body.torque += torque;
  }
}

/// Attaches a held grain to a body, where both are now.
template <class Model>
void attach_grain(WorldState<Model>& w, std::size_t row, BodyId to) {
  auto& p = w.grains;
  const std::uint32_t grain = p.id[row];
  for (grain::HeldGrains& held : w.held) {
    std::erase_if(held.grains, [&](const auto& g) { return g.id == grain; });
  }
  auto of_body = std::find_if(w.held.begin(), w.held.end(), [&](const auto& h) { return h.body == to; });
  if (of_body == w.held.end()) of_body = w.held.insert(w.held.end(), {to, {}, {}});
  const auto& motion = w.machine.bodies()[to.index()].motion;
  const Vector3<double> place = transpose_times(motion.rotation, p.position[row] - motion.position);
  of_body->grains.push_back({grain, place, transposed(motion.rotation) * p.rotation(row)});
  of_body->carried_to.velocity = {HUGE_VAL, 0, 0};  // nowhere yet
  w.carry_held = &carry_held<Model>;
  w.load_by_held = &load_by_held<Model>;
}

}  // namespace dem
