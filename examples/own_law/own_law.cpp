// A normal law and a friction law of one's own: a spring that stiffens, and friction that weakens with the distance
// slipped, as that of faults does. A stool of four balls on a slope holds up to the static angle; once it slides, less
// than that holds it.

#include "slip_weakening.hpp"
#include "stiffening_spring.hpp"

#include <dem/dem.hpp>

#include <array>

struct Rock : dem::Model {
  using Shape = dem::shape::SphereCluster<4>;
  using Normal = StiffeningSpring;
  using Friction = SlipWeakening;
  using Integrator = dem::integrator::VelocityVerlet;
};

int main() {
  const double g = 9.81, mu = 0.6, residual = 0.3, r = 1e-3;
  dem::World<Rock> world({.gravity = {0, 0, -g}, .overlap_limit = 0.01, .threads = 1});
  world.set_contact({.normal = {2000, 1e-5, 0.05}, .friction = {mu, residual, 1e-6, 2000, 0.05}});
  const std::array<dem::Ball, 4> feet = {
      {{{3 * r, 3 * r, 0}, r}, {{-3 * r, 3 * r, 0}, r}, {{3 * r, -3 * r, 0}, r}, {{-3 * r, -3 * r, 0}, r}}};
  const auto stool = world.add_species(dem::shape::SphereCluster<4>(feet));
  world.add_surface(world.ground(), dem::surface::Plane{});
  const auto block = world.add_grain({stool, {0, 0, r}});

  const double degree = M_PI / 180, step = 0.1 * degree;
  double angle = 0;
  for (; world.velocity(block).norm() < 1e-4 && angle < 45 * degree; angle += step) {
    world.set_gravity({g * std::sin(angle), 0, -g * std::cos(angle)});
    if (const auto report = world.run(500); !report) return fmt::print("{}\n", report.text), 1;
  }
  angle -= step;
  fmt::print("lets go at {:.1f} deg, atan(mu) = {:.1f} deg\n", angle / degree, std::atan(mu) / degree);

  if (const auto report = world.run_for(0.02); !report) return fmt::print("{}\n", report.text), 1;
  const double before = world.velocity(block).x(), start = world.time();
  if (const auto report = world.run_for(0.05); !report) return fmt::print("{}\n", report.text), 1;
  const double slides = (world.velocity(block).x() - before) / (world.time() - start);
  fmt::print("slides with {:.3f} m/s^2, {:.3f} of g (sin - residual cos)\n", slides,
             slides / (g * (std::sin(angle) - residual * std::cos(angle))));
}
