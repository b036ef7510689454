#pragma once

#include <dem/coupling/machine_surface.hpp>
#include <dem/geometry/shape.hpp>
#include <dem/geometry/surface_traits.hpp>
#include <dem/mbd/body/body.hpp>

#include <algorithm>

namespace dem::coupling {

/// Whether a surface is one ball: its sample point finds every contact, so the partner's points are not needed.
template <class Surface>
bool is_ball(const Surface& s) {
  return std::visit(
      []<class G>(const G& geometry) {
        if constexpr (surface::MayBeBall<G>) return geometry.is_ball();
        return false;
      },
      s.geometry);
}
/// Whether a surface shows points to others.
template <class Surface>
bool has_points(const Surface& s) {
  return std::visit(
      []<class G>(const G& geometry) {
        if constexpr (surface::HasPoints<G>) return geometry.has_points();
        return false;
      },
      s.geometry);
}
/// The scale on which a surface is round, for laws that ask for a radius (m): half its smaller extent.
template <class Surface>
double point_radius(const Surface& s) {
  const surface::Aabb b = std::visit([](const auto& geometry) { return geometry.bounds(); }, s.geometry);
  const Vec3 extent = b.high - b.low;
  double smallest = extent.maxCoeff();
  for (int k = 0; k < 3; ++k) {
    if (extent[k] > 1e-6 * extent.maxCoeff()) smallest = std::min(smallest, extent[k]);
  }
  return 0.5 * smallest;
}
/// The effective radius of all contacts of two surfaces, whichever of them shows its points, for laws and reports (m).
/// A ball meets another one with R_a R_b/(R_a + R_b) and any other surface as if that were flat; of two other surfaces
/// the smaller one's scale is taken, as a block's on the ground.
template <class Surface>
double pair_radius(const Surface& a, const Surface& b) {
  const double ra = point_radius(a), rb = point_radius(b);
  if (!is_ball(a) && !is_ball(b)) return std::min(ra, rb);
  const auto on = [](const Surface& s, double r) {
    return std::visit([&](const auto& geometry) { return surface::radius_on(geometry, r); }, s.geometry);
  };
  return is_ball(a) ? on(b, ra) : on(a, rb);
}

}  // namespace dem::coupling
