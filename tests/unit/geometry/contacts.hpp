#pragma once

#include <dem/geometry/shape.hpp>

#include <vector>

/// A contact as a test looks at it.
struct Contact {
  std::uint32_t feature;
  dem::Vec3 normal, point;  ///< the point from the centre of a
  double overlap, effective_radius;
  double weight = 1.0;
};

/// All contacts of shape a with b, b being `separation` away, in the order in which they are found; with a gap (m) for
/// shapes that find contacts across it.
template <class Shape, class... Gap>
std::vector<Contact> contacts(const Shape& a, const dem::Mat3& turn_a, const Shape& b, const dem::Mat3& turn_b,
                              const dem::Vec3& separation, Gap... gap) {
  alignas(64) double pose_a[Shape::pose_size + 1] = {}, pose_b[Shape::pose_size + 1] = {};
  a.orient(dem::from_eigen(turn_a), pose_a);
  b.orient(dem::from_eigen(turn_b), pose_b);
  std::vector<Contact> found;
  const auto sink = [&](std::uint32_t feature, const auto& point) {
    const auto g = point.geometry();
    found.push_back({feature, to_eigen(g.normal), to_eigen(g.arm), g.overlap, g.effective_radius, g.weight});
  };
  Shape::collide(a, pose_a, b, pose_b, dem::from_eigen(separation), sink, gap...);
  return found;
}
