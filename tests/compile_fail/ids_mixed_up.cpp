// expect: could not convert|cannot convert|no viable conversion
#include <dem/dem.hpp>

int main() {
  dem::World<dem::Model> world;
  world.surface_force(world.ground());
}
