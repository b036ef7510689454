#pragma once

#include <dem/geometry/cluster/ball_mass_properties.hpp>
#include <dem/geometry/principal_axes.hpp>
#include <dem/geometry/shape.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <span>

namespace dem::shape {

/// Up to N spheres glued into one rigid grain. Species with fewer spheres may share a world with fuller ones.
template <int N>
class SphereCluster {
  static_assert(N >= 1 && N <= 256, "SphereCluster<N>: N must lie between 1 and 256");

 public:
  /// Sphere centres are kept as x[stride] y[stride] z[stride], whole packs each.
  static constexpr int stride = round_up_to_pack(N);
  static constexpr int pose_size = 3 * stride;
  static constexpr bool has_orientation = true;
  static constexpr std::size_t most_contacts = std::size_t{N} * N;
  template <class T>
  using PairContactPoint = contact::ClusterContactPoint<T>;

  /// A rigid layout of 1 to N balls in any frame (m). The mass properties are those of the union of the balls (exact if
  /// none overlap, else volumes are good to 2e-4 and moments to 5e-4), unless they are given (density 1, in the same
  /// frame). The grain's own frame is then moved to the centre of mass and turned to the principal axes;
  /// `frame_rotation` and `frame_centre` tell where it went. Throws Error if there are no balls, too many, or a radius
  /// is not positive.
  explicit SphereCluster(std::span<const Ball> balls, const std::optional<MassProperties>& given = {}) {
    if (balls.empty() || balls.size() > static_cast<std::size_t>(N)) {
      fail("a SphereCluster<{}> was given {} spheres, but takes 1 to {}; choose a larger N or fewer spheres", N,
           balls.size(), N);
    }
    for (const Ball& b : balls) require_positive(b.radius, "radius of a sphere of a cluster", "m");
    const MassProperties mass = given                ? *given
                                : any_overlap(balls) ? union_mass_properties(balls)
                                                     : separate_mass_properties(balls);
    const PrincipalAxes axes = principal_axes(mass.inertia);
    volume_ = require_positive(mass.volume, "volume of a sphere cluster", "m^3");
    unit_inertia_ = axes.moments;
    frame_centre_ = mass.centre;
    frame_rotation_ = axes.rotation;
    count_ = static_cast<int>(balls.size());
    std::fill(x_, x_ + stride, std::numeric_limits<double>::quiet_NaN());
    for (int k = 0; k < count_; ++k) {
      const Vec3 c = axes.rotation.transpose() * (balls[static_cast<std::size_t>(k)].centre - mass.centre);
      x_[k] = c.x();
      y_[k] = c.y();
      z_[k] = c.z();
      radius_[k] = balls[static_cast<std::size_t>(k)].radius;
      bounding_radius_ = std::max(bounding_radius_, c.norm() + radius_[k]);
    }
  }

  int count() const { return count_; }
  Ball ball(int k) const { return {Vec3(x_[k], y_[k], z_[k]), radius_[k]}; }
  double radius(int k) const { return radius_[k]; }
  double bounding_radius() const { return bounding_radius_; }
  double volume() const { return volume_; }
  const Vec3& unit_inertia() const { return unit_inertia_; }
  /// Of the balls, in the grain's frame.
  std::uint64_t fingerprint() const {
    const auto n = static_cast<std::size_t>(count_);
    return fingerprint_of(std::span(x_, n), std::span(y_, n), std::span(z_, n), std::span(radius_, n));
  }
  const Vec3& frame_centre() const { return frame_centre_; }
  const Mat3& frame_rotation() const { return frame_rotation_; }
  /// For the stable time step: clusters with faces, such as cube8, meet with four spheres each way, twice what grains
  /// of one sphere are counted with, and larger ones lie on half of their spheres.
  contact::Patch patch() const { return at_once(count_ < 4 ? 1.0 : 2.0); }
  contact::Patch surface_patch() const { return at_once(1.0); }

  DEM_HOT void orient(const Matrix3<double>& r, double* pose) const {
    DEM_UNROLL for (int k = 0; k < stride; k += pack_width) {
      const Pack x = load(x_ + k), y = load(y_ + k), z = load(z_ + k);
      store(Pack(r.row0.x) * x + Pack(r.row0.y) * y + Pack(r.row0.z) * z, pose + k);
      store(Pack(r.row1.x) * x + Pack(r.row1.y) * y + Pack(r.row1.z) * z, pose + stride + k);
      store(Pack(r.row2.x) * x + Pack(r.row2.y) * y + Pack(r.row2.z) * z, pose + 2 * stride + k);
    }
  }

  /// Which spheres of a overlap which of b, without branches, for clusters small enough that one word holds all
  /// answers: bit k * stride + m for sphere k of a and sphere m of b.
  template <class Gap = NoGap>
  static DEM_HOT std::uint64_t contact_bits(const SphereCluster& a, const double* pose_a, const SphereCluster& b,
                                            const double* pose_b, const Vector3<double>& separation,
                                            Gap gap = {}) requires(N* stride <= 64) {
    return contact_bits_of_block(a, pose_a, 0, b, pose_b, 0, separation, gap);
  }
  static constexpr std::uint32_t feature_of(int bit) requires(N* stride <= 64) {
    return static_cast<std::uint32_t>(bit / stride * N + bit % stride);
  }
  /// The contact of sphere feature / N of a with sphere feature % N of b.
  static DEM_HOT PairContactPoint<double> contact_point(const SphereCluster& a, const double* pose_a,
                                                        const SphereCluster& b, const double* pose_b,
                                                        const Vector3<double>& separation, std::uint32_t feature) {
    const std::uint32_t k = feature / N, m = feature % N;
    const Vector3<double> centre = {pose_a[k], pose_a[stride + k], pose_a[2 * stride + k]};
    const Vector3<double> other = {pose_b[m], pose_b[stride + m], pose_b[2 * stride + m]};
    return {centre, (separation - centre) + other, a.radius_[k], b.radius_[m]};
  }

  template <class Callback, class Gap = NoGap>
  static DEM_HOT void collide(const SphereCluster& a, const double* pose_a, const SphereCluster& b,
                              const double* pose_b, const Vector3<double>& separation, Callback&& callback,
                              Gap gap = {}) {
    for (int row = 0; row < N; row += rows_per_word) {
      for (int lane = 0; lane < stride; lane += lanes_per_word) {
        for (std::uint64_t found = contact_bits_of_block(a, pose_a, row, b, pose_b, lane, separation, gap); found != 0;
             found &= found - 1) {
          const int bit = std::countr_zero(found);
          const auto feature =
              static_cast<std::uint32_t>((row + bit / lanes_per_word) * N + lane + bit % lanes_per_word);
          callback(feature, contact_point(a, pose_a, b, pose_b, separation, feature));
        }
      }
    }
  }
  static std::uint32_t mirrored(std::uint32_t feature) { return (feature % N) * N + feature / N; }

  template <class Callback>
  DEM_HOT void sample_points(const double* pose, Callback&& callback) const {
    for (int k = 0; k < count_; ++k) {
      callback(static_cast<std::uint32_t>(k),
               contact::SamplePoint{{pose[k], pose[stride + k], pose[2 * stride + k]}, radius_[k], radius_[k]});
    }
  }

 private:
  contact::Patch at_once(double least) const {
    const double points = std::max(least, count_ / 8.0);  // stable_time_step counts each four times
    return {points, points};
  }

  // One 64-bit word holds the answers for so many spheres of a (rows) against so many of b (lanes).
  static constexpr int lanes_per_word = stride < 64 ? stride : 64;
  static constexpr int rows_per_word = 64 / lanes_per_word < N ? 64 / lanes_per_word : N;

  /// Bit (k - row) * lanes_per_word + (m - lane): sphere k of a overlaps sphere m of b, or comes within the gap.
  template <class Gap>
  static DEM_HOT std::uint64_t contact_bits_of_block(const SphereCluster& a, const double* pose_a, int row,
                                                     const SphereCluster& b, const double* pose_b, int lane,
                                                     const Vector3<double>& separation, Gap gap) {
    std::uint64_t found = 0;
    DEM_UNROLL for (int m = lane; m < lane + lanes_per_word && m < stride; m += pack_width) {
      const Pack x = load(pose_b + m) + Pack(separation.x);
      const Pack y = load(pose_b + stride + m) + Pack(separation.y);
      const Pack z = load(pose_b + 2 * stride + m) + Pack(separation.z);
      const Pack radius = load(b.radius_ + m);
      DEM_UNROLL for (int k = row; k < row + rows_per_word && k < N; ++k) {
        const Pack dx = x - Pack(pose_a[k]), dy = y - Pack(pose_a[stride + k]), dz = z - Pack(pose_a[2 * stride + k]);
        const Pack reach = widened(radius + Pack(a.radius_[k]), gap);
        const auto hits = std::uint64_t{bits(dx * dx + dy * dy + dz * dz < reach * reach)};
        found |= hits << ((k - row) * lanes_per_word + m - lane);
      }
    }
    return found;
  }

  // Unused lanes hold points that no comparison finds near anything, each other included.
  alignas(64) double x_[std::size_t{stride}] = {};
  alignas(64) double y_[std::size_t{stride}] = {};
  alignas(64) double z_[std::size_t{stride}] = {};
  alignas(64) double radius_[std::size_t{stride}] = {};
  int count_ = 0;
  double bounding_radius_ = 0.0;
  double volume_ = 0.0;
  Vec3 unit_inertia_ = Vec3::Zero();
  Vec3 frame_centre_ = Vec3::Zero();
  Mat3 frame_rotation_ = Mat3::Identity();
};

/// The thesis's cubical grain: eight spheres of radius h/2 at (+-h/2, +-h/2, +-h/2) in a cube of half-edge h (m), with
/// the volume and inertia of the solid cube of edge 2 h.
inline SphereCluster<8> cube8(double half_edge) {
  require_positive(half_edge, "half-edge of a cube of 8 spheres", "m");
  Ball balls[8];
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner((k & 1) ? 1 : -1, (k & 2) ? 1 : -1, (k & 4) ? 1 : -1);
    balls[k] = {0.5 * half_edge * corner, 0.5 * half_edge};
  }
  return SphereCluster<8>(balls, box_mass_properties(filled(2.0 * half_edge)));
}

}  // namespace dem::shape
