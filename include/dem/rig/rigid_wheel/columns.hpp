#pragma once

#include <dem/rig/rigid_wheel/references.hpp>
#include <dem/rig/rigid_wheel/results.hpp>
#include <dem/terramechanics/column_wheel.hpp>

namespace dem::rig::rigid_wheel {

/// Rolls the rig's wheel on columns of these soils (dynamic Bekker), at the slips of the runs. It takes a second or so
/// for a soil.
inline void roll_on_columns(std::vector<Reference>& soils, const Campaign& c, const Settings& s) {
  for (Reference& reference : soils) {
    const terramechanics::ColumnWheel test{
        .wheel = reference_wheel(s),
        .soil = reference.soil,
        .friction = s.wheel == "smooth" ? s.wheel_friction : terramechanics::ColumnPart::rough,
        .load = s.load,
        .wheel_mass = 0.1 * s.load / 9.81,
        .spin = s.spin(),
        .travel = 1.5 * s.radius};
    for (const SlipResult& r : c.slips) {
      auto& forces = reference.on_columns.emplace_back();
      try {
        const auto run = terramechanics::roll_on_columns(test, r.slip);
        forces = {.sinkage = run.sinkage, .load = s.load, .pull = run.pull, .torque = run.torque};
      } catch (const Error&) {  // it does not carry the wheel
      }
    }
  }
}

}  // namespace dem::rig::rigid_wheel
