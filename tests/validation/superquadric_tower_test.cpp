// Towers of cubes on a floor for ten seconds: they have to stand still, neither creep nor rattle.

#include "world/scenes.hpp"

#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/geometry/superquadric/superquadric_points.hpp>
#include <dem/law/rolling/torsion.hpp>

using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;

namespace {

constexpr double half = 5e-3, stiffness = 2e4;  // m, N/m

template <class Shape, class Resistance = dem::rolling::None>
struct Towers : Grains<Shape, dem::integrator::VelocityVerlet> {
  using Rolling = Resistance;
};

/// Three cubes, a little askew and turned about the vertical; what they do from the first second on. Dampers are
/// strong, as a tower rocks on springs that yield slowly; the ramp of friction is not, as it is no part of the time
/// step's limit.
template <class Shape, class Resistance = dem::rolling::None>
void check_tower(const Shape& cube, const typename Resistance::template Parameters<double>& resistance = {}) {
  using Model = Towers<Shape, Resistance>;
  dem::World<Model> w(options({0, 0, -9.81}, 4e-6));
  w.set_contact({{stiffness, 2e-3 * stiffness, 1.0}, {0.5, stiffness, 5e-4 * stiffness, 1.0}, resistance});
  dem::NewGrain p;
  p.species = w.add_species(cube);
  w.add_surface(w.ground(), dem::surface::Plane{});
  for (int k = 0; k < 3; ++k) {
    p.position = {0.08 * half * k, -0.06 * half * k, half * (2 * k + 1)};
    p.rotation = Eigen::AngleAxisd(0.2 * k, Vec3::UnitZ()).toRotationMatrix();
    w.add_grain(p);
  }
  REQUIRE(w.run_for(1.0));
  std::vector<Vec3> positions;
  std::vector<Mat3> rotations;
  for_each_grain(w, [&](GrainId id) {
    positions.push_back(w.position(id));
    rotations.push_back(w.rotation(id));
  });
  // Energies are measured against a cube's fall from its own height.
  const double drop = mass_of(w, GrainId(0)) * 9.81 * 2 * half;
  double energy = 0.0;
  for (int k = 0; k < 90; ++k) {
    REQUIRE(w.run_for(0.1));
    energy = std::max(energy, kinetic_energy(w));
  }
  // Under its own weight a contact yields by m g/K = 2.4e-4 half edges. What the sway of the first second has left is
  // less than a two hundredth of that, and its energy, from (m g)^2/(2 K) = 6e-5 of a fall, falls with the square.
  CHECK(energy < 1e-9 * drop);
  for_each_grain(w, [&](GrainId id) {
    CHECK((w.position(id) - positions[id.index()]).norm() < 1e-6 * half);
    CHECK((w.rotation(id) - rotations[id.index()]).norm() < 1e-6);
  });
}

}  // namespace

TEST_CASE("a tower of cubes with one contact a pair and torsion stands still for ten seconds") {
  // One point does not resist turning about its normal: without torsion the upper cubes keep the slow turn that the
  // first contact gave them, 1e-5 rad/s here. A face of half edge h presses like a circle of radius h, on R* = 0.6 h: 3
  // pi/16 mu h/R* = 0.5 at the most.
  check_tower<Superquadric, dem::rolling::Torsion>(Superquadric(Vec3::Constant(half), Vec3::Constant(8)),
                                                   {0.3, stiffness, 0.3});
}

TEST_CASE("a tower of cubes of points stands still for ten seconds") {
  // Many points a face resist every motion.
  check_tower(SuperquadricPoints(Vec3::Constant(half), Vec3::Constant(8)));
}

TEST_CASE("a tower of cubes of eight spheres stands still for ten seconds") { check_tower(dem::shape::cube8(half)); }
