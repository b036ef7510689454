// expect: exec::Cuda, exec::Flat: grains must be shape::Sphere or a shape::SphereCluster of at most 8 spheres
#include <dem/flat/flat.hpp>
#include <dem/geometry/polyhedron/polyhedron.hpp>

struct Gravel : dem::Model {
  using Shape = dem::shape::Polyhedron;
  using Executor = dem::exec::Flat;
};

int main() { dem::flat::check_flat_model<Gravel>(); }
