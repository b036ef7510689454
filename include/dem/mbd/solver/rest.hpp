#pragma once

// Static equilibrium of a machine. Not among what <dem/mbd/mbd.hpp> includes.

#include <dem/core/macros.hpp>
#include <dem/math/solve_positive.hpp>
#include <dem/mbd/machine.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace dem::mbd {

struct RestOptions {
  /// Of the residuals, as a share of the weight of the machine or of its largest force. Where 20 iterations
  /// do not halve them, a thousand times as much is taken for rest.
  double tolerance = 1e-9;
  int most_iterations = 300;
};

/// How a search for equilibrium ended. Converts to true if it was found.
struct RestReport {
  bool ok = false;
  int iterations = 0;
  double force = 0.0;   ///< N, the largest that is left on a body
  double torque = 0.0;  ///< N m, the largest that is left, about a centre of mass
  double share = 0.0;   ///< the residual as a share of the weight or of the largest force
  double moved = 0.0;   ///< m, the farthest that a body was moved, also if it was put back
  std::string body;     ///< with the largest residual
  std::string text;     ///< in words, if it was not found
  explicit operator bool() const { return ok; }
};

namespace detail {

/// Looks for the pose at which no force is left, by implicit steps in a time of its own, without inertia between them:
/// (M/tau^2 + K) d = f, with K by differences. Short steps follow the forces, long ones are Newton's.
template <class PutForces>
class RestSearch {
 public:
  /// `put_forces()` adds the forces from outside to the bodies, whose sums are clear.
  RestSearch(Parts& parts, const Vec3& gravity, double time, double dt, PutForces put_forces)
      : m_(parts), put_forces_(std::move(put_forces)), gravity_(from_eigen(gravity)), time_(time), dt_(dt) {
    double weight = 0.0;
    const JoinedBodies joined = joined_bodies(parts);
    for (const JoinedBodies::Machine& k : joined.machines) size_ = std::max(size_, k.size);
    for (std::size_t i = 0; i < parts.bodies.size(); ++i) {
      Body& b = parts.bodies[i];
      if (b.fixed) continue;
      b.motion.velocity = b.motion.angular_velocity = {0, 0, 0};
      free_.push_back(i);
      start_.push_back(b.motion);
      weight += b.mass * norm(gravity_);
    }
    evaluate(force_);
    scale_ = weight;
    for (const Spring& s : parts.springs) scale_ = std::max(scale_, std::abs(s.force));
    for (const Actuator& u : parts.actuators) scale_ = std::max(scale_, std::abs(u.force));
    for (const Load& l : parts.loads) scale_ = std::max(scale_, norm(l.wrench.force) + norm(l.wrench.torque) / size_);
  }

  /// Puts the bodies where they were.
  void put_back() {
    for (std::size_t k = 0; k < free_.size(); ++k) m_.bodies[free_[k]].motion = start_[k];
  }

  DEM_SETUP RestReport run(const RestOptions& o) {
    RestReport report;
    double tau = 0.1, last = residual(), least = 1e300;
    int stalled = 0;  // iterations since the residual was halved
    for (; std::isfinite(last) && report.iterations < o.most_iterations; ++report.iterations) {
      const double share = worst_share(report);
      stalled = share < 0.5 * least ? 0 : stalled + 1;
      if (stalled == 0) least = share;
      if (share <= o.tolerance || (stalled >= 20 && share <= 1e3 * o.tolerance)) {
        report.ok = true;
        break;
      }
      find_stiffness();
      std::vector<double> step;
      for (int k = 0; k < 40; ++k, tau *= 0.25) {
        if (solve(tau, step)) break;
      }
      limit(step);
      move(step);
      evaluate(force_);
      const double now = residual();
      tau *= std::clamp(last / std::max(now, 1e-300), 0.3, 4.0);
      tau = std::min(tau, longest_);
      last = now;
    }
    if (!std::isfinite(last)) {
      const std::string cause = not_a_number(m_);
      report.text = dem::text("no rest was found: after {} iterations the forces on body '{}' are not finite. {}",
                              report.iterations, body_without_number(),
                              cause.empty() ? "Start nearer to rest, or check the loads."
                                            : cause + " is not a number: check the function that gives it.");
      return report;
    }
    for (std::size_t k = 0; k < free_.size(); ++k) {
      report.moved = std::max(report.moved, norm(m_.bodies[free_[k]].motion.position - start_[k].position));
    }
    if (!report.ok) {
      report.text = dem::text(
          "no rest was found in {} iterations: {:.3g} N and {:.3g} N m are left, {:.3g} of the weight or of the "
          "largest "
          "force, most on body '{}'. It may have nothing to rest on, or a load that never comes to rest; hold it, or "
          "start nearer to rest",
          report.iterations, report.force, report.torque, report.share, report.body);
    }
    return report;
  }

 private:
  /// Forces (N) and torques (N m) on the free bodies, gravity included.
  void evaluate(std::vector<double>& f) {
    clear_forces(m_);
    put_forces_();
    add_forces(m_, time_, dt_);
    f.resize(6 * free_.size());
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const Body& b = m_.bodies[free_[k]];
      const Vector3<double> sum = b.force + b.mass * gravity_;
      const double all[6] = {sum.x, sum.y, sum.z, b.torque.x, b.torque.y, b.torque.z};
      std::copy(all, all + 6, f.begin() + static_cast<std::ptrdiff_t>(6 * k));
    }
  }
  double mass(std::size_t row) const {
    const Body& b = m_.bodies[free_[row / 6]];
    return row % 6 < 3 ? b.mass : std::max({b.inertia[0], b.inertia[1], b.inertia[2]});
  }
  double residual() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < force_.size(); ++i) sum += force_[i] * force_[i] / mass(i);
    return std::sqrt(sum);
  }
  const std::string& body_without_number() const {
    std::size_t k = 0;
    while (k + 1 < free_.size() &&
           std::all_of(&force_[6 * k], &force_[6 * k] + 6, [](double f) { return std::isfinite(f); })) {
      ++k;
    }
    return m_.bodies[free_[k]].name;
  }
  double worst_share(RestReport& report) const {
    report.share = report.force = report.torque = 0.0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const double* f = &force_[6 * k];
      const double force = norm(Vector3<double>{f[0], f[1], f[2]}), torque = norm(Vector3<double>{f[3], f[4], f[5]});
      report.force = std::max(report.force, force);
      report.torque = std::max(report.torque, torque);
      const double share = std::max(force, torque / size_) / std::max(scale_, 1e-300);
      if (share >= report.share) {
        report.share = share;
        report.body = m_.bodies[free_[k]].name;
      }
    }
    return report.share;
  }

  void move_body(Body& b, const double* d) {
    b.motion.position += Vector3<double>{d[0], d[1], d[2]};
    b.motion.rotation = rotation_from_vector(Vector3<double>{d[3], d[4], d[5]}) * b.motion.rotation;
  }
  void move(const std::vector<double>& step) {
    for (std::size_t k = 0; k < free_.size(); ++k) {
      Body& b = m_.bodies[free_[k]];
      move_body(b, &step[6 * k]);
      b.motion.rotation = orthonormalised(b.motion.rotation);
    }
  }

  /// K = -df/dd, made symmetric, by central differences.
  void find_stiffness() {
    const std::size_t n = force_.size();
    K_.assign(n * n, 0.0);
    std::vector<double> ahead, behind;
    for (std::size_t c = 0; c < n; ++c) {
      Body& b = m_.bodies[free_[c / 6]];
      const integrator::Motion<double> kept = b.motion;
      const double h = c % 6 < 3 ? 1e-6 * size_ : 1e-6;
      double d[6] = {0, 0, 0, 0, 0, 0};
      d[c % 6] = h;
      move_body(b, d);
      evaluate(ahead);
      b.motion = kept;
      d[c % 6] = -h;
      move_body(b, d);
      evaluate(behind);
      b.motion = kept;
      for (std::size_t r = 0; r < n; ++r) {
        const double k = -(ahead[r] - behind[r]) / (4.0 * h);
        K_[r * n + c] += k;
        K_[c * n + r] += k;
      }
    }
    double fastest = 0.0;
    for (std::size_t r = 0; r < n; ++r) fastest = std::max(fastest, K_[r * n + r] / mass(r));
    longest_ = fastest > 0.0 ? 1e5 / std::sqrt(fastest) : 1e3;  // beyond it M/tau^2 is lost in rounding
  }
  /// False if the matrix is not positive: the step in time has to be shorter.
  bool solve(double tau, std::vector<double>& step) {
    const std::size_t n = force_.size();
    std::vector<double> A = K_;
    for (std::size_t r = 0; r < n; ++r) A[r * n + r] += mass(r) / (tau * tau);
    step = force_;
    solve_positive(A, step);
    for (std::size_t r = 0; r < n; ++r) {
      if (!(A[r * n + r] > 0.0)) return false;
    }
    return true;
  }
  /// A step that turns or moves a body far is shortened.
  void limit(std::vector<double>& step) const {
    double far = 0.0;
    for (std::size_t i = 0; i < step.size(); ++i) {
      far = std::max(far, std::abs(step[i]) / (i % 6 < 3 ? 0.1 * size_ : 0.2));
    }
    if (far > 1.0) {
      for (double& x : step) x /= far;
    }
  }

  Parts& m_;
  PutForces put_forces_;
  Vector3<double> gravity_;
  double time_, dt_, size_ = 1e-6, scale_ = 0.0, longest_ = 1e3;
  std::vector<std::size_t> free_;
  std::vector<integrator::Motion<double>> start_;
  std::vector<double> force_, K_;
};

/// Throws Error for what a search for rest cannot hold, and stops all bodies that are not fixed.
void stop_for_rest(Parts& parts);

/// While it lives, fixed bodies have no speed: belts, which run on afterwards.
class StandStill {
 public:
  explicit StandStill(Parts& parts);
  ~StandStill();
  StandStill(const StandStill&) = delete;
  StandStill& operator=(const StandStill&) = delete;

 private:
  Parts& m_;
  std::vector<integrator::Motion<double>> was_;
};

/// What is held exactly gets springs for the search, so stiff that they hardly give way. All else (limits, brakes,
/// friction) keeps the stiffness that it has in steps of dt (s): it is what the run goes on with.
void put_springs_on(Parts& parts, double dt);

/// Searches, with joints as they are in steps of dt (s).
template <class Joints, class PutForces>
RestReport search_rest(Parts& parts, const Vec3& gravity, double time, double dt, const RestOptions& options,
                       PutForces&& put_forces) {
  if constexpr (Joints::projects) put_springs_on(parts, dt);
  const StandStill belts(parts);
  RestSearch<std::decay_t<PutForces>> search(parts, gravity, time, dt, put_forces);
  const Stepping stepping(parts);
  const RestReport report = search.run(options);
  if (!report) search.put_back();
  Joints::State::take_springs_off(parts);
  settle_turns(parts);
  return report;
}

}  // namespace detail

/// Brings a machine to rest: moves its bodies to where gravity, springs, loads, actuators, limits and joints are in
/// balance, and stops them. Loads are asked at the machine's present time and at speed 0; friction, dampers and motors
/// hold nothing. Joints stand open as they will in steps of dt (s), so the run that follows stays where it is. A
/// direction in which nothing holds and nothing pulls, as a wheel about its axle, stays as it is. If no rest is found,
/// the bodies are stopped where they were. Fixed bodies that have a velocity (belts) stand during the search, and run
/// on afterwards. Velocities that are given afterwards fit the joints by Machine::assemble.
///
/// Throws Error for a prescribed motion of a body that is not fixed, and what Machine::run throws. Of a machine in a
/// world: <dem/world/rest.hpp>.
template <integrator::Integrator I, JointPolicy Joints>
RestReport find_rest(Machine<I, Joints>& machine, double dt, const RestOptions& options = {}) {
  Parts& parts = machine.parts();
  detail::stop_for_rest(parts);
  if (const MachineReport report = machine.run(0.0, dt); machine.report().body.valid()) {
    return {.body = parts.bodies[report.body.index()].name, .text = report.text};
  }
  const RestReport report =
      detail::search_rest<Joints>(parts, machine.gravity, machine.time(), dt / machine.substeps, options, [] {});
  machine.initialise(machine.time(), machine.gravity);
  return report;
}

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void stop_for_rest(Parts& parts) {
  for (const PrescribedMotion& p : parts.motions) {
    if (p.spec.on && !parts.bodies[p.spec.body.index()].fixed) {
      fail(
          "find_rest knows nothing of prescribed motion '{}'; switch it off (switch_on(motion, false)) and on again "
          "afterwards, or hold the coordinate with an actuator",
          p.spec.name);
    }
  }
  for (Body& b : parts.bodies) {
    if (!b.fixed) b.motion.velocity = b.motion.angular_velocity = {0, 0, 0};
  }
}

DEM_INLINE StandStill::StandStill(Parts& parts) : m_(parts) {
  for (Body& b : parts.bodies) {
    was_.push_back(b.motion);
    if (b.fixed) b.motion.velocity = b.motion.angular_velocity = {0, 0, 0};
  }
}

DEM_INLINE StandStill::~StandStill() {
  for (std::size_t i = 0; i < was_.size(); ++i) {
    if (m_.bodies[i].fixed) m_.bodies[i].motion = was_[i];
  }
}

DEM_INLINE void put_springs_on(Parts& parts, double dt) {
  constexpr double stiffer = 100.0;
  std::vector<Joint*> joints;
  std::vector<Coupling*> couplings;
  for (Joint& j : parts.joints) {
    if (j.rigid) joints.push_back(&j);
    j.rigid = false;
  }
  for (Coupling& g : parts.couplings) {
    if (g.k == 0.0 && g.c == 0.0) couplings.push_back(&g);
  }
  derive_stiffness(parts, dt);
  for (Joint* j : joints) {
    j->k *= stiffer;
    j->kr *= stiffer;
  }
  for (Coupling* g : couplings) g->k *= stiffer;
}

}  // namespace dem::mbd::detail

#endif
