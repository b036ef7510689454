#pragma once

// The worlds that many tests run. Each is compiled once, in worlds/*.cpp: a world takes ten seconds, and a test that
// uses one of these does not compile it again. A test makes a model of its own only if what it asks needs one.

#include <dem/domain/periodic.hpp>
#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/grain/broadphase/all_pairs.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/law/friction/cundall_strack.hpp>
#include <dem/law/friction/mindlin.hpp>
#include <dem/law/normal/hertz.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/mbd/mbd.hpp>
#include <dem/mbd/solver/projected.hpp>
#include <dem/parallel/serial.hpp>
#include <dem/world/contacts.hpp>
#include <dem/world/energy.hpp>
#include <dem/world/world.hpp>

namespace models {

using Sphere = dem::shape::Sphere;
using Cube8 = dem::shape::SphereCluster<8>;

/// The default laws.
template <class S, class I = dem::integrator::SymplecticEuler, class B = dem::broadphase::UniformGrid,
          class E = dem::exec::Threads>
struct Grains : dem::Model {
  using Shape = S;
  using Integrator = I;
  using BroadPhase = B;
  using Executor = E;
};

/// Laws of choice.
template <class N, class F, class R = dem::rolling::None, class C = dem::cohesion::None, class S = Sphere>
struct Laws : dem::Model {
  using Shape = S;
  using Normal = N;
  using Friction = F;
  using Rolling = R;
  using Cohesion = C;
  using Integrator = dem::integrator::VelocityVerlet;
  using Executor = dem::exec::Serial;
};

using CorrectedBalls = dem::Model;  // by the predictor-corrector
using Balls = Grains<Sphere>;       // by symplectic Euler
using VerletBalls = Grains<Sphere, dem::integrator::VelocityVerlet>;
using CorrectedCubes = Grains<Cube8, dem::integrator::PredictorCorrector>;
using Cubes = Grains<Cube8>;
using VerletCubes = Grains<Cube8, dem::integrator::VelocityVerlet>;
struct PeriodicCubes : Cubes {
  using Domain = dem::domain::Periodic;
};
struct PeriodicVerletCubes : VerletCubes {
  using Domain = dem::domain::Periodic;
};
/// The machine's joints are held exactly.
struct HeldBalls : VerletBalls {
  using Joints = dem::mbd::Projected;
};

using Linear = dem::contact::LinearSpringDashpot;
struct LinearModel : Laws<Linear, dem::friction::CundallStrack> {
  using Executor = dem::exec::Threads;
};
struct HertzModel : Laws<dem::contact::Hertz, dem::friction::Mindlin> {
  using Executor = dem::exec::Threads;
};

}  // namespace models

// What of a world takes the time: its classes, the functions of a step, and what looks at contacts.
#define TEST_WORLD(declare, M)                                                              \
  declare template void dem::evaluate_contacts<M>(dem::WorldState<M>&);                     \
  declare template void dem::advance<M>(dem::WorldState<M>&);                               \
  declare template void dem::initialise<M>(dem::WorldState<M>&);                            \
  declare template void dem::rebuild_neighbours<M>(dem::WorldState<M>&);                    \
  declare template void dem::find_sleepers<M>(dem::WorldState<M>&);                         \
  declare template void dem::watch_changed<M>(dem::WorldState<M>&);                         \
  declare template void dem::choose_working_chunks<M>(dem::WorldState<M>&);                 \
  declare template void dem::put_in<M>(dem::WorldState<M>&);                                \
  declare template void dem::take_out<M>(dem::WorldState<M>&);                              \
  declare template void dem::release_ids<M>(dem::WorldState<M>&);                           \
  declare template void dem::note_deep<M>(dem::WorldState<M>&);                             \
  declare template void dem::find_points_deep_enough<M>(dem::WorldState<M>&);               \
  declare template void dem::check_thin_sheets<M>(const dem::WorldState<M>&);               \
  declare template void dem::choose_time_step<M>(dem::WorldState<M>&, bool&);               \
  declare template dem::StableTimeStep dem::stable_time_step<M>(const dem::WorldState<M>&); \
  declare template dem::StepReport dem::find_problem<M>(dem::WorldState<M>&);               \
  declare template std::vector<dem::Contact<M>> dem::contacts_of<M>(const dem::World<M>&);  \
  declare template void dem::count_energy<M>(dem::World<M>&);                               \
  declare template dem::GrainEnergy dem::energy_of<M>(const dem::World<M>&);                \
  declare template class dem::WorldSetup<M>;                                                \
  declare template class dem::WorldGrains<M>;                                               \
  declare template class dem::World<M>;

// A machine with the solver of one integrator.
#define TEST_MACHINE(declare, I)              \
  declare template class dem::mbd::Solver<I>; \
  declare template class dem::mbd::Machine<I>;

TEST_WORLD(extern, models::CorrectedBalls)
TEST_WORLD(extern, models::Balls)
TEST_WORLD(extern, models::VerletBalls)
TEST_WORLD(extern, models::CorrectedCubes)
TEST_WORLD(extern, models::Cubes)
TEST_WORLD(extern, models::VerletCubes)
TEST_WORLD(extern, models::PeriodicCubes)
TEST_WORLD(extern, models::PeriodicVerletCubes)
TEST_WORLD(extern, models::HeldBalls)
TEST_WORLD(extern, models::LinearModel)
TEST_WORLD(extern, models::HertzModel)

TEST_MACHINE(extern, dem::integrator::PredictorCorrector)
TEST_MACHINE(extern, dem::integrator::SymplecticEuler)
TEST_MACHINE(extern, dem::integrator::VelocityVerlet)
