#pragma once

#include <dem/core/ids.hpp>

namespace dem {

using ConnectionId = Id<struct ConnectionTag>;  ///< a named point of a body, to which joints are attached
using JointId = Id<struct JointTag>;            ///< a joint between two bodies
using ActuatorId = Id<struct ActuatorTag>;      ///< a PD actuator or a motor
using SpringId = Id<struct SpringTag>;          ///< a spring-damper element between two points
using CouplingId = Id<struct CouplingTag>;      ///< a gear, rack or differential between joint coordinates
using ClutchId = Id<struct ClutchTag>;          ///< a clutch or a brake
using BrakeId = ClutchId;                       ///< a brake is a clutch to what its joint stands on
using LoadId = Id<struct LoadTag>;              ///< an applied force or torque
using MotionId = Id<struct MotionTag>;          ///< a prescribed motion
using TerrainId = Id<struct TerrainTag>;        ///< ground that gives way and remembers it
using SensorId = Id<struct SensorTag>;          ///< a force sensor

}  // namespace dem
