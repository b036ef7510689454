#pragma once

#include <dem/math/vector.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace dem {

/// Repeatable random numbers: the same seed gives the same numbers with every compiler and library. SplitMix64 (Steele,
/// Lea and Flood 2014, doi 10.1145/2714064.2660195): 64 bits of state, each number comes up once in 2^64. The state is
/// part of what saved worlds hold.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed = 1) : state_(seed) {}

  template <class V>
  void fields(V& v) {
    v("state", state_);
  }

  /// 64 random bits.
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Even in [0, 1), with 53 random bits.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// Even in [low, high).
  double between(double low, double high) { return low + (high - low) * uniform(); }
  /// Even in a box.
  Vec3 in_box(const Vec3& low, const Vec3& high) {
    const double x = between(low.x(), high.x()), y = between(low.y(), high.y());
    return {x, y, between(low.z(), high.z())};
  }
  /// Even in a ball about the origin.
  Vec3 in_ball(double radius) {
    for (;;) {
      const Vec3 x = in_box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
      if (eager::dot3(x.data(), 1, x.data()) <= 1.0) return radius * x;
    }
  }
  /// A rotation drawn evenly from all rotations (K. Shoemake, Graphics Gems III, 1992).
  Mat3 rotation() {
    const double u = uniform(), a = 2.0 * std::numbers::pi * uniform(), b = 2.0 * std::numbers::pi * uniform();
    const double s = std::sqrt(1.0 - u), t = std::sqrt(u);
    const double w = t * std::cos(b), x = s * std::sin(a), y = s * std::cos(a), z = t * std::sin(b);
    return to_eigen(Matrix3<double>{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
                                    {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
                                    {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}});
  }

 private:
  std::uint64_t state_;
};

}  // namespace dem
