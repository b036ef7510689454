// Of direct_shear_all: everything that --shape and --integrator may ask for.

#include "worlds.hpp"

std::span<const shear::ShearWorld> worlds() {
  static constexpr shear::ShearWorld all[] = {{"cube8", "verlet", cube8_verlet},
                                              {"cube8", "euler", cube8_euler},
                                              {"cube8", "predictor-corrector", cube8_predictor_corrector},
                                              {"polyhedron", "verlet", polyhedron_verlet},
                                              {"superquadric", "verlet", superquadric_verlet}};
  return all;
}
