#pragma once

#include <dem/mbd/solver/mechanism.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace dem::vehicle {

/// Mass (kg) and principal moments of inertia (kg m^2, about the centre of mass, along the axes of the vehicle).
struct PartMass {
  double mass = 0.0;
  Vec3 inertia = Vec3::Zero();
};

/// A full cylinder about the x (0), y (1) or z (2) axis of the vehicle; mass in kg, radius and length in m.
DEM_SETUP inline PartMass round_part(double mass, double radius, double length, int axis) {
  require_positive(mass, "mass of a round part", "kg");
  require_positive(radius, "radius of a round part", "m");
  require_positive(length, "length of a round part", "m");
  PartMass p{mass, filled(mass * (3.0 * radius * radius + length * length) / 12.0)};
  p.inertia[axis] = 0.5 * mass * radius * radius;
  return p;
}

/// Where a vehicle is put together. All parts of this room are given in the axes of the vehicle: x forward, y left, z
/// up, in m. The frame places them in a mechanism, which may be that of a machine or that of a world.
class Assembly {
 public:
  /// `rotation` turns axes of the vehicle to global ones. The vehicle starts with `speed` (m/s, forward).
  explicit Assembly(mbd::Mechanism& mechanism, std::string name = "car", const Vec3& position = Vec3::Zero(),
                    const Mat3& rotation = Mat3::Identity(), double speed = 0.0)
      : mechanism_(&mechanism), name_(std::move(name)), position_(position), rotation_(rotation), speed_(speed) {}

  mbd::Mechanism& mechanism() const { return *mechanism_; }
  const Mat3& rotation() const { return rotation_; }
  double speed() const { return speed_; }
  std::string name(const std::string& part) const { return name_ + " " + part; }
  Vec3 point(const Vec3& p) const { return position_ + rotation_ * p; }
  Vec3 direction(const Vec3& d) const { return rotation_ * d; }

  /// Adds a body with its centre of mass at `centre`. It turns with `spin` (rad/s) at the start, beside the speed of
  /// the vehicle.
  DEM_SETUP BodyId body(const std::string& part, const PartMass& m, const Vec3& centre,
                        const Vec3& spin = Vec3::Zero()) const {
    const Vec3 velocity = direction(Vec3(speed_, 0, 0)), turn = direction(spin);
    return mechanism_->add_body(
        mbd::given_body(name(part), m.mass, m.inertia).at(point(centre), rotation_).moving(velocity, turn));
  }
  /// Adds a joint. Unless it says where x of its frame lies, that follows from the axes of the vehicle as
  /// JointSpec::with_x says of the global ones: the arms of a cross stand the same way wherever the vehicle heads.
  DEM_SETUP JointId add_joint(const mbd::JointSpec& s) const {
    if (s.x_axis) return mechanism_->add_joint(s);
    const bool along_x = std::abs(s.axis_a.normalized().dot(direction(Vec3::UnitX()))) > 0.9;
    return mechanism_->add_joint(s.with_x(direction(along_x ? Vec3::UnitY() : Vec3::UnitX())));
  }
  /// The same for a joint of one point and one axis.
  DEM_SETUP JointId joint(mbd::JointKind kind, const std::string& part, BodyId a, BodyId b, const Vec3& at,
                          const Vec3& axis = Vec3::UnitZ()) const {
    return add_joint(mbd::joint(kind, name(part), a, b, point(at), direction(axis)));
  }

 private:
  mbd::Mechanism* mechanism_;
  std::string name_;
  Vec3 position_;
  Mat3 rotation_;
  double speed_;
};

}  // namespace dem::vehicle
