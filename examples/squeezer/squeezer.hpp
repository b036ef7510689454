#pragma once

// Andrews' squeezing mechanism (Schiehlen, Multibody Systems Handbook, 1990; Hairer & Wanner, Solving ODEs II, chapter
// VII.7; doi 10.1007/978-3-642-05221-7): seven bodies in a plane, ten hinges, a spring, and a motor with a constant
// torque.

#include <dem/mbd/mbd.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace squeezer {

using dem::BodyId;
using dem::JointId;
using dem::Vec3;

/// Angles beta, Theta, gamma, Phi, delta, Omega, epsilon in rad at the start ...
inline constexpr std::array<double, 7> start = {-0.0617138900142764496358948458001, 0.0,
                                                0.455279819163070380255912382449,   0.222668390165885884674473185609,
                                                0.487364979543842550225598953530,   -0.222668390165885884674473185609,
                                                1.23054744454982119249735015568};
/// ... and at t = 0.03 s.
inline constexpr std::array<double, 7> reference = {15.8107712,   -15.7563711,  0.0408222401, -0.5347301163,
                                                    0.5244099659, 0.5347301163, 1.0480807410};
inline constexpr std::array<const char*, 7> names = {"beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"};

/// The mechanism; `angles` are the joints whose coordinates are the seven angles.
template <class I, class Joints = dem::mbd::Penalty>
struct Squeezer {
  dem::mbd::Machine<I, Joints> machine;
  std::array<JointId, 7> angles;

  double error(std::size_t k) const { return std::abs(machine.coordinate(angles[k]) / reference[k] - 1.0); }
  /// The largest relative error of the seven angles, at t = 0.03 s.
  double error() const {
    double worst = 0.0;
    for (std::size_t k = 0; k < 7; ++k) worst = std::max(worst, error(k));
    return worst;
  }
};

template <class I, class Joints = dem::mbd::Penalty>
Squeezer<I, Joints> make() {
  using namespace dem::mbd;
  const double d = 0.028, da = 0.0115, e = 0.02, ea = 0.01421, rr = 0.007, ra = 0.00092, sa = 0.01874, sb = 0.01043,
               sc = 0.018, sd = 0.02, ta = 0.02308, tb = 0.00916, u = 0.04, ua = 0.01228, ub = 0.00449, zf = 0.02,
               zt = 0.04, fa = 0.01421;
  const Vec3 O(0, 0, 0), A(-0.06934, -0.00227, 0), B(-0.03635, 0.03273, 0), C(0.014, 0.072, 0), z = Vec3::UnitZ();
  const auto [beta, theta, gamma, phi, delta, omega, epsilon] = start;
  // Unit vectors along an angle, and across it: (sin, -cos).
  const auto along = [](double q) { return Vec3(std::cos(q), std::sin(q), 0); };
  const auto across = [](double q) { return Vec3(std::sin(q), -std::cos(q), 0); };

  const Vec3 crank_end = rr * along(beta);
  const Vec3 P = crank_end - d * along(beta + theta);  // where four bodies meet
  const Vec3 K5_end = A + zt * along(delta), K7_end = A + u * across(epsilon);

  Squeezer<I, Joints> s;
  Machine<I, Joints>& m = s.machine;
  m.gravity = Vec3::Zero();
  const auto body = [&](const char* name, double mass, double inertia, const Vec3& at) {
    return m.add_body(given_body(name, mass, Vec3(inertia, inertia, inertia)).at(at));
  };
  const BodyId ground = m.ground();
  const BodyId K1 = body("K1 crank", 0.04325, 2.194e-6, ra * along(beta));
  const BodyId K2 = body("K2 rod", 0.00365, 4.410e-7, crank_end - da * along(beta + theta));
  const BodyId K3 = body("K3", 0.02373, 5.255e-6, B + sa * across(gamma) + sb * along(gamma));
  const BodyId K4 = body("K4", 0.00706, 5.667e-7, K5_end + (e - ea) * across(phi + delta));
  const BodyId K5 = body("K5", 0.07050, 1.169e-5, A + ta * along(delta) + tb * across(delta));
  const BodyId K6 = body("K6", 0.00706, 5.667e-7, K7_end + (zf - fa) * along(omega + epsilon));
  const BodyId K7 = body("K7", 0.05498, 1.912e-5, A + ua * across(epsilon) + ub * along(epsilon));

  const auto hinge = [&](const char* name, BodyId a, BodyId b, const Vec3& at, double angle) {
    return m.add_joint(revolute(name, a, b, at, z).starting_at(angle));
  };
  s.angles[0] = hinge("O", ground, K1, O, beta);
  s.angles[1] = hinge("crank end", K1, K2, crank_end, theta);
  s.angles[2] = hinge("B", ground, K3, B, gamma);
  s.angles[3] = hinge("K5 end", K5, K4, K5_end, phi);
  s.angles[4] = hinge("A of K5", ground, K5, A, delta);
  s.angles[5] = hinge("K7 end", K7, K6, K7_end, omega);
  s.angles[6] = hinge("A of K7", ground, K7, A, epsilon);
  hinge("P of K3", K2, K3, P, 0);
  hinge("P of K4", K2, K4, P, 0);
  hinge("P of K6", K2, K6, P, 0);

  const Vec3 D = B + sc * across(gamma) + sd * along(gamma);
  m.add_spring(spring("spring", ground, C, K3, D, 4530.0, 0.0, 0.07785));
  m.add_load(applied_torque("motor", K1, z, 0.033));
  return s;
}

}  // namespace squeezer
