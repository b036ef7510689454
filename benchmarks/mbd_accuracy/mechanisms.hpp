#pragma once

// Six mechanisms with answers that do not come from this library: published, in closed form, or from their equations in
// the fewest coordinates, integrated by Runge and Kutta's rule of fourth order in steps so short that they do not
// count.

#include <dem/mbd/mbd.hpp>
#include <dem/mbd/solver/projected.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "../../examples/squeezer/squeezer.hpp"

namespace accuracy {

using namespace dem;
using namespace dem::mbd;

/// y' = f(y), from 0 to `time` (s), in n steps.
template <std::size_t N, class F>
std::array<double, N> runge_kutta(std::array<double, N> y, double time, int n, F&& f) {
  const double h = time / n;
  const auto along = [&](const std::array<double, N>& d, double by) {
    std::array<double, N> x = y;
    for (std::size_t i = 0; i < N; ++i) x[i] += by * d[i];
    return x;
  };
  for (int k = 0; k < n; ++k) {
    const auto a = f(y), b = f(along(a, 0.5 * h)), c = f(along(b, 0.5 * h)), d = f(along(c, h));
    for (std::size_t i = 0; i < N; ++i) y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  return y;
}

inline const Vec3 X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();

/// What a run came to: its error as the table defines it, and how far its joints opened (m).
struct Outcome {
  double error, opening;
};

template <class I, class J = Penalty>
double worst_opening(const Machine<I, J>& m) {
  double worst = 0.0;
  for (std::size_t k = 0; k < m.parts().joints.size(); ++k) {
    worst = std::max(worst, m.violation(JointId(k)).displacement);
  }
  return worst;
}

/// Andrews' squeezer, 0.03 s: the largest relative error of the seven published angles.
struct Squeezer {
  static constexpr const char* name = "squeezer";
  static constexpr std::array steps = {8e-7, 4e-7, 2e-7, 1e-7, 5e-8},
                              projected_steps = {2e-5, 1e-5, 5e-6, 2.5e-6, 1.25e-6};
  template <class I, class J = Penalty>
  static Outcome run(double dt) {
    auto s = squeezer::make<I, J>();
    s.machine.most_substeps = 1;  // the table is over the time step, whatever joints do; so it is below
    (void)s.machine.run(0.03, dt);
    return {s.error(), worst_opening(s.machine)};
  }
};

/// Two four-bars side by side, 10 s, through their singular position ten times: the error of the crank's angle (rad).
/// All links keep their directions or turn alike, so with three cranks of 1/3 kg m^2 and two couplers of 1 kg on a
/// circle of 1 m: 3 q'' = 3.5 g sin(q), q from the vertical.
struct FourBar {
  static constexpr const char* name = "four-bar";
  static constexpr std::array steps = {1.6e-4, 8e-5, 4e-5, 2e-5, 1e-5},
                              projected_steps = {1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4};
  template <class I, class J = Penalty>
  static Outcome run(double dt) {
    static const double answer = runge_kutta<2>({0.0, 1.0}, 10.0, 200000, [](const auto& y) {
      return std::array{y[1], 3.5 * 9.81 / 3.0 * std::sin(y[0])};
    })[0];
    Machine<I, J> m;
    m.most_substeps = 1;
    m.gravity = {0, -9.81, 0};
    const auto rod = [&](const std::string& title, const Vec3& at, const Vec3& along, const Vec3& v, const Vec3& w) {
      return m.add_body(
          given_body(title, 1.0, Vec3(1.0 / 12.0 * (Vec3::Ones() - along) + 1e-3 * along)).at(at).moving(v, w));
    };
    std::array<BodyId, 3> cranks;
    JointId base;
    for (int k = 0; k <= 2; ++k) {
      const auto i = static_cast<std::size_t>(k);
      cranks[i] = rod("crank " + std::to_string(k), {1.0 * k, 0.5, 0}, Y, {0.5, 0, 0}, -1.0 * Z);
      base = m.add_joint(revolute("base " + std::to_string(k), m.ground(), cranks[i], {1.0 * k, 0, 0}, Z));
    }
    for (int k = 0; k < 2; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const BodyId coupler = rod("coupler " + std::to_string(k), {k + 0.5, 1, 0}, X, {1, 0, 0}, Vec3::Zero());
      m.add_joint(revolute("left " + std::to_string(k), cranks[i], coupler, {1.0 * k, 1, 0}, Z));
      m.add_joint(revolute("right " + std::to_string(k), cranks[i + 1], coupler, {k + 1.0, 1, 0}, Z));
    }
    (void)m.run(10.0, dt);
    return {std::abs(-m.coordinate(base) - answer), worst_opening(m)};
  }
};

/// Bricard's mechanism, 10 s: the largest error of its energy as a share of the largest kinetic energy. (No form of its
/// own in few coordinates is at hand; energy is what its benchmark asks for.)
struct Bricard {
  static constexpr const char* name = "Bricard";
  static constexpr std::array steps = {1.6e-4, 8e-5, 4e-5, 2e-5, 1e-5},
                              projected_steps = {1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4};
  template <class I, class J = Penalty>
  static Outcome run(double dt) {
    Machine<I, J> m;
    m.most_substeps = 1;
    m.gravity = {0, -9.81, 0};
    const std::array<Vec3, 6> hinge = {Vec3(0, 0, 0),  Vec3(1, 0, 0),  Vec3(1, -1, 0),
                                       Vec3(1, -1, 1), Vec3(0, -1, 1), Vec3(0, 0, 1)};
    const std::array<Vec3, 6> axis = {Y, Z, X, Y, Z, X};
    BodyId last = m.ground();
    for (std::size_t k = 0; k < 5; ++k) {
      const Vec3 size = (hinge[k + 1] - hinge[k]).cwiseAbs().cwiseMax(Vec3::Constant(0.1));
      const BodyId rod =
          m.add_body(box_body("rod " + std::to_string(k), size, 100.0).at(0.5 * (hinge[k] + hinge[k + 1])));
      m.add_joint(revolute("hinge " + std::to_string(k), last, rod, hinge[k], axis[k]));
      last = rod;
    }
    m.add_joint(revolute("hinge 5", last, m.ground(), hinge[5], axis[5]));
    const double start = energy_of(m.parts(), m.gravity).sum();
    double worst = 0.0, kinetic = 0.0, opening = 0.0;
    (void)m.run(10.0, dt, [&] {
      const Energy e = energy_of(m.parts(), m.gravity);
      worst = std::max(worst, std::abs(e.sum() - start));
      kinetic = std::max(kinetic, e.kinetic);
      opening = std::max(opening, m.violation(JointId(5)).displacement);
    });
    return {worst / kinetic, opening};
  }
};

/// A spatial slider-crank without gravity or friction, 1 s (one turn): the error of the crank's angle (rad). The rod
/// keeps one arm of its universal joint square to the slider's, so its rotation follows from the crank's angle q, and
/// q' from the energy, I(q) q'^2 = const.
struct SliderCrank {
  static constexpr const char* name = "slider-crank";
  static constexpr std::array steps = {4e-5, 2e-5, 1e-5, 5e-6, 2.5e-6},
                              projected_steps = {2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4};
  static constexpr double radius = 0.08, length = 0.3, speed = 6.0;

  static Vec3 pin(double q) { return Vec3(0, 0.1, 0.12) + radius * Vec3(0, -std::sin(q), std::cos(q)); }
  static Vec3 slider(double q) {
    const Vec3 p = pin(q);
    return (p.x() + std::sqrt(length * length - p.y() * p.y() - p.z() * p.z())) * X;
  }
  /// The slider's arm of the cross: at the start square to the rod's.
  static Vec3 arm() {
    const Vec3 d = (slider(0.0) - pin(0.0)).normalized(), given = d.x() > 0.9 ? Y : X;
    const Vec3 on_rod = (given - given.dot(d) * d).normalized();
    return X.cross(on_rod).normalized();
  }
  static Mat3 rod_axes(double q) {
    const Vec3 d = (slider(q) - pin(q)).normalized(), across = arm().cross(d).normalized();
    Mat3 axes;
    axes << d, across, d.cross(across);
    return axes;
  }
  static double inertia(double q) {
    constexpr double h = 1e-5;
    const Vec3 slide = (slider(q + h) - slider(q - h)) / (2 * h), end = (pin(q + h) - pin(q - h)) / (2 * h);
    const Vec3 middle = 0.5 * (slide + end);
    const Mat3 turn = rod_axes(q).transpose() * (rod_axes(q + h) - rod_axes(q - h)) / (2 * h);  // the spin's matrix
    const Vec3 w(turn(2, 1), turn(0, 2), turn(1, 0));
    return 1e-4 + 0.12 * 0.25 * radius * radius + 0.5 * middle.squaredNorm() + 4e-4 * w.x() * w.x() +
           4e-3 * (w.y() * w.y() + w.z() * w.z()) + 2.0 * slide.squaredNorm();
  }
  template <class I, class J = Penalty>
  static Outcome run(double dt) {
    static const double answer = runge_kutta<1>({0.0}, 1.0, 4000, [](const auto& y) {
      static const double start = inertia(0.0);
      return std::array{speed * std::sqrt(start / inertia(y[0]))};
    })[0];
    Machine<I, J> m;
    m.most_substeps = 1;
    m.gravity.setZero();
    m.given_velocities = GivenVelocities::lead;
    const Vec3 centre(0, 0.1, 0.12), p = pin(0.0), s = slider(0.0), d = (s - p).normalized();
    const BodyId crank = m.add_body(given_body("crank", 0.12, Vec3(1e-4, 1e-4, 1e-4))
                                        .at(0.5 * (centre + p))
                                        .moving(Vec3(speed * X).cross(Vec3(0.5 * (p - centre))), speed * X));
    const BodyId rod = m.add_body(given_body("rod", 0.5, Vec3(4e-4, 4e-3, 4e-3)).at(0.5 * (p + s), rod_axes(0.0)));
    const BodyId slide = m.add_body(given_body("slider", 2.0, Vec3(1e-3, 1e-3, 1e-3)).at(s));
    const JointId bearing = m.add_joint(revolute("crank bearing", m.ground(), crank, centre, X));
    m.add_joint(spherical("big end", crank, rod, p));
    m.add_joint(universal("small end", rod, slide, s, d, X));
    m.add_joint(prismatic("guide", m.ground(), slide, s, X));
    (void)m.run(1.0, dt);
    return {std::abs(m.coordinate(bearing) - answer), worst_opening(m)};
  }
};

/// A flyball governor in the manner of the IFToMM benchmark A05, with numbers of its own, 2 s: two arms with balls on a
/// shaft that turns freely, and a stiff, strongly damped spring from each to a collar on the shaft. Error of the arms'
/// angle (rad). In three coordinates: the shaft's turn, the arms' angle q from the downward vertical, the collar's
/// depth s.
struct Governor {
  static constexpr const char* name = "governor";
  static constexpr std::array steps = {8e-5, 4e-5, 2e-5, 1e-5, 5e-6},
                              projected_steps = {1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5};
  static constexpr double g = 9.81, ball = 5.0, reach = 0.9, across = 0.5, axial = 0.02;  // an arm with its ball
  static constexpr double shaft = 0.3, collar = 4.0, collar_turn = 0.02;                  // kg m^2, kg, kg m^2
  static constexpr double at = 0.5, k = 8e4, c = 2e3, free = 0.5, start = std::numbers::pi / 6,
                          spin = 2 * std::numbers::pi;

  static double depth_at_start() { return 2 * at * std::cos(start); }  // the springs' length is then `free`
  static double turning(double q) {
    const double s2 = std::sin(q) * std::sin(q);
    return shaft + collar_turn + 2 * ((ball * reach * reach + across) * s2 + axial * (1 - s2));
  }
  template <class I, class J = Penalty>
  static Outcome run(double dt) {
    static const double answer = [] {
      const double momentum = turning(start) * spin;
      return runge_kutta<4>({start, 0.0, depth_at_start(), 0.0}, 2.0, 400000, [momentum](const auto& y) {
        const double q = y[0], s = y[2], x = at * std::sin(q), z = at * std::cos(q) - s;  // spring: from collar to arm
        const double l = std::sqrt(x * x + z * z), w = momentum / turning(q);
        const double dx = at * std::cos(q) * y[1], dz = -at * std::sin(q) * y[1] - y[3];
        const double push = k * (free - l) - c * (x * dx + z * dz) / l;  // pushes arm and collar apart
        const double dl_dq = (x * at * std::cos(q) - z * at * std::sin(q)) / l, dl_ds = -z / l;
        const double heavy = ball * reach * reach + across;
        const double torque = (heavy - axial) * std::sin(q) * std::cos(q) * w * w - ball * g * reach * std::sin(q);
        return std::array{y[1], (torque + push * dl_dq) / heavy, y[3], g + 2 * push * dl_ds / collar};
      })[0];
    }();
    Machine<I, J> m;
    m.most_substeps = 1;
    const Vec3 w = spin * Z;
    const BodyId axle = m.add_body(given_body("shaft", 10.0, Vec3(1, 1, shaft)).moving(Vec3::Zero(), w));
    m.add_joint(revolute("shaft bearing", m.ground(), axle, {0, 0, 0}, Z));
    const Vec3 low(0, 0, -depth_at_start());
    const BodyId ring =
        m.add_body(given_body("collar", collar, Vec3(0.02, 0.02, collar_turn)).at(low).moving(Vec3::Zero(), w));
    m.add_joint(prismatic("collar guide", axle, ring, low, Z));
    JointId hinge;
    for (const double side : {1.0, -1.0}) {
      const Vec3 along(side * std::sin(start), 0, -std::cos(start));
      const Mat3 pose = Eigen::AngleAxisd(-side * start, Y).toRotationMatrix();
      const std::string which = side > 0 ? "right" : "left";
      const BodyId arm = m.add_body(given_body(which + " arm", ball, Vec3(across, across, axial))
                                        .at(reach * along, pose)
                                        .moving(w.cross(reach * along), w));
      hinge = m.add_joint(revolute(which + " hinge", axle, arm, {0, 0, 0}, -side * Y).starting_at(start));
      m.add_spring(mbd::spring(which + " spring", ring, low, arm, at * along, k, c, free));
    }
    (void)m.run(2.0, dt);
    return {std::abs(m.coordinate(hinge) - answer), worst_opening(m)};
  }
};

/// A heavy top in steady precession, one round: how far its axis is from where it began (m at 1 m).
struct HeavyTop {
  static constexpr const char* name = "heavy top";
  static constexpr std::array steps = {1.6e-4, 8e-5, 4e-5, 2e-5, 1e-5}, projected_steps = steps;
  template <class I, class J = Penalty>
  static Outcome run(double given_dt) {
    const double mass = 0.5, h = 0.1, A = 4e-4, C = 6e-4, W = 2.0, tilt = 0.5, g = 9.81;
    const double spin = (mass * g * h + (A + mass * h * h) * W * W * std::cos(tilt)) / (C * W);
    const Mat3 pose = Eigen::AngleAxisd(tilt, Y).toRotationMatrix();
    const Vec3 axis = pose * Z, w = W * Z + (spin - W * std::cos(tilt)) * axis;
    Machine<I, J> m;
    m.most_substeps = 1;
    const BodyId top =
        m.add_body(given_body("top", mass, Vec3(A, A, C)).at(h * axis, pose).moving(w.cross(h * axis), w));
    m.add_joint(spherical("tip", m.ground(), top, {0, 0, 0}));
    const double round = 2 * std::numbers::pi / W, dt = round / std::round(round / given_dt);
    (void)m.run(round, dt);
    return {(m.body(top).rotation() * Z - axis).norm(), worst_opening(m)};
  }
};

}  // namespace accuracy
