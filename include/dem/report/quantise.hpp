#pragma once
// Numbers of a replay in few bits, with what that costs.

#include <dem/math/vector.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace dem::report {

/// A box along the global axes (m).
struct Box {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// A coordinate in 65,536 steps from `low` to `high` (m); off by at most half a step, (high - low) / 131070. What lies
/// outside is put on the border.
[[nodiscard]] inline std::uint16_t pack_coordinate(double x, double low, double high) {
  const double share = high > low ? (x - low) / (high - low) : 0.0;
  return static_cast<std::uint16_t>(std::lround(65535.0 * (share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share)));
}
[[nodiscard]] inline double unpack_coordinate(std::uint16_t steps, double low, double high) {
  return low + steps / 65535.0 * (high - low);
}

/// The quaternion (w, x, y, z) of a rotation, through its largest component, so that no angle loses digits.
[[nodiscard]] inline std::array<double, 4> quaternion_of(const Mat3& r) {
  const double xx = r(0, 0), yy = r(1, 1), zz = r(2, 2);
  const std::array<double, 4> squares = {1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz};
  std::size_t most = 0;
  for (std::size_t k = 1; k < 4; ++k) most = squares[k] > squares[most] ? k : most;
  const double wx = r(2, 1) - r(1, 2), wy = r(0, 2) - r(2, 0), wz = r(1, 0) - r(0, 1);
  const double xy = r(0, 1) + r(1, 0), xz = r(0, 2) + r(2, 0), yz = r(1, 2) + r(2, 1);
  std::array<double, 4> q = most == 0   ? std::array<double, 4>{squares[0], wx, wy, wz}
                            : most == 1 ? std::array<double, 4>{wx, squares[1], xy, xz}
                            : most == 2 ? std::array<double, 4>{wy, xy, squares[2], yz}
                                        : std::array<double, 4>{wz, xz, yz, squares[3]};
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& component : q) component /= length;
  return q;
}

/// A rotation in 32 bits: which component of its quaternion is the largest (bits 30 and 31; w, x, y, z), and the other
/// three in 1023 steps from -1/sqrt(2) to 1/sqrt(2) (bits 0, 10 and 20), all with the sign that makes the largest one
/// positive. No rotation at all is kept exactly; others are off by at most 4.9e-3 rad (0.28 degrees): each of the three
/// is off by h = 6.92e-4, the largest, which is at least 1/2, by up to 3 h, and an angle by twice the length of these
/// four.
[[nodiscard]] inline std::uint32_t pack_rotation(const std::array<double, 4>& q) {
  std::size_t most = 0;
  for (std::size_t k = 1; k < 4; ++k) most = std::abs(q[k]) > std::abs(q[most]) ? k : most;
  const double scale = q[most] < 0.0 ? -std::sqrt(2.0) * 511.0 : std::sqrt(2.0) * 511.0;
  auto packed = static_cast<std::uint32_t>(most) << 30U;
  unsigned shift = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == most) continue;
    const long steps = std::lround(scale * q[k]);
    packed |= static_cast<std::uint32_t>(511 + (steps < -511 ? -511 : steps > 511 ? 511 : steps)) << shift;
    shift += 10;
  }
  return packed;
}
/// The quaternion (w, x, y, z) of a packed rotation.
[[nodiscard]] inline std::array<double, 4> unpack_rotation(std::uint32_t packed) {
  const std::size_t most = packed >> 30U;
  std::array<double, 4> q = {};
  double rest = 1.0;
  unsigned shift = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == most) continue;
    q[k] = (static_cast<double>(packed >> shift & 1023U) - 511.0) / (std::sqrt(2.0) * 511.0);
    rest -= q[k] * q[k];
    shift += 10;
  }
  q[most] = std::sqrt(rest > 0.0 ? rest : 0.0);
  return q;
}

/// A number from 0 to `most` in 256 steps of its square root, fine where it is small: off by at most
/// sqrt(value most)/255 + most/260100.
[[nodiscard]] inline std::uint8_t pack_scalar(double value, double most) {
  const double share = most > 0.0 ? value / most : 0.0;
  return static_cast<std::uint8_t>(std::lround(255.0 * std::sqrt(share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share)));
}
[[nodiscard]] inline double unpack_scalar(std::uint8_t steps, double most) {
  return (steps / 255.0) * (steps / 255.0) * most;
}

}  // namespace dem::report
