#pragma once

#include <dem/geometry/polyhedron/polyhedron.hpp>

#include <cstdint>
#include <numbers>
#include <random>

namespace dem::shape {

// Ready-made polyhedra. All throw Error unless lengths are positive.

/// A box with the given edge lengths (m) along the axes of its frame.
inline Polyhedron box(const Vec3& edges) {
  for (int k = 0; k < 3; ++k) require_positive(edges[k], "edge length of a box", "m");
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) {
    const Vec3 sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    corners.push_back(0.5 * componentwise(sign, edges));
  }
  return Polyhedron(corners);
}
/// A cube of half-edge h (m): what shape::cube8 makes of eight spheres, with sharp edges.
inline Polyhedron cube(double half_edge) { return box(filled(2.0 * half_edge)); }

namespace detail {

/// Corners on a sphere of the given radius (m).
inline Polyhedron on_sphere(std::vector<Vec3> corners, double radius) {
  require_positive(radius, "circumscribed radius of a polyhedron", "m");
  for (Vec3& p : corners) p *= radius / p.norm();
  return Polyhedron(corners);
}

}  // namespace detail

/// Regular bodies by their circumscribed radius (m).
inline Polyhedron tetrahedron(double radius) {
  return detail::on_sphere({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, radius);
}
inline Polyhedron octahedron(double radius) {
  return detail::on_sphere({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, radius);
}
inline Polyhedron icosahedron(double radius) {
  std::vector<Vec3> corners;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-std::numbers::phi, std::numbers::phi}) {
      corners.insert(corners.end(), {Vec3(0, s, t), Vec3(s, t, 0), Vec3(t, 0, s)});
    }
  }
  return detail::on_sphere(corners, radius);
}
inline Polyhedron dodecahedron(double radius) {
  constexpr double p = std::numbers::phi, q = 1.0 / p;
  std::vector<Vec3> corners;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-1.0, 1.0}) {
      corners.insert(corners.end(), {Vec3(0, s * q, t * p), Vec3(s * q, t * p, 0), Vec3(t * p, 0, s * q)});
      corners.insert(corners.end(), {Vec3(s, t, -1), Vec3(s, t, 1)});
    }
  }
  return detail::on_sphere(corners, radius);
}

/// A prism along z: a regular polygon with `sides` corners on a circle of the given radius (m), `height` (m) tall.
/// Throws Error unless there are 3 to 32 sides.
inline Polyhedron prism(int sides, double radius, double height) {
  require_within(sides, 3, PolyhedronTables::most_corners / 2, "number of sides of a prism");
  require_positive(radius, "radius of a prism", "m");
  require_positive(height, "height of a prism", "m");
  std::vector<Vec3> corners;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / sides;
    for (const double z : {-0.5, 0.5}) {
      corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z * height);
    }
  }
  return Polyhedron(corners);
}

/// What a rock is to look like.
struct RockOptions {
  double length = 1e-3;     ///< m, longest edge of the box about it
  double elongation = 0.8;  ///< intermediate over longest edge of that box, in (0, 1]
  double flatness = 0.8;    ///< shortest over intermediate edge of that box, in (0, 1]
  int points = 24;          ///< drawn evenly on an ellipsoid; 6 to 64; most become corners
  std::uint64_t seed = 1;
};

/// A rock: the convex hull of points on an ellipsoid, scaled to the box that was asked for. The same seed gives the
/// same rock everywhere. Throws Error if a number is out of range.
inline Polyhedron rock(const RockOptions& o) {
  require_positive(o.length, "length of a rock", "m");
  require_within(o.elongation, 0.05, 1.0, "elongation of a rock (intermediate over longest edge)");
  require_within(o.flatness, 0.05, 1.0, "flatness of a rock (shortest over intermediate edge)");
  require_within(o.points, 6, PolyhedronTables::most_corners, "number of points of a rock");
  std::mt19937_64 random(o.seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  std::vector<Vec3> points;
  Vec3 low = filled(1e300), high = -low;
  for (int k = 0; k < o.points; ++k) {
    const double z = 2.0 * uniform() - 1.0, angle = 2.0 * std::numbers::pi * uniform(), r = std::sqrt(1.0 - z * z);
    points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    low = lower(low, points.back());
    high = upper(high, points.back());
  }
  const Vec3 wanted = o.length * Vec3(1.0, o.elongation, o.elongation * o.flatness);
  const Vec3 size = high - low;
  for (Vec3& p : points) {
    for (int k = 0; k < 3; ++k) p[k] = (p[k] - low[k]) / size[k] * wanted[k];
  }
  return Polyhedron(points);
}

}  // namespace dem::shape
