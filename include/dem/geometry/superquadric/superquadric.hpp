#pragma once

#include <dem/geometry/superquadric/superquadric_grain.hpp>
#include <dem/geometry/superquadric/superquadric_search.hpp>

namespace dem::shape {

/// A superquadric grain, one contact a pair: where the two surfaces share a normal (the "common normal" of Podlozhnyuk
/// et al. 2017, doi:10.1007/s40571-016-0131-6, found directly instead of through a midpoint). The overlap is the least
/// distance by which one grain must move to part from the other, so without dampers and friction the normal force has a
/// potential, K overlap^2 / 2. Surfaces of machine parts are felt with the point of the boundary that meets them first
/// and with fixed points spread over it, which share one contact. Laws that ask for a radius (Hertz, Mindlin, JKR,
/// bridges) get that of the sphere of the same volume, not the curvature at the contact: on the tip of an ellipsoid
/// with radii 2:1:1 Hertz comes out 1.6 times too stiff.
class Superquadric : public SuperquadricGrain {
 public:
  static constexpr std::size_t most_contacts = 1;
  using WarmStart = CommonNormal;

  /// Radii in m, exponents from 2 to 32, and how many cells the points for surfaces have along an edge. Throws Error
  /// for values out of range.
  Superquadric(const Vec3& radii, const Vec3& exponents, int divisions = 4)
      : SuperquadricGrain(radii, exponents, divisions, PointArea::share) {}

  /// `found` holds what the last search found for this pair: it makes the search short, and leaves the answer the same
  /// up to the search's tolerance. With a gap (m) pairs up to that far apart are handed over too, with a negative
  /// overlap.
  template <class Callback>
  static DEM_HOT void collide(const Superquadric& a, const double* pose_a, const Superquadric& b, const double* pose_b,
                              const Vector3<double>& separation, WarmStart& found, Callback&& callback,
                              double gap = 0.0) {
    const Matrix3<double> ra = rotation(pose_a), rb = rotation(pose_b);
    const SolidPair pair = {a.solid(), b.solid(), transposed(ra) * rb, transpose_times(ra, separation), gap};
    if (!find_common_normal(pair, found)) return;
    callback(0u,
             PairContactPoint<double>{ra * found.normal, found.overlap, ra * found.point, a.effective_radius(b), 1.0});
  }
  template <class Callback>
  static DEM_HOT void collide(const Superquadric& a, const double* pose_a, const Superquadric& b, const double* pose_b,
                              const Vector3<double>& separation, Callback&& callback, double gap = 0.0) {
    WarmStart nothing;
    collide(a, pose_a, b, pose_b, separation, nothing, callback, gap);
  }
  /// Where the surfaces of this and of another grain share a normal, in the frame of this one; `turn` leads from the
  /// other's frame into this, `centre` (m) is the other's. False if they are apart.
  bool shares_normal(const Superquadric& other, const Matrix3<double>& turn, const Vector3<double>& centre,
                     CommonNormal& found) const {
    return find_common_normal({solid(), other.solid(), turn, centre}, found);
  }
  static std::uint32_t mirrored(std::uint32_t feature) { return feature; }
};

}  // namespace dem::shape
