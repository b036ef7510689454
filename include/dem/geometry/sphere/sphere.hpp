#pragma once

#include <dem/core/error.hpp>
#include <dem/geometry/shape.hpp>

namespace dem::shape {

/// A single sphere.
class Sphere {
 public:
  static constexpr int pose_size = 0;
  static constexpr bool has_orientation = false;
  static constexpr std::size_t most_contacts = 1;
  template <class T>
  using PairContactPoint = contact::SphereContactPoint<T>;

  /// Throws Error unless radius > 0 (m).
  explicit Sphere(double radius) : radius_(require_positive(radius, "radius of a sphere", "m")) {}

  double radius() const { return radius_; }
  double bounding_radius() const { return radius_; }
  std::uint64_t fingerprint() const { return fingerprint_of(radius_); }
  double volume() const { return sphere_mass_properties(radius_).volume; }
  Vec3 unit_inertia() const { return sphere_mass_properties(radius_).inertia.diagonal(); }

  void orient(const Matrix3<double>&, double*) const {}

  template <class Gap = NoGap>
  static DEM_HOT std::uint64_t contact_bits(const Sphere& a, const double*, const Sphere& b, const double*,
                                            const Vector3<double>& separation, Gap gap = {}) {
    const double reach = widened(a.radius_ + b.radius_, gap);
    return dot(separation, separation) < reach * reach ? 1u : 0u;
  }
  static constexpr std::uint32_t feature_of(int bit) { return static_cast<std::uint32_t>(bit); }
  static DEM_HOT PairContactPoint<double> contact_point(const Sphere& a, const double*, const Sphere& b, const double*,
                                                        const Vector3<double>& separation, std::uint32_t) {
    return {separation, a.radius_, b.radius_};
  }
  template <class Callback, class Gap = NoGap>
  static DEM_HOT void collide(const Sphere& a, const double* pose_a, const Sphere& b, const double* pose_b,
                              const Vector3<double>& separation, Callback&& callback, Gap gap = {}) {
    if (contact_bits(a, pose_a, b, pose_b, separation, gap) != 0)
      callback(0u, contact_point(a, pose_a, b, pose_b, separation, 0u));
  }
  static std::uint32_t mirrored(std::uint32_t feature) { return feature; }

  template <class Callback>
  DEM_HOT void sample_points(const double*, Callback&& callback) const {
    callback(0u, contact::SamplePoint{{0, 0, 0}, radius_, radius_});
  }

 private:
  double radius_;
};

}  // namespace dem::shape
