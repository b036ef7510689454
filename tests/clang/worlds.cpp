// Worlds that clang compiles without a warning: the default one, and one with a choice of everything.
#include <dem/dem.hpp>
#include <dem/geometry/shapes.hpp>

namespace {

struct Mixture : dem::Model {
  using Shape = dem::shape::Mixed<dem::shape::Sphere, dem::shape::Polyhedron, dem::shape::Superquadric>;
  using Normal = dem::contact::Hertz;
  using Friction = dem::friction::Mindlin;
  using Rolling = dem::rolling::Sum<dem::rolling::ElasticPlastic, dem::rolling::Torsion>;
  using Cohesion = dem::cohesion::DMT;
  using Integrator = dem::integrator::VelocityVerlet;
  using Executor = dem::exec::Serial;
};

template <class Model>
bool steps() {
  dem::World<Model> world;
  world.add_body_contacts();
  return static_cast<bool>(world.run_for(0.0));
}

}  // namespace

int main() { return steps<dem::Model>() && steps<Mixture>() ? 0 : 1; }
