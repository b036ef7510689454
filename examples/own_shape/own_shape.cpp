// A shape of one's own: a capsule. Two capsules touch where their lines are nearest to each other. One that lies across
// a slope rolls down it; two that cross on a plane bear each other.

#include "capsule.hpp"

#include <dem/dem.hpp>

struct Pills : dem::Model {
  using Shape = Capsule;
  using Integrator = dem::integrator::VelocityVerlet;
};

dem::Mat3 turned(const dem::Vec3& line) {  // the frame's z along a direction
  return dem::rotation_between(dem::Vec3::UnitZ(), line);
}

int main() {
  const double g = 9.81, half = 3e-3, radius = 1e-3, slope = 0.2;
  const dem::ContactParameters<Pills> sand = {.normal = {2000, 0.2, 1.0}, .friction = {0.6, 2000, 0.02, 0.975}};
  dem::World<Pills> world({.gravity = {g * std::sin(slope), 0, -g * std::cos(slope)}, .threads = 1});
  world.set_contact(sand);
  const auto pill = world.add_species(Capsule{half, radius});
  world.add_surface(world.ground(), dem::surface::Plane{});
  const auto roller =
      world.add_grain({.species = pill, .position = {0, 0, radius}, .rotation = turned(dem::Vec3::UnitY())});
  if (const auto report = world.run_for(0.3); !report) return fmt::print("{}\n", report.text), 1;
  const auto& kind = world.species(pill);
  const double expected = g * std::sin(slope) / (1 + kind.inertia.z() / (kind.mass * radius * radius));
  fmt::print("rolls with {:.4f} of g sin / (1 + I / m r^2)\n", world.velocity(roller).x() / (expected * world.time()));

  dem::World<Pills> pile({.gravity = {0, 0, -g}, .threads = 1});
  pile.set_contact(sand);
  pile.add_species(Capsule{half, radius});
  const auto floor = pile.add_surface(pile.ground(), dem::surface::Plane{});
  pile.add_grain({.species = pill, .position = {-2e-3, 0, radius}, .rotation = turned(dem::Vec3::UnitY())});
  pile.add_grain({.species = pill, .position = {2e-3, 0, radius}, .rotation = turned(dem::Vec3::UnitY())});
  const auto top =
      pile.add_grain({.species = pill, .position = {0, 0, 3 * radius}, .rotation = turned(dem::Vec3::UnitX())});
  if (const auto report = pile.run_for(0.5); !report) return fmt::print("{}\n", report.text), 1;
  fmt::print("a bridge of three weighs {:.6f} of 3 m g, and rests at {:.4f} of 3 r\n",
             -pile.surface_force(floor).z() / (3 * kind.mass * g), pile.position(top).z() / (3 * radius));
}
