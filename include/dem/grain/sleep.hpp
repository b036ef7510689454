#pragma once

#include <dem/grain/contact_evaluator.hpp>
#include <dem/grain/move.hpp>
#include <dem/grain/sleep_options.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace dem::grain {

/// A grain at the end of the last window, or when it fell asleep.
struct Rest {
  Vector3<double> position = {0, 0, 0};                   ///< m
  Vector3<double> force = {0, 0, 0}, torque = {0, 0, 0};  ///< N, N m
  double borne = 0.0;                                     ///< N, sum of the magnitudes of its contact forces
  std::uint8_t quiet_windows = 0;
  bool asleep = false;
};

/// What is known of resting grains.
struct Sleepers {
  static constexpr std::uint8_t windows_to_sleep = 2;

  std::vector<Rest> grains;            ///< by id
  std::vector<double> borne;           ///< N, by row: of the contacts that the grain's own chunk holds
  std::vector<std::uint32_t> working;  ///< chunks whose contacts are evaluated
  bool measuring = false;              ///< a window ends with this step
  bool all_work = true;                ///< in the next evaluation: neighbour lists are new
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

/// Whether the forces on a grain of a sleeping chunk have changed by too much since it fell asleep.
template <class Model, class Particles>
bool is_disturbed(std::size_t begin, std::size_t end, const Particles& p,
                  std::span<const Species<typename Model::Shape>> species, const Vec3& gravity, const Sleepers& s,
                  const SleepOptions& o) {
  const double g = gravity.norm();
  for (std::size_t i = begin; i < end; ++i) {
    const Rest& rest = s.grains[p.id[i]];
    const auto& kind = species[p.species[i]];
    const double most = o.change * std::max(kind.mass * g, rest.borne);
    // Written such that a NaN disturbs as well.
    if (!(norm(p.force[i] - rest.force) <= most) ||
        !(norm(p.torque[i] - rest.torque) <= most * kind.shape.bounding_radius())) {
      return true;
    }
  }
  return false;
}

/// Stops the grains of a chunk that falls asleep.
template <class Shape, class Particles>
void put_to_sleep(std::size_t begin, std::size_t end, Particles& p, std::span<const Species<Shape>> species,
                  Sleepers& s) {
  bool stops = false;
  for (std::size_t i = begin; i < end; ++i) {
    Rest& rest = s.grains[p.id[i]];
    if (rest.asleep) continue;
    p.velocity.set(i, {0, 0, 0});
    p.spin.set(i, {0, 0, 0});
    rest.asleep = stops = true;
  }
  if (stops) refresh_views(begin, end, p, species);
}

/// Ends a window for the grains of a chunk that is awake: counts those that were quiet. Puts all of them to sleep when
/// each was quiet for long enough, and returns whether it did.
template <class Model, class Particles>
bool end_window(std::size_t begin, std::size_t end, std::span<const Chunk<Model>> chunks, Particles& p,
                std::span<const Species<typename Model::Shape>> species, const Vec3& gravity,
                std::span<const std::uint32_t> incoming_first, std::span<const Incoming> incoming, Sleepers& s,
                const SleepOptions& o) {
  const double g = gravity.norm();
  bool sleeps = true;
  for (std::size_t i = begin; i < end; ++i) {
    double borne = s.borne[i];
    for (std::uint32_t m = incoming_first[i]; m < incoming_first[i + 1]; ++m) {
      const Chunk<Model>& other = chunks[incoming[m].chunk];
      const std::uint32_t stop = other.partner_load_first[incoming[m].candidate + 1];
      for (std::uint32_t c = other.partner_load_first[incoming[m].candidate]; c < stop; ++c) {
        borne += norm(other.partner_loads[c].force);
      }
    }
    const auto& kind = species[p.species[i]];
    const double radius = kind.shape.bounding_radius(), bears = std::max(kind.mass * g, borne);
    Rest& rest = s.grains[p.id[i]];
    const Vector3<double> left = p.force[i] + kind.mass * from_eigen(gravity);
    const double most = o.balance * bears;
    const bool is_balanced = kind.is_held() || (norm(left) <= most && norm(p.torque[i]) <= most * radius);
    const bool is_steady = std::abs(borne - rest.borne) <= o.change * bears;
    const bool is_quiet = is_balanced && is_steady && norm(p.position[i] - rest.position) <= o.motion * radius;
    rest.quiet_windows =
        is_quiet ? std::min<std::uint8_t>(rest.quiet_windows + 1, Sleepers::windows_to_sleep) : std::uint8_t{0};
    rest.position = p.position[i];
    rest.force = p.force[i];
    rest.torque = p.torque[i];
    rest.borne = borne;
    sleeps &= rest.quiet_windows == Sleepers::windows_to_sleep;
  }
  if (!sleeps) return false;
  put_to_sleep<typename Model::Shape>(begin, end, p, species, s);
  return true;
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
