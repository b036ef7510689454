#pragma once

#include <dem/grain/contact_evaluator.hpp>
#include <dem/grain/force_sums.hpp>
#include <dem/grain/move.hpp>
#include <dem/grain/sleep_options.hpp>
#include <dem/grain/wakefulness.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace dem::grain {

/// Which way a grain faces: two rows of its rotation. Of shapes without orientation it is the angular velocity (rad/s).
struct Facing {
  Vector3<double> first = {0, 0, 0}, second = {0, 0, 0};
};

/// A grain at the end of the last window, or when it fell asleep.
struct Rest {
  Vector3<double> position = {0, 0, 0};                             ///< m
  Vector3<double> force = {0, 0, 0}, torque = {0, 0, 0};            ///< N, N m
  Vector3<double> more_force = {0, 0, 0}, more_torque = {0, 0, 0};  ///< N, N m: running mean of what came since
  Facing facing = {};
  double borne = 0.0;  ///< N, sum of the magnitudes of its contact forces
  std::uint8_t quiet_windows = 0;
  bool asleep = false;
};

/// What is known of resting grains.
struct Sleepers {
  static constexpr std::uint8_t windows_to_sleep = 2;

  std::vector<Rest> grains;                 ///< by id
  std::vector<double> borne;                ///< N, by row: of the contacts that the grain's own chunk holds
  std::vector<std::uint8_t> doing;          ///< by row, in a step of images too: see Wakefulness
  std::vector<std::uint8_t> acted_on;       ///< by row: more than what is kept acted on the grain in this evaluation
  std::vector<std::uint16_t> awake_beside;  ///< by row: how many grains are awake of those with which it has candidates
  Columns3 kept_force, kept_torque;         ///< N, N m, by row of a sleeper: the sums over its contacts with sleepers
  Columns3 surface_force, surface_torque;   ///< N, N m, by row of a chunk that sleeps: what surfaces do to the grain
  std::vector<std::uint32_t> working;       ///< chunks on whose grains new forces may act
  bool measuring = false;                   ///< a window ends with this step
  bool all_work = true;                     ///< all contacts are, in the next evaluation: neighbour lists are new
};

/// Adds up what the grains of one chunk bear by the contacts that were just evaluated.
template <class Hits, class Forces>
void add_borne(std::size_t begin, const Hits& hits, const Forces& forces, bool of_pairs, std::span<double> borne) {
  for (std::size_t c = 0; c < hits.size(); ++c) {
    const double magnitude = norm(ContactForces::at(forces.force, c));
    borne[hits[c].i - begin] += magnitude;
    if (of_pairs && hits[c].partner - begin < borne.size()) borne[hits[c].partner - begin] += magnitude;
  }
}

/// The magnitudes of a grain's contact forces, summed (N). To be called in a step that measures.
template <class Model>
double borne_by(std::size_t i, std::span<const Chunk<Model>> chunks, std::span<const std::uint32_t> incoming_first,
                std::span<const Incoming> incoming, const Sleepers& s) {
  double borne = s.borne[i];
  for (std::uint32_t m = incoming_first[i]; m < incoming_first[i + 1]; ++m) {
    const Chunk<Model>& other = chunks[incoming[m].chunk];
    const std::uint32_t stop = other.partner_load_first[incoming[m].candidate + 1];
    for (std::uint32_t c = other.partner_load_first[incoming[m].candidate]; c < stop; ++c) {
      borne += norm(other.partner_loads[c].force);
    }
  }
  return borne;
}

/// Whether the forces on a sleeping grain have changed by too much since it fell asleep: in a running mean, or by a
/// jolt. When grains that are awake act on it no more, it bears what it will bear, and the mean is not waited for
/// (`is_final`).
template <class GrainColumns, class Shape>
bool is_disturbed(std::size_t i, const GrainColumns& p, const Species<Shape>& kind, double g, bool is_final,
                  const SleepOptions& o, Rest& rest) {
  const double bears = std::max(kind.mass * g, rest.borne), arm = kind.shape.bounding_radius();
  const auto exceed = [&](const Vector3<double>& force, const Vector3<double>& torque, double share) {
    // Written such that a NaN disturbs as well.
    return !(norm(force) <= share * bears) || !(norm(torque) <= share * bears * arm);
  };
  const Vector3<double> force = p.force[i] - rest.force, torque = p.torque[i] - rest.torque;
  const double share = 1.0 / o.mean;
  rest.more_force += share * (force - rest.more_force);
  rest.more_torque += share * (torque - rest.more_torque);
  if (is_final) rest.more_force = force, rest.more_torque = torque;
  return exceed(force, torque, is_final ? o.change : o.jolt) || exceed(rest.more_force, rest.more_torque, o.change);
}

template <class GrainColumns>
Facing facing(std::size_t i, const GrainColumns& p) {
  if constexpr (GrainColumns::has_orientation) return {p.row0[i], p.row1[i]};
  return {p.local_angular_velocity[i], {0, 0, 0}};
}

/// By how much (rad) a grain has turned in a window of `seconds`, at the most. Two rows of a rotation move by 1 to 1.4
/// times the angle. Without orientation, angular velocities at both ends count as far as they agree: one that swings is
/// not turning.
template <class GrainColumns>
double turned(const Facing& before, const Facing& now, double seconds) {
  if constexpr (GrainColumns::has_orientation) {
    const Vector3<double> a = now.first - before.first, b = now.second - before.second;
    return std::sqrt(dot(a, a) + dot(b, b));
  } else {
    const bool goes_on = dot(before.first, now.first) > 0.0;
    return goes_on ? seconds * std::min(norm(before.first), norm(now.first)) : 0.0;
  }
}

/// The end of a window of `seconds`.
struct WindowEnd {
  const SleepOptions& options;
  Vec3 gravity;  ///< m/s^2
  double seconds;
};

/// Ends a window for a grain that is awake, and returns whether it was quiet for long enough to sleep. One that nothing
/// touches and that moves flies, however slowly.
template <class GrainColumns, class Shape>
bool end_window(std::size_t i, const GrainColumns& p, const Species<Shape>& kind, double borne, Rest& rest,
                const WindowEnd& window) {
  const SleepOptions& o = window.options;
  const double radius = kind.shape.bounding_radius(), bears = std::max(kind.mass * window.gravity.norm(), borne);
  const Vector3<double> left = p.force[i] + kind.mass * from_eigen(window.gravity);
  const double most = o.balance * bears;
  const Facing faces = facing(i, p);
  const bool is_balanced = kind.is_held() || (norm(left) <= most && norm(p.torque[i]) <= most * radius);
  const bool flies = borne == 0.0 && (norm(p.velocity[i]) > 0.0 || norm(p.local_angular_velocity[i]) > 0.0);
  const bool is_steady = std::abs(borne - rest.borne) <= o.change * bears;
  const bool is_still = norm(p.position[i] - rest.position) <= o.motion * radius &&
                        turned<GrainColumns>(rest.facing, faces, window.seconds) <= o.motion;
  const bool is_quiet = is_balanced && !flies && is_steady && is_still;
  rest.quiet_windows =
      is_quiet ? std::min<std::uint8_t>(rest.quiet_windows + 1, Sleepers::windows_to_sleep) : std::uint8_t{0};
  rest.position = p.position[i];
  rest.force = p.force[i];
  rest.torque = p.torque[i];
  rest.facing = faces;
  rest.borne = borne;
  return rest.quiet_windows == Sleepers::windows_to_sleep;
}

/// Keeps what contacts between sleepers do to the grains of a chunk that are watched.
inline void keep(std::size_t begin, std::size_t end, const ForceSums& asleep, Sleepers& s) {
  for (std::size_t i = begin; i < end; ++i) {
    if ((s.doing[i] & watched) == 0) continue;
    s.kept_force.set(i, asleep.force(i - begin));
    s.kept_torque.set(i, asleep.torque(i - begin));
  }
}

/// Keeps what surfaces do to the grains of a chunk that sleeps.
inline void keep_of_surfaces(std::size_t begin, std::size_t end, const ForceSums& of_surfaces, Sleepers& s) {
  for (std::size_t i = begin; i < end; ++i) {
    s.surface_force.set(i, of_surfaces.force(i - begin));
    s.surface_torque.set(i, of_surfaces.torque(i - begin));
  }
}

/// What acts on a sleeper (N, N m): by contacts with grains that are awake and with surfaces, and by contacts between
/// sleepers, which is kept.
struct SleeperSums {
  Vector3<double> force, torque, kept_force, kept_torque;
};

/// Completes the sums of a sleeper with the contacts that other chunks hold. Those of contacts between sleepers are
/// kept, or made anew if the grain is watched.
template <class Model, class GrainColumns>
SleeperSums complete_sums(std::size_t i, std::span<const Chunk<Model>> chunks, const GrainColumns& p,
                          std::span<const std::uint32_t> incoming_first, std::span<const Incoming> incoming,
                          const Sleepers& s) {
  const bool is_watched = (s.doing[i] & watched) != 0;
  SleeperSums sums = {p.force[i], p.torque[i], s.kept_force[i], s.kept_torque[i]};
  if (!chunks[i / chunk_size].evaluated) sums.force = s.surface_force[i], sums.torque = s.surface_torque[i];
  if (!is_watched && s.awake_beside[i] == 0) return sums;
  for (std::uint32_t m = incoming_first[i]; m < incoming_first[i + 1]; ++m) {
    const Chunk<Model>& other = chunks[incoming[m].chunk];
    if (!is_watched && !other.evaluated) continue;  // all of its contacts sleep
    const std::uint32_t first = other.partner_load_first[incoming[m].candidate];
    const std::uint32_t stop = other.partner_load_first[incoming[m].candidate + 1];
    if (first == stop) continue;
    const bool sleeps = other.sleeps[incoming[m].candidate] != 0;
    if (sleeps && !is_watched) continue;
    for (std::uint32_t c = first; c < stop; ++c) {
      (sleeps ? sums.kept_force : sums.force) += other.partner_loads[c].force;
      (sleeps ? sums.kept_torque : sums.torque) += other.partner_loads[c].torque;
    }
  }
  return sums;
}

/// Completes the sums of forces on the grains of one chunk where some sleep. Like gather_forces.
template <class Model, class GrainColumns>
void gather_forces(std::size_t chunk_index, std::span<const Chunk<Model>> chunks, GrainColumns& p,
                   std::span<const std::uint32_t> incoming_first, std::span<const Incoming> incoming, Sleepers& s) {
  const std::size_t begin = chunk_index * chunk_size, end = std::min(begin + chunk_size, p.count);
  const Chunk<Model>& chunk = chunks[chunk_index];
  for (std::size_t i = begin; i < end; ++i) {
    if (s.doing[i] & awake) {  // no contact of it sleeps
      Vector3<double> force = p.force[i], torque = p.torque[i];
      add_incoming<Model>(i, chunks, incoming_first, incoming, force, torque);
      p.force.set(i, force);
      p.torque.set(i, torque);
      continue;
    }
    if (!chunk.evaluated && s.awake_beside[i] == 0) {  // nothing new acts on it
      s.acted_on[i] = 0;
      continue;
    }
    const SleeperSums sums = complete_sums<Model>(i, chunks, p, incoming_first, incoming, s);
    if (s.doing[i] & watched) s.kept_force.set(i, sums.kept_force), s.kept_torque.set(i, sums.kept_torque);
    // What surfaces do that do not move is no news. One that moves may have left it. Written such that a NaN acts.
    const auto is_none = [](const Vector3<double>& v) { return v.x == 0.0 && v.y == 0.0 && v.z == 0.0; };
    s.acted_on[i] = chunk.meets_moving || (s.awake_beside[i] > 0 && !(is_none(sums.force) && is_none(sums.torque)));
    p.force.set(i, sums.force + sums.kept_force);
    p.torque.set(i, sums.torque + sums.kept_torque);
  }
}

/// The chunks that hold candidates of each other, for each chunk; from those that each of them reaches.
template <class Model>
void list_chunks_around(std::span<Chunk<Model>> chunks) {
  for (auto& chunk : chunks) chunk.around.clear();
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    for (const std::uint32_t other : chunks[c].reached) {
      chunks[c].around.push_back(other);
      chunks[other].around.push_back(static_cast<std::uint32_t>(c));
    }
  }
}

}  // namespace dem::grain
