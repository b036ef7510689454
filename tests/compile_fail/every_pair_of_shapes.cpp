// expect-success: dem.hpp alone says how each of dem's shapes touches each other one.
#include <dem/dem.hpp>
#include <dem/geometry/shapes.hpp>

using namespace dem::shape;

struct Grain : dem::Model {
  using Shape = Mixed<Sphere, SphereCluster<8>, SphereCluster<2>, Polyhedron, Superquadric, SuperquadricPoints>;
};

int main() {
  dem::World<Grain> world;
  world.add_species(Superquadric({1, 1, 1}, {4, 4, 4}));
  world.add_species(SuperquadricPoints({1, 1, 1}, {4, 4, 4}));
  return world.run(1) ? 0 : 1;
}
