#pragma once

// Models of the contact laws, and scenes that ask the same question of several of them.

#include "world/scenes.hpp"

#include <dem/law/cohesion/constant.hpp>
#include <dem/law/cohesion/jkr.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/friction/coulomb_viscous.hpp>
#include <dem/law/friction/none.hpp>
#include <dem/law/friction/varying.hpp>
#include <dem/law/normal/hysteretic.hpp>
#include <dem/law/rolling/constant_torque.hpp>
#include <dem/law/rolling/elastic_plastic.hpp>
#include <dem/law/rolling/sum.hpp>
#include <dem/law/rolling/torsion.hpp>

using namespace dem;

using models::HertzModel;
using models::Laws;
using models::Linear;
using models::LinearModel;
using PlasticModel = Laws<contact::Hysteretic, friction::CoulombViscous>;

/// A grain at a place with a motion.
inline NewGrain grain_at(const Vec3& position, const Vec3& velocity = {0, 0, 0}, const Vec3& spin = {0, 0, 0}) {
  NewGrain n;
  n.species = SpeciesId(0);
  n.position = position;
  n.velocity = velocity;
  n.angular_velocity = spin;
  return n;
}

/// What holds grains together, for run_box.
struct Attracted {
  double well = 0.0;                                                     ///< J, lower at rest than at first contact
  double (*stretched)(double gap, double radius) = [](double, double) {  ///< J, higher across a gap, of that
    return 0.0;                                                          ///< effective radius
  };
};

/// Grains in a closed box, without gravity, from random motions: as long as nothing but damped laws acts, they never
/// gain energy but what an attraction may give. Returns the share of the kinetic energy that is left at the end.
template <class Model>
double run_box(World<Model>& w, const Sphere& shape, double radius, double speed, int steps,
               const Attracted& attracted = {}) {
  const double pitch = 2.05 * radius, edge = 3 * pitch;
  const auto species = w.add_species(shape);
  add_open_box(w, Vec3::Constant(edge));
  SurfaceOptions lid;
  lid.position = {0, 0, edge};
  lid.rotation = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
  w.add_surface(w.ground(), surface::Plane{}, lid);
  add_block(w, species, Vec3::Constant(0.5 * pitch), pitch, 3, 3, 3, speed);
  const double start = kinetic_energy(w);
  EnergyWatch watch;
  watch.look(start, 0.0);
  for (int k = 0; k < 100; ++k) {
    const auto report = w.run(static_cast<std::uint64_t>(steps / 100));
    INFO(report.text);
    REQUIRE(report);
    double held = 0.0, fallen = 0.0;
    const auto look = [&](double overlap, double effective_radius) {
      held += spring_energy(w, {{0, 0, 1}, overlap, {0, 0, 0}, effective_radius, 1.0});
      if (overlap > 0.0) held += attracted.well;  // friction that the attraction presses
      if (overlap < 0.0) held += attracted.stretched(-overlap, effective_radius);
      if (overlap > 0.0) fallen += attracted.well;
    };
    for_each_grain(w, [&](GrainId a) {
      const Vec3 x = w.position(a);
      for_each_grain(w, [&](GrainId b) {
        if (a < b) look(2 * radius - (w.position(b) - x).norm(), 0.5 * radius);
      });
      for (int axis = 0; axis < 3; ++axis) {
        look(radius - x[axis], radius);
        look(radius - (edge - x[axis]), radius);
      }
    });
    watch.look(kinetic_energy(w), held, fallen);
  }
  CHECK(watch.gains() == 0);
  return kinetic_energy(w) / start;
}
