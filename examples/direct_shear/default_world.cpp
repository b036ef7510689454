// Of direct_shear: what it runs by default.

#include "worlds.hpp"

std::span<const shear::ShearWorld> worlds() {
  static constexpr shear::ShearWorld own[] = {{"cube8", "verlet", cube8_verlet}};
  return own;
}
