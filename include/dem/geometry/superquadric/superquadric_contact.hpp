#pragma once

#include <dem/geometry/superquadric/superquadric_solid.hpp>

#include <cstdint>

namespace dem::shape {

/// What one pair of solids keeps from a search to the next, in the frame of a: the solution, or at least a direction
/// that parts the boxes around them.
struct CommonNormal {
  Vector3<double> normal = {0, 0, 0};           ///< unit vector from a to b
  Vector3<double> point = {0, 0, 0};            ///< m, midway between the two surface points that share the normal
  double overlap = 0.0;                         ///< m, of the surface points along the normal; negative: a gap
  std::uint32_t has_normal = 0, has_point = 0;  ///< 0 or 1; in 32 bits no byte is padding, which a saved state has
};

/// Two solids as the search sees them: b turned and shifted into the frame of a.
struct SolidPair {
  const SuperquadricSolid& a;
  const SuperquadricSolid& b;
  Matrix3<double> turn;    ///< b's frame -> a's
  Vector3<double> centre;  ///< m, of b
  double gap = 0.0;        ///< m, up to which they count as touching: that of cohesion at a distance

  /// Overlap of the slabs that the two solids fill along n, from a to b, and the surface points that bound them. Its
  /// least value over all unit vectors is the depth of penetration; a negative value proves that they are apart.
  double overlap_along(const Vector3<double>& n, Vector3<double>& of_a, Vector3<double>& of_b) const {
    Vector3<double> local;
    const double sum = a.support(n, of_a) + b.support(-transpose_times(turn, n), local);
    of_b = turn * local + centre;
    return sum - dot(n, centre);
  }
  /// The same for the boxes around the solids: never less, and cheap.
  DEM_HOT double box_overlap_along(const Vector3<double>& n) const {
    return a.box_support(n) + b.box_support(transpose_times(turn, n)) - dot(n, centre);
  }
  /// m; steps of the search are measured against it.
  double length() const { return min(a.smallest_radius(), b.smallest_radius()); }
};

/// How a step of Newton's iteration changed things.
struct NewtonStep {
  double along, across;  ///< m, along the normal and in the tangent plane
  double mismatch;       ///< of the two normals before the step, rad
  bool apart;            ///< the tangent planes before the step prove that the solids are farther apart than the gap
  Vector3<double> turn;  ///< by how much the normal of a turns on the way, to first order
};

/// One step of Newton's iteration for the common normal: the surface points x + overlap/2 n of a and x - overlap/2 n of
/// b lie on their surfaces and have the normals n and -n. In the tangent plane the mismatch r of the normals and the
/// curvatures K_a, K_b of the surfaces demand the step (K_a + K_b) y = -r; along n each point goes to its surface,
/// which turns the normals as well. The middle of a flat face has no curvature: no step is longer than `longest` (m),
/// and a trace of curvature keeps the matrix regular.
DEM_FN NewtonStep newton_step(const SolidPair& s, double longest, CommonNormal& c) {
  using Vec = Vector3<double>;
  const Vec half = (0.5 * c.overlap) * c.normal;
  const SuperquadricSolid::Jet a = s.a.jet(c.point + half);
  const SuperquadricSolid::Jet b = s.b.jet(transpose_times(s.turn, c.point - half - s.centre));
  const double per_a = 1.0 / norm(a.gradient), per_b = 1.0 / norm(b.gradient);
  const Vec normal_a = per_a * a.gradient, normal_b = per_b * (s.turn * b.gradient);
  const Vec difference = normal_a - normal_b;
  const Vec n = (1.0 / norm(difference)) * difference;

  // Two tangents t, q (Duff et al., Journal of Computer Graphics Techniques 6(1), 2017), and all three seen from b.
  const double sign = std::copysign(1.0, n.z), f = -1.0 / (sign + n.z), g = n.x * n.y * f;
  const Vec t = {1.0 + sign * n.x * n.x * f, sign * g, -sign * n.x}, q = {g, sign + n.y * n.y * f, -n.y};
  const Vec t_b = transpose_times(s.turn, t), q_b = transpose_times(s.turn, q), n_b = transpose_times(s.turn, n);
  const auto form = [](const Vec& u, const Vec& d, const Vec& v) {
    return u.x * d.x * v.x + u.y * d.y * v.y + u.z * d.z * v.z;
  };

  // By the convexity of F each solid lies behind the plane through its point, shifted by (1 - F)/|grad F|. A common
  // point would lie behind both, no farther than `far` from x; of two points a gap apart one lies before its plane by
  // no more than that.
  const double at = dot(normal_a, t), aq = dot(normal_a, q), bt = dot(normal_b, t), bq = dot(normal_b, q);
  const double mismatch = std::sqrt((at + bt) * (at + bt) + (aq + bq) * (aq + bq));
  const double far = norm(c.point) + norm(s.a.radius());
  const bool apart =
      (1.0 - a.value) * per_a + (1.0 - b.value) * per_b + dot(difference, half) + mismatch * far < -s.gap;

  // Each point goes along n to its surface: distances from ln F, which is closer to linear than F.
  const double to_a = 1.0 / dot(normal_a, n), to_b = 1.0 / dot(normal_b, n);
  const auto distance = [](double value) { return 2.0 * value * (1.0 - value) / (1.0 + value); };
  const double along_a = distance(a.value) * per_a * to_a, along_b = distance(b.value) * per_b * to_b;

  const double turn_at = per_a * form(t, a.curvature, n), turn_aq = per_a * form(q, a.curvature, n);
  const double turn_bt = per_b * form(t_b, b.curvature, n_b), turn_bq = per_b * form(q_b, b.curvature, n_b);
  const double rt = at + bt + turn_at * along_a + turn_bt * along_b;
  const double rq = aq + bq + turn_aq * along_a + turn_bq * along_b;

  // Moving in the plane moves each point off its surface where the normals differ from n; going back turns them.
  const double trace = 1e-9 / longest;
  const double tt_a = per_a * form(t, a.curvature, t), tq_a = per_a * form(t, a.curvature, q),
               qq_a = per_a * form(q, a.curvature, q);
  const double tt = tt_a + per_b * form(t_b, b.curvature, t_b) + trace;
  const double qq = qq_a + per_b * form(q_b, b.curvature, q_b) + trace;
  const double tq = tq_a + per_b * form(t_b, b.curvature, q_b);
  double k11 = tt - turn_at * at * to_a - turn_bt * bt * to_b, k12 = tq - turn_at * aq * to_a - turn_bt * bq * to_b;
  double k21 = tq - turn_aq * at * to_a - turn_bq * bt * to_b, k22 = qq - turn_aq * aq * to_a - turn_bq * bq * to_b;
  if (!(k11 * k22 - k12 * k21 > 0.0)) {  // too far from the solution for these terms
    k11 = tt, k22 = qq, k12 = k21 = tq;
  }
  const double scale = 1.0 / max(k11 * k22 - k12 * k21, trace * trace);
  double yt = scale * (rq * k12 - rt * k22), yq = scale * (rt * k21 - rq * k11);
  const double across = std::sqrt(yt * yt + yq * yq), shorten = across > longest ? longest / across : 1.0;
  yt *= shorten;
  yq *= shorten;
  const auto bounded = [&](double d) { return max(-longest, min(longest, d)); };
  const double move_a = bounded(along_a - (at * yt + aq * yq) * to_a);
  const double move_b = bounded(along_b - (bt * yt + bq * yq) * to_b);

  c.overlap = c.overlap * dot(c.normal, n) + move_a - move_b;
  c.point = c.point + yt * t + yq * q + (0.5 * (move_a + move_b)) * n;
  c.normal = n;
  const Vec turned =
      (at + tt_a * yt + tq_a * yq + turn_at * move_a) * t + (aq + tq_a * yt + qq_a * yq + turn_aq * move_a) * q;
  return {max(std::abs(move_a), std::abs(move_b)), shorten * across, mismatch, apart, turned};
}

enum class Search { found, apart, lost };

/// Newton's iteration from what `c` holds, until the last step went less than 3e-6 of the smallest radius: quadratic
/// convergence then leaves errors far below that. On flat faces, where the point hardly matters, normals that agree to
/// 1e-9 are enough.
DEM_FN Search follow_common_normal(const SolidPair& s, int most_steps, CommonNormal& c) {
  const double length = s.length(), near = 3e-6 * length;
  for (int k = 0; k < most_steps; ++k) {
    const NewtonStep step = newton_step(s, 0.3 * length, c);
    if (!(step.mismatch < 1.99) || !(std::abs(c.overlap) < 1e3 * length)) return Search::lost;
    if (step.apart) return Search::apart;
    if (step.along < near && (step.across < near || step.mismatch < 1e-9)) {
      const Vector3<double> n = c.normal + step.turn;
      c.normal = (1.0 / norm(n)) * n;
      return Search::found;
    }
  }
  return Search::lost;
}

}  // namespace dem::shape
