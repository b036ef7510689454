#include "world/scenes.hpp"

#include <dem/geometry/polyhedron/polyhedra.hpp>

TEST_CASE("a stack of five cubes, put down askew, stands still for ten seconds") {
  using Sharp = Grains<dem::shape::Polyhedron, dem::integrator::VelocityVerlet>;
  dem::World<Sharp> w(options({0, 0, -9.81}, 1e-5));
  // A fifth of critical damping. (With the thesis's weaker dampers the sway dies away with 0.4/s: the same end, later.)
  w.set_contact({{2000.0, 0.1, 1.0}, {0.4, 2000.0, 0.015, 0.975}});
  const double h = 1.2e-3;
  const auto cube = w.add_species(dem::shape::cube(h));
  const auto plate = w.add_surface(w.ground(), dem::surface::Plane{});
  Random random(7);
  for (int level = 0; level < 5; ++level) {
    dem::NewGrain n;
    n.species = cube;
    n.position = {0.05 * h * random.between(-1, 1), 0.05 * h * random.between(-1, 1), h + (2.0 * h + 1e-6) * level};
    n.rotation = Eigen::AngleAxisd(0.1 * random.between(-1, 1), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    w.add_grain(n);
  }
  const double weight = 5.0 * w.species(cube).mass * 9.81;
  REQUIRE(w.run_for(4.0));  // it sways like a rod on springs, which dies away with some 5/s
  std::vector<Vec3> settled;
  for_each_grain(w, [&](GrainId p) { settled.push_back(w.position(p)); });
  REQUIRE(w.run_for(10.0));
  for_each_grain(w, [&](GrainId p) { CHECK((w.position(p) - settled[p.index()]).norm() < 1e-6 * h); });
  CHECK(kinetic_energy(w) < 1e-9 * weight * h);
  CHECK((w.surface_force(plate) - Vec3(0, 0, -weight)).norm() < 1e-6 * weight);
}
