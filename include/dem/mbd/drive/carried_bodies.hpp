#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <array>
#include <vector>

namespace dem::mbd {

/// The bodies whose whole motion is prescribed: by a pose, or by a rotation and positions along three directions. They
/// give way to nothing that touches them. Motions of joints do not count: the joint itself yields a little.
class CarriedBodies {
 public:
  explicit CarriedBodies(const Parts& parts);

  bool has(BodyId body) const { return !bodies_.empty() && bodies_[body.index()].is_carried(); }
  /// Whether forces move the body.
  bool gives_way(const Body& body, BodyId id) const { return !body.fixed && !has(id); }

 private:
  struct Held {
    bool turns = false;
    int directions = 0;  ///< of `along`, each across those before it
    std::array<Vector3<double>, 3> along = {};
    bool is_carried() const { return turns && directions == 3; }
  };

  void add(const PrescribedMotion& p, std::size_t count);
  /// One that lies within 1e-3 of what those before it span is left out, as drives do (jacobian.hpp).
  static void add_direction(Held& held, Vector3<double> axis);

  std::vector<Held> bodies_;  // empty if no motion is prescribed
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE CarriedBodies::CarriedBodies(const Parts& parts) {
  for (const PrescribedMotion& p : parts.motions) {
    if (p.spec.on && p.spec.target != MotionSpec::Target::joint) add(p, parts.bodies.size());
  }
}

DEM_INLINE void CarriedBodies::add(const PrescribedMotion& p, std::size_t count) {
  bodies_.resize(count);
  Held& held = bodies_[p.spec.body.index()];
  if (p.spec.target == MotionSpec::Target::pose) held = {true, 3, {}};
  else if (p.spec.target == MotionSpec::Target::rotation) held.turns = true;  // it turns about no other axis
  else add_direction(held, p.axis);
}

DEM_INLINE void CarriedBodies::add_direction(Held& held, Vector3<double> axis) {
  if (held.directions == 3) return;
  for (int k = 0; k < held.directions; ++k) {
    const Vector3<double>& n = held.along[static_cast<std::size_t>(k)];
    axis -= dot(axis, n) * n;
  }
  if (const double left = norm(axis); left > 1e-3) {
    held.along[static_cast<std::size_t>(held.directions++)] = (1.0 / left) * axis;
  }
}

}  // namespace dem::mbd

#endif
