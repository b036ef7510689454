#pragma once

#include <dem/core/error.hpp>
#include <dem/math/matrix3.hpp>
#include <dem/math/wrench.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/vehicle/road.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dem::vehicle {

/// A tyre on hard ground (road.hpp): one contact point, at the lowest place of the wheel's middle plane.
///   across the road   K d + C d', never pulling; d: deflection
///   along the road    a tread spring, kx sx and ky sy, with a damper on its rate; their sum is cut at mu Fn
/// The stretch s of the tread grows with the slip velocity v and is renewed as the tyre rolls by a relaxation length L:
///   s' = v - |omega| r s / L
/// So a tyre that stands holds like a spring. One that rolls has the slip stiffness kx L and the cornering stiffness
/// ky L. With an infinite L it is the thesis's rigid wheel with asperity friction. The model is the single contact
/// point transient model of Pacejka, Tire and Vehicle Dynamics, doi 10.1016/C2010-0-68548-8.
///
/// A machine's stable_time_step() does not know the tyre: steps h need K h^2 + 2 C h < 4 m, for a wheel of mass m. A
/// step that is too large is told when the tyre throws the wheel up (tyre_watch.hpp).
struct TyreSpec {
  double radius = 0.485;           ///< m, unloaded
  double width = 0.254;            ///< m
  double stiffness = 4e5;          ///< K, N/m
  double damping = 4e3;            ///< C, N s/m
  double friction = 0.8;           ///< mu
  double tread_stiffness = 4e5;    ///< kx, N/m
  double lateral_stiffness = 3e5;  ///< ky, N/m
  double tread_damping = 2e3;      ///< N s/m
  double relaxation_length = 0.3;  ///< m; may be infinite

  TyreSpec rigid() const {
    TyreSpec s = *this;
    s.relaxation_length = std::numeric_limits<double>::infinity();
    return s;
  }
};

/// Throws Error for a tyre that cannot be.
DEM_SETUP inline void check_tyre(const TyreSpec& s) {
  require_positive(s.radius, "radius of a tyre", "m");
  require_positive(s.width, "width of a tyre", "m");
  require_positive(s.stiffness, "stiffness of a tyre", "N/m");
  require_non_negative(s.damping, "damping of a tyre", "N s/m");
  require_non_negative(s.friction, "friction of a tyre", "(no unit)");
  require_positive(s.tread_stiffness, "tread stiffness of a tyre", "N/m");
  require_positive(s.lateral_stiffness, "lateral stiffness of a tyre", "N/m");
  require_non_negative(s.tread_damping, "tread damping of a tyre", "N s/m");
  if (!(s.relaxation_length > 0.0)) {
    fail("relaxation length of a tyre is {:g} m, but must be positive; infinity makes a rigid tread",
         s.relaxation_length);
  }
}

/// What a tyre did in the newest force evaluation. Works are sums over time.
struct TyreState {
  double deflection = 0.0;        ///< m
  double load = 0.0;              ///< N, across the road
  double pull = 0.0, side = 0.0;  ///< N, on the wheel: forward, to the left
  double slip = 0.0;              ///< (omega r - v)/max(omega r, v): positive drives, negative brakes; r loaded
  double slip_angle = 0.0;        ///< rad, of the path to the left of the wheel's plane
  double stretch_x = 0.0, stretch_y = 0.0;  ///< m, of the tread
  double elastic_energy = 0.0;              ///< J, in the tread and the carcass
  double work = 0.0;                        ///< J, on the wheel so far
  Vec3 contact = Vec3::Zero();              ///< m, global
  double time = -1.0;                       ///< s, of the newest evaluation

  /// f(number) for all of them.
  template <class F>
  void each(F&& f) {
    f(deflection), f(load), f(pull), f(side), f(slip), f(slip_angle), f(stretch_x), f(stretch_y);
    f(elastic_energy), f(work), f(contact.x()), f(contact.y()), f(contact.z()), f(time);
  }
};

namespace detail {

/// The tread's stretch at the end of a time dt (s) in which it slid at `slid` in the mean and slides at v now (m/s),
/// and its rate; rolling (m/s) renews it.
inline double stretched(double s, double slid, double v, double rolling, double length, double dt, double& rate) {
  const double end = (s + dt * slid) / (1.0 + dt * rolling / length);
  rate = v - rolling / length * end;
  return end;
}

/// Unit vector from the middle of a wheel to its lowest point over a road with a normal n; a: axis of the wheel.
inline Vec3 down_of(const Vec3& a, const Vec3& n) {
  Vec3 down = a.dot(n) * a - n;  // in the plane of the wheel
  down /= std::max(1e-9, down.norm());
  return down;
}

/// m, by which that point is below a plane; negative above it.
inline double depth_below(const Road& plane, double radius, const Vec3& centre, const Vec3& down) {
  const double height = (centre - plane.point).dot(plane.normal);
  const double free = -down.dot(plane.normal) * radius;  // height of the centre of a wheel that just touches
  return free - height;
}

}  // namespace detail

/// m, by which a wheel that turns about `axis` (unit vector to the left, body frame) is in a road; negative above it.
inline double depth_in(const Road& road, double radius, const Body& wheel, const Vec3& axis) {
  const Road plane = road.under(wheel.position(), radius);
  return detail::depth_below(plane, radius, wheel.position(), detail::down_of(wheel.rotation() * axis, plane.normal));
}

/// The speeds with which a tread slid until now: those of now for `newest_share` of the time, for the rest those of
/// before, of the wheel's centre (m/s) and its spin (rad/s), global.
struct TreadSpeeds {
  double newest_share = 1.0;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
};

/// Force and torque of the road on a wheel that turns about `axis` (unit vector to the left, body frame). Moves the
/// state on to `time`; a second call at the same time adds nothing to it.
inline Wrench tyre_wrench(const TyreSpec& tyre, const Road& ground, const Body& wheel, const Vec3& axis, double time,
                          TyreState& s, const TreadSpeeds& before = {}) {
  const Road road = ground.under(wheel.position(), tyre.radius);
  const double dt = s.time < 0.0 ? 0.0 : std::max(0.0, time - s.time);
  const Vec3 n = road.normal, a = wheel.rotation() * axis;
  const Vec3 down = detail::down_of(a, n), centre = wheel.position();
  s.deflection = detail::depth_below(road, tyre.radius, centre, down);
  s.time = time;
  if (!(s.deflection > 0.0)) {
    const double work = s.work;
    s = {};
    s.time = time;
    s.work = work;
    return {};
  }
  const double loaded = tyre.radius - s.deflection / std::max(0.1, -down.dot(n));
  const Vec3 arm = loaded * down, spin = wheel.angular_velocity();
  const Vec3 v = wheel.velocity() + spin.cross(arm);
  const double into = -v.dot(n);
  s.load = std::max(0.0, tyre.stiffness * s.deflection + tyre.damping * into);

  Vec3 ahead = a.cross(n);
  ahead /= std::max(1e-9, ahead.norm());
  const Vec3 left = n.cross(ahead);
  const double turning = spin.dot(a) * loaded, rolling = std::abs(turning);
  const double travel = wheel.velocity().dot(ahead), drift = wheel.velocity().dot(left);
  double rate_x = 0.0, rate_y = 0.0;
  Vec3 slid = v;
  if (before.newest_share < 1.0)
    slid = before.newest_share * v + (1.0 - before.newest_share) * (before.velocity + before.spin.cross(arm));
  const double length = tyre.relaxation_length;
  s.stretch_x = detail::stretched(s.stretch_x, slid.dot(ahead), v.dot(ahead), rolling, length, dt, rate_x);
  s.stretch_y = detail::stretched(s.stretch_y, slid.dot(left), v.dot(left), rolling, length, dt, rate_y);
  const double limit = tyre.friction * road.friction * s.load;
  const double spring = std::hypot(tyre.tread_stiffness * s.stretch_x, tyre.lateral_stiffness * s.stretch_y);
  if (spring > limit) {
    s.stretch_x *= limit / spring;
    s.stretch_y *= limit / spring;
  }
  s.pull = -tyre.tread_stiffness * s.stretch_x - tyre.tread_damping * rate_x;
  s.side = -tyre.lateral_stiffness * s.stretch_y - tyre.tread_damping * rate_y;
  if (const double size = std::hypot(s.pull, s.side); size > limit) {
    s.pull *= limit / size;
    s.side *= limit / size;
  }
  const double fastest = std::max(std::abs(turning), std::abs(travel));
  s.slip = fastest > 1e-3 ? (turning - travel) / fastest : 0.0;
  s.slip_angle = std::abs(travel) > 1e-3 ? std::atan2(drift, std::abs(travel)) : 0.0;
  s.elastic_energy =
      0.5 * (tyre.stiffness * s.deflection * s.deflection + tyre.tread_stiffness * s.stretch_x * s.stretch_x +
             tyre.lateral_stiffness * s.stretch_y * s.stretch_y);
  s.contact = centre + arm;
  const Vec3 force = s.load * n + s.pull * ahead + s.side * left;
  s.work += dt * force.dot(v);
  return {from_eigen(force), from_eigen(Vec3(arm.cross(force)))};
}

}  // namespace dem::vehicle
