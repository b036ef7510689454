#pragma once

#include <dem/core/error.hpp>
#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>

namespace dem::soil {

/// How an average weights what is near. The integral of each kernel over all space is 1.
class Kernel {
 public:
  /// Each cell of the grid by itself: 1/V in the cell, 0 outside. Exact balances, and jumps from cell to cell.
  static Kernel cell() { return {}; }
  /// Lucy (1977, doi:10.1086/112164): 105/(16 pi c^3) (1 + 3 r/c) (1 - r/c)^3 up to the reach c (m). Smooth and of
  /// finite reach. Throws Error unless the reach is positive.
  static Kernel lucy(double reach) {
    require_positive(reach, "reach of Lucy's kernel", "m");
    return {Shape::lucy, reach, reach, 105.0 / (16.0 * M_PI * reach * reach * reach)};
  }
  /// exp(-r^2/(2 w^2)) of the width w (m), cut off at 3 w and made whole again. Throws Error unless the width is
  /// positive.
  static Kernel gaussian(double width) {
    require_positive(width, "width of a Gaussian kernel", "m");
    const double root = 2.50662827463100050242, w3 = width * width * width;  // sqrt(2 pi)
    const double whole = w3 * (root * root * root * std::erf(3.0 / std::sqrt(2.0)) - 12.0 * M_PI * std::exp(-4.5));
    return {Shape::gaussian, 3.0 * width, width, 1.0 / whole};
  }

  bool is_cell() const { return shape_ == Shape::cell; }
  double reach() const { return reach_; }  ///< m; 0 of cell()

  /// 1/m^3, at a distance (squared, m^2). Not of cell().
  double at(double distance2) const {
    if (distance2 >= reach_ * reach_) return 0.0;
    if (shape_ == Shape::gaussian) return factor_ * std::exp(-0.5 * distance2 / (width_ * width_));
    const double q = std::sqrt(distance2) / reach_, rest = 1.0 - q;
    return factor_ * (1.0 + 3.0 * q) * rest * rest * rest;
  }

  /// 1/m^3, the mean along the line from a to b, seen from x (m). The part of the line within reach is cut where it is
  /// nearest to x, and each part is summed by Gauss's five points. Not of cell().
  double along(const Vec3& a, const Vec3& b, const Vec3& x) const {
    const Vec3 d = b - a, out = a - x;
    const double length2 = d.squaredNorm();
    if (length2 == 0.0) return at(out.squaredNorm());
    const double foot = -out.dot(d) / length2, least2 = out.squaredNorm() - foot * foot * length2;
    const double half2 = (reach_ * reach_ - least2) / length2;
    if (half2 <= 0.0) return 0.0;
    const double half = std::sqrt(half2), first = std::max(0.0, foot - half), last = std::min(1.0, foot + half);
    if (first >= last) return 0.0;
    const double middle = std::clamp(foot, first, last);
    const auto part = [&](double from, double to) {
      static constexpr double place[] = {0.0, 0.53846931010568309104, 0.90617984593866399280};
      static constexpr double weight[] = {0.56888888888888888889, 0.47862867049936646804, 0.23692688505618908751};
      double sum = 0.0;
      for (int k = -2; k <= 2; ++k) {
        const double s = 0.5 * (from + to) + (k < 0 ? -0.5 : 0.5) * place[std::abs(k)] * (to - from);
        sum += weight[std::abs(k)] * at(std::max(0.0, least2) + (s - foot) * (s - foot) * length2);
      }
      return 0.5 * (to - from) * sum;
    };
    return part(first, middle) + part(middle, last);
  }

 private:
  enum class Shape { cell, lucy, gaussian };
  Kernel(Shape shape = Shape::cell, double reach = 0.0, double width = 0.0, double factor = 0.0)
      : shape_(shape), reach_(reach), width_(width), factor_(factor) {}

  Shape shape_;
  double reach_, width_, factor_;
};

}  // namespace dem::soil
