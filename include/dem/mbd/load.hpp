#pragma once

#include <dem/mbd/ids.hpp>
#include <dem/mbd/signal.hpp>
#include <dem/state/body.hpp>

#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// A force (N) at a point of a body, or a torque (N m), along a direction that stays in space or turns with the body.
struct LoadSpec {
  std::string name;
  BodyId body = {};
  bool is_torque = false;
  Vec3 direction = Vec3::UnitZ();  ///< global at assembly; made a unit vector
  Signal size = 0.0;               ///< N or N m
  Vec3 at = Vec3::Zero();          ///< m, global at assembly
  bool follows_body = false;       ///< the direction turns with the body
  bool on = true;
};

inline LoadSpec applied_force(std::string name, BodyId body, const Vec3& at, const Vec3& direction, Signal newtons) {
  return {.name = std::move(name), .body = body, .direction = direction, .size = std::move(newtons), .at = at};
}
inline LoadSpec applied_torque(std::string name, BodyId body, const Vec3& axis, Signal newton_metres) {
  return {
      .name = std::move(name), .body = body, .is_torque = true, .direction = axis, .size = std::move(newton_metres)};
}

struct Load {
  LoadSpec spec;
  Vector3<double> point = {};      ///< m, body frame
  Vector3<double> direction = {};  ///< global, or body frame if it follows the body
  double size = 0.0;               ///< N or N m, in the newest force evaluation
};

inline void apply_load(Load& load, std::vector<Body>& bodies, double time) {
  if (!load.spec.on) return;
  Body& b = bodies[load.spec.body.index()];
  const Matrix3<double>& r = b.motion.rotation;
  load.size = load.spec.size(time).value;
  const Vector3<double> f = load.size * (load.spec.follows_body ? r * load.direction : load.direction);
  if (load.spec.is_torque) {
    b.torque += f;
  } else {
    b.force += f;
    b.torque += cross(r * load.point, f);
  }
}

}  // namespace dem::mbd
