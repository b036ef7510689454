#pragma once

#include <dem/core/macros.hpp>
#include <dem/math/vector.hpp>

#include <cmath>

namespace dem::mbd {

// The springs of a bushing that resist rotation: with the vector r of the rotation of b in a's joint frame (its axis
// times its angle) the energy is 1/2 r.K r. It is positive for any constants K about x, y, z, a twist about a single
// axis meets that axis's constant at any angle, and the torque below is exactly its gradient.

/// The rotation vector (rad) of the matrix whose element (i, k) is a_i . b_k. Good up to half a turn.
DEM_HOT Vector3<double> rotation_vector(const Vector3<double>& xa, const Vector3<double>& ya, const Vector3<double>& za,
                                        const Vector3<double>& xb, const Vector3<double>& yb,
                                        const Vector3<double>& zb) {
  const Vector3<double> s = {0.5 * (dot(za, yb) - dot(ya, zb)), 0.5 * (dot(xa, zb) - dot(za, xb)),
                             0.5 * (dot(ya, xb) - dot(xa, yb))};
  const double sine = norm(s), cosine = 0.5 * (dot(xa, xb) + dot(ya, yb) + dot(za, zb) - 1.0);
  return (sine > 1e-8 ? std::atan2(sine, cosine) / sine : 1.0) * s;
}

/// The torque on b, in a's joint frame, of springs that store 1/2 r.load, where load = K r. To first order it is -load;
/// the rest is what turning b by a little more changes in r: -(1 + [r]x/2 + c [r]x^2) load.
DEM_HOT Vector3<double> rotation_vector_torque(const Vector3<double>& r, const Vector3<double>& load) {
  const double t2 = dot(r, r), t = std::sqrt(t2);
  // (1 - t/2 cot(t/2)) / t^2, by its series where the difference would lose digits.
  const double c = t > 0.02 ? (1.0 - 0.5 * t / std::tan(0.5 * t)) / t2 : 1.0 / 12 + t2 * (1.0 / 720 + t2 / 30240);
  const Vector3<double> across = cross(r, load);
  return -(load + 0.5 * across + c * cross(r, across));
}

}  // namespace dem::mbd
