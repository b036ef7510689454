// The kernels that device code may call compile for a device. Nothing is run.

#include <dem/contact/penalty.hpp>
#include <dem/contact/touch.hpp>
#include <dem/friction/asperity_spring.hpp>
#include <dem/friction/none.hpp>
#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/surface/box.hpp>
#include <dem/surface/plane.hpp>

using dem::Vector3;

struct Contact {
  dem::contact::ClusterTouch<double> pair;
  dem::contact::SphereTouch<double> spheres;
  dem::contact::SurfaceTouch<double> surface;
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
  const double normal = dem::contact::Penalty::force<double>(
      c.normal, {g.overlap, approach, g.area, g.effective_radius, 1.0, c.time_step}, none);
  dem::friction::AsperitySpring::History<double> history = {slip};
  const dem::friction::TangentialState<double> state = {
      velocity - approach * g.normal, normal, g.overlap, g.area, g.effective_radius, 1.0, c.time_step};
  const Vector3<double> friction = dem::friction::AsperitySpring::force<double>(c.friction, state, history);
  slip = history.slip;
  dem::friction::None::History<double> nothing;
  return friction + dem::friction::None::force<double>({}, state, nothing) - normal * g.normal;
}

__global__ void contact_forces(int n, Contact* contacts, Constants constants, Vector3<double>* forces) {
  const int k = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (k >= n) return;
  Contact& c = contacts[k];
  forces[k] = force(c.pair.geometry(), c.velocity, constants, c.slip) +
              force(c.spheres.geometry(), c.velocity, constants, c.slip) +
              force(c.surface.geometry(), c.velocity, constants, c.slip);
}

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
