// The program of README.md: cubes of eight glued spheres fall into a box, and the floor weighs them.
#include <dem/dem.hpp>

struct Sand : dem::Model {  // policies that are not named keep their defaults
  using Shape = dem::shape::SphereCluster<8>;
  using Integrator = dem::integrator::VelocityVerlet;
};

int main() {
  dem::World<Sand> world({.gravity = {0, 0, -9.81}});
  world.set_contact(
      {.normal = {.stiffness = 2000, .damping = 0.05, .separation_factor = 1},
       .friction = {.coefficient = 0.4, .stiffness = 2000, .velocity_stiffness = 0.015, .breaking_factor = 0.975}});

  const auto wall = [&](dem::Vec3 middle, dem::Vec3 edges) {
    return world.add_surface(world.ground(), dem::surface::Box(edges), {.position = middle});
  };
  const auto floor = wall({0, 0, -0.005}, {0.04, 0.04, 0.01});
  for (const double s : {-1.0, 1.0}) {
    wall({s * 0.015, 0, 0.05}, {0.01, 0.04, 0.1});
    wall({0, s * 0.015, 0.05}, {0.04, 0.01, 0.1});
  }

  const auto cube = world.add_species(dem::shape::cube8(1e-3), {.density = 2650});  // half an edge in m; kg/m^3
  for (int k = 0; k < 250; ++k) {
    const dem::Mat3 turn = dem::Quaternion(1, 0.3 * (k % 5), 0.2 * (k % 7), 0.1).normalized().toRotationMatrix();
    world.add_grain({cube, 4e-3 * dem::Vec3(k % 5 - 2, k / 5 % 5 - 2, k / 25 + 0.5), {0, 0, 0}, turn});
  }

  if (const auto report = world.run_for(0.5); !report) return fmt::print("{}\n", report.text), 1;
  fmt::print("weight {:.5f} N, on the floor {:.5f} N\n", 250 * world.species(cube).mass * 9.81,
             -world.surface_force(floor).z());
}
