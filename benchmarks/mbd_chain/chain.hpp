#pragma once

// A machine of the size of a vehicle: a chassis on springs, four limbs of eight bodies with joints of many kinds, and a
// sliding rack. 34 moving bodies, 35 joints.

#include <dem/mbd/mbd.hpp>

#include <cmath>
#include <string>

namespace dem::bench {

template <integrator::Integrator I>
mbd::Machine<I> make_chain() {
  using namespace dem::mbd;
  Machine<I> m;
  m.joint_tolerance = HUGE_VAL;  // the rate is asked for, with joints as soft as they get
  const auto block = [&](const std::string& name, const Vec3& at, const Vec3& size) {
    return m.add_body(box_body(name, size, 2000.0).at(at));
  };
  const BodyId chassis = block("chassis", {0, 0, 0.8}, {3.0, 0.8, 0.3});
  const BodyId rack = block("rack", {1.5, 0, 0.6}, {0.1, 0.6, 0.1});
  m.add_joint(prismatic("rack slide", chassis, rack, {1.5, 0, 0.6}, Vec3::UnitY()).with_limits(-0.1, 0.1));
  for (int limb = 0; limb < 4; ++limb) {
    const double side = limb % 2 == 0 ? 1.0 : -1.0, x = limb < 2 ? 1.5 : -1.5;
    const JointKind kinds[8] = {JointKind::revolute,  JointKind::revolute,         JointKind::spherical,
                                JointKind::universal, JointKind::revolute,         JointKind::fixed,
                                JointKind::prismatic, JointKind::constant_velocity};
    BodyId last = chassis;
    for (int k = 0; k < 8; ++k) {
      const Vec3 at(x, side * (0.4 + 0.2 * k), 0.8);
      const BodyId link = block("link " + std::to_string(8 * limb + k), at + Vec3(0, side * 0.1, 0), {0.1, 0.2, 0.1});
      const Vec3 axis = kinds[k] == JointKind::revolute ? Vec3::UnitX() : Vec3::UnitY();
      JointSpec spec = joint(kinds[k], "joint " + std::to_string(8 * limb + k), last, link, at, axis);
      if (kinds[k] == JointKind::prismatic) spec = spec.with_limits(-0.05, 0.05);
      m.add_joint(spec);
      last = link;
    }
    const Vec3 tip(x, side * 2.0, 0.8);
    m.add_spring(spring("spring " + std::to_string(limb), m.ground(), tip + Vec3(0, 0, -0.8), last, tip, 2e5, 4e3));
  }
  m.add_joint(point_on_plane("guide x", m.ground(), chassis, {0, 0, 0.8}, Vec3::UnitX()));
  m.add_joint(point_on_plane("guide y", m.ground(), chassis, {0, 0, 0.8}, Vec3::UnitY()));
  return m;
}

}  // namespace dem::bench
