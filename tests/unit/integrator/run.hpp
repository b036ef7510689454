#pragma once

#include <dem/integrator/motion.hpp>
#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>

#include <cmath>
#include <vector>

using Motion = dem::integrator::Motion<double>;
using Acceleration = dem::integrator::Acceleration<double>;

/// Calls an integrator as a world does: n steps of dt, `acceleration(motion)` evaluated once a stage.
template <class Integrator, class F>
Motion run(Motion m, double dt, long n, F&& acceleration) {
  typename Integrator::template Memory<double> memory{};
  Integrator::template initialise<double>(memory, acceleration(m));
  for (long step = 0; step < n; ++step) {
    for (int stage = 0; stage < Integrator::stages; ++stage) {
      if constexpr (Integrator::predicts_before_forces) {
        Integrator::template before_forces<double>(stage, dt, m, memory);
      }
      Integrator::template after_forces<double>(stage, dt, m, memory, acceleration(m));
    }
    if (step % 64 == 0) m.rotation = dem::orthonormalised(m.rotation);
  }
  return m;
}

inline Motion at_rest() { return {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, dem::Matrix3<double>::identity()}; }

/// The order of accuracy from errors at step sizes that halve each time: the slope between the two finest.
inline double order(const std::vector<double>& errors) {
  return std::log2(errors[errors.size() - 2] / errors[errors.size() - 1]);
}

/// Torque-free rotation of a body with these principal moments.
struct Tumbling {
  dem::Vec3 moments;
  Acceleration operator()(const Motion& m) const {
    return {{0, 0, 0},
            dem::integrator::angular_acceleration<double>({0, 0, 0}, m.angular_velocity, dem::from_eigen(moments),
                                                          dem::from_eigen(dem::Vec3(moments.cwiseInverse())))};
  }
  double energy(const Motion& m) const {
    const dem::Vec3 w = to_eigen(m.angular_velocity);
    return 0.5 * w.dot(moments.cwiseProduct(w));
  }
  /// Angular momentum in global axes.
  dem::Vec3 momentum(const Motion& m) const {
    return to_eigen(m.rotation) * moments.cwiseProduct(to_eigen(m.angular_velocity));
  }
};
