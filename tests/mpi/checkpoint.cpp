#include "box_of_spheres.hpp"

namespace scenes {

bool checkpoint() {
  const bool counted = goes_on<Shared, Alone>("counted", []<class Model>(int n) {
    auto world = box_of_spheres<Model>(n);
    count_energy(world);
    return world;
  });
  return goes_on<Shared, Alone>("checkpoint", []<class Model>(int n) { return box_of_spheres<Model>(n); }) && counted;
}

}  // namespace scenes
