#pragma once

#include <dem/geometry/superquadric/box_separation.hpp>
#include <dem/geometry/superquadric/superquadric_contact.hpp>

namespace dem::shape {

/// A first guess: of the given directions the one along which the solids overlap least.
template <class... Directions>
CommonNormal guess_common_normal(const SolidPair& s, const Directions&... directions) {
  CommonNormal best;
  best.overlap = 1e300;
  const auto consider = [&](const Vector3<double>& direction) {
    const Vector3<double> n = (1.0 / max(norm(direction), 1e-300)) * direction;
    Vector3<double> of_a, of_b;
    const double overlap = s.overlap_along(n, of_a, of_b);
    if (overlap < best.overlap) best = {n, 0.5 * (of_a + of_b), overlap, true, true};
  };
  (consider(directions), ...);
  return best;
}

/// The sure way, for grains with sharp edges that meet askew: exponents are raised step by step, from ellipsoids, whose
/// common normal is found from anywhere, to the true ones; each solution starts the next search.
inline Search approach_by_exponents(const SolidPair& s, CommonNormal& c) {
  const auto capped = [](const SuperquadricSolid& solid, double cap) {
    return SuperquadricSolid(to_eigen(solid.radius()), lower(to_eigen(solid.exponent()), filled(cap)));
  };
  const Vector3<double>&pa = s.a.exponent(), &pb = s.b.exponent();
  const double top = std::max({pa.x, pa.y, pa.z, pb.x, pb.y, pb.z});
  bool started = false;
  for (const double cap : {2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0}) {
    if (cap >= top) break;
    const SuperquadricSolid a = capped(s.a, cap), b = capped(s.b, cap);
    const SolidPair softer = {a, b, s.turn, s.centre, s.gap};
    if (!started) c = guess_common_normal(softer, s.centre);
    started = true;
    const double length = s.length();
    for (int k = 0; k < 30; ++k) {  // to the end: that the rounder solids are apart says nothing
      const NewtonStep step = newton_step(softer, 0.3 * length, c);
      if (step.along + step.across < 1e-4 * length) break;
    }
  }
  if (!started) c = guess_common_normal(s, s.centre);
  return follow_common_normal(s, 60, c);
}

/// The last resort: goes down the overlap along n by the difference of the two surface points, which is its gradient.
inline void descend_overlap(const SolidPair& s, const Vector3<double>& start, CommonNormal& c) {
  Vector3<double> of_a, of_b, n = start;
  double overlap = s.overlap_along(n, of_a, of_b), step = 1.0;
  for (int k = 0; k < 100; ++k) {
    c = {n, 0.5 * (of_a + of_b), overlap, true, true};
    const Vector3<double> gradient = (of_a - of_b) - dot(of_a - of_b, n) * n;
    const double size = norm(gradient);
    if (!(size > 1e-9 * s.length()) || step < 1e-9) return;
    Vector3<double> next = n - (0.5 * step / size) * gradient;
    next = (1.0 / norm(next)) * next;
    Vector3<double> next_a, next_b;
    const double lower = s.overlap_along(next, next_a, next_b);
    if (lower < overlap) {
      n = next, overlap = lower, of_a = next_a, of_b = next_b;
      step = min(1.0, 1.5 * step);
    } else {
      step *= 0.5;
    }
  }
}

/// Newton's iteration from a guess, and the sure ways where it fails. Returns whether the solids overlap or come within
/// the gap.
inline bool search_from(const SolidPair& s, const CommonNormal& guess, CommonNormal& c) {
  c = guess;
  Search search = follow_common_normal(s, 40, c);
  if (search == Search::lost) search = approach_by_exponents(s, c);
  if (search == Search::lost) descend_overlap(s, guess.normal, c);
  return search != Search::apart && c.overlap > -s.gap;
}

/// Common normal of two solids, from what an earlier search left in `c` or from nothing. Returns whether they overlap
/// or come within the gap. With overlapping solids `c.overlap` is the least distance by which one must move for them to
/// part; the answer is exact up to the tolerance of follow_common_normal while the overlap is smaller than the radii of
/// curvature.
DEM_FN bool find_common_normal(const SolidPair& s, CommonNormal& c) {
  if (c.has_normal && s.box_overlap_along(c.normal) < -s.gap) return false;
  if (c.has_point) {
    const Search search = follow_common_normal(s, 12, c);
    if (search != Search::lost) return search == Search::found && c.overlap > -s.gap;
  }
  c = {};
  const BoxSeparation boxes = separate_boxes(s.a.radius(), s.b.radius(), s.turn, s.centre, s.gap);
  if (boxes.overlap < -s.gap) {
    c.normal = boxes.axis;
    c.has_normal = 1;
    return false;
  }
  return search_from(s, guess_common_normal(s, boxes.axis, s.centre), c);
}

/// The same for a solid and a ball (m), whose centre is seen from the solid: the normal where the ray to the centre
/// leaves the solid is near enough to start with.
DEM_FN bool find_ball_contact(const SuperquadricSolid& a, const Vector3<double>& centre, double radius, CommonNormal& c,
                              double gap = 0.0) {
  const Vector3<double>& box = a.radius();
  const auto outside = [](double x, double limit) { return max(std::abs(x) - limit, 0.0); };
  const Vector3<double> out = {outside(centre.x, box.x), outside(centre.y, box.y), outside(centre.z, box.z)};
  if (!(dot(out, out) < (radius + gap) * (radius + gap))) return false;
  const SuperquadricSolid ball(radius);
  const SolidPair s = {a, ball, Matrix3<double>::identity(), centre, gap};
  if (c.has_point) {
    const Search search = follow_common_normal(s, 12, c);
    if (search != Search::lost) return search == Search::found && c.overlap > -s.gap;
  }
  const SurfacePoint foot = a.radial(centre);
  const Vector3<double> of_ball = centre - radius * foot.normal;
  c = {foot.normal, 0.5 * (foot.position + of_ball), dot(foot.normal, foot.position - of_ball), true, true};
  const Search search = follow_common_normal(s, 20, c);
  if (search != Search::lost) return search == Search::found && c.overlap > -s.gap;
  return search_from(s, guess_common_normal(s, foot.normal, centre), c);
}

}  // namespace dem::shape
