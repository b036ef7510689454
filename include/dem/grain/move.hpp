#pragma once

#include <dem/grain/chunk.hpp>
#include <dem/grain/species.hpp>
#include <dem/grain/wakefulness.hpp>

#include <array>
#include <bit>
#include <span>
#include <type_traits>

namespace dem::grain {

/// Where a grain finds the contacts that another chunk holds for it: candidate entry `candidate` of chunk `chunk`,
/// whose partner it is.
struct Incoming {
  std::uint32_t chunk, candidate;
};

/// Adds to a grain's force and torque those of the contacts that other chunks hold.
template <class Model>
DEM_HOT_HOST void add_incoming(std::size_t i, std::span<const Chunk<Model>> chunks,
                               std::span<const std::uint32_t> incoming_first, std::span<const Incoming> incoming,
                               Vector3<double>& force, Vector3<double>& torque) {
  for (std::uint32_t m = incoming_first[i]; m < incoming_first[i + 1]; ++m) {
    const Chunk<Model>& other = chunks[incoming[m].chunk];
    const std::uint32_t stop = other.partner_load_first[incoming[m].candidate + 1];
    for (std::uint32_t c = other.partner_load_first[incoming[m].candidate]; c < stop; ++c) {
      force += other.partner_loads[c].force;
      torque += other.partner_loads[c].torque;
    }
  }
}

/// Completes the sums of forces on the grains of one chunk with the contacts that other chunks hold, in a fixed order.
/// Every chunk only reads what others wrote: no locks, and the same bits on any number of threads.
template <class Model, class GrainColumns>
void gather_forces(std::size_t chunk_index, std::span<const Chunk<Model>> chunks, GrainColumns& p,
                   std::span<const std::uint32_t> incoming_first, std::span<const Incoming> incoming) {
  const std::size_t begin = chunk_index * chunk_size;
  const std::size_t end = std::min(begin + chunk_size, p.count);
  for (std::size_t i = begin; i < end; ++i) {
    Vector3<double> force = p.force[i], torque = p.torque[i];
    add_incoming<Model>(i, chunks, incoming_first, incoming, force, torque);
    p.force.set(i, force);
    p.torque.set(i, torque);
  }
}

/// Acceleration of a pack of grains from the gathered forces (eqs. 12 and 13).
template <class GrainColumns>
DEM_HOT_HOST integrator::Acceleration<Pack> acceleration(std::size_t i, const GrainColumns& p,
                                                         std::span<const SpeciesInertia> inertia, const Vec3& gravity,
                                                         const integrator::Motion<Pack>& m, double lead = 0.0) {
  const auto of = [&](auto&& member) {
    return generate([&](int lane) { return member(inertia[p.species[i + static_cast<std::size_t>(lane)]]); });
  };
  const bool one_species = inertia.size() == 1;
  const auto value = [&](auto&& member) { return one_species ? Pack(member(inertia[0])) : of(member); };
  const Pack inverse_mass = value([](const SpeciesInertia& s) { return s.inverse_mass; });
  const Pack gravity_scale = value([](const SpeciesInertia& s) { return s.gravity_scale; });
  const Vector3<Pack> moments = {value([](const SpeciesInertia& s) { return s.inertia[0]; }),
                                 value([](const SpeciesInertia& s) { return s.inertia[1]; }),
                                 value([](const SpeciesInertia& s) { return s.inertia[2]; })};
  const Vector3<Pack> inverse = {value([](const SpeciesInertia& s) { return s.inverse_inertia[0]; }),
                                 value([](const SpeciesInertia& s) { return s.inverse_inertia[1]; }),
                                 value([](const SpeciesInertia& s) { return s.inverse_inertia[2]; })};
  const Vector3<Pack> g = {Pack(gravity.x()), Pack(gravity.y()), Pack(gravity.z())};
  Vector3<Pack> torque = p.torque.pack(i);
  if constexpr (GrainColumns::has_orientation) torque = transpose_times(m.rotation, torque);
  return {inverse_mass * p.force.pack(i) + gravity_scale * g,
          integrator::angular_acceleration(torque, m.angular_velocity, moments, inverse, Pack(lead))};
}

/// What contacts read of the grains of one chunk.
template <class GrainColumns, class Shape>
void refresh_views(std::size_t begin, std::size_t end, GrainColumns& p, std::span<const Species<Shape>> species) {
  for (std::size_t i = begin; i < end; ++i) {
    const Species<Shape>& kind = species[p.species[i]];
    p.view[i] = {p.position[i], kind.shape.bounding_radius(), p.velocity[i], kind.inverse_mass, p.angular_velocity(i)};
  }
}

/// Refreshes what depends on where the grains of a chunk are: views, poses, bounds, and how far they moved since the
/// neighbour list was made. Where grains may sleep (`doing` is not empty), views and poses of those that are awake.
template <class Model, class GrainColumns>
void refresh_chunk(std::size_t chunk_index, Chunk<Model>& chunk, GrainColumns& p,
                   std::span<const Species<typename Model::Shape>> species, Wakefulness doing = {}) {
  const std::size_t begin = chunk_index * chunk_size;
  const std::size_t end = std::min(begin + chunk_size, p.count);
  for_each_awake_run(begin, end, doing, [&](std::size_t first, std::size_t stop) {
    refresh_views(first, stop, p, species);
    if constexpr (Model::Shape::pose_size > 0) {
      for (std::size_t i = first; i < stop; ++i) species[p.species[i]].shape.orient(p.rotation(i), p.pose_of(i));
    }
  });
  const std::size_t stop = p.packs_end(begin);
  if (end < stop) p.pad(stop);
  Vector3<Pack> low = p.position.pack(begin), high = low;
  Pack moved2(0.0), check(0.0);
  for (std::size_t i = begin; i < stop; i += static_cast<std::size_t>(pack_width)) {
    const Vector3<Pack> x = p.position.pack(i), v = p.velocity.pack(i), w = p.local_angular_velocity.pack(i);
    low = {min(low.x, x.x), min(low.y, x.y), min(low.z, x.z)};
    high = {max(high.x, x.x), max(high.y, x.y), max(high.z, x.z)};
    const Vector3<Pack> moved = x - p.listed_at.pack(i);
    moved2 = max(moved2, dot(moved, moved));
    // A NaN or an infinity anywhere survives these sums: 0 * inf = NaN.
    check += Pack(0.0) * (x.x + x.y + x.z + v.x + v.y + v.z + w.x + w.y + w.z);
  }
  chunk.low = Vec3(smallest(low.x), smallest(low.y), smallest(low.z));
  chunk.high = Vec3(largest(high.x), largest(high.y), largest(high.z));
  chunk.moved2 = largest(moved2);
  bool finite = true;
  for (int k = 0; k < pack_width; ++k) finite &= lane(check, k) == 0.0;
  chunk.finite = finite;
}

/// How many steps lie between two clean-ups of the rotation matrices. Rounding turns a product of rotations into a
/// non-rotation by about 1e-16 a step, so 1e-14 at the most.
inline constexpr std::uint64_t steps_between_orthonormalisations = 64;

/// Lane by lane `yes` where the condition holds, of structs of packs.
template <class Value>
Value chosen(const PackMask& condition, const Value& yes, const Value& no) {
  if constexpr (std::is_empty_v<Value>) {
    return no;
  } else {
    using Packs = std::array<Pack, sizeof(Value) / sizeof(Pack)>;
    const auto a = std::bit_cast<Packs>(yes), b = std::bit_cast<Packs>(no);
    Packs result;
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = select(condition, a[k], b[k]);
    return std::bit_cast<Value>(result);
  }
}

/// Which grains of a pack sleep.
inline PackMask sleeping(std::size_t i, Wakefulness doing) {
  return generate([&](int lane) { return doing[i + static_cast<std::size_t>(lane)] & awake ? 0.0 : 1.0; }) > Pack(0.0);
}
/// How many of them are awake.
inline std::size_t count_awake(std::size_t i, Wakefulness doing) {
  std::size_t count = 0;
  for (std::size_t lane = 0; lane < pack_width; ++lane) count += static_cast<std::size_t>(doing[i + lane] & awake);
  return count;
}

/// Calls advance(i, motion, memory) for each pack of a chunk's grains. Grains that sleep stay as they are.
template <class GrainColumns, class Advance>
void advance_chunk(std::size_t begin, GrainColumns& p, Wakefulness doing, const Advance& advance) {
  const std::size_t stop = p.packs_end(begin);
  for (std::size_t i = begin; i < stop; i += static_cast<std::size_t>(pack_width)) {
    const std::size_t awake_here = doing.empty() ? pack_width : count_awake(i, doing);
    if (awake_here == 0) continue;
    integrator::Motion<Pack> m = p.motion(i);
    auto memory = p.memory_pack(i);
    if (awake_here == pack_width) {
      advance(i, m, memory);
    } else {
      const auto m_before = m;
      const auto memory_before = memory;
      advance(i, m, memory);
      const PackMask sleeps = sleeping(i, doing);
      m = chosen(sleeps, m_before, m);
      memory = chosen(sleeps, memory_before, memory);
    }
    p.set_motion(i, m);
    p.set_memory_pack(i, memory);
  }
}

/// What moves the grains in a stage of a step.
template <class Shape>
struct MovingStage {
  std::span<const Species<Shape>> species;
  std::span<const SpeciesInertia> inertia;
  Vec3 gravity;                   ///< m/s^2
  int stage = 0;                  ///< of the integrator
  double dt = 0.0;                ///< s
  bool cleans_rotations = false;  ///< takes the rounding out of the rotation matrices
  Wakefulness doing = {};         ///< empty where no grain may sleep
};

/// Forces -> accelerations -> motion, for the grains of one chunk.
template <class Model, class GrainColumns>
void move_chunk(std::size_t chunk_index, Chunk<Model>& chunk, GrainColumns& p,
                const MovingStage<typename Model::Shape>& s) {
  using Integrator = typename Model::Integrator;
  const double lead = integrator::gyroscopic_lead<Integrator>(s.dt);
  advance_chunk(chunk_index * chunk_size, p, s.doing, [&](std::size_t i, integrator::Motion<Pack>& m, auto& memory) {
    Integrator::template after_forces<Pack>(s.stage, Pack(s.dt), m, memory,
                                            acceleration(i, p, s.inertia, s.gravity, m, lead));
    if (s.cleans_rotations && GrainColumns::has_orientation) m.rotation = orthonormalised(m.rotation);
  });
  refresh_chunk<Model>(chunk_index, chunk, p, s.species, s.doing);
}

/// The integrator's memory from the forces at the initial state.
template <class Model, class GrainColumns>
void initialise_chunk(std::size_t chunk_index, GrainColumns& p, std::span<const SpeciesInertia> inertia,
                      const Vec3& gravity) {
  const std::size_t begin = chunk_index * chunk_size, stop = p.packs_end(begin);
  for (std::size_t i = begin; i < stop; i += static_cast<std::size_t>(pack_width)) {
    auto memory = p.memory_pack(i);
    Model::Integrator::template initialise<Pack>(memory, acceleration(i, p, inertia, gravity, p.motion(i)));
    p.set_memory_pack(i, memory);
  }
}

/// The part of an integration stage that comes before the forces (velocity Verlet's first kick and drift).
template <class Model, class GrainColumns>
void predict_chunk(std::size_t chunk_index, Chunk<Model>& chunk, GrainColumns& p,
                   const MovingStage<typename Model::Shape>& s) {
  using Integrator = typename Model::Integrator;
  advance_chunk(chunk_index * chunk_size, p, s.doing, [&](std::size_t, integrator::Motion<Pack>& m, auto& memory) {
    Integrator::template before_forces<Pack>(s.stage, Pack(s.dt), m, memory);
  });
  refresh_chunk<Model>(chunk_index, chunk, p, s.species, s.doing);
}

}  // namespace dem::grain
