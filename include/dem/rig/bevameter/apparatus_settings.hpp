#pragma once
// What the settings of a bevameter make of those of its apparatus.

#include <dem/rig/bevameter/settings.hpp>
#include <dem/rig/direct_shear/resolve.hpp>
#include <dem/rig/plate_sinkage/settings.hpp>
#include <dem/rig/rigid_wheel/settings.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

namespace dem::rig::bevameter {

/// The bed of an apparatus.
inline BedSettings bed_of(const Settings& s, double length, double width, double depth) {
  BedSettings bed;
  bed.length = length, bed.width = width, bed.depth = depth;
  bed.relative_density = s.relative_density;
  bed.fall_speed = s.fall_speed;
  bed.stage_limit = s.stage_limit;
  bed.stable_share = s.stable_share;
  bed.sleep = s.sleep;
  bed.seed = s.seed;
  bed.threads = s.threads;
  return bed;
}

/// The folder of an apparatus.
inline std::string folder_in(const Settings& s, const char* apparatus) {
  return (std::filesystem::path(s.output) / apparatus).string();
}

/// What an apparatus leaves in its folder.
template <class ApparatusSettings>
void set_output(ApparatusSettings& of, const Settings& s, const char* apparatus) {
  of.output = folder_in(s, apparatus);
  of.replay = s.replay;
  of.replay_forces = s.replay_forces;
  of.vtk = s.vtk;
}

/// The plates, drawn up again at the end.
inline plate_sinkage::Settings plates_of(const Settings& s) {
  plate_sinkage::Settings p;
  p.size = s.size;
  p.grains = s.grains;
  p.bed = bed_of(s, s.bed_length, s.bed_width, s.bed_depth);
  p.widths = s.widths;
  p.length = s.plate_length;
  p.speed = s.plate_speed;
  p.sinkage = s.sinkage;
  p.plate_friction = s.plate_friction;
  p.unload = true;
  set_output(p, s, "plates");
  plate_sinkage::resolve(p);
  return p;
}

/// The shear test. The box has as many grains along each edge as that of the direct shear rig's quick size (smoke: its
/// smoke size), whatever their size.
inline direct_shear::Settings shear_of(const Settings& s, double relative_density) {
  const double scale = s.grains.half_edge / (s.size == "smoke" ? 3e-3 : 1.6e-3);
  direct_shear::Settings d;
  d.size = s.size;
  d.half_edge = s.grains.half_edge;
  d.box_length = d.box_width = 0.06 * scale;
  d.box_height = 0.05 * scale;
  d.grains = s.size == "smoke" ? 385 : 2537;
  d.stiffness = s.grains.stiffness;
  d.damping = s.grains.damping;
  d.separation_factor = s.grains.separation_factor;
  d.friction = s.grains.friction;
  d.wall_friction = s.grains.wall_friction;
  d.friction_stiffness = s.grains.friction_stiffness;
  d.velocity_stiffness = s.grains.velocity_stiffness;
  d.breaking_factor = s.grains.breaking_factor;
  d.density = s.grains.density;
  d.constants_for = s.grains.constants_for;
  d.scale_contacts = s.grains.scale_contacts;
  d.relative_density = std::clamp(relative_density, 0.0, 1.0);
  d.shear_speed = s.shear_speed;
  d.travel = s.shear_travel;
  d.smoothing = s.shear_smoothing * s.shear_travel;
  for (const double sigma : s.normal_stresses) d.loads.push_back(sigma * d.area() / 9.81);
  d.stable_share = s.stable_share;
  d.seed = s.seed;
  d.threads = s.threads;
  set_output(d, s, "shear");
  direct_shear::resolve(d);
  return d;
}

/// The wheel; `soil` is the file of the soil that was found, empty before.
inline rigid_wheel::Settings wheel_of(const Settings& s, const std::string& soil) {
  rigid_wheel::Settings w;
  w.size = s.size;
  w.grains = s.grains;
  w.bed = bed_of(s, s.wheel_bed_length, s.wheel_bed_width, s.wheel_bed_depth);
  w.wheel = s.wheel;
  w.wheel_friction = s.wheel_friction;
  w.load = s.load;
  w.spin_deg = s.spin_deg;
  w.slips = s.slips;
  w.travel = s.wheel_travel;
  w.path = s.path;
  w.soil = soil;
  set_output(w, s, "wheel");
  rigid_wheel::resolve(w);
  return w;
}

}  // namespace dem::rig::bevameter
