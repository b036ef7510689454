#pragma once

#include <dem/core/error.hpp>
#include <dem/geometry/edge_set.hpp>
#include <dem/math/fingerprint.hpp>

#include <cmath>

namespace dem::surface {

/// A solid box, centred in its own frame. A sphere touches it once: on a face, an edge or a corner.
class Box {
 public:
  /// Edge lengths in m. Other bodies are shown the corners and, where an edge is cut into more pieces than one, the
  /// points between. Throws Error unless all edges are positive, for less than 1 piece or
  /// more than 1000.
  explicit Box(const Vec3& edges, int pieces = 1)
      : half_{0.5 * edges.x(), 0.5 * edges.y(), 0.5 * edges.z()}, pieces_(pieces) {
    for (int k = 0; k < 3; ++k) require_positive(edges[k], "edge length of a box", "m");
    require_within(pieces, 1, 1000, "pieces of an edge of a box");
  }

  Vec3 edges() const { return 2.0 * to_eigen(half_); }
  std::uint64_t fingerprint() const { return fingerprint_of(half_, pieces_); }

  template <class T>
  DEM_HOT auto near(const Vector3<T>& p, const T& radius) const {
    const T x = outside(p.x, half_.x), y = outside(p.y, half_.y), z = outside(p.z, half_.z);
    return x * x + y * y + z * z <= radius * radius;  // also for points (radius 0) inside
  }

  template <class Callback>
  DEM_HOT void contacts(const Vector3<double>& p, double radius, Callback&& callback) const {
    // From the point to the nearest point of the solid box.
    const Vector3<double> to_box = {clamped(p.x, half_.x) - p.x, clamped(p.y, half_.y) - p.y,
                                    clamped(p.z, half_.z) - p.z};
    const double distance2 = dot(to_box, to_box);
    if (distance2 >= radius * radius) {
      if (distance2 > 0.0 || radius > 0.0) return;
    }
    if (distance2 > 0.0) {
      const double distance = std::sqrt(distance2);
      callback(0u, (1.0 / distance) * to_box, distance);
      return;
    }
    // The centre is inside: out through the nearest face.
    const double dx = std::abs(p.x) - half_.x, dy = std::abs(p.y) - half_.y, dz = std::abs(p.z) - half_.z;
    Vector3<double> normal = {0, 0, 0};
    if (dx >= dy && dx >= dz) {
      normal.x = p.x < 0.0 ? 1.0 : -1.0;
      callback(0u, normal, dx);
    } else if (dy >= dz) {
      normal.y = p.y < 0.0 ? 1.0 : -1.0;
      callback(0u, normal, dy);
    } else {
      normal.z = p.z < 0.0 ? 1.0 : -1.0;
      callback(0u, normal, dz);
    }
  }

  /// Points for contact with other surfaces: callback(number, point, radius), numbers ascending.
  template <class Callback>
  void points(const Aabb&, Callback&& callback) const {
    for_each_point([&](std::uint32_t k, const Vector3<double>& p) { callback(k, p, 0.0); });
  }
  /// For grains that offer penetration(), within a radius of p: corners 0 to 7, and from 8 on points of the edges near
  /// p (points_of_edge): callback(number, point, weight).
  template <class Callback>
  void corners(const Vector3<double>& p, double radius, Callback&& callback) const {
    if (!near(p, radius)) return;
    for (std::uint32_t k = 0; k < 8; ++k) {
      const Vector3<double> c = {k & 1u ? half_.x : -half_.x, k & 2u ? half_.y : -half_.y, k & 4u ? half_.z : -half_.z};
      if (dot(c - p, c - p) <= radius * radius) callback(k, c, 1.0);
    }
    edges({}, [&](std::uint32_t edge, const Vector3<double>& tail, const Vector3<double>& head) {
      points_of_edge(tail, head, p, radius, [&](std::uint32_t place, const Vector3<double>& c, double weight) {
        callback(8 + 3 * ((edge - first_edge) / most_parts) + place, c, weight);
      });
    });
  }
  bool has_points() const { return true; }
  /// The edges, for contact with other bodies: callback(number, one end, other end), most_parts numbers an edge.
  template <class Callback>
  void edges(const Aabb&, Callback&& callback) const {
    const double half[3] = {half_.x, half_.y, half_.z};
    for (std::uint32_t k = 0; k < 12; ++k) {
      const std::uint32_t axis = k / 4;
      double tail[3], head[3];
      tail[axis] = -half[axis];
      head[axis] = half[axis];
      for (std::uint32_t i = 1; i <= 2; ++i) {
        const std::uint32_t across = (axis + i) % 3;
        tail[across] = head[across] = (k >> (i - 1) & 1u) != 0 ? half[across] : -half[across];
      }
      callback(first_edge + most_parts * k, Vector3<double>{tail[0], tail[1], tail[2]},
               Vector3<double>{head[0], head[1], head[2]});
    }
  }
  /// Cuts the range of shares of the way from tail to head to what lies in the box; false if nothing is left.
  bool clip(const Vector3<double>& tail, const Vector3<double>& head, double& from, double& to) const {
    const Vector3<double> d = head - tail;
    return clip_between(tail.x, d.x, half_.x, from, to) && clip_between(tail.y, d.y, half_.y, from, to) &&
           clip_between(tail.z, d.z, half_.z, from, to);
  }

  Aabb bounds() const { return {-to_eigen(half_), to_eigen(half_)}; }

 private:
  static constexpr std::uint32_t first_edge = 12 * 1001;  ///< beyond the numbers of points

  /// How far a coordinate lies outside [-limit, limit].
  template <class T>
  static DEM_HOT T outside(const T& value, double limit) {
    return max(max(value, -value) - T(limit), T(0));
  }
  static DEM_HOT double clamped(double value, double limit) { return max(-limit, min(limit, value)); }

  /// Edge by edge: four along each axis, each from its lower corner on; the upper corners belong to the edges along x.
  template <class F>
  void for_each_point(F&& f) const {
    const double half[3] = {half_.x, half_.y, half_.z};
    std::uint32_t number = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 4; ++side) {
        const int first = axis == 0 ? 0 : 1, last = axis == 0 ? pieces_ : pieces_ - 1;
        for (int k = first; k <= last; ++k) {
          double x[3];
          x[axis] = (2.0 * k / pieces_ - 1.0) * half[axis];
          x[(axis + 1) % 3] = (side & 1) != 0 ? half[(axis + 1) % 3] : -half[(axis + 1) % 3];
          x[(axis + 2) % 3] = (side & 2) != 0 ? half[(axis + 2) % 3] : -half[(axis + 2) % 3];
          f(number++, Vector3<double>{x[0], x[1], x[2]});
        }
      }
    }
  }

  Vector3<double> half_;
  int pieces_;
};

}  // namespace dem::surface
