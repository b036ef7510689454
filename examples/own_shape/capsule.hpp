#pragma once

#include <dem/geometry/contact_point.hpp>
#include <dem/math/vector.hpp>

#include <algorithm>
#include <numbers>

struct Capsule {  // all that is within `radius` of a line of length 2 `half`, along z of the grain's frame
  static constexpr int pose_size = 3;  // cached for each grain: half the line, in global axes
  static constexpr bool has_orientation = true;
  static constexpr std::size_t most_contacts = 1;
  template <class T>
  using PairContactPoint = dem::contact::ContactPoint<T>;
  using V = dem::Vector3<double>;

  double half, radius;  // m

  double bounding_radius() const { return half + radius; }
  double cylinder() const { return 2 * std::numbers::pi * half * radius * radius; }
  double ball() const { return 4.0 / 3 * std::numbers::pi * radius * radius * radius; }
  double volume() const { return cylinder() + ball(); }
  dem::Vec3 unit_inertia() const {  // principal moments about the centre, of density 1
    const double r2 = radius * radius, ends = half * half + 0.75 * half * radius;
    const double across = cylinder() * (r2 / 4 + half * half / 3) + ball() * (0.4 * r2 + ends);
    return {across, across, cylinder() * 0.5 * r2 + ball() * 0.4 * r2};
  }
  static V line(const double* pose) { return {pose[0], pose[1], pose[2]}; }
  void orient(const dem::Matrix3<double>& rotation, double* pose) const {
    const V along = half * (rotation * V{0, 0, 1});
    pose[0] = along.x, pose[1] = along.y, pose[2] = along.z;
  }
  template <class Callback>
  static void collide(const Capsule& a, const double* pose_a, const Capsule& b, const double* pose_b,
                      const V& separation, Callback&& callback) {
    // Nearest points s u and separation + t v of the lines, s and t from -1 to 1, by turns: each comes nearer by the
    // square of the cosine between the lines, and where they are nearly parallel any points will do.
    const V u = line(pose_a), v = line(pose_b);
    double s = 0.0, t = 0.0;
    for (int k = 0; k < 20; ++k) {
      s = std::clamp(dot(separation + t * v, u) / dot(u, u), -1.0, 1.0);
      t = std::clamp(dot(s * u - separation, v) / dot(v, v), -1.0, 1.0);
    }
    const V link = separation + t * v - s * u;
    const double distance = norm(link), overlap = a.radius + b.radius - distance;
    if (!(overlap > 0.0 && distance > 0.0)) return;
    const V normal = 1.0 / distance * link;
    callback(0u, PairContactPoint<double>{normal, overlap, s * u + (a.radius - 0.5 * overlap) * normal,
                                          a.radius * b.radius / (a.radius + b.radius), 1.0});
  }
  static std::uint32_t mirrored(std::uint32_t feature) { return feature; }
  template <class Callback>
  void sample_points(const double* pose, Callback&& callback) const {  // on surfaces: the balls at its ends
    callback(0u, dem::contact::SamplePoint{-line(pose), radius, radius});
    callback(1u, dem::contact::SamplePoint{line(pose), radius, radius});
  }
};
