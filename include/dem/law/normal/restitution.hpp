#pragma once

#include <dem/core/error.hpp>

#include <cmath>
#include <numbers>

namespace dem::contact {

// A spring with a viscous damper, m d'' + 2 b sqrt(k m) d' + k d = 0 with the damping ratio b, rebounds with the same
// restitution at every impact speed. Hertz's contact does so too when its damper grows with the fourth root of the
// overlap: with u = d^(5/4) its equation is that of the linear spring, with 5/4 m in place of m (Antypov and Elliott
// 2011, doi:10.1209/0295-5075/94/50004). One function of b therefore serves both.
//
// That is the restitution of one contact, whole or a share of one (an edge or a corner of a polyhedron, see
// NormalState). A body that lands on n whole contacts at once, as a cluster flat on its spheres, has n springs and n
// dampers, so its damping ratio is b sqrt(n), and it rebounds lower than asked.

/// Coefficient of restitution of a contact with the damping ratio b >= 0. If the contact may pull, it ends where the
/// overlap is zero: e = exp(-pi b/sqrt(1 - b^2)), zero from critical damping on. If it never pulls, it ends where the
/// force is zero, which is earlier: e = exp(-2 b acos(b)/sqrt(1 - b^2)), with acosh and b^2 - 1 for b > 1 (Schwager and
/// Poeschel 2007, doi:10.1007/s10035-007-0065-z).
inline double restitution_of(double damping_ratio, bool may_pull = false) {
  const double b = require_non_negative(damping_ratio, "damping ratio", "(no unit)");
  const double rest = std::sqrt(std::abs(1.0 - b * b));
  if (may_pull) return b < 1.0 ? std::exp(-std::numbers::pi * b / rest) : 0.0;
  if (std::abs(1.0 - b) < 1e-6) return std::exp(-2.0 * b * (1.0 + (1.0 - b) / 3.0));  // acos(b)/sqrt(1 - b^2)
  return std::exp(-2.0 * b * (b < 1.0 ? std::acos(b) : std::acosh(b)) / rest);
}

/// The damping ratio with which a contact has the restitution e. Throws Error unless 0.01 <= e <= 1.
inline double damping_ratio_of(double restitution, bool may_pull = false) {
  require_within(restitution, 0.01, 1.0, "coefficient of restitution");
  const double loss = -std::log(restitution);
  if (may_pull) return loss / std::sqrt(std::numbers::pi * std::numbers::pi + loss * loss);
  // e falls with b, and at b = 1 + 1/(2 sqrt(e)) it is lower than asked: halve what is between until nothing is left.
  double low = 0.0, high = 1.0 + 0.5 / std::sqrt(restitution);
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return restitution == 1.0 ? 0.0 : 0.5 * (low + high);
}

}  // namespace dem::contact
