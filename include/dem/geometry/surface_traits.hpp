#pragma once

#include <dem/core/function_like.hpp>
#include <dem/geometry/direction_code.hpp>
#include <dem/geometry/surface.hpp>
#include <dem/math/fingerprint.hpp>

#include <concepts>
#include <cstdint>

namespace dem::surface {

// What a surface may also have, all of it in its own frame and in m. Grains feel with it
//   close(point, radius, points)   false only if no sample point in that sphere can touch, cheap for a surface that is
//                         much smaller than its bounding box; `points`: some of them have no radius;
//   corners(point, radius, callback)   calls callback(number, corner) for those within the radius, or
//                         callback(number, corner, weight) with a weight below 1 where they come and go;
//   balls(point, radius, callback), is_on_ball(point)   a round surface as balls that fill it: calls
//                         callback(number, centre, ball's radius) for those that a grain may touch; is_on_ball() is
//                         true where their boundary is the surface's;
//   radius_on(radius)     the effective radius of a boundary of that radius on it, if it is curved;
//   point_contacts(point, gap, callback)   contacts of a point up to a gap before it, where they are not found as
//                         those of spheres are;
//   find_points_to(depth)   from now on points are found so deep behind it;
//   hides(point, radius, points)   whether a point lies so deep in a solid that no sample point of a grain with that
//                         bounding radius is found: the grain is refused;
//   lets_points_through()   whether points (radius 0) pass it unseen, as a sheet without thickness;
//   names_directions      true if features end in the direction of their contact (direction_code.hpp).
// Other machine parts find it with
//   points(box, callback), has_points()   calls callback(number, point, radius) for the points in a box, numbers
//                         ascending. They cover it: two such surfaces (or one and a plane) find each other by them;
//   is_ball()             whether it is one ball: its one sample point finds every contact, so the partner's points are
//                         not needed;
//   edges(box, callback)  calls callback(number, one end, other end) for straight sharp edges that may lie in a box.
//                         Numbers are other than those of points, each with most_parts - 1 free ones behind it;
//   rims(callback)        calls callback(number, middle, radius) for round edges about its z axis;
//   lateral_line(way, low, high), length()   of a round surface along its z axis: the line of it on the side of a
//                         direction; false if there is none;
//   grain()               a superquadric: the grain of that shape, or null;
//   clip(tail, head, from, to)   a solid: cuts the range [from, to] of shares of the way from tail to head to what lies
//                         in it; false if nothing is left;
//   parts_inside(tail, head, callback)   a solid of any form: calls callback(from, to) for each part of that way that
//                         lies in it, ascending.
// Saved states ask it for
//   fingerprint()         64 bits that tell whether two surfaces are the same (fingerprint_of): a saved state is
//   refused
//                         where they differ. Without it their bounds are compared.

/// What a surface's corners are shown to, in the checks of concepts.
struct AnyCorner {
  void operator()(std::uint32_t, const Vector3<double>&, double = 1.0) const {}
};

template <class S>
concept KnowsClose = requires(const S& s, const Vector3<double>& point) {
  { s.close(point, 1.0, true) } -> std::same_as<bool>;
};
template <class S>
concept HidesGrains = requires(const S& s, const Vector3<double>& point) {
  { s.hides(point, 1.0, true) } -> std::same_as<bool>;
};
template <class S>
concept HasCorners = requires(const S& s, const Vector3<double>& point) {
  s.corners(point, 1.0, AnyCorner{});
};
template <class S>
concept HasBalls = requires(const S& s, const Vector3<double>& point) {
  s.balls(point, 1.0, FunctionLike<void(std::uint32_t, const Vector3<double>&, double)>{});
  { s.is_on_ball(point) } -> std::same_as<bool>;
};
template <class S>
concept FindsPointsDeep = requires(S& s) {
  s.find_points_to(1.0);
};
template <class S>
concept MayLetPointsThrough = requires(const S& s) {
  { s.lets_points_through() } -> std::same_as<bool>;
};
template <class S>
concept HasPoints = requires(const S& s, const Aabb& box) {
  s.points(box, FunctionLike<void(std::uint32_t, const Vector3<double>&, double)>{});
  { s.has_points() } -> std::same_as<bool>;
};
template <class S>
concept MayBeBall = requires(const S& s) {
  { s.is_ball() } -> std::same_as<bool>;
};
template <class S>
concept HasEdges = requires(const S& s, const Aabb& box) {
  s.edges(box, FunctionLike<void(std::uint32_t, const Vector3<double>&, const Vector3<double>&)>{});
};
template <class S>
concept HasRims = requires(const S& s) {
  s.rims(FunctionLike<void(std::uint32_t, const Vector3<double>&, double)>{});
};
template <class S>
concept HasLateralSurface = requires(const S& s, Vector3<double>& p) {
  { s.lateral_line(p, p, p) } -> std::same_as<bool>;
  { s.length() } -> std::same_as<double>;
};
template <class S>
concept IsSuperquadric = requires(const S& s) {
  { s.grain()->even_support(static_cast<const double*>(nullptr), Vector3<double>{}) } -> std::same_as<Vector3<double>>;
};
template <class S>
concept ClipsLines = requires(const S& s, const Vector3<double>& p, double& share) {
  { s.clip(p, p, share, share) } -> std::same_as<bool>;
};
template <class S>
concept PartsLines = requires(const S& s, const Vector3<double>& p) {
  s.parts_inside(p, p, FunctionLike<void(double, double)>{});
};

/// m, the effective radius of a boundary of a radius on a surface; one without radius_on() counts as flat.
template <class S>
DEM_HOT double radius_on(const S& s, double radius) {
  if constexpr (requires { s.radius_on(radius); }) {
    return s.radius_on(radius);
  } else {
    return radius;
  }
}

template <class S>
concept TellsFingerprint = requires(const S& s) {
  { s.fingerprint() } -> std::same_as<std::uint64_t>;
};
/// 64 bits that differ where surfaces do: those that a surface tells, or those of its bounds.
template <class S>
std::uint64_t fingerprint(const S& s) {
  if constexpr (TellsFingerprint<S>) {
    return s.fingerprint();
  } else {
    return fingerprint_of(s.bounds().low, s.bounds().high);
  }
}

/// Contacts of a point (a sample point of radius 0) up to a gap (m) before a surface; as of a sphere of that radius
/// where there is no point_contacts().
template <class S, class Callback>
DEM_HOT void point_contacts(const S& s, const Vector3<double>& point, double gap, Callback&& callback) {
  if constexpr (requires { s.point_contacts(point, gap, callback); }) {
    s.point_contacts(point, gap, callback);
  } else {
    s.contacts(point, gap, callback);
  }
}

}  // namespace dem::surface
