#pragma once

#include <dem/integrator/velocity_verlet.hpp>
#include <dem/mbd/mbd.hpp>
#include <dem/vehicle/ring_tyre.hpp>

#include <algorithm>
#include <string>

namespace dem::vehicle {

/// What a plate takes from a tyre that is pressed on it: means over a stretch of deflection.
struct PressedLoad {
  double force = 0.0;   ///< N
  double length = 0.0;  ///< m, of the belt that touches
};

/// A ring tyre in a press: its rim, which does not turn, goes down on a plate without friction. The plate gives way by
/// 1e6 N/m under each segment that touches, which is a part of the deflection: 3 of 35 mm under 10 kN.
///
///     dem::vehicle::TyrePress press({.pressure = 2.5e5});
///     press.at(0.035).force;                           // N, at a deflection of 35 mm
class TyrePress {
 public:
  static constexpr double speed = 0.05;      ///< m/s, of the rim
  static constexpr double time_step = 5e-5;  ///< s

  /// The tyre just touches the plate. Throws Error for a tyre that cannot be.
  explicit TyrePress(const RingTyreSpec& s) {
    machine_.gravity = Vec3::Zero();
    rim_ = machine_.add_body(mbd::cylinder_body("rim", 0.2, 0.25, 1000).at(Vec3(0, 0, s.radius)));
    tyre_ = add_ring_tyre(Assembly(machine_, "press", Vec3(0, 0, s.radius)), "tyre", rim_, Vec3::Zero(), s);
    const Vec3 axes[3] = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    for (int k = 0; k < 3; ++k) {
      const std::string name = std::to_string(k);
      const auto way = k == 2 ? mbd::Signal::ramp(0.0, -speed) : mbd::Signal(0.0);
      machine_.add_motion(mbd::prescribed_position("move " + name, rim_, axes[k], way));
      machine_.add_motion(mbd::prescribed_rotation("turn " + name, rim_, axes[k], 0.0));
    }
    for (const BodyId b : tyre_.segments) {
      const auto law = [this, half = 0.5 * s.thickness, arc = s.arc()](double, const Body& body) {
        const double depth = half - body.motion.position.z;
        if (!(depth > 0.0)) return Wrench{};
        const double f = std::max(0.0, 1e6 * depth - 1e3 * body.motion.velocity.z);
        now_.force += f, now_.length += arc;
        return Wrench{{0, 0, f}, {0, 0, 0}};
      };
      machine_.add_load(mbd::custom_load("plate " + machine_.body(b).name, b, law));
    }
    machine_.initialise(0.0, machine_.gravity);
  }
  TyrePress(const TyrePress&) = delete;
  TyrePress& operator=(const TyrePress&) = delete;

  /// Presses on to a deflection (m) and 2.5 mm beyond: means over 5 mm about it, at which one segment more or less
  /// makes no jump. Throws Error if the tyre is pressed further already, or blows up.
  PressedLoad at(double deflection) {
    const double begin = (deflection - 2.5e-3) / speed, end = (deflection + 2.5e-3) / speed;
    if (!(machine_.time() < end)) {
      fail("a tyre in a press is {:g} m deep already, but is asked for {:g} m; ask for rising deflections",
           machine_.time() * speed, deflection);
    }
    PressedLoad sum;
    double n = 0.0;
    while (machine_.time() < end) {
      step();
      if (machine_.time() > begin) sum.force += now_.force, sum.length += now_.length, n += 1.0;
    }
    return {sum.force / n, sum.length / n};
  }
  /// One time step.
  void step() {
    now_ = {};
    if (const auto report = machine_.step(time_step); !report) fail("a tyre in a press: {}", report.text);
  }

  [[nodiscard]] const mbd::Mechanism& machine() const { return machine_; }
  [[nodiscard]] const RingTyre& tyre() const { return tyre_; }

 private:
  mbd::Machine<integrator::VelocityVerlet> machine_;
  RingTyre tyre_;
  BodyId rim_;
  PressedLoad now_;  ///< in the newest evaluation
};

}  // namespace dem::vehicle
