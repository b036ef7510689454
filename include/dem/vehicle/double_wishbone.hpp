#pragma once

#include <dem/vehicle/assembly.hpp>

#include <string>

namespace dem::vehicle {

/// Points of a double wishbone suspension in m: of the left wheel, as the suspension is drawn.
struct WishbonePoints {
  Vec3 wheel = Vec3::Zero();  ///< middle of the wheel
  Vec3 knuckle = Vec3::Zero();
  Vec3 upper_front = Vec3::Zero(), upper_back = Vec3::Zero(), upper_ball = Vec3::Zero();
  Vec3 lower_front = Vec3::Zero(), lower_back = Vec3::Zero(), lower_ball = Vec3::Zero();
  Vec3 rod_inner = Vec3::Zero(), rod_outer = Vec3::Zero();  ///< tie rod or toe link; outer on the knuckle
  Vec3 spring_chassis = Vec3::Zero(), spring_arm = Vec3::Zero();
  Vec3 shock_chassis = Vec3::Zero(), shock_arm = Vec3::Zero();

  /// f(point) for all of them.
  template <class F>
  WishbonePoints mapped(F&& f) const {
    return {f(wheel),          f(knuckle),    f(upper_front),   f(upper_back), f(upper_ball),
            f(lower_front),    f(lower_back), f(lower_ball),    f(rod_inner),  f(rod_outer),
            f(spring_chassis), f(spring_arm), f(shock_chassis), f(shock_arm)};
  }
  /// Of the wheel on the other side.
  WishbonePoints mirrored() const {
    return mapped([](const Vec3& p) { return Vec3(p.x(), -p.y(), p.z()); });
  }
  WishbonePoints shifted(const Vec3& by) const {
    return mapped([&](const Vec3& p) -> Vec3 { return p + by; });
  }
  /// Centres of mass of the arms: half way from the middle of the hinge to the ball joint.
  Vec3 upper_centre() const { return 0.25 * (upper_front + upper_back) + 0.5 * upper_ball; }
  Vec3 lower_centre() const { return 0.25 * (lower_front + lower_back) + 0.5 * lower_ball; }
};

/// A joint that holds a point: rigid as the time step allows, or of rubber.
struct BallJoint {
  bool is_rubber = false;
  double stiffness = 7e7;  ///< N/m in each direction, of rubber
  double damping = 3.5e4;  ///< N s/m

  /// Throws Error for a constant that is not positive.
  DEM_SETUP JointId add(const Assembly& in, const std::string& part, BodyId a, BodyId b, const Vec3& at) const {
    if (!is_rubber) return in.joint(mbd::JointKind::spherical, part, a, b, at);
    require_positive(stiffness, ("stiffness of " + part).c_str(), "N/m");
    require_positive(damping, ("damping of " + part).c_str(), "N s/m");
    return in.add_joint(mbd::bushing(in.name(part), a, b, in.point(at), in.direction(Vec3::UnitZ()), filled(stiffness),
                                     filled(damping), Vec3::Zero(), Vec3::Zero()));
  }
};

struct DoubleWishboneSpec {
  WishbonePoints points;
  PartMass upper_arm, lower_arm, knuckle;
  double spring_free_length = 0.0;             ///< m
  mbd::Curve spring_force = {};                ///< N over compression in m
  double shock = 0.0;                          ///< N s/m
  BallJoint upper_ball = {}, lower_ball = {};  ///< between the arms and the knuckle
  double lower_angle = 0.45;                   ///< rad, stops of the lower arm, both ways from where it is drawn

  DoubleWishboneSpec mirrored() const {
    DoubleWishboneSpec s = *this;
    s.points = points.mirrored();
    return s;
  }
};

/// The suspension of one wheel: two arms that turn on the chassis, and the knuckle between them. What holds the
/// knuckle's toe is another part: a toe link, or the tie rod of a steering.
struct DoubleWishbone {
  BodyId upper_arm, lower_arm, knuckle;
  JointId upper_hinge, lower_hinge, upper_ball, lower_ball;  ///< the hinges point forward
  SpringId spring, shock;
};

DEM_SETUP inline DoubleWishbone add_double_wishbone(const Assembly& in, const std::string& corner, BodyId chassis,
                                                    const DoubleWishboneSpec& s) {
  using mbd::JointKind;
  mbd::Mechanism& m = in.mechanism();
  const WishbonePoints& p = s.points;
  DoubleWishbone w;
  w.upper_arm = in.body(corner + " upper arm", s.upper_arm, p.upper_centre());
  w.lower_arm = in.body(corner + " lower arm", s.lower_arm, p.lower_centre());
  w.knuckle = in.body(corner + " knuckle", s.knuckle, p.knuckle);
  const auto hinge = [&](const char* part, BodyId arm, const Vec3& front, const Vec3& back) {
    const Vec3 middle = 0.5 * (front + back), axis = front - back;
    return mbd::revolute(in.name(corner + part), chassis, arm, in.point(middle), in.direction(axis));
  };
  w.upper_hinge = in.add_joint(hinge(" upper hinge", w.upper_arm, p.upper_front, p.upper_back));
  w.lower_hinge = in.add_joint(
      hinge(" lower hinge", w.lower_arm, p.lower_front, p.lower_back).with_limits(-s.lower_angle, s.lower_angle));
  w.upper_ball = s.upper_ball.add(in, corner + " upper ball joint", w.upper_arm, w.knuckle, p.upper_ball);
  w.lower_ball = s.lower_ball.add(in, corner + " lower ball joint", w.lower_arm, w.knuckle, p.lower_ball);
  w.spring = m.add_spring(mbd::spring_table(in.name(corner + " spring"), chassis, in.point(p.spring_chassis),
                                            w.lower_arm, in.point(p.spring_arm), s.spring_free_length, s.spring_force));
  w.shock = m.add_spring({.name = in.name(corner + " shock"),
                          .a = chassis,
                          .b = w.lower_arm,
                          .at_a = in.point(p.shock_chassis),
                          .at_b = in.point(p.shock_arm),
                          .force_over_speed = mbd::Curve::line(0.0, -require_non_negative(s.shock, "shock", "N s/m"))});
  return w;
}

/// A massless link of given length that keeps the knuckle's toe where there is no steering.
DEM_SETUP inline JointId add_toe_link(const Assembly& in, const std::string& corner, BodyId chassis, BodyId knuckle,
                                      const WishbonePoints& p) {
  return in.add_joint(
      mbd::distance(in.name(corner + " toe link"), chassis, in.point(p.rod_inner), knuckle, in.point(p.rod_outer)));
}

}  // namespace dem::vehicle
