#pragma once

#include <dem/coupling/machine_surface.hpp>
#include <dem/geometry/shape.hpp>
#include <dem/mbd/body/body.hpp>

#include <algorithm>
#include <cmath>

namespace dem::coupling {

/// A surface whose points cover it: two such surfaces (or one and a plane) find each other by their points.
template <class S>
concept HasPoints = requires(const S& s, const surface::Bounds& box) {
  s.points(box, [](std::uint32_t, const Vector3<double>&, double) {});
  { s.has_points() } -> std::same_as<bool>;
};
/// A surface with straight sharp edges: edges(box, callback) calls callback(number, one end, other end) for those that
/// may lie in a box of its frame. Numbers are other than those of its points, each with most_parts - 1 free ones behind
/// it.
template <class S>
concept HasEdges = requires(const S& s, const surface::Bounds& box) {
  s.edges(box, [](std::uint32_t, const Vector3<double>&, const Vector3<double>&) {});
};
/// A solid that tells which part of a line from `tail` to `head` lies in it: clip(tail, head, from, to) cuts the range
/// [from, to] of shares of the way down, and is false if nothing is left.
template <class S>
concept ClipsLines = requires(const S& s, const Vector3<double>& p, double& share) {
  { s.clip(p, p, share, share) } -> std::same_as<bool>;
};
/// A solid of any form that does: parts_inside(tail, head, callback) calls callback(from, to) for each part of the line
/// that lies in it, ascending.
template <class S>
concept PartsLines = requires(const S& s, const Vector3<double>& p) {
  s.parts_inside(p, p, [](double, double) {});
};
/// A surface with round edges about its z axis: rims(callback) calls callback(number, middle, radius).
template <class S>
concept HasRims = requires(const S& s) {
  s.rims([](std::uint32_t, const Vector3<double>&, double) {});
};
/// A round surface along its z axis: lateral_line(way, low, high) gives the line of it on the side of a direction, and
/// is false if there is none.
template <class S>
concept HasLateralSurface = requires(const S& s, Vector3<double>& p) {
  { s.lateral_line(p, p, p) } -> std::same_as<bool>;
  { s.length() } -> std::same_as<double>;
};
/// A surface that is a superquadric: grain() is the grain of that shape, or null.
template <class S>
concept IsSuperquadric = requires(const S& s) {
  { s.grain()->even_support(static_cast<const double*>(nullptr), Vector3<double>{}) } -> std::same_as<Vector3<double>>;
};
/// A surface that may be one ball: its sample point finds every contact, so the partner's points are not needed.
template <class S>
concept MayBeBall = requires(const S& s) {
  { s.is_ball() } -> std::same_as<bool>;
};

template <class Surface>
bool is_ball(const Surface& s) {
  return std::visit(
      []<class G>(const G& geometry) {
        if constexpr (MayBeBall<G>) return geometry.is_ball();
        return false;
      },
      s.geometry);
}
/// Whether a surface shows points to others.
template <class Surface>
bool has_points(const Surface& s) {
  return std::visit(
      []<class G>(const G& geometry) {
        if constexpr (HasPoints<G>) return geometry.has_points();
        return false;
      },
      s.geometry);
}
/// The scale on which a surface is round, for laws that ask for a radius (m): half its smaller extent.
template <class Surface>
double point_radius(const Surface& s) {
  const surface::Bounds b = std::visit([](const auto& geometry) { return geometry.bounds(); }, s.geometry);
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
