#pragma once

#include <dem/math/vector.hpp>

namespace dem {

/// A force (N) and a torque (N m) in global axes.
struct Wrench {
  Vector3<double> force = {0, 0, 0};
  Vector3<double> torque = {0, 0, 0};

  friend Wrench operator+(const Wrench& a, const Wrench& b) { return {a.force + b.force, a.torque + b.torque}; }
  friend Wrench operator*(double s, const Wrench& a) { return {s * a.force, s * a.torque}; }
};

}  // namespace dem
