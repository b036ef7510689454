#include "world/laws.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/geometry/superquadric/superquadric_points.hpp>

namespace flat_mesh_test {

using dem::surface::TriangleMesh;

namespace {

using Springs = Laws<Linear, friction::CundallStrack, rolling::ElasticPlastic>;
using Moduli = Laws<contact::Hertz, friction::Mindlin>;

template <class L, class S>
struct With : L {
  using Shape = S;
};

template <class L>
ContactParameters<L> laws_of() {
  if constexpr (std::is_same_v<typename L::Normal, Linear>) {
    return {.normal = Linear::with_restitution(2000.0, 0.6),
            .friction = {0.4, 1500.0, 0.1},
            .rolling = {0.02, 1000.0, 0.3}};
  } else {
    const auto elastic = contact::elastic_pair({.young = 2e6, .poisson = 0.25});
    return {.normal = contact::Hertz::with_restitution(elastic, 0.6),
            .friction = friction::Mindlin::with_restitution(elastic, 0.4, 0.6)};
  }
}

constexpr double grain_half = 5e-3;  // m, of all grains

/// Somewhere, turned somehow, so that no coordinate of a vertex is a round number.
const Vec3 mesh_place(0.17, -0.31, 0.43);
Mat3 tilt() { return (Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized())).toRotationMatrix(); }

/// One grain on a flat surface, thrown so that it tumbles or rolls, or laid down to slide and tip over.
template <class M>
struct OneGrain {
  World<M> world;
  SurfaceId surface;

  OneGrain(const typename M::Shape& shape, bool thrown, const typename M::Surfaces& geometry, const SurfaceOptions& at)
      : world(options(tilt() * Vec3(1.5, 0.5, -9.6))) {
    world.set_contact(laws_of<M>());
    surface = world.add_surface(world.ground(), geometry, at);
    NewGrain n;
    n.species = world.add_species(shape);
    const double height = thrown ? 1.02 * shape.bounding_radius() : grain_half;
    n.position = mesh_place + tilt() * Vec3(-0.11, -0.07, height);
    n.velocity = tilt() * Vec3(0.9, 0.5, thrown ? -0.2 : 0.0);
    n.rotation = tilt();
    if (thrown) {
      n.angular_velocity = tilt() * Vec3(-11.0, 23.0, 5.0);
      n.rotation = tilt() * Eigen::AngleAxisd(0.3, Vec3(1, 1, 0).normalized()).toRotationMatrix();
    }
    world.add_grain(n);
  }
};

/// A flat mesh of triangles of about a centimetre, with the tilt in its vertices.
TriangleMesh tilted_mesh() {
  IndexedMesh flat = mesh::rectangle(0.6, 0.6, 61, 47);
  for (Vec3& v : flat.vertices) v = mesh_place + tilt() * v;
  return TriangleMesh(flat, {.side = surface::MeshSide::one_sided, .facing = MeshFacing::as_given});
}

/// The same on the mesh and on a plane. Rounding sets them apart by 1e-17 m and each impact amplifies that; were an
/// edge felt, it would be by 1e-6 m or more.
template <class L, class S>
void compare(const S& shape) {
  using M = With<L, S>;
  for (const bool thrown : {true, false}) {
    CAPTURE(thrown);
    OneGrain<M> on_mesh(shape, thrown, tilted_mesh(), {});
    OneGrain<M> on_plane(shape, thrown, surface::Plane{}, {.position = mesh_place, .rotation = tilt()});
    const World<M>&m = on_mesh.world, &p = on_plane.world;
    const GrainId it(0);
    double apart = 0.0, spin_apart = 0.0, force_apart = 0.0, spin = 0.0, force = 0.0;
    while (p.time() < 0.08) {
      REQUIRE(on_mesh.world.step());
      REQUIRE(on_plane.world.step());
      const Vec3 push = p.surface_force(on_plane.surface);
      apart = std::max(apart, (m.position(it) - p.position(it)).norm());
      spin_apart = std::max(spin_apart, (m.angular_velocity(it) - p.angular_velocity(it)).norm());
      force_apart = std::max(force_apart, (m.surface_force(on_mesh.surface) - push).norm());
      spin = std::max(spin, p.angular_velocity(it).norm());
      force = std::max(force, push.norm());
    }
    CHECK(force > 0.0);
    CHECK((p.position(it) - mesh_place - tilt() * Vec3(-0.11, -0.07, 0)).norm() >
          0.04);  // over four rectangles and more
    CHECK(apart < 1e-9 * grain_half);
    CHECK(spin_apart < 1e-9 * spin);
    CHECK(force_apart < 1e-9 * force);
  }
}

}  // namespace

TEST_CASE("grains slide, tip and roll over a tilted flat mesh as over a plane, by springs or by moduli") {
  compare<Springs>(Sphere(grain_half));
  compare<Springs>(shape::Superquadric(Vec3::Constant(grain_half), Vec3::Constant(8)));
  compare<Springs>(shape::Superquadric(Vec3::Constant(grain_half), Vec3::Constant(2)));
  compare<Moduli>(shape::cube8(grain_half));
  compare<Moduli>(shape::cube(grain_half));
  compare<Moduli>(shape::SuperquadricPoints(Vec3::Constant(grain_half), Vec3::Constant(8)));
}

}  // namespace flat_mesh_test
