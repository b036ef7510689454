#pragma once

#include <dem/math/vector.hpp>

#include <cmath>
#include <type_traits>

namespace dem::shape {

/// m^e of numbers m >= 0 for an exponent e >= 0 that is fixed at set-up: whole exponents up to 64 by repeated
/// multiplication, others by pow, which costs many times as much.
class Power {
 public:
  Power() = default;
  explicit Power(double exponent) : exponent_(exponent) {
    if (exponent == std::floor(exponent) && exponent <= 64.0) whole_ = static_cast<int>(exponent);
  }

  template <class T>
  DEM_HOT T operator()(T m) const {
    if (whole_ >= 0) {
      T result = T(1);
      for (int n = whole_; n > 0; n >>= 1) {
        if ((n & 1) != 0) result = result * m;
        m = m * m;
      }
      return result;
    }
    if constexpr (std::is_same_v<T, double>) {
      return std::pow(m, exponent_);
    } else {
      return generate([&](int k) { return std::pow(lane(m, k), exponent_); });
    }
  }
  /// Of three numbers at once: their chains of multiplications run side by side.
  DEM_HOT Vector3<double> operator()(Vector3<double> m) const {
    if (whole_ < 0) return {std::pow(m.x, exponent_), std::pow(m.y, exponent_), std::pow(m.z, exponent_)};
    Vector3<double> result = {1, 1, 1};
    for (int n = whole_; n > 0; n >>= 1) {
      if ((n & 1) != 0) result = {result.x * m.x, result.y * m.y, result.z * m.z};
      m = {m.x * m.x, m.y * m.y, m.z * m.z};
    }
    return result;
  }

 private:
  double exponent_ = 0.0;
  int whole_ = -1;  // the exponent, if whole
};

}  // namespace dem::shape
