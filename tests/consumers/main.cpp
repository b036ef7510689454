// Uses dem the way a stranger would: a ball falls on a plate and stays there. The version that was built against is the
// one that was asked for.
#include <cstdio>
#include <cstring>
#include <dem/dem.hpp>

int main(int count, char** arguments) {
  dem::World<dem::Model> world;
  world.set_contact({{2000.0, 0.05, 1.0}, {0.4, 2000.0, 0.015, 0.975}});
  const auto plate = world.add_surface(world.ground(), dem::surface::Plane{});
  dem::NewGrain ball;
  ball.species = world.add_species(dem::shape::Sphere(1e-3));
  ball.position = {0, 0, 1.1e-3};
  const auto grain = world.add_grain(ball);
  const dem::StepReport report = world.run_for(0.1);
  std::printf("%s: %g N on the plate\n", DEM_VERSION_STRING, world.surface_force(plate).z());
  const bool rests = report && world.position(grain).z() < 1e-3 && world.surface_force(plate).z() < 0.0;
  return rests && count == 2 && std::strcmp(arguments[1], DEM_VERSION_STRING) == 0 ? 0 : 1;
}
