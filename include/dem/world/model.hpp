#pragma once

#include <dem/domain/open.hpp>
#include <dem/geometry/box/box.hpp>
#include <dem/geometry/cylinder/cylinder.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>
#include <dem/geometry/plane/plane.hpp>
#include <dem/geometry/sphere/sphere.hpp>
#include <dem/geometry/sphere/sphere_surface.hpp>
#include <dem/grain/broadphase/uniform_grid.hpp>
#include <dem/integrator/predictor_corrector.hpp>
#include <dem/law/cohesion/none.hpp>
#include <dem/law/friction/asperity_spring.hpp>
#include <dem/law/normal/penalty.hpp>
#include <dem/law/rolling/none.hpp>
#include <dem/mbd/solver/joint_policy.hpp>
#include <dem/parallel/threads.hpp>

#include <type_traits>

namespace dem {

/// The policies of a world. Derive from it and name those that differ:
///   struct Sand : dem::Model { using Shape = dem::shape::SphereCluster<8>; };
struct Model {
  using Shape = shape::Sphere;
  /// Those that cost no time where they are not used. Others by name: surface::Set<surface::Plane,
  /// surface::Superquadric>.
  using Surfaces =
      surface::Set<surface::Plane, surface::Box, surface::Sphere, surface::Cylinder, surface::TriangleMesh>;
  using Normal = contact::Penalty;
  using Friction = friction::AsperitySpring;
  using Rolling = rolling::None;
  using Cohesion = cohesion::None;
  using BroadPhase = broadphase::UniformGrid;
  using Domain = domain::Open;
  using Integrator = integrator::PredictorCorrector;
  using Executor = exec::Threads;
  /// Of the machine. mbd::Projected, of <dem/mbd/solver/projected.hpp>, holds them exactly.
  using Joints = mbd::Penalty;
};

template <class... Kinds>
constexpr bool check_surfaces(const std::variant<Kinds...>*) {
  (surface::check_surface<Kinds>(), ...);
  return true;
}

/// Within `struct Rolling : Model` the name Rolling means the struct itself, and no policy.
template <class M, class... Policies>
constexpr void check_name() {
  static_assert(
      !(std::is_same_v<M, Policies> || ...),
      "Model: your model is called like one of its policies (Shape, Surfaces, Normal, Friction, Rolling, "
      "Cohesion, BroadPhase, Domain, Integrator, Executor or Joints), so that name means the model itself; rename the "
      "model");
}

/// Refuses a wrong policy in words, at compile time.
template <class M>
constexpr bool check_model() {
  check_name<M, typename M::Shape, typename M::Surfaces, typename M::Normal, typename M::Friction, typename M::Rolling,
             typename M::Cohesion, typename M::BroadPhase, typename M::Domain, typename M::Integrator,
             typename M::Executor, typename M::Joints>();
  shape::check_shape<typename M::Shape>();
  check_surfaces(static_cast<typename M::Surfaces*>(nullptr));
  contact::check_normal_law<typename M::Normal>();
  friction::check_friction_law<typename M::Friction>();
  rolling::check_rolling_law<typename M::Rolling>();
  cohesion::check_cohesion_law<typename M::Cohesion, typename M::Normal>();
  if constexpr (cohesion::reaches<typename M::Cohesion>) shape::check_reaching_shape<typename M::Shape>();
  broadphase::check_broad_phase<typename M::BroadPhase>();
  static_assert(
      requires {
        { M::Domain::has_images } -> std::convertible_to<bool>;
        { M::Domain::has_ranks } -> std::convertible_to<bool>;
      },
      "Domain: must be domain::Open, domain::Periodic, domain::Sheared, or what ranks share: domain::Ranks, "
      "PeriodicRanks or ShearedRanks");
  integrator::check_integrator<typename M::Integrator>();
  exec::check_executor<typename M::Executor>();
  mbd::check_joint_policy<typename M::Joints>();
  return true;
}

}  // namespace dem
