#pragma once

// Models of the contact laws, and scenes that ask the same question of several of them.

#include "world/scenes.hpp"

#include <dem/cohesion/constant.hpp>
#include <dem/cohesion/jkr.hpp>
#include <dem/cohesion/liquid_bridge.hpp>
#include <dem/contact/hertz.hpp>
#include <dem/contact/hysteretic.hpp>
#include <dem/contact/linear_spring_dashpot.hpp>
#include <dem/friction/coulomb_viscous.hpp>
#include <dem/friction/cundall_strack.hpp>
#include <dem/friction/mindlin.hpp>
#include <dem/friction/none.hpp>
#include <dem/friction/varying.hpp>
#include <dem/rolling/constant_torque.hpp>
#include <dem/rolling/elastic_plastic.hpp>
#include <dem/rolling/sum.hpp>
#include <dem/rolling/torsion.hpp>

using namespace dem;

template <class N, class F, class R = rolling::None, class C = cohesion::None, class S = Sphere>
struct Laws : dem::Model {
  using Shape = S;
  using Normal = N;
  using Friction = F;
  using Rolling = R;
  using Cohesion = C;
  using Integrator = integrator::VelocityVerlet;
  using Executor = exec::Serial;
};

using Linear = contact::LinearSpringDashpot;
using LinearModel = Laws<Linear, friction::CundallStrack>;
using HertzModel = Laws<contact::Hertz, friction::Mindlin>;
using PlasticModel = Laws<contact::Hysteretic, friction::CoulombViscous>;

/// A grain at a place with a motion.
inline NewParticle grain(const Vec3& position, const Vec3& velocity = {0, 0, 0}, const Vec3& spin = {0, 0, 0}) {
  NewParticle n;
  n.species = SpeciesId(0);
  n.position = position;
  n.velocity = velocity;
  n.angular_velocity = spin;
  return n;
}

/// Grains in a closed box, without gravity, from random motions: as long as nothing but damped laws acts, they never
/// have more kinetic energy than at the beginning, plus what cohesion may give (`bonus`, J). Returns the share that is
/// left at the end.
template <class Model>
double run_box(World<Model>& w, const typename Model::Shape& shape, double radius, double speed, int steps,
               double bonus = 0.0) {
  const double pitch = 2.05 * radius, edge = 3 * pitch;
  const auto species = w.add_species(shape);
  add_open_box(w, Vec3::Constant(edge));
  SurfaceOptions lid;
  lid.position = {0, 0, edge};
  lid.rotation = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
  w.add_surface(w.ground(), surface::Plane{}, lid);
  add_block(w, species, Vec3::Constant(0.5 * pitch), pitch, 3, 3, 3, speed);
  const double start = kinetic_energy(w);
  double largest = start;
  for (int k = 0; k < 100; ++k) {
    const auto report = w.run(static_cast<std::uint64_t>(steps / 100));
    INFO(report.text);
    REQUIRE(report);
    largest = std::max(largest, kinetic_energy(w));
  }
  CHECK(largest <= start * (1 + 1e-9) + bonus);
  return kinetic_energy(w) / start;
}
