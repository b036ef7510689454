#pragma once

#include <dem/world/world_setup.hpp>

#include <algorithm>
#include <vector>

namespace dem {

/// What is asked of the grains of a world one by one, and set by hand. Each call throws Error for a grain or species
/// that is not there or was removed, and where ranks share the grains, within a run.
template <class M>
class WorldGrains : public WorldSetup<M> {
  using Setup = WorldSetup<M>;

 protected:
  using Setup::state_, Setup::initialised_, Setup::row, Setup::row_that_moves, Setup::require_between_runs,
      Setup::touched;

 public:
  using Shape = typename M::Shape;
  using Setup::Setup;

  /// How many are there; those that are about to be removed no longer count.
  std::size_t grain_count() const { return state_.grains.count - state_.to_remove.size(); }
  /// All grains that are there, in the order in which they were added.
  std::vector<GrainId> grains() const {
    std::vector<GrainId> ids;
    for (std::size_t k = 0; k < state_.grains.row_of.size(); ++k) {
      if (state_.grains.row_of[k] == state_.grains.gone) continue;
      ids.push_back(state_.grains.name(static_cast<std::uint32_t>(k)));
    }
    if (!state_.grains.number.empty()) std::sort(ids.begin(), ids.end());
    return ids;
  }
  /// m, of the centre of mass.
  Vec3 position(GrainId p) const { return to_eigen(state_.grains.position[row(p)]); }
  /// m/s, of the centre of mass.
  Vec3 velocity(GrainId p) const { return to_eigen(state_.grains.velocity[row(p)]); }
  /// rad/s, global axes.
  Vec3 angular_velocity(GrainId p) const { return to_eigen(state_.grains.angular_velocity(row(p))); }
  /// From the grain's frame, that of its shape, to global axes.
  Mat3 rotation(GrainId p) const { return to_eigen(state_.grains.rotation(row(p))); }
  /// Force (N) and torque (N m) on a grain in the last force evaluation: of its contacts, and of a load law, without
  /// its weight.
  Vec3 force(GrainId p) const { return to_eigen(state_.grains.force[row(p)]); }
  Vec3 torque(GrainId p) const { return to_eigen(state_.grains.torque[row(p)]); }
  /// Whether a grain sleeps (WorldOptions::sleep).
  bool is_asleep(GrainId p) const { return dem::is_asleep(state_, state_.grains.id[row(p)]); }
  /// How many grains sleep.
  std::size_t asleep_count() const {
    require_between_runs("how many grains sleep");
    if (!state_.options.sleep) return 0;
    const auto& rests = state_.sleepers.grains;
    const auto& rows = state_.grains.row_of;
    std::size_t count = 0;
    for (std::size_t id = 0; id < rests.size(); ++id) {
      count += rests[id].asleep && rows[id] != state_.grains.gone ? 1 : 0;
    }
    return count;
  }
  SpeciesId species_of(GrainId p) const { return SpeciesId(state_.grains.species[row(p)]); }
  const Species<Shape>& species(SpeciesId s) const { return known(state_.species, s, "species"); }

  /// m/s. Throws Error for a held grain too, and unless v is finite, as the other set_... do.
  void set_velocity(GrainId p, const Vec3& v) {
    detail::require_finite(v, "velocity of a grain");
    wake_around(state_, row_that_moves(p));
    state_.grains.velocity.set(row(p), from_eigen(v));
    initialised_ = false;
  }
  /// rad/s, global axes.
  void set_angular_velocity(GrainId p, const Vec3& w) {
    detail::require_finite(w, "angular velocity of a grain");
    wake_around(state_, row_that_moves(p));
    state_.grains.local_angular_velocity.set(row(p), from_eigen(Vec3(rotation(p).transpose() * w)));
    initialised_ = false;
  }
  /// Puts a grain elsewhere; its contacts there start without friction, those that it still has go on.
  void set_position(GrainId p, const Vec3& x) {
    detail::require_finite(x, "position of a grain");
    wake_around(state_, row_that_moves(p));
    state_.grains.position.set(row(p), from_eigen(x));
    state_.placed.grain(state_.step, state_.grains.id[row(p)]);
    touched();
  }

  /// Turns a grain; it keeps its angular velocity in global axes.
  void set_rotation(GrainId p, const Mat3& r) requires(Shape::has_orientation) {
    if (!(distance_from_rotation(r) <= 1e-6)) {
      fail("grain {} was given a rotation matrix that is no rotation; normalise it (R^T R = I, det R = 1)", p.value);
    }
    wake_around(state_, row_that_moves(p));
    const Vec3 w = angular_velocity(p);
    state_.grains.set_rotation(row(p), from_eigen(r));
    state_.grains.local_angular_velocity.set(row(p), from_eigen(Vec3(r.transpose() * w)));
    state_.placed.grain(state_.step, state_.grains.id[row(p)]);
    touched();
  }
};

}  // namespace dem
