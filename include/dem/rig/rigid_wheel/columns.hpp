#pragma once

#include <dem/rig/rigid_wheel/references.hpp>
#include <dem/rig/rigid_wheel/results.hpp>
#include <dem/terramechanics/column_wheel.hpp>

namespace dem::rig::rigid_wheel {

/// Rolls the rig's wheel on columns of these soils (dynamic Bekker), at the slips of runs that were made. It takes some
/// seconds a soil: columns know no rates, so the wheel turns at 1 rad/s whatever the rig's does. Slips from 0.95 on,
/// where it hardly gets on, are left out. Columns carry a wheel with grousers by their tips, so its sinkage is not
/// beside that of the rim: it is not known.
inline void roll_on_columns(std::vector<Reference>& soils, const Campaign& c, const Settings& s) {
  for (Reference& reference : soils) {
    const terramechanics::ColumnWheel test{.wheel = reference_wheel(s),
                                           .soil = reference.soil,
                                           .friction = grips(s) ? terramechanics::ColumnPart::rough : s.wheel_friction,
                                           .load = s.load,
                                           .wheel_mass = 0.1 * s.load / 9.81,
                                           .spin = 1.0,
                                           .travel = 1.5 * s.radius,
                                           .spacing = s.radius / 13.0};
    for (const SlipResult& r : c.slips) {
      auto& forces = reference.on_columns.emplace_back();
      if (r.samples.empty() || r.slip > 0.95) continue;
      try {
        const auto run = terramechanics::roll_on_columns(test, r.slip);
        forces = {.sinkage = s.wheel == "grousers" ? not_known : run.sinkage,
                  .load = s.load,
                  .pull = run.pull,
                  .torque = run.torque};
      } catch (const Error& problem) {  // as of soil that does not carry the wheel
        reference.no_columns = problem.what();
      }
    }
  }
}

}  // namespace dem::rig::rigid_wheel
