// expect: Mixed: nothing says how these two shapes touch
#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedron.hpp>

using Both = dem::shape::Mixed<dem::shape::Superquadric, dem::shape::Polyhedron>;
static_assert(dem::shape::Shape<Both>);

int main() {
  const Both grain = dem::shape::Superquadric({1, 1, 1}, {2, 2, 2});
  double pose[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Both::collide(grain, pose, grain, pose, {1, 0, 0}, dem::AnyCallback{});
}
