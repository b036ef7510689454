#pragma once

#include <dem/core/function.hpp>
#include <dem/core/ids.hpp>
#include <dem/math/vector.hpp>

namespace dem {

/// What a load law knows of a grain, where the forces of a step are found.
struct GrainNow {
  GrainId id;
  SpeciesId species;
  double time;            ///< s, of the position
  Vec3 position;          ///< m, of the centre of mass; in a periodic cell it may lie a little outside of it
  Vec3 velocity;          ///< m/s; by velocity Verlet that of half a step before
  Vec3 angular_velocity;  ///< rad/s, global axes
};

/// What a load law puts on a grain, global axes.
struct GrainLoad {
  Vec3 force = Vec3::Zero();   ///< N, at the centre of mass
  Vec3 torque = Vec3::Zero();  ///< N m
};

/// A load of the user's own on each grain. It is called from all threads at once, in no order, once in each force
/// evaluation: what it gives must depend on the grain and on what does not change within a step alone.
using GrainLoadLaw = Function<GrainLoad(const GrainNow&)>;

}  // namespace dem
