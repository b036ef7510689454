#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/curve.hpp>
#include <dem/mbd/ids.hpp>
#include <dem/mbd/joint/coordinate.hpp>

#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// A spring and damper between two points: force over length from a table or a stiffness and a free length.
struct SpringSpec {
  std::string name;
  BodyId a = {}, b = {};
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();  ///< m, global at assembly
  Curve force_over_length = {};                   ///< N over m; positive pushes the points apart
  Curve force_over_speed = {};                    ///< N over m/s of lengthening; positive pushes the points apart
};

/// A linear spring (N/m) of free length (m; the length at assembly if negative) with a linear damper (N s/m).
DEM_COLD inline SpringSpec spring(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b,
                                  double stiffness, double damping = 0.0, double free_length = -1.0) {
  require_non_negative(stiffness, "stiffness of a spring", "N/m");
  require_non_negative(damping, "damping of a spring", "N s/m");
  const double l0 = free_length < 0.0 ? norm(from_eigen(at_b) - from_eigen(at_a)) : free_length;
  return {.name = std::move(name),
          .a = a,
          .b = b,
          .at_a = at_a,
          .at_b = at_b,
          .force_over_length = Curve::line(stiffness * l0, -stiffness),
          .force_over_speed = damping > 0.0 ? Curve::line(0.0, -damping) : Curve{}};
}
/// A spring of free length (m) whose force (N) over its compression (m, positive when shorter) is a table. Beyond the
/// table the force goes on with the slope of its last piece. With a curve that is `held_outside` it keeps its last
/// value instead: a bump stop is such a spring, which does not pull. The damper acts at every length.
DEM_COLD inline SpringSpec spring_table(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b,
                                        double free_length, const Curve& force_over_compression, double damping = 0.0) {
  require_positive(free_length, "free length of a spring", "m");
  require_non_negative(damping, "damping of a spring", "N s/m");
  std::vector<std::pair<double, double>> points;
  for (const auto& [x, f] : force_over_compression.points()) points.emplace_back(free_length - x, f);
  const Curve over_length({points.rbegin(), points.rend()});
  return {.name = std::move(name),
          .a = a,
          .b = b,
          .at_a = at_a,
          .at_b = at_b,
          .force_over_length = force_over_compression.is_held_outside() ? over_length.held_outside() : over_length,
          .force_over_speed = damping > 0.0 ? Curve::line(0.0, -damping) : Curve{}};
}

struct Spring {
  SpringSpec spec;
  Vector3<double> point_a = {}, point_b = {};  ///< m, body frames
  double length = 0.0, speed = 0.0;            ///< m, m/s
  double force = 0.0;                          ///< N, positive pushes the points apart
};

inline void apply_spring(Spring& s, std::vector<Body>& bodies) {
  Body &a = bodies[s.spec.a.index()], &b = bodies[s.spec.b.index()];
  const Coordinate q = distance_of(s.point_a, s.point_b, a, b);
  s.length = q.value;
  s.speed = q.speed;
  s.force = 0.0;
  if (!s.spec.force_over_length.empty()) s.force += s.spec.force_over_length(q.value);
  if (!s.spec.force_over_speed.empty()) s.force += s.spec.force_over_speed(q.speed);
  q.apply(s.force, a, b);
}

}  // namespace dem::mbd
