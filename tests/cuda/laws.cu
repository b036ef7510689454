// The kernels that device code may call compile for a device. Nothing is run.

#include <dem/geometry/box/box.hpp>
#include <dem/geometry/contact_point.hpp>
#include <dem/geometry/plane/plane.hpp>
#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/law/cohesion/constant.hpp>
#include <dem/law/cohesion/contact_stress.hpp>
#include <dem/law/cohesion/dmt.hpp>
#include <dem/law/cohesion/jkr.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/cohesion/none.hpp>
#include <dem/law/friction/asperity_spring.hpp>
#include <dem/law/friction/coulomb_viscous.hpp>
#include <dem/law/friction/cundall_strack.hpp>
#include <dem/law/friction/mindlin.hpp>
#include <dem/law/friction/none.hpp>
#include <dem/law/friction/varying.hpp>
#include <dem/law/normal/hertz.hpp>
#include <dem/law/normal/hysteretic.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/law/normal/penalty.hpp>
#include <dem/law/rolling/constant_torque.hpp>
#include <dem/law/rolling/elastic_plastic.hpp>
#include <dem/law/rolling/none.hpp>
#include <dem/law/rolling/sum.hpp>
#include <dem/law/rolling/torsion.hpp>

using dem::Vector3;

struct Contact {
  dem::contact::ClusterContactPoint<double> pair;
  dem::contact::SphereContactPoint<double> spheres;
  dem::contact::SurfaceContactPoint<double> surface;
  Vector3<double> velocity;
  Vector3<double> slip;
};

struct Constants {
  dem::contact::Penalty::Parameters<double> normal;
  dem::friction::AsperitySpring::Parameters<double> friction;
  double time_step;
};

__device__ Vector3<double> force(const dem::contact::Geometry<double>& g, const Vector3<double>& velocity,
                                 const Constants& c, Vector3<double>& slip) {
  const double approach = dot(velocity, g.normal);
  dem::contact::Penalty::History<double> none;
  const double normal =
      dem::contact::Penalty::force<double>(c.normal, {g.overlap, approach, g.effective_radius, 1.0, c.time_step}, none);
  dem::friction::AsperitySpring::History<double> history = {slip};
  const dem::friction::TangentialState<double> state = {
      velocity - approach * g.normal, normal, g.overlap, g.effective_radius, 1.0, c.time_step};
  const Vector3<double> friction = dem::friction::AsperitySpring::force<double>(c.friction, state, history);
  slip = history.slip;
  dem::friction::None::History<double> nothing;
  return g.weight * (friction + dem::friction::None::force<double>({}, state, nothing) - normal * g.normal);
}

__global__ void contact_forces(int n, Contact* contacts, Constants constants, Vector3<double>* forces) {
  const int k = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (k >= n) return;
  Contact& c = contacts[k];
  forces[k] = force(c.pair.geometry(), c.velocity, constants, c.slip) +
              force(c.spheres.geometry(), c.velocity, constants, c.slip) +
              force(c.surface.geometry(), c.velocity, constants, c.slip);
}

/// One contact under one law of each kind: its parameters, and what it remembers.
template <class Normal, class Friction, class Rolling, class Cohesion>
struct LawContact {
  typename Normal::template Parameters<double> normal;
  typename Friction::template Parameters<double> friction;
  typename Rolling::template Parameters<double> rolling;
  typename Cohesion::template Parameters<double> cohesion;
  typename Normal::template History<double> normal_history;
  typename Friction::template History<double> friction_history;
  typename Rolling::template History<double> rolling_history;
  typename Cohesion::template History<double> cohesion_history;
  dem::contact::NormalState<double> state;
  Vector3<double> velocity, spin;
};

template <class Normal, class Friction, class Rolling, class Cohesion>
__global__ void law_forces(int n, LawContact<Normal, Friction, Rolling, Cohesion>* contacts, Vector3<double>* forces) {
  const int k = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (k >= n) return;
  auto& c = contacts[k];
  const dem::contact::NormalState<double>& s = c.state;
  const double repulsion = Normal::force(c.normal, s, c.normal_history);
  const auto attraction = Cohesion::force(c.cohesion, s, c.cohesion_history);
  const double pressing = dem::max(0.0, repulsion + attraction.grip);
  const auto turn = [](const Vector3<double>& v) { return -v; };
  Friction::carry(c.friction_history, turn);
  Rolling::carry(c.rolling_history, turn);
  const dem::friction::TangentialState<double> sliding = {c.velocity,         pressing,         s.overlap,
                                                          s.effective_radius, s.effective_mass, s.time_step};
  const dem::rolling::RollingState<double> rolling = {{0, 0, 1},          c.spin,           c.spin.z,   pressing,
                                                      s.effective_radius, s.effective_mass, s.time_step};
  forces[k] = Friction::force(c.friction, sliding, c.friction_history) +
              Rolling::torque(c.rolling, rolling, c.rolling_history) +
              Vector3<double>{0, 0, attraction.pull - repulsion};
}

template <class Normal, class Friction, class Rolling, class Cohesion>
void launch(LawContact<Normal, Friction, Rolling, Cohesion>* contacts, Vector3<double>* forces) {
  law_forces<<<1, 32>>>(32, contacts, forces);
}
namespace contact = dem::contact;
namespace friction = dem::friction;
namespace rolling = dem::rolling;
namespace cohesion = dem::cohesion;
template void launch(LawContact<contact::Hertz, friction::Mindlin, rolling::ElasticPlastic, cohesion::JKR>*,
                     Vector3<double>*);
template void launch(LawContact<contact::LinearSpringDashpot, friction::CundallStrack,
                                rolling::Sum<rolling::ElasticPlastic, rolling::Torsion>, cohesion::LiquidBridge>*,
                     Vector3<double>*);
template void launch(LawContact<contact::Hysteretic, friction::CoulombViscous,
                                rolling::Sum<rolling::ConstantTorque, rolling::Torsion>, cohesion::DMT>*,
                     Vector3<double>*);
template void launch(
    LawContact<contact::Penalty, friction::Varying<friction::AsperitySpring>, rolling::None, cohesion::Constant>*,
    Vector3<double>*);
template void launch(
    LawContact<contact::LinearSpringDashpot, friction::CundallStrack, rolling::None, cohesion::ContactStress>*,
    Vector3<double>*);

struct Body {
  dem::integrator::Motion<double> motion;
  dem::integrator::PredictorCorrector::Memory<double> corrector;
  dem::integrator::VelocityVerlet::Memory<double> verlet;
  dem::integrator::SymplecticEuler::Memory<double> euler;
  Vector3<double> force, torque, inertia, inverse_inertia;
};

template <class Integrator>
__device__ void advance(Body& b, typename Integrator::template Memory<double>& memory, int stage, double dt) {
  const dem::integrator::Acceleration<double> a = {
      b.force, dem::integrator::angular_acceleration<double>(transpose_times(b.motion.rotation, b.torque),
                                                             b.motion.angular_velocity, b.inertia, b.inverse_inertia)};
  Integrator::template initialise<double>(memory, a);
  Integrator::template before_forces<double>(stage, dt, b.motion, memory);
  Integrator::template after_forces<double>(stage, dt, b.motion, memory, a);
}

__global__ void move(int n, Body* bodies, int stage, double dt) {
  const int k = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (k >= n) return;
  Body& b = bodies[k];
  advance<dem::integrator::PredictorCorrector>(b, b.corrector, stage, dt);
  advance<dem::integrator::VelocityVerlet>(b, b.verlet, stage, dt);
  advance<dem::integrator::SymplecticEuler>(b, b.euler, stage, dt);
  b.motion.rotation = dem::orthonormalised(b.motion.rotation * dem::rotation_from_vector<double>(dt * b.torque));
}
