#include "catch.hpp"

#include <dem/geometry/mixed.hpp>
#include <dem/grain/stable_time_step.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/law/friction/none.hpp>
#include <dem/world/model.hpp>

using Catch::Approx;
using dem::Vec3;
using dem::shape::PointArea;
using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;

namespace {

template <class S>
struct With : dem::Model {
  using Shape = S;
  using Integrator = dem::integrator::VelocityVerlet;
};

/// The stable time step of grains of one shape, with the normal and the friction stiffness, alone or beside a surface.
template <class Shape>
double limit(const Shape& shape, double normal, double friction, bool surface = false) {
  using Model = With<Shape>;
  dem::Materials<Model> materials;
  const auto material = materials.id("grain");
  materials.set_default({{normal, 0.0, 1.0}, {0.0, friction, 0.0, 0.0}});
  const double density = 2650, mass = density * shape.volume();
  const std::vector<dem::Species<Shape>> species = {
      {shape, material, density, mass, 1 / mass, density * shape.unit_inertia()}};
  const std::vector<dem::grain::SurfaceMatter> surfaces(surface ? 1 : 0, {material});
  return dem::grain::stable_time_step<Model>(species, materials, surfaces, 0.1).dt;
}

const Vec3 radii(1e-3, 1.2e-3, 0.8e-3), exponents(8, 8, 8);

}  // namespace

TEST_CASE("points that touch at once count in the stable time step") {
  const Superquadric whole(radii, exponents);
  const double one = limit(whole, 2000, 0);
  for (const PointArea kind : {PointArea::physical, PointArea::relative}) {
    const SuperquadricPoints points(radii, exponents, 6, kind);
    const auto patch = points.patch();
    // The same grain with a patch of so much area: as if the stiffness were that of the patch.
    CHECK(limit(points, 2000 / patch.weight, 0) == Approx(one).epsilon(1e-12));
    // Friction springs are per area as well.
    CHECK(limit(points, 1e-9 / patch.weight, 2000 / patch.weight) == Approx(one).epsilon(1e-12));
    // In any mixture as well.
    using Any = dem::shape::Mixed<dem::shape::Sphere, SuperquadricPoints>;
    CHECK(limit(Any(points), 2000 / patch.weight, 0) == Approx(one).epsilon(1e-12));
  }
  // Points that share a contact, in pairs or on surfaces, are as stiff as a whole one. A pair of grains has twice the
  // inverse effective mass of a grain on a wall, so it is what limits.
  CHECK(limit(SuperquadricPoints(radii, exponents), 2000, 0) == Approx(one).epsilon(1e-12));
  CHECK(limit(whole, 2000, 0, true) == Approx(one).epsilon(1e-12));
}
