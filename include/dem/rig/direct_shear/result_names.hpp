#pragma once

#include <dem/rig/old_results.hpp>

namespace dem::rig::direct_shear {

/// What the files of a run are called.
inline ResultNames result_names() {
  return {.files = {"results.csv", "report.html", "load_#+.#kPa.csv", "load_#+.#kPa.pvd", "shear_stress.gp",
                    "shear_stress.svg", "shear_stress.png", "dilation.gp", "dilation.svg", "dilation.png",
                    "mohr_coulomb.gp", "mohr_coulomb.svg", "mohr_coulomb.png"},
          .frames = {"grains", "boxes", "spheres", "superquadrics", "polyhedra", "meshes"}};
}

}  // namespace dem::rig::direct_shear
