#pragma once

// Joints that are held exactly. Not among what <dem/mbd/mbd.hpp> includes.

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/prescribe.hpp>
#include <dem/mbd/solver/joined_bodies.hpp>
#include <dem/mbd/solver/rigid_rows.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace dem::mbd {

namespace detail {

/// Moves bodies onto what their joints allow. The integrator moves them as if there were no joints. Then impulses along
/// the rows of the step's start close the joints at its end (positions), and impulses along the rows of its end take
/// what speed is left along them. With velocity Verlet that is RATTLE (Andersen 1983,
/// doi:10.1016/0021-9991(83)90014-1). Impulses are equal and opposite at one point, so momentum and angular momentum
/// are kept.
class Projection {
 public:
  /// Marks the joints that are held exactly; they have no springs. To be called when stiffness has been derived.
  static void take_springs_off(Parts& m);

  /// Closes the joints of bodies that are about to start, without a change of speed.
  void start(Parts& m);
  /// To be called before a step begins. What a part that was switched on or off changes counts from now on.
  void begin(Parts& m);
  /// The bodies were put elsewhere, if only by rounding.
  void forget() { is_stale_ = true; }

  /// After the integrator has moved the bodies: closes the joints at `time` (s), the end of a step of dt (s).
  void move(Parts& m, double time, double dt, bool is_last_stage);

  /// Integrators take gyroscopic terms at the spin `lead` (s) ahead, and know nothing of the joints' torques: adds what
  /// these, as they were in the step before, change of the terms.
  void add_gyroscopic(Parts& m, double lead);

  /// At the end of the step, when forces have changed the speeds: takes what does not fit the joints, and tells what
  /// they carried, as the mean over the step of dt (s) that ends at `time` (s).
  void finish(Parts& m, double time, double dt);

  template <class V>
  void fields(V& v) {
    v("torque_of_joints", torque_);
    is_stale_ = true;
  }

 private:
  static constexpr double tolerance = 1e-11;  ///< rad, and m as a share of the machine's size
  struct Change {
    Vector3<double> velocity = {0, 0, 0};  ///< m/s, global
    Vector3<double> spin = {0, 0, 0};      ///< rad/s, body frame
  };

  static void mark(Parts& m);
  void lay_out(Parts& m);

  /// Hands the bodies what the impulses x_ change of their speeds, `by_speed` times, and moves them for `dt` (s) with
  /// it.
  void push(Parts& m, double by_speed, double dt);

  void add_impulses() {
    for (std::size_t r = 0; r < x_.size(); ++r) total_[r] += x_[r];
  }
  void collect(const Parts& m, const std::vector<double>& impulses);
  void report(Parts& m, double per_time);
  static void note_reached(Parts& m);

  RigidRows rows_, at_start_;  ///< the latter of the step's start, if the former are others already
  bool went_on_ = false;
  std::vector<double> x_, errors_, total_, on_drive_, multiplier_;
  std::vector<Vector3<double>> torque_, gyroscopic_;  ///< N m, global: of joints in the last step, see add_gyroscopic
  std::vector<Change> change_;
  std::vector<Wrench> reaction_, on_body_;
  double per_metre_ = 1.0, worst_ = 0.0;
  bool is_stale_ = true;
};

}  // namespace detail

/// Joints, couplings and prescribed motions that are held exactly, at the end of each step, by impulses: the time step
/// is chosen by what moves, and not by how far joints may give way. Joints and couplings that are given a stiffness or
/// a damping stay springs. Limits and friction stay what they are, friction with the load of the step before.
///
///     #include <dem/mbd/solver/projected.hpp>
///     mbd::Machine<integrator::VelocityVerlet, mbd::Projected> machine;
struct Projected {
  static constexpr bool projects = true;
  using State = detail::Projection;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void Projection::take_springs_off(Parts& m) {
  mark(m);
  for (Joint& j : m.joints) {
    if (j.rigid) j.k = j.c = j.kr = j.cr = 0.0;
  }
  for (Coupling& g : m.couplings) {
    if (!g.spec.stiffness && !g.spec.damping) g.k = g.c = 0.0;
  }
}

DEM_INLINE void Projection::start(Parts& m) {
  lay_out(m);
  for (int pass = 0; pass < 30 && rows_.errors(m, x_, per_metre_) > tolerance; ++pass) {
    for (double& e : x_) e = -e;
    rows_.solve(x_);
    push(m, 0.0, 1.0);
    rows_.update(m);
  }
}

DEM_INLINE void Projection::begin(Parts& m) {
  if (is_stale_ || !rows_.is_laid_out_for(m)) lay_out(m);
  total_.assign(rows_.size(), 0.0);
}

DEM_INLINE void Projection::move(Parts& m, double time, double dt, bool is_last_stage) {
  if (!m.motions.empty()) sample_motions(m, time, dt);
  if (went_on_) rows_ = at_start_;  // the stage before ended with others
  went_on_ = false;
  std::fill(total_.begin(), total_.end(), 0.0);
  worst_ = rows_.errors(m, x_, per_metre_);
  for (int pass = 0; pass < 12 && worst_ > tolerance; ++pass) {
    const double before = worst_;
    for (double& e : x_) e *= -1.0 / dt;
    rows_.solve(x_);
    add_impulses();
    push(m, 1.0, dt);
    worst_ = rows_.errors(m, errors_, per_metre_);
    if (worst_ < 0.5 * before) {
      std::swap(x_, errors_);
    } else if (went_on_) {
      break;
    } else {  // through a singular position the rows of the step's start say nothing of its end
      for (double& x : x_) x = -x;
      add_impulses();
      push(m, 1.0, dt);
      went_on_ = true;
      at_start_ = rows_;
      worst_ = rows_.errors(m, x_, per_metre_);
    }
    if (went_on_ && worst_ > tolerance) rows_.update(m);
  }
  note_reached(m);
  if (is_last_stage) return;
  x_ = total_;  // a trial stage: what is left to do for the speeds is much the same again
  push(m, 1.0, 0.0);
}

DEM_INLINE void Projection::add_gyroscopic(Parts& m, double lead) {
  torque_.resize(m.bodies.size(), {0, 0, 0});
  gyroscopic_.assign(m.bodies.size(), {0, 0, 0});
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    Body& b = m.bodies[i];
    if (b.fixed) continue;
    const Vector3<double> inertia = {b.inertia[0], b.inertia[1], b.inertia[2]};
    const Vector3<double> t = transpose_times(b.motion.rotation, torque_[i]), &w = b.motion.angular_velocity;
    const auto term = [&](const Vector3<double>& spin) {
      return cross(spin, {inertia.x * spin.x, inertia.y * spin.y, inertia.z * spin.z});
    };
    const Vector3<double> ahead = w + lead * Vector3<double>{t.x / inertia.x, t.y / inertia.y, t.z / inertia.z};
    gyroscopic_[i] = b.motion.rotation * (term(w) - term(ahead));
    b.torque += gyroscopic_[i];
  }
}

DEM_INLINE void Projection::finish(Parts& m, double time, double dt) {
  if (!m.motions.empty()) sample_motions(m, time, dt);  // forces may have changed the speeds of bodies in their pose
  reaction_.assign(m.joints.size(), {});
  on_body_.assign(m.bodies.size(), {});
  on_drive_.assign(m.motions.size(), 0.0);
  multiplier_.assign(m.couplings.size(), 0.0);
  collect(m, total_);
  went_on_ = false;
  rows_.update(m);
  rows_.speed_errors(m, x_);
  rows_.solve(x_);
  push(m, 1.0, 0.0);
  collect(m, x_);
  report(m, 1.0 / dt);
}

DEM_INLINE void Projection::mark(Parts& m) {
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    m.joints[i].rigid =
        traits_of(m.joints[i].kind).stiffness == Stiffness::derived && !m.joint_specs[i].has_stiffness_or_damping();
  }
}

DEM_INLINE void Projection::lay_out(Parts& m) {
  mark(m);
  double size = 1e-300;
  for (const JoinedBodies::Machine& k : joined_bodies(m).machines) size = std::max(size, k.size);
  per_metre_ = 1.0 / size;
  rows_.lay_out(m);
  rows_.update(m);
  is_stale_ = false;
}

DEM_INLINE void Projection::push(Parts& m, double by_speed, double dt) {
  change_.assign(m.bodies.size(), {});
  for (const RigidRows::Side& s : rows_.sides()) {
    change_[s.body].velocity += x_[s.row] * s.velocity;
    change_[s.body].spin += x_[s.row] * s.spin;
  }
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    if (m.bodies[i].fixed) continue;
    const Change& by = change_[i];
    integrator::Motion<double>& b = m.bodies[i].motion;
    b.velocity += by_speed * by.velocity;
    b.angular_velocity += by_speed * by.spin;
    if (dt == 0.0) continue;
    b.position += dt * by.velocity;
    integrator::turn(b.rotation, dt * by.spin);
  }
}

DEM_INLINE void Projection::collect(const Parts& m, const std::vector<double>& impulses) {
  for (const RigidRows::Side& s : rows_.sides()) on_body_[s.body] = on_body_[s.body] + impulses[s.row] * s.push;
  const std::vector<RigidRows::Side>& sides = rows_.sides();
  for (const RigidRows::Item& item : rows_.items()) {
    if (item.kind == RigidRows::Item::coupling) multiplier_[item.index] += impulses[item.first_row];
    if (item.kind == RigidRows::Item::drive && m.rows[item.index].is_reported) {
      on_drive_[m.rows[item.index].motion] += impulses[item.first_row];
    }
  }
  for (const RigidRows::Side& s : sides) {
    const RigidRows::Item& item = rows_.item_of(s.row);
    if (item.kind != RigidRows::Item::joint || m.joints[item.index].b != s.body) continue;
    const bool pushes = dot(s.push.force, s.push.force) > 0.0;
    Wrench& w = reaction_[item.index];
    (pushes ? w.force : w.torque) += impulses[s.row] * (pushes ? s.push.force : s.push.torque);
  }
}

DEM_INLINE void Projection::report(Parts& m, double per_time) {
  torque_.resize(m.bodies.size());
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    if (!m.joints[i].rigid) continue;
    m.joints[i].force = per_time * reaction_[i].force;
    m.joints[i].torque = per_time * reaction_[i].torque;
  }
  for (std::size_t i = 0; i < m.couplings.size(); ++i) {
    if (!RigidRows::is_rigid(m.couplings[i])) continue;
    m.couplings[i].multiplier = per_time * multiplier_[i];
  }
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    m.bodies[i].force += per_time * on_body_[i].force;
    m.bodies[i].torque += per_time * on_body_[i].torque;
    if (i < gyroscopic_.size()) m.bodies[i].torque -= gyroscopic_[i];
    torque_[i] = per_time * on_body_[i].torque;
  }
  for (std::size_t i = 0; i < m.motions.size(); ++i) {
    PrescribedMotion& p = m.motions[i];
    const Body& x = m.bodies[p.spec.body.index()];
    p.drive.impulse = 0.0;
    p.drive.force = p.spec.on ? per_time * on_drive_[i] : 0.0;
    if (p.spec.on && x.fixed && p.spec.target != MotionSpec::Target::joint) {
      p.drive.force = -dot(p.axis, p.spec.target == MotionSpec::Target::rotation ? x.torque : x.force);
    }
  }
}

DEM_INLINE void Projection::note_reached(Parts& m) {
  for (PrescribedMotion& p : m.motions) {
    if (p.spec.by_speed) p.drive.reached = coordinate_of_drive(m, p);
  }
}

}  // namespace dem::mbd::detail

#endif
