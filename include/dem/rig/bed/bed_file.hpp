#pragma once
// Levelled beds kept as files, so that several runs start from one.

#include <dem/rig/bed/make_bed.hpp>
#include <dem/soil/packing_file.hpp>

namespace dem::rig {

/// Reads the bed of --bed-file. Throws Error if it is none, not one of these grains in this box, or one that repeats
/// itself where a box has walls or the other way round.
inline soil::Packing read_bed(const BedSettings& s, const GrainSettings& grains, bool repeats) {
  soil::Packing p = soil::load_packing(s.file);
  const auto differs = [](double a, double b) { return std::abs(a - b) > 1e-9; };
  if (p.grains.empty() || p.shape != "cube8") {
    fail("the bed '{}' has {} grains of shape {}, but must have cubes of eight spheres, cube8; give another --bed-file",
         s.file, p.grains.size(), p.shape);
  }
  if (differs(p.half_edge, grains.half_edge) || differs(p.length_x, s.length) || differs(p.length_y, s.width)) {
    fail(
        "the bed '{}' has grains of half-edge {:g} m in a box of {:g} x {:g} m, but the settings say {:g} m in {:g} x "
        "{:g} m; give --half-edge {:g} --bed-length {:g} --bed-width {:g}",
        s.file, p.half_edge, p.length_x, p.length_y, grains.half_edge, s.length, s.width, p.half_edge, p.length_x,
        p.length_y);
  }
  if ((p.note.find(repeating_note) != std::string::npos) != repeats) {
    fail("the bed '{}' {} along x, but the one that is asked for {}; give another --bed-file", s.file,
         repeats ? "has walls" : "repeats itself", repeats ? "repeats itself" : "has walls");
  }
  return p;
}

/// What a bed starts from: its file of places, or grains to be rained. `repeats`: it repeats itself along x. Throws
/// Error.
inline soil::Packing start_of_bed(const BedSettings& s, const GrainSettings& grains, double volume,
                                  double bounding_radius, bool repeats = false) {
  return s.is_rained() ? bed_grains(s, grains, volume, bounding_radius) : read_bed(s, grains, repeats);
}

}  // namespace dem::rig
