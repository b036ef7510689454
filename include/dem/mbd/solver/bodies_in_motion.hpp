#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <vector>

namespace dem::mbd {

/// The free bodies of a machine as the integrator sees them: inverse inertias, and what it remembers of each body.
template <integrator::Integrator I>
class BodiesInMotion {
 public:
  using Memory = typename I::template Memory<double>;

  /// Reads masses and inertias. Throws Error for a body that cannot be integrated.
  DEM_SETUP void read(const std::vector<Body>& bodies) {
    memory_.assign(bodies.size(), {});
    inverse_.clear();
    for (const Body& b : bodies) {
      check_body(b);
      inverse_.push_back(inverse_of(b));
    }
  }
  /// Whether these are still the masses and inertias that were read.
  bool has_read(const std::vector<Body>& bodies) const {
    if (inverse_.size() != bodies.size()) return false;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const Inverse now = inverse_of(bodies[i]);
      const Vector3<double> change = now.inertia - inverse_[i].inertia;
      if (now.mass != inverse_[i].mass || dot(change, change) != 0.0) return false;
    }
    return true;
  }
  /// Fills the integrator's memory from the forces that the bodies carry.
  void initialise(const std::vector<Body>& bodies, const Vector3<double>& gravity) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      I::template initialise<double>(memory_[i], acceleration(bodies[i], inverse_[i], gravity, 0.0));
    }
  }

  // Flattened, because the vector operators in them have to be inlined however large the program is.
  DEM_FLATTEN void before_forces(std::vector<Body>& bodies, int stage, double dt) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (!bodies[i].fixed) I::template before_forces<double>(stage, dt, bodies[i].motion, memory_[i]);
    }
  }
  DEM_FLATTEN void after_forces(std::vector<Body>& bodies, int stage, double dt, const Vector3<double>& gravity) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].fixed) continue;
      const double lead = integrator::gyroscopic_lead<I>(dt);
      I::template after_forces<double>(stage, dt, bodies[i].motion, memory_[i],
                                       acceleration(bodies[i], inverse_[i], gravity, lead));
    }
  }

  /// Adds an impulse (N s, and N m s about the centre of mass) to a free body's velocities.
  void push(std::vector<Body>& bodies, std::size_t i, const Wrench& impulse) const {
    integrator::Motion<double>& m = bodies[i].motion;
    const Inverse& inv = inverse_[i];
    const Vector3<double> turn = transpose_times(m.rotation, impulse.torque);
    m.velocity += inv.mass * impulse.force;
    m.angular_velocity +=
        {inv.inverse_inertia.x * turn.x, inv.inverse_inertia.y * turn.y, inv.inverse_inertia.z * turn.z};
  }

  std::vector<Memory>& memory() { return memory_; }

  template <class V>
  void fields(V& v) {
    v("inverse", inverse_);
    if constexpr (!std::is_empty_v<Memory>) {
      memory_.resize(inverse_.size());
      for (Memory& m : memory_) v.reals("memory", m);
    } else {
      memory_.resize(inverse_.size());
    }
  }

 private:
  struct Inverse {
    double mass;
    Vector3<double> inertia, inverse_inertia;
    template <class V>
    void fields(V& v) {
      v("mass", mass), v("inertia", inertia), v("inverse_inertia", inverse_inertia);
    }
  };

  static Inverse inverse_of(const Body& b) {
    if (b.fixed) return {0.0, {1, 1, 1}, {0, 0, 0}};
    const Vector3<double> i = from_eigen(b.inertia);
    return {1.0 / b.mass, i, {1.0 / i.x, 1.0 / i.y, 1.0 / i.z}};
  }
  static integrator::Acceleration<double> acceleration(const Body& b, const Inverse& inv, const Vector3<double>& g,
                                                       double lead) {
    return {g + inv.mass * b.force,
            integrator::angular_acceleration(transpose_times(b.motion.rotation, b.torque), b.motion.angular_velocity,
                                             inv.inertia, inv.inverse_inertia, lead)};
  }

  std::vector<Memory> memory_;
  std::vector<Inverse> inverse_;
};

}  // namespace dem::mbd
