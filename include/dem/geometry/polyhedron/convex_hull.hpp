#pragma once

#include <dem/core/error.hpp>
#include <dem/math/vector.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <vector>

namespace dem {

using Triangle = std::array<int, 3>;

/// Convex hull of a cloud of points as triangles, counter-clockwise from outside, that name points of the cloud.
/// Quickhull (Barber, Dobkin and Huhdanpaa 1996, DOI 10.1145/235815.235821) without its lists of outside points: each
/// round takes the point that stands out furthest and replaces the triangles that see it. Points that stand out by less
/// than some 1e-8 of the cloud's size are left out, and points within 1e-9 of each other are one.
///
/// Where points are off a common plane by about as much, rounding may say that a point sees triangles which do not hang
/// together, and the hull would not close. It is then made again of points that are shifted at random by 1e-7 of the
/// size, which leaves nothing to rounding (as Qhull's option QJ does), until it closes; points amid faces and edges may
/// then be corners.
class HullBuilder {
 public:
  /// Throws Error unless there are four finite points that do not lie in one plane.
  explicit HullBuilder(std::span<const Vec3> points) : points_(points.begin(), points.end()) {
    if (points.size() < 4) fail("a convex hull was given {} points, but needs at least 4", points.size());
    Vec3 low = points[0], high = points[0];
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (!is_finite(points[k])) fail("point {} of a convex hull is not finite", k);
      low = lower(low, points[k]);
      high = upper(high, points[k]);
    }
    size_ = (high - low).norm();
    middle_ = 0.5 * (low + high);
    merge_points();
    const std::vector<Vec3> given = points_;
    for (unsigned attempt = 0; attempt < most_attempts; ++attempt) {
      if (attempt > 0) shift(given, attempt);
      if (build()) return;
    }
    fail(
        "no convex hull of {} points was found that closes, not even with the points shifted by {:.2g} m; points that "
        "are nearly in a plane or a line, by less than that, should be left out",
        points.size(), 1e-7 * size_);
  }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> result;
    const auto named = [&](int k) { return name_[static_cast<std::size_t>(k)]; };
    for (const Facet& f : facets_) result.push_back({named(f.corner[0]), named(f.corner[1]), named(f.corner[2])});
    return result;
  }

 private:
  struct Facet {
    Triangle corner;
    Vec3 normal;
    double offset;
  };

  static constexpr unsigned most_attempts = 20;
  static constexpr double least_rise = 1e-9;  ///< of the size, of a point that is taken in

  /// Keeps one of points that are the same but for rounding: shifted apart, they would be corners of slivers.
  void merge_points() {
    std::vector<int> by_x(points_.size());
    std::iota(by_x.begin(), by_x.end(), 0);
    std::sort(by_x.begin(), by_x.end(),
              [&](int a, int b) { return std::pair(at(a).x(), a) < std::pair(at(b).x(), b); });
    const double near = 1e-9 * size_;
    std::vector<char> gone(points_.size(), 0);
    for (std::size_t k = 0; k < by_x.size(); ++k) {
      if (gone[static_cast<std::size_t>(by_x[k])]) continue;
      for (std::size_t m = k + 1; m < by_x.size() && at(by_x[m]).x() - at(by_x[k]).x() <= near; ++m) {
        if ((at(by_x[m]) - at(by_x[k])).norm() <= near) gone[static_cast<std::size_t>(by_x[m])] = 1;
      }
    }
    std::vector<Vec3> kept;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (gone[k]) continue;
      kept.push_back(points_[k]);
      name_.push_back(static_cast<int>(k));
    }
    points_ = std::move(kept);
  }

  void shift(std::span<const Vec3> points, unsigned seed) {
    std::minstd_rand random(seed);
    const auto number = [&] { return static_cast<double>(random()) / std::minstd_rand::max() - 0.5; };
    for (std::size_t k = 0; k < points.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis) points_[k][axis] = points[k][axis] + 2e-7 * size_ * number();
    }
    slack_ = tilt_ = 0.0;
  }

  /// Whether it came out closed, with no point outside.
  bool build() {
    first_tetrahedron();
    std::vector<bool> taken(points_.size(), false);
    for (const Facet& f : facets_) {
      for (const int k : f.corner) taken[static_cast<std::size_t>(k)] = true;
    }
    for (;;) {
      const int next = furthest([&](const Vec3& p) { return outermost(p); });
      if (outermost(at(next)) <= least_rise * size_) break;
      if (taken[static_cast<std::size_t>(next)]) return false;  // its own triangles do not hold it
      taken[static_cast<std::size_t>(next)] = true;
      take(next);
    }
    return is_closed();
  }

  bool is_closed() const {
    std::set<std::array<int, 2>> runs;
    for (const Facet& f : facets_) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (!runs.insert({f.corner[k], f.corner[(k + 1) % 3]}).second) return false;
      }
    }
    std::set<int> corners;
    for (const auto& [from, to] : runs) {
      if (!runs.contains({to, from})) return false;
      corners.insert(from);
    }
    if (facets_.size() != 2 * corners.size() - 4) return false;  // Euler, for triangles
    return std::all_of(points_.begin(), points_.end(), [&](const Vec3& p) { return outermost(p) < 1e-6 * size_; });
  }

  Facet facet(int a, int b, int c) const {
    const Vec3 normal = cross(at(b) - at(a), at(c) - at(a)).normalized();
    return {{a, b, c}, normal, normal.dot(at(a))};
  }
  const Vec3& at(int k) const { return points_[static_cast<std::size_t>(k)]; }

  /// The point for which f is largest. A small strictly convex term decides between points that are equally far out. So
  /// only true corners of the hull are taken, never points in the middle of an edge or a face.
  template <class F>
  int furthest(F&& f) const {
    int best = 0;
    double most = -1e300;
    for (int k = 0; k < static_cast<int>(points_.size()); ++k) {
      const double value = f(at(k)) + tilt_ * (at(k) - middle_).squaredNorm() / size_;
      if (value > most) {
        most = value;
        best = k;
      }
    }
    return best;
  }

  void first_tetrahedron() {
    const int a = furthest([&](const Vec3& p) { return (p - middle_).norm(); });
    const int b = furthest([&](const Vec3& p) { return (p - at(a)).norm(); });
    const Vec3 along = (at(b) - at(a)).normalized();
    const int c = furthest([&](const Vec3& p) { return cross(p - at(a), along).norm(); });
    const Vec3 normal = cross(at(b) - at(a), at(c) - at(a)).normalized();
    const int d = furthest([&](const Vec3& p) { return std::abs(normal.dot(p - at(a))); });
    const double thickness = std::abs(normal.dot(at(d) - at(a)));
    if (!(size_ > 0.0) || !(thickness > 1e-6 * size_)) {
      fail("the points of a convex hull lie in one plane: they are {:g} m across, but only {:.3g} m thick", size_,
           size_ > 0.0 ? thickness : 0.0);
    }
    const Vec3 inside = 0.25 * (at(a) + at(b) + at(c) + at(d));
    facets_ = {facet(a, b, c), facet(a, b, d), facet(b, c, d), facet(c, a, d)};
    for (Facet& f : facets_) {
      if (f.normal.dot(inside) > f.offset) f = facet(f.corner[0], f.corner[2], f.corner[1]);
    }
  }

  /// How far a point is above the plane of the triangle that it is highest above.
  double outermost(const Vec3& p) const {
    double most = -1e300;
    for (const Facet& f : facets_) most = std::max(most, f.normal.dot(p) - f.offset);
    return most;
  }

  /// Takes one more corner in.
  void take(int next) {
    std::vector<Facet> kept;
    std::vector<std::array<int, 2>> rim;  // directed edges of the facets that go
    for (const Facet& f : facets_) {
      if (f.normal.dot(at(next)) - f.offset <= slack_ * size_) {
        kept.push_back(f);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) rim.push_back({f.corner[k], f.corner[(k + 1) % 3]});
    }
    for (const auto& edge : rim) {
      const bool inner = std::find(rim.begin(), rim.end(), std::array<int, 2>{edge[1], edge[0]}) != rim.end();
      if (!inner) kept.push_back(facet(edge[0], edge[1], next));
    }
    facets_ = kept;
  }

  std::vector<Vec3> points_;
  std::vector<int> name_;  ///< place of each in the cloud
  std::vector<Facet> facets_;
  double size_ = 0.0;
  double slack_ = least_rise;  ///< of the size, by which a point must be above a plane to see it
  double tilt_ = 1e-7;         ///< share of the strictly convex function
  Vec3 middle_ = Vec3::Zero();
};

inline std::vector<Triangle> convex_hull(std::span<const Vec3> points) { return HullBuilder(points).triangles(); }

}  // namespace dem
