#pragma once

// A spatial slider-crank: the crank turns about x beside the slider's line, the rod runs from the crank's pin to the
// slider, which is guided along x. One degree of freedom; where the slider is follows from the crank's angle.

#include "mbd_test.hpp"

#include <algorithm>
#include <cmath>

namespace dem::mbd::test {

template <class I, class Joints = Penalty>
struct SpatialSliderCrank {
  static constexpr double radius = 0.08, rod_length = 0.3, speed = 6.0;  // m, m, rad/s

  Machine<I, Joints> m;
  Vec3 centre = {0, 0.1, 0.12}, start;  // m: of the crank, and the slider at the start
  BodyId crank, rod, slider;
  JointId bearing, guide;

  SpatialSliderCrank() {
    m.gravity.setZero();
    const Vec3 pin = this->pin(0.0);
    start = Vec3(slider_at(0.0), 0, 0);
    const Vec3 along = (start - pin).normalized(), middle = 0.5 * (centre + pin);
    const Mat3 pose = Eigen::Quaterniond::FromTwoVectors(X, along).toRotationMatrix();
    crank = m.add_body(given_body("crank", 0.12, Vec3(1e-4, 1e-4, 1e-5))
                           .at(middle)
                           .moving(Vec3(speed * X).cross(Vec3(middle - centre)), speed * X));
    rod = m.add_body(given_body("rod", 0.5, Vec3(4e-4, 4e-3, 4e-3)).at(0.5 * (pin + start), pose));
    slider = m.add_body(given_body("slider", 2.0, Vec3(1e-3, 1e-3, 1e-3)).at(start));
    bearing = m.add_joint(revolute("crank bearing", m.ground(), crank, centre, X));
    m.add_joint(spherical("big end", crank, rod, pin));
    m.add_joint(universal("small end", rod, slider, start, along, X));
    guide = m.add_joint(prismatic("guide", m.ground(), slider, start, X));
  }

  Vec3 pin(double angle) const { return centre + radius * Vec3(0, -std::sin(angle), std::cos(angle)); }
  double slider_at(double angle) const {
    const Vec3 p = pin(angle);
    return p.x() + std::sqrt(rod_length * rod_length - p.y() * p.y() - p.z() * p.z());
  }
  /// m, by which the slider is off from where the crank's angle puts it.
  double off() const { return std::abs(start.x() + m.coordinate(guide) - slider_at(m.coordinate(bearing))); }
  double kinetic() const {
    return kinetic_energy(m.body(crank)) + kinetic_energy(m.body(rod)) + kinetic_energy(m.body(slider));
  }
};

}  // namespace dem::mbd::test
