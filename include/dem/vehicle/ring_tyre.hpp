#pragma once

#include <dem/mbd/joint/bushing.hpp>
#include <dem/vehicle/assembly.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace dem::vehicle {

/// A pneumatic tyre as a ring of small bodies: the belt, cut into segments. Air presses them outwards, the belt's
/// tension holds them together, sidewalls hold them on the rim. Where the ring is pressed flat the tension has no
/// part that points inwards any more, so the air is carried by the ground: a contact pressure of about that of the air.
///
///   belt       hinges with a spring and damper between neighbours, tight so that the inflated ring has its radius
///   air        p b ds outwards on each segment, along the rim's radius, and its opposite on the rim
///   sidewalls  a bushing between rim and segment: radial, along the belt, sideways, and against turning
///
/// The belt bends freely. The sidewalls' radial stiffness rises with the pressure, so that the tyre's vertical
/// stiffness is that of Rhyne's formula; see rhyne_stiffness().
struct RingTyreSpec {
  double radius = 0.485;     ///< m, of the inflated, unloaded tyre
  double width = 0.254;      ///< b, m, of the belt
  double rim_radius = 0.21;  ///< m
  int segments = 48;
  double mass = 20.0;                  ///< kg, of the belt
  double thickness = 0.02;             ///< m, of belt and tread
  double pressure = 2.0e5;             ///< Pa, above that of the air around: 0 (none), or 1e3 to 2e6
  double belt_stiffness = 1.5e6;       ///< EA, N
  double sidewall_stiffness = 1e4;     ///< N/m for a metre of belt, radial, without pressure
  double sidewall_by_pressure = 1.65;  ///< m/m, what a pressure (Pa) adds to that
  double along_stiffness = 3e5;        ///< N/m for a metre of belt, along it
  double lateral_stiffness = 2e5;      ///< N/m for a metre of belt, sideways
  double damping = 0.1;                ///< of critical, of each spring with a segment's mass

  double arc() const { return 2.0 * std::numbers::pi * radius / segments; }  ///< ds, m
  /// s, an estimate: neighbours that turn against each other on their hinges are the fastest motion, with omega^2 of
  /// some 10.4 k/m. The machine's own limit does not know the hinges.
  double stable_time_step() const { return 2.0 / std::sqrt(10.4 * belt_stiffness / arc() * segments / mass); }
  double radial_stiffness() const { return sidewall_stiffness + sidewall_by_pressure * pressure; }
};

/// Throws Error for a tyre that cannot be.
DEM_SETUP inline void check_ring_tyre(const RingTyreSpec& s) {
  require_positive(s.radius, "radius of a ring tyre", "m");
  require_positive(s.width, "width of a ring tyre", "m");
  require_within(s.segments, 12, 400, "segments of a ring tyre");
  require_positive(s.mass, "mass of a ring tyre", "kg");
  require_positive(s.thickness, "thickness of a ring tyre", "m");
  require_non_negative(s.pressure, "pressure of a ring tyre", "Pa");
  require_positive(s.belt_stiffness, "belt stiffness of a ring tyre", "N");
  for (const double k : {s.sidewall_stiffness, s.along_stiffness, s.lateral_stiffness})
    require_positive(k, "a sidewall stiffness of a ring tyre", "N/m^2");
  require_non_negative(s.sidewall_by_pressure, "rise of a ring tyre's sidewall stiffness with its pressure",
                       "(no unit)");
  require_non_negative(s.damping, "damping of a ring tyre", "(of critical)");
  if (!(s.rim_radius > 0.0 && s.rim_radius + s.thickness < s.radius)) {
    fail(
        "the rim of a ring tyre has a radius of {:g} m, but must be above 0 and below that of the tyre, {:g} m, less "
        "its thickness",
        s.rim_radius, s.radius);
  }
  if (!(s.pressure * s.width * s.radius < 0.1 * s.belt_stiffness)) {
    fail(
        "a pressure of {:g} Pa would stretch the belt of a ring tyre by {:.2g}, a tenth is the most; lower it, or "
        "raise "
        "belt_stiffness",
        s.pressure, s.pressure * s.width * s.radius / s.belt_stiffness);
  }
  if (s.pressure > 0.0 && !(s.pressure >= 1e3 && s.pressure <= 2e6)) {
    fail("the pressure of a ring tyre is {:g} Pa, but must be 0 or lie between 1e3 and 2e6; 1 bar is 1e5 Pa",
         s.pressure);
  }
}

/// N/m, vertical stiffness of a belted radial tyre by T. B. Rhyne, "Development of a vertical stiffness relationship
/// for belted radial tires", Tire Science and Technology 33, 136 (2005), doi 10.2346/1.2174340, as it is quoted: K =
/// 0.00028 p sqrt((1.03 - 0.004 AR) S (S AR/50 + D)) + 3.45 in kg/mm, with p in kPa, the section's width S and the
/// rim's diameter D in mm, and the aspect ratio AR in percent. `pressure` in Pa, lengths in m.
inline double rhyne_stiffness(double pressure, double section_width, double radius, double rim_radius) {
  const double s = 1e3 * section_width, d = 2e3 * rim_radius, aspect = 100.0 * (radius - rim_radius) / section_width;
  return 9.81e3 * (0.00028 * 1e-3 * pressure * std::sqrt((1.03 - 0.004 * aspect) * s * (s * aspect / 50.0 + d)) + 3.45);
}

/// The bodies of a ring tyre, in the order of their angle on the rim.
struct RingTyre {
  RingTyreSpec spec;
  BodyId rim;
  std::vector<BodyId> segments;
  /// m, along x, y, z of a segment: along the belt, across it, outwards. Segments overlap, so that no gap opens between
  /// them where the belt stretches.
  Vector3<double> edges() const { return {1.05 * spec.arc(), spec.width, spec.thickness}; }
};

/// m, by which the tread's lowest point is nearer to the wheel's middle than that of the unloaded tyre, on ground that
/// z stands across. The print of a tyre is as deep as this point. By the middles of
/// the segments, so within 1 mm.
inline double deflection_of(const mbd::Mechanism& m, const RingTyre& tyre) {
  double lowest = HUGE_VAL;
  for (const BodyId b : tyre.segments) {
    const Vec3 out = m.reference_rotation(b).col(2);
    lowest = std::min(lowest, m.body(b).position().z() + 0.5 * tyre.spec.thickness * out.z());
  }
  return tyre.spec.radius - (m.body(tyre.rim).position().z() - lowest);
}

/// Puts a tyre on a rim that turns about y of the vehicle, with its middle at `middle` (m) and a `spin` (rad/s). The
/// rim's mass is that of the wheel without the belt. Outside of the ring is the tread: a segment's own frame has its
/// middle half a thickness below it. Throws Error for a tyre that cannot be.
DEM_SETUP inline RingTyre add_ring_tyre(const Assembly& in, const std::string& corner, BodyId rim, const Vec3& middle,
                                        const RingTyreSpec& s, double spin = 0.0) {
  check_ring_tyre(s);
  mbd::Mechanism& m = in.mechanism();
  RingTyre tyre{.spec = s, .rim = rim, .segments = {}};
  const int n = s.segments;
  const double ds = s.arc(), mass = s.mass / n, ring = s.radius - 0.5 * s.thickness;
  const Vec3 inertia = mass / 12.0 *
                       Vec3(s.width * s.width + s.thickness * s.thickness, ds * ds + s.thickness * s.thickness,
                            ds * ds + s.width * s.width);
  const auto damper = [&](double stiffness, double of) { return 2.0 * s.damping * std::sqrt(stiffness * of); };
  // Along, sideways, radial; turning about these as stiff as a sidewall at the ends of the segment.
  const Vec3 k = ds * Vec3(s.along_stiffness, s.lateral_stiffness, s.radial_stiffness());
  const Vec3 turn(0.25 * s.width * s.width * k.z(), 0.25 * ds * ds * (k.z() + k.x()) + 0.01 * s.width * s.width * k.z(),
                  0.25 * s.width * s.width * k.x());
  Vec3 c, turn_damping;
  for (int i = 0; i < 3; ++i) c[i] = damper(k[i], mass), turn_damping[i] = damper(turn[i], inertia[i]);

  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    const Vec3 out(std::sin(angle), 0, -std::cos(angle)), at = middle + ring * out;
    Mat3 axes;  // along the belt, sideways, outwards
    axes.col(2) = out, axes.col(1) = Vec3::UnitY(), axes.col(0) = Vec3::UnitY().cross(out);
    const std::string part = corner + " tyre " + std::to_string(i);
    const Vec3 velocity = in.direction(Vec3(in.speed(), 0, 0) + Vec3(0, spin, 0).cross(ring * out));
    const BodyId body = m.add_body(mbd::given_body(in.name(part), mass, inertia)
                                       .at(in.point(at), in.rotation() * axes)
                                       .moving(velocity, in.direction(Vec3(0, spin, 0))));
    tyre.segments.push_back(body);
    in.add_joint(mbd::bushing(in.name(part), rim, body, in.point(at), in.direction(out), k, c, turn, turn_damping)
                     .with_x(in.direction(axes.col(0))));
    // Along the rim's radius, so that the air's forces on the whole ring are none.
    const Vector3<double> outwards = transpose_times(m.body(rim).motion.rotation, from_eigen(in.direction(out)));
    const double air = s.pressure * s.width * ds;
    const auto law = [outwards, air](double, const Body& wheel, const Body&) {
      return Wrench{air * (wheel.motion.rotation * outwards), {0, 0, 0}};
    };
    m.add_load(mbd::custom_load(in.name(part + " air"), rim, body, law));
  }
  // Neighbours are hinged where their ends meet, by a spring in all directions, so that they lie along the belt. The
  // ends stop so far short of each other that the spring's pull holds the air: p b ds = 2 T sin(pi/n).
  const double half_angle = std::numbers::pi / n, chord = 2.0 * ring * std::sin(half_angle);
  const double stiffness = s.belt_stiffness / chord, damping = damper(stiffness, mass);
  const double tension = s.pressure * s.width * ds / (2.0 * std::sin(half_angle));
  const double half = 0.5 * (chord - tension / stiffness) / std::cos(half_angle);
  for (int i = 0; i < n; ++i) {
    const BodyId first = tyre.segments[i], second = tyre.segments[(i + 1) % n];
    // In the order of the angle, from x = 0 forward, the belt runs along minus x of the segments.
    const auto end_of = [&](BodyId b, double at) {
      return transpose_times(m.body(b).motion.rotation, from_eigen(m.reference_rotation(b) * Vec3(at, 0, 0)));
    };
    const Vector3<double> end = end_of(first, -half), begin = end_of(second, half);
    const auto hinge = [=](double, const Body& a, const Body& b) {
      const auto &x = a.motion, &y = b.motion;
      const Vector3<double> of_a = x.rotation * end, of_b = y.rotation * begin;
      const Vector3<double> gap = (y.position + of_b) - (x.position + of_a);
      const Vector3<double> opening = (y.velocity + cross(y.rotation * y.angular_velocity, of_b)) -
                                      (x.velocity + cross(x.rotation * x.angular_velocity, of_a));
      const Vector3<double> force = -stiffness * gap - damping * opening;
      return Wrench{force, cross(of_b, force)};
    };
    m.add_load(mbd::custom_load(in.name(corner + " belt " + std::to_string(i)), first, second, hinge));
  }
  return tyre;
}

}  // namespace dem::vehicle
