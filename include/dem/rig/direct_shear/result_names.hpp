#pragma once

#include <dem/rig/old_results.hpp>

namespace dem::rig::direct_shear {

/// What the files of a run are called.
inline ResultNames result_names() {
  return {.files = {"results.csv", "load_#+.#kPa.csv", "load_#+.#kPa.pvd"},
          .plots = {"shear_stress", "dilation", "mohr_coulomb"},
          .frames = {"grains", "boxes", "spheres", "superquadrics", "polyhedra", "meshes"}};
}

}  // namespace dem::rig::direct_shear
