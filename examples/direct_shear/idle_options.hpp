#pragma once

#include "settings.hpp"

#include <initializer_list>
#include <string>
#include <vector>

namespace direct_shear {

/// An option that changes nothing in a run, because of another option.
struct IdleOption {
  std::string name;
  std::string when_it_counts;  ///< "counts only ..."
};

/// All of them for these settings, which need not be resolved. They are refused when given, for who gives one expects
/// that it does something, and left out of settings.toml.
inline std::vector<IdleOption> idle_options(const Settings& s) {
  std::vector<IdleOption> idle;
  const auto unless = [&](bool counts, const char* when, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      if (!counts) idle.push_back({name, when});
    }
  };
  const bool made = s.packing_file.empty(), random = s.packing == "random";
  unless(made, "without --packing-file, which fixes the packing",
         {"--grains", "--packing", "--relative-density", "--tilt", "--shake-amplitude", "--shake-frequency",
          "--shake-time", "--densify-time", "--settle-limit", "--seed", "--save-packing"});
  if (made) {
    unless(random, "with --packing random", {"--relative-density", "--densify-time", "--seed"});
    unless(!random, "with --packing poured", {"--tilt", "--shake-time"});
    unless(!random || s.relative_density != 0.0, "with a --relative-density above 0, for which a packing is shaken",
           {"--densify-time", "--shake-amplitude", "--shake-frequency"});
  }
  unless(!s.packing_only, "without --packing-only, for it is of the test",
         {"--stable-share", "--strike-off", "--loads", "--lid-speed", "--rest-speed", "--consolidation-limit",
          "--shear-speed", "--travel", "--ramp-time", "--smoothing", "--residual-share", "--area-correction",
          "--vtk-spheres", "--vtk-interval"});
  unless(s.scale_contacts, "with --scale-contacts true", {"--constants-for"});
  unless(s.time_step == 0.0, "without --time-step, which sets the step", {"--stable-share"});
  unless(s.time_step != 0.0, "with --time-step", {"--allow-unstable-time-step"});
  unless(s.shape == "cube8", "with --shape cube8", {"--vtk-spheres"});
  unless(s.vtk, "with files for ParaView, without --no-vtk", {"--vtk-spheres", "--vtk-interval"});
  return idle;
}

}  // namespace direct_shear
