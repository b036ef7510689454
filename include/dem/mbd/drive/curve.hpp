#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>
#include <vector>

namespace dem::mbd {

/// A table y(x) with straight lines between its points: force over length, torque over speed. Outside its range it goes
/// on with the slope of its last piece, unless it is `held_outside`.
class Curve {
 public:
  Curve() = default;
  /// Points (x, y) in rising x, at least two. Throws Error if x does not rise or a value is not finite.
  Curve(std::vector<std::pair<double, double>> points);
  Curve(std::initializer_list<std::pair<double, double>> points)
      : Curve(std::vector<std::pair<double, double>>(points)) {}

  /// y = y0 + slope x.
  static Curve line(double y0, double slope) { return {{0.0, y0}, {1.0, y0 + slope}}; }

  /// The same curve, that keeps its first and last value outside its range.
  Curve held_outside() const;

  bool is_held_outside() const { return held_; }

  double operator()(double x) const;
  double slope(double x) const;
  /// The steepest slope, by size: what limits the time step.
  double steepest() const;
  /// The integral of y from x = a to b: exact, over every piece and what goes on outside. Negative where b < a.
  double integral(double a, double b) const;
  /// Where the curve is 0: the first place within it, or beyond its ends as far as it goes on. `otherwise` if nowhere.
  double zero_or(double otherwise) const;
  bool empty() const { return points_.empty(); }
  const std::vector<std::pair<double, double>>& points() const { return points_; }

  template <class V>
  void fields(V& v) {
    v.given("points", points_), v.given("held_outside", held_);
  }

 private:
  using Point = std::pair<double, double>;
  static double crossing(const Point& p, const Point& q) {
    return p.first - p.second * (q.first - p.first) / (q.second - p.second);
  }
  std::pair<const Point&, const Point&> piece(double x) const;

  std::vector<Point> points_;
  bool held_ = false;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE Curve::Curve(std::vector<std::pair<double, double>> points) : points_(std::move(points)) {  // NOLINT
  if (points_.size() < 2) fail("a curve has {} points, but needs at least 2", points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!std::isfinite(points_[i].first) || !std::isfinite(points_[i].second)) {
      fail("point {} of a curve is ({:g}, {:g}), but must be finite", i, points_[i].first, points_[i].second);
    }
    if (i > 0 && !(points_[i].first > points_[i - 1].first)) {
      fail("point {} of a curve has x = {:g} after x = {:g}: x must rise from point to point; sort the table", i,
           points_[i].first, points_[i - 1].first);
    }
  }
}

DEM_INLINE Curve Curve::held_outside() const {
  Curve c = *this;
  c.held_ = true;
  return c;
}

DEM_INLINE double Curve::operator()(double x) const {
  const auto& [p, q] = piece(x);
  if (held_ && x <= points_.front().first) return points_.front().second;
  if (held_ && x >= points_.back().first) return points_.back().second;
  return p.second + (q.second - p.second) / (q.first - p.first) * (x - p.first);
}

DEM_INLINE double Curve::slope(double x) const {
  if (held_ && (x < points_.front().first || x > points_.back().first)) return 0.0;
  const auto& [p, q] = piece(x);
  return (q.second - p.second) / (q.first - p.first);
}

DEM_INLINE double Curve::steepest() const {
  double s = 0.0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    s = std::max(s, std::abs((points_[i].second - points_[i - 1].second) / (points_[i].first - points_[i - 1].first)));
  }
  return s;
}

DEM_INLINE double Curve::integral(double a, double b) const {
  if (b < a) return -integral(b, a);
  double sum = 0.0, x = a;
  const auto area_to = [&](double to) {
    sum += 0.5 * ((*this)(x) + (*this)(to)) * (to - x);
    x = to;
  };
  for (const Point& p : points_) {
    if (p.first > x && p.first < b) area_to(p.first);
  }
  area_to(b);
  return sum;
}

DEM_INLINE double Curve::zero_or(double otherwise) const {
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Point &p = points_[i - 1], &q = points_[i];
    if (p.second == 0.0) return p.first;
    if ((p.second < 0.0) != (q.second < 0.0) || q.second == 0.0) return crossing(p, q);
  }
  if (held_ || points_.empty()) return otherwise;
  const auto n = points_.size();
  const double below = crossing(points_[0], points_[1]), above = crossing(points_[n - 2], points_[n - 1]);
  if (above > points_.back().first && std::isfinite(above)) return above;
  return below < points_.front().first && std::isfinite(below) ? below : otherwise;
}

DEM_INLINE std::pair<const Curve::Point&, const Curve::Point&> Curve::piece(double x) const {
  const auto above = std::upper_bound(points_.begin() + 1, points_.end() - 1, x,
                                      [](double value, const Point& p) { return value < p.first; });
  return {*(above - 1), *above};
}

}  // namespace dem::mbd

#endif
