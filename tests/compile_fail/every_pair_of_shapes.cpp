// expect-success: dem.hpp alone says how each of dem's shapes touches each other one.
#include <dem/dem.hpp>

using namespace dem::shape;

template <class Rounded>
struct Grain : dem::Model {
  using Shape = Mixed<Sphere, SphereCluster<8>, SphereCluster<2>, Polyhedron, Rounded>;
};

int main() {
  const auto step = [](auto model, const auto& grain) {
    dem::World<decltype(model)> world;
    world.add_species(grain);
    return bool(world.run(1));
  };
  const dem::Vec3 radii(1, 1, 1), exponents(4, 4, 4);
  return step(Grain<Superquadric>{}, Superquadric(radii, exponents)) &&
                 step(Grain<SuperquadricPoints>{}, SuperquadricPoints(radii, exponents))
             ? 0
             : 1;
}
