// A program on ranks: mpirun -np 2 ./test_ranks spheres cubes ...; ends with 0 if all scenes have the bits that they
// have on one process.

#include "scene_list.hpp"

#include <dem/domain/session.hpp>

#include <string>

int main(int argc, char** argv) {
  const dem::domain::Session mpi(argc, argv);
  bool same = true;
  for (int k = 1; k < argc; ++k) {
    const std::string scene = argv[k];
    if (scene == "spheres") same = scenes::spheres() && same;
    else if (scene == "cubes") same = scenes::cubes() && same;
    else if (scene == "periodic") same = scenes::periodic() && same;
    else if (scene == "tiles") same = scenes::tiles() && same;
    else if (scene == "checkpoint") same = scenes::checkpoint() && same;
    else if (scene == "reports") same = scenes::reports() && same;
    else if (scene == "differ") same = scenes::differ() && same;
    else if (scene == "differ_later") same = scenes::differ_later() && same;
    else if (scene == "caught") same = scenes::caught() && same;
    else if (scene == "contacts_on_one") scenes::contacts_on_one();
    else if (scene == "columns_on_one") scenes::columns_on_one();
    else if (scene == "run_on_one") scenes::run_on_one();
    else if (scene == "tiles_on_one") scenes::tiles_on_one();
    else if (scene == "other_tiles") scenes::other_tiles();
    else if (scene == "added_before_tiles") scenes::added_before_tiles();
    else if (scene == "mistake") scenes::mistake();
    else if (scene == "disagree") scenes::disagree();
    else if (scene == "steered") scenes::steered();
    else if (scene == "other_shear") scenes::other_shear();
    else dem::fail("there is no scene '{}'", scene);
  }
  return same ? 0 : 1;
}
