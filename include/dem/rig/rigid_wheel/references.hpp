#pragma once

#include <dem/rig/rigid_wheel/settings.hpp>
#include <dem/terramechanics/soil_reader.hpp>
#include <dem/terramechanics/wheel_load.hpp>

#include <optional>
#include <string>
#include <vector>

namespace dem::rig::rigid_wheel {

/// A soil that the grains stand beside: by Bekker and Wong, and by columns with memory.
struct Reference {
  std::string name;
  terramechanics::Soil soil;
  /// On columns, of each run; filled by roll_on_columns(). None where there is no result; why stands in `no_columns`.
  std::vector<std::optional<terramechanics::WheelForces>> on_columns = {};
  std::string no_columns = {};  ///< of the last run without one
};

/// The published soils, and that of --soil. Throws Error if there is none of that name, or its file cannot be read.
inline std::vector<Reference> references(const Settings& s) {
  std::vector<Reference> list{{"P1", terramechanics::melanz_sand}, {"P3", terramechanics::mojave_martian_simulant}};
  if (!s.soil.empty() && s.soil != "p1" && s.soil != "p3")
    list.push_back({s.soil.substr(s.soil.rfind('/') + 1), terramechanics::find_soil(s.soil).soil});
  return list;
}

/// The rig's wheel, as the semi-empirical soils know it.
inline terramechanics::Wheel reference_wheel(const Settings& s) {
  return {.radius = s.radius, .width = s.width, .grouser_height = s.wheel == "grousers" ? s.grouser_height : 0.0};
}

/// Whether the rim grips as much as the grains do among each other; else it is smooth for the soil as well.
inline bool grips(const Settings& s) { return s.wheel != "smooth" && s.wheel_friction >= s.grains.friction; }

inline constexpr const char* smooth_text =
    "The rim is smoother than the grains: dynamic Bekker has its friction, but the equations of Bekker, Reece and Wong "
    "are those of soil that shears on soil.";

/// The wheel on a soil by eqs. 2-11; none where the soil does not carry it.
inline std::optional<terramechanics::WheelForces> reference_at(const terramechanics::Soil& soil, double slip,
                                                               const Settings& s) {
  try {
    return wheel_under_load(reference_wheel(s), soil, {slip, terramechanics::SlipDefinition::wheel_speed}, s.load);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace dem::rig::rigid_wheel
