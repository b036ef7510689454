#pragma once

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/mbd/mbd.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include "catch.hpp"
#include "core/error_of.hpp"

namespace dem::mbd::test {

using Catch::Matchers::Contains;
using integrator::PredictorCorrector;
using integrator::SymplecticEuler;
using integrator::VelocityVerlet;

inline constexpr double pi = std::numbers::pi;
inline const Vec3 X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();

inline BodySpec brick(const std::string& name, const Vec3& at, double mass = 1.0) {
  return given_body(name, mass, Vec3(mass * Vec3(0.02, 0.03, 0.04))).at(at);
}

inline BodySpec ball(const std::string& name, double mass = 1.0, double inertia = 0.1) {
  return given_body(name, mass, Vec3(inertia, inertia, inertia));
}

/// A mechanism with the solver of a world, which calls it stage by stage, and `put_forces` in place of the grains.
template <class I, class Joints = Penalty>
struct InWorld {
  Mechanism m;
  Solver<I, Joints> solver;

  void start(double dt, const Vec3& gravity = Vec3::Zero()) {
    solver.design_for(m, dt);
    solver.initialise(m, 0.0, dt, gravity, [] {});
  }
  template <class PutForces>
  void stage(int stage, double dt, const Vec3& gravity, PutForces&& put_forces) {
    solver.stage(m, stage, dt, gravity, put_forces);
  }
  template <class PutForces>
  void step(double dt, const Vec3& gravity, PutForces&& put_forces) {
    for (int k = 0; k < I::stages; ++k) stage(k, dt, gravity, put_forces);
  }
};

}  // namespace dem::mbd::test
