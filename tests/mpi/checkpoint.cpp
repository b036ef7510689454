#include "box_of_spheres.hpp"

namespace scenes {

bool checkpoint() {
  return goes_on<Shared, Alone>("checkpoint", []<class Model>(int n) { return box_of_spheres<Model>(n); });
}

}  // namespace scenes
