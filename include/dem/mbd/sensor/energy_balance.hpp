#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/sensor/energy.hpp>
#include <dem/mbd/solver/mechanism.hpp>

#include <algorithm>
#include <memory>
#include <vector>

namespace dem::mbd {

namespace detail {

/// Velocity (m/s) and spin (rad/s) of b against a at the joint's point, global.
Wrench relative_velocity(const Joint& j, const Body& a, const Body& b);
inline Wrench velocity_of(const Body& b) { return {b.motion.velocity, b.motion.rotation * b.motion.angular_velocity}; }

/// W that a joint's dampers turn into heat: the power of the same joint without springs.
double heating(const Joint& j, const Body& a, const Body& b);
double heating(const JointLimitState& e, const Joint& j, const Body& a, const Body& b);
/// Speed of the coordinate that a motion prescribes, but no pose.
double speed_of(const Parts& m, const PrescribedMotion& p);

}  // namespace detail

/// Follows where the energy of a machine comes from and goes to, step by step:
///
///     EnergyBalance balance(machine, machine.gravity);
///     machine.run(10.0, 1e-4, [&] { balance.follow(machine.time()); });
///     balance.error();  // J: energy now - energy at the start - work put in + heat
///
/// Powers are integrated with the trapezoidal rule, from the states at both ends of a step, so that the balance closes
/// with the order of the integrator; across an impact, a jump of a load or the end of a slip, with dt. What closes it
/// not: a joint, coupling or spring that is switched on or off, a ratio that is changed, a body that is fixed while it
/// moves, sub-steps that are raised, and derived stiffness that is lowered in another pose. Begin anew after these (a
/// new EnergyBalance). What a fixed body with a velocity but no motion (a belt) does is not counted. It refers to the
/// machine, which has to outlive it and must not be moved.
class EnergyBalance {
 public:
  EnergyBalance(const Mechanism& machine, const Vec3& gravity, double time = 0.0);

  /// To be called after each step, with the time (s) that it reached.
  void follow(double time);

  /// The energies of the machine now.
  Energy energy() const { return energy_of(machine_->parts(), gravity_); }
  double work_of_loads() const { return loads_; }        ///< J, put in by loads
  double work_of_drives() const { return drives_; }      ///< J, put in by actuators, motors and prescribed motions
  double work_of_contacts() const { return contacts_; }  ///< J, put in by grains and by contacts of machine parts
  /// J, turned into heat since the start: by dampers of joints, limits, couplings, bushings and springs, by clutches
  /// and brakes that slip, and by friction of joints.
  double heat() const {
    return dampers_ + slip_work() - slip_start_ + friction_ - (joint_friction() - friction_start_);
  }
  /// J: what the machine has and lost, less what it had and got. 0 for an exact run.
  double error() const { return energy().sum() - start_ - loads_ - drives_ - contacts_ + heat(); }

 private:
  struct Powers {  // W
    double heat = 0.0, friction = 0.0, loads = 0.0, actuators = 0.0, contacts = 0.0, posed = 0.0;
  };

  Powers powers() const;

  std::vector<double> speeds() const;

  /// Whether a motion moves a body itself, and no joint of it: what its drive does then may go to what it touches.
  bool is_moved(std::size_t body) const;
  /// Bodies whose pose is prescribed: what moves them gives them their energy, and takes what all others do to them.
  template <class F>
  void for_each_posed(F&& f) const {
    const Parts& m = machine_->parts();
    for (const PrescribedMotion& p : m.motions) {
      if (p.spec.on && p.spec.target == MotionSpec::Target::pose) f(m.bodies[p.spec.body.index()]);
    }
  }
  double posed_energy() const;
  double slip_work() const;
  double joint_friction() const;

  const Mechanism* machine_;
  Vec3 gravity_;
  double time_;
  double start_, slip_start_, friction_start_ = 0.0;  // J, at the start
  double dampers_ = 0.0, friction_ = 0.0, loads_ = 0.0, drives_ = 0.0, contacts_ = 0.0;
  double posed_ = 0.0;
  Powers last_;
  std::vector<double> speeds_;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE Wrench relative_velocity(const Joint& j, const Body& a, const Body& b) {
  const Vector3<double> wa = a.motion.rotation * a.motion.angular_velocity,
                        wb = b.motion.rotation * b.motion.angular_velocity, rb = b.motion.rotation * j.point_b;
  const Vector3<double> ra = b.motion.position - a.motion.position + rb;
  return {b.motion.velocity - a.motion.velocity + cross(wb, rb) - cross(wa, ra), wb - wa};
}

DEM_INLINE double heating(const Joint& j, const Body& a, const Body& b) {
  if (!j.on) return 0.0;
  Joint damper = j;
  damper.k = damper.kr = 0.0;
  damper.k3 = damper.kr3 = {0, 0, 0};
  if (j.tables) damper.tables = std::make_shared<const BushingTables>();
  Body x, y;
  x.motion = a.motion;
  y.motion = b.motion;
  traits_of(j.kind).force(damper, x, y, velocity_of(a).torque, velocity_of(b).torque, 0.0);
  return -power({damper.force, damper.torque}, relative_velocity(j, a, b));
}

DEM_INLINE double heating(const JointLimitState& e, const Joint& j, const Body& a, const Body& b) {
  if (!j.on) return 0.0;
  const Coordinate q = coordinate_of(j, a, b, e.dof);
  const double inward = q.value < e.lower ? -q.speed : q.value > e.upper ? q.speed : 0.0;
  return inward > 0.0 ? e.damping * inward * inward : 0.0;
}

DEM_INLINE double speed_of(const Parts& m, const PrescribedMotion& p) {
  const Wrench v = velocity_of(m.bodies[p.spec.body.index()]);
  if (p.spec.target == MotionSpec::Target::position) return dot(p.axis, v.force);
  if (p.spec.target == MotionSpec::Target::rotation) return dot(p.axis, v.torque);
  const Joint& j = m.joints[p.spec.joint.index()];
  return coordinate_of(j, m.bodies[j.a], m.bodies[j.b], p.spec.dof).speed;
}

}  // namespace dem::mbd::detail

namespace dem::mbd {

DEM_INLINE EnergyBalance::EnergyBalance(const Mechanism& machine, const Vec3& gravity, double time)
    : machine_(&machine), gravity_(gravity), time_(time), start_(energy().sum()), slip_start_(slip_work()) {
  last_ = powers();
  speeds_ = speeds();
  posed_ = posed_energy();
  friction_start_ = joint_friction();
}

DEM_INLINE void EnergyBalance::follow(double time) {
  const double dt = time - time_;
  time_ = time;
  const Powers now = powers();
  const auto mean = [&](double a, double b) { return 0.5 * dt * (a + b); };
  dampers_ += mean(last_.heat, now.heat);
  friction_ += mean(last_.friction, now.friction);
  loads_ += mean(last_.loads, now.loads);
  contacts_ += mean(last_.contacts, now.contacts);
  drives_ += mean(last_.actuators, now.actuators) - mean(last_.posed, now.posed);
  const double posed = posed_energy();
  drives_ += posed - posed_;
  posed_ = posed;
  const std::vector<double> v = speeds();
  const Parts& m = machine_->parts();
  for (std::size_t i = 0; i < v.size(); ++i) {  // its force is the mean one of the step
    drives_ += m.motions[i].drive.force * mean(i < speeds_.size() ? speeds_[i] : v[i], v[i]);
  }
  speeds_ = v;
  last_ = now;
}

DEM_INLINE EnergyBalance::Powers EnergyBalance::powers() const {
  using detail::power, detail::velocity_of;
  const Parts& m = machine_->parts();
  Powers p;
  for (const Joint& j : m.joints) p.heat += detail::heating(j, m.bodies[j.a], m.bodies[j.b]);
  for (const JointLimitState& e : m.limits) {
    const Joint& j = m.joints[e.joint];
    p.heat += detail::heating(e, j, m.bodies[j.a], m.bodies[j.b]);
  }
  for (const Coupling& g : m.couplings) {
    if (!g.spec.on) continue;
    double rate = 0.0;
    for (const auto& t : g.spec.terms) rate += t.ratio * coordinate_now(m, t.joint, t.dof).speed;
    p.heat += g.c * rate * rate;
  }
  for (const Spring& s : m.springs) {
    if (!s.spec.on || s.spec.force_over_speed.empty()) continue;
    const double speed = coordinate_of(s, m.joints, m.bodies[s.a], m.bodies[s.b]).speed;
    p.heat -= s.spec.force_over_speed(speed) * speed;
  }
  for (const Clutch& u : m.clutches) {  // what slips is counted by the clutch itself
    if (!u.history.is_closed) continue;
    p.heat -= (u.torque + u.k * u.history.stretch) * slip_of(u, m.joints, m.bodies).rate;
  }
  for (const JointFrictionState& e : m.friction) {
    const Joint& j = m.joints[e.joint];
    p.friction -= power({e.force, e.torque}, detail::relative_velocity(j, m.bodies[j.a], m.bodies[j.b]));
  }
  for (const Load& l : m.loads) {
    if (!l.spec.on) continue;
    const Body& b = m.bodies[l.spec.body.index()];
    p.loads += power(l.wrench, velocity_of(b));
    if (!l.spec.pair_law) continue;
    const Body& a = m.bodies[l.spec.a.index()];
    const auto arm = b.motion.position - a.motion.position;
    p.loads -= power({l.wrench.force, l.wrench.torque + cross(arm, l.wrench.force)}, velocity_of(a));
  }
  for (const Actuator& u : m.actuators) {
    p.actuators += u.force * coordinate_of(u, m.joints, m.bodies[u.a], m.bodies[u.b]).speed;
  }
  for (std::size_t i = 0; i < m.outside.size(); ++i) {
    if (!m.bodies[i].fixed || is_moved(i)) p.contacts += power(m.outside[i], velocity_of(m.bodies[i]));
  }
  for_each_posed([&](const Body& b) { p.posed += power({b.force, b.torque}, velocity_of(b)); });
  return p;
}

DEM_INLINE std::vector<double> EnergyBalance::speeds() const {
  const Parts& m = machine_->parts();
  std::vector<double> v;
  for (const PrescribedMotion& p : m.motions) {
    const bool counts = p.spec.on && p.spec.target != MotionSpec::Target::pose;
    v.push_back(counts ? detail::speed_of(m, p) : 0.0);
  }
  return v;
}

DEM_INLINE bool EnergyBalance::is_moved(std::size_t body) const {
  const auto& motions = machine_->parts().motions;
  return std::any_of(motions.begin(), motions.end(), [&](const PrescribedMotion& p) {
    return p.spec.on && p.spec.target != MotionSpec::Target::joint && p.spec.body.index() == body;
  });
}

DEM_INLINE double EnergyBalance::posed_energy() const {
  double sum = 0.0;
  for_each_posed([&](const Body& b) {
    if (!b.fixed) sum += kinetic_energy(b) - b.mass * dot(from_eigen(gravity_), b.motion.position);
  });
  return sum;
}

DEM_INLINE double EnergyBalance::slip_work() const {
  double sum = 0.0;
  for (const Clutch& u : machine_->parts().clutches) sum += u.history.slip_work;
  return sum;
}

DEM_INLINE double EnergyBalance::joint_friction() const {
  double sum = 0.0;
  for (const JointFrictionState& f : machine_->parts().friction) sum += elastic_energy(f);
  return sum;
}

}  // namespace dem::mbd

#endif
