#pragma once

#include <dem/rig/direct_shear/grain_kind.hpp>
#include <dem/soil/packing_file.hpp>

#include <cmath>

namespace dem::rig::direct_shear {

/// Reads --packing-file. Throws Error if it is no packing, or not one of these grains in this box.
inline soil::Packing read_packing(const Settings& s) {
  auto packing = soil::load_packing(s.packing_file);
  const std::string& shape = kind_of(s).name;
  if (packing.grains.empty()) {
    fail("the packing '{}' has no grains, but must have at least one; give another --packing-file", s.packing_file);
  }
  if (packing.shape != shape) {
    fail(
        "the packing '{}' is one of grains of shape {}, but --shape is {}: other grains in these places would overlap; "
        "give --shape {}, or leave --packing-file out",
        s.packing_file, packing.shape, shape, packing.shape);
  }
  const auto differs = [](double a, double b) { return std::abs(a - b) > 1e-9; };
  if (differs(packing.half_edge, s.half_edge) || differs(packing.length_x, s.box_length) ||
      differs(packing.length_y, s.box_width)) {
    fail(
        "the packing '{}' has grains of half-edge {:g} m in a box of {:g} x {:g} m, but the settings say {:g} m in "
        "{:g} x {:g} m; give --half-edge {:g} --box-length {:g} --box-width {:g}",
        s.packing_file, packing.half_edge, packing.length_x, packing.length_y, s.half_edge, s.box_length, s.box_width,
        packing.half_edge, packing.length_x, packing.length_y);
  }
  return packing;
}

}  // namespace dem::rig::direct_shear
