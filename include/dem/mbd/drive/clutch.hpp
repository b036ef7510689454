#pragma once

// Brakes, clutches and the plates of limited-slip differentials: dry friction with true stiction on a coordinate.
//
// How it sticks. A spring of derived stiffness runs from an anchor to the coordinate, with a damper beside it. Their
// sum is limited to the capacity. Where the spring alone would exceed it, the anchor is dragged along, so that the
// spring keeps just the capacity. Below the capacity the anchor stays where it is, so a load that the friction can hold
// is held in place for good: the stretch is the load over the stiffness, and it does not creep. The stretch is the
// difference of the coordinate and the anchor, never a sum of speeds over time, so nothing drifts with the steps
// either.
//
// Why a spring and not a constraint. A constraint that is solved for with the prescribed motions would hold without any
// stretch. But it has to decide between sticking and slipping of all brakes, clutches and drives at once, within each
// stage, while the joints that carry the torque are springs. A spring is evaluated like any other part: its result does
// not depend on order, it keeps momentum, the stable time step knows it, and its energy is known. Its stretch is small:
// with a wheel of 1 kg m^2 at dt = 1e-4 s, 1000 N m turn the wheel by less than 0.1 mrad. What it costs is one more
// share of its bodies' masses, so derived joints on a wheel with a brake are softer than without one: 2/3 of their
// stiffness where there were two parts on the wheel. An open one is not evaluated at all.

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/signal.hpp>
#include <dem/mbd/ids.hpp>
#include <dem/mbd/joint/coupling.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// What a brake, a clutch or the plates of a limited-slip differential are made from. What slips is sum(ratio_i q_i) of
/// joint coordinates; coordinate i feels ratio_i times the torque, on the joint's body b, and its opposite on body a.
/// The torque is limited by the capacity alone: what the joints carry has no share in it.
struct ClutchSpec {
  std::string name;
  std::vector<CouplingSpec::Term> terms = {};
  BodyId a = {}, b = {};                         ///< instead of terms: two bodies that slip about an axis
  Vec3 at = Vec3::Zero(), axis = Vec3::UnitZ();  ///< m, and a direction; global at assembly
  Signal capacity = 0.0;                         ///< N m (N where the coordinate slides); below 0 it counts as 0
  CouplingId differential = {};                  ///< see limited_slip
  double bias_ratio = 1.0;                       ///< likewise
  std::optional<double> stiffness = {};          ///< N m/rad (N/m), of what sticks; derived if not given
  std::optional<double> damping = {};            ///< N m s/rad (N s/m); derived if not given
  bool on = true;

  /// Stiffness and damping of what sticks; both have to be greater than zero and not below zero, respectively.
  ClutchSpec with_stiffness(double k, double c) const;
};

/// A brake on the coordinate of a joint: the joint's body b is held to its body a. The capacity (N m of a joint that
/// turns, N of one that slides) is a number or a function of time, or is set while running (set_capacity).
///
///     const BrakeId handbrake = car.add_brake(brake("handbrake", rear_hub, 0.0));
///     car.set_capacity(handbrake, 1500.0);
DEM_SETUP inline ClutchSpec brake(std::string name, JointId joint, Signal capacity) {
  return {.name = std::move(name), .terms = {{joint, 1.0}}, .capacity = std::move(capacity)};
}
/// A clutch between two shafts that turn in bearings of their own (N m): what slips is the turn of `out` less that of
/// `in`. Both joints have to count the turn the same way, as two on one axis do.
DEM_SETUP inline ClutchSpec clutch(std::string name, JointId in, JointId out, Signal capacity) {
  return {.name = std::move(name), .terms = {{out, 1.0}, {in, -1.0}}, .capacity = std::move(capacity)};
}
/// A clutch or a brake between two bodies that have no joint with each other, about an axis at a point (global at
/// assembly). A free joint that measures the turn is added with it.
ClutchSpec clutch(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis, Signal capacity);
/// The plates of a limited-slip differential, between the two outputs of a differential(...). Their capacity is the
/// preload (N m; what it takes to turn one wheel against the other without input), and a share of the input's torque:
/// with no preload, the slower output gets up to `bias_ratio` times the torque of the faster one. 1: an open one.
ClutchSpec limited_slip(std::string name, CouplingId differential, Signal preload, double bias_ratio);

/// A brake or clutch, ready to run, and what it did in the newest force evaluation.
struct Clutch {
  ClutchSpec spec;
  double k = 0.0, c = 0.0;
  double bias = 0.0;      ///< of a limited-slip differential: N m of capacity per N m of the coupling's multiplier
  double capacity = 0.0;  ///< N m or N
  double torque = 0.0;    ///< N m or N; positive makes the sum of coordinates grow
  double speed = 0.0;     ///< rad/s or m/s, of the sum; 0 while it is open
  struct History {
    bool is_closed = false;  ///< has an anchor
    double anchor = 0.0;     ///< rad or m: the sum at which the spring is free
    double stretch = 0.0;    ///< rad or m: the sum less the anchor
    double slip_work = 0.0;  ///< J, turned into heat by slipping since it was added
    template <class V>
    void fields(V& v) {
      v("is_closed", is_closed), v("anchor", anchor), v("stretch", stretch), v("slip_work", slip_work, "J");
    }
  } history;
  template <class V>
  void fields(V& v) {
    v.given("name", spec.name), v.list("terms", spec.terms, "term"), v.given("differential", spec.differential);
    v.given("bias_ratio", spec.bias_ratio), v.given("stiffness", spec.stiffness), v.given("damping", spec.damping);
    v("set_capacity", spec.capacity), v("on", spec.on), v("k", k), v("c", c), v("bias", bias), v("capacity", capacity);
    v("torque", torque), v("speed", speed), v("history", history);
  }

  bool is_slipping() const { return history.is_closed && std::abs(k * history.stretch) >= 0.999999 * capacity; }
  double elastic_energy() const {
    return history.is_closed ? 0.5 * k * history.stretch * history.stretch : 0.0;
  }  ///< J
};

/// The sum of coordinates that a clutch acts on, and its rate.
Signal::Sample slip_of(const Clutch& u, const std::vector<Joint>& joints, const std::vector<Body>& bodies);

/// `multiplier` (N m) is that of the differential's coupling, if there is one. The anchor is dragged, and slip work
/// counted, only where `commit` says so.
void apply_clutch(Clutch& u, const std::vector<Joint>& joints, std::vector<Body>& bodies, double time, double dt,
                  double multiplier, bool commit);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE ClutchSpec ClutchSpec::with_stiffness(double k, double c) const {
  ClutchSpec s = *this;
  s.stiffness = k;
  s.damping = c;
  return s;
}

DEM_INLINE ClutchSpec clutch(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis, Signal capacity) {
  return {.name = std::move(name), .a = a, .b = b, .at = at, .axis = axis, .capacity = std::move(capacity)};
}

DEM_INLINE ClutchSpec limited_slip(std::string name, CouplingId differential, Signal preload, double bias_ratio) {
  return {
      .name = std::move(name), .capacity = std::move(preload), .differential = differential, .bias_ratio = bias_ratio};
}

DEM_INLINE Signal::Sample slip_of(const Clutch& u, const std::vector<Joint>& joints, const std::vector<Body>& bodies) {
  Signal::Sample s;
  for (const auto& term : u.spec.terms) {
    const Joint& j = joints[term.joint.index()];
    const Coordinate q = coordinate_of(j, bodies[j.a], bodies[j.b], term.dof);
    s.value += term.ratio * q.value;
    s.rate += term.ratio * q.speed;
  }
  return s;
}

DEM_INLINE void apply_clutch(Clutch& u, const std::vector<Joint>& joints, std::vector<Body>& bodies, double time,
                             double dt, double multiplier, bool commit) {
  Clutch::History& h = u.history;
  u.torque = u.speed = u.capacity = 0.0;
  if (u.spec.on) {
    u.capacity = u.spec.capacity(time, dt).value;
    // Compared such that a NaN stays one and reaches the report.
    u.capacity = (u.capacity < 0.0 ? 0.0 : u.capacity) + u.bias * std::abs(multiplier);
  }
  if (u.capacity <= 0.0) {
    h.slip_work += u.elastic_energy();  // what the spring held when it was let go
    h.is_closed = false;
    h.stretch = 0.0;
    return;
  }
  const Signal::Sample s = slip_of(u, joints, bodies);
  if (!h.is_closed) h.anchor = s.value;
  h.is_closed = true;
  double stretch = s.value - h.anchor;
  const double most = u.capacity / u.k;
  const double dragged = std::abs(stretch) - most;
  if (dragged > 0.0) {
    stretch = std::copysign(most, stretch);
    if (commit) {
      const double held = std::abs(h.stretch), let_go = std::max(held - most, 0.0);  // where the capacity fell
      h.slip_work += 0.5 * u.k * let_go * (held + most) + u.capacity * (dragged - let_go);
      h.anchor = s.value - stretch;
    }
  }
  if (commit) h.stretch = stretch;
  u.speed = s.rate;
  u.torque = -(u.k * stretch + u.c * s.rate);
  if (!(std::abs(u.torque) <= u.capacity)) u.torque = std::copysign(u.capacity, u.torque);  // NaN if that is
  for (const auto& term : u.spec.terms) {
    const Joint& j = joints[term.joint.index()];
    coordinate_of(j, bodies[j.a], bodies[j.b], term.dof).apply(term.ratio * u.torque, bodies[j.a], bodies[j.b]);
  }
}

}  // namespace dem::mbd

#endif
