#include "scenes.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>

using Catch::Approx;
using dem::surface::MeshSide;
using dem::surface::TriangleMesh;
namespace mesh = dem::mesh;

namespace {

/// A single ball of 5 mm on a surface of the ground.
struct OneBall {
  dem::World<Balls> world;
  GrainId ball;
  SurfaceId surface;

  OneBall(const Balls::Surfaces& geometry, const Vec3& gravity, const Vec3& at, const Vec3& velocity, double dt,
          const dem::ContactParameters<Balls>& constants)
      : world(options(gravity, dt)) {
    world.set_contact(constants);
    const auto species = world.add_species(Sphere(5e-3));
    surface = world.add_surface(world.ground(), geometry);
    ball = world.add_grain({species, at, velocity});
  }
  double energy() const {
    const double stretch = world.surface_force(surface).norm();  // energy of the contact: F^2/(2 k)
    return kinetic_energy(world) + stretch * stretch / 4000.0 -
           mass_of(world, ball) * world.state().options.gravity.dot(world.position(ball));
  }
};

}  // namespace

TEST_CASE("a ball slides, rolls and bounces over a flat mesh as over a plane") {
  // The mesh's vertices lie in z = 0 exactly. The two runs may differ by rounding only; contact amplifies it little, as
  // a single ball on a plane is not chaotic.
  const TriangleMesh flat(mesh::rectangle(1.0, 1.0, 37, 23), {.side = MeshSide::one_sided});
  const Vec3 gravity(1.3, 0.4, -g), velocity(0.9, -0.3, -0.5), at(-0.31, 0.13, 5.2e-3);
  OneBall on_mesh(flat, gravity, at, velocity, 1e-5, sand<Balls>(0.3));
  OneBall on_plane(dem::surface::Plane{}, gravity, at, velocity, 1e-5, sand<Balls>(0.3));
  double apart = 0.0, spin_apart = 0.0, force_apart = 0.0;
  for (int k = 0; k < 400; ++k) {
    REQUIRE(on_mesh.world.run(100));
    REQUIRE(on_plane.world.run(100));
    const auto &m = on_mesh.world, &p = on_plane.world;
    apart = std::max(apart, (m.position(on_mesh.ball) - p.position(on_plane.ball)).norm());
    spin_apart = std::max(spin_apart, (m.angular_velocity(on_mesh.ball) - p.angular_velocity(on_plane.ball)).norm());
    force_apart = std::max(force_apart, (m.surface_force(on_mesh.surface) - p.surface_force(on_plane.surface)).norm());
  }
  CHECK(on_mesh.world.position(on_mesh.ball).x() > 0.0);  // from -0.31: it crossed a dozen triangles
  CHECK(std::abs(on_mesh.world.angular_velocity(on_mesh.ball).y()) > 50.0);
  CHECK(apart < 1e-9);
  CHECK(spin_apart < 1e-9);
  CHECK(force_apart < 1e-9);
}

TEST_CASE("a ball on a mesh weighs m g, on a face, an edge and a vertex") {
  const TriangleMesh block(mesh::box({0.1, 0.1, 0.02}, 4));
  for (const Vec3& at : {Vec3(0.003, 0.004, 0.015), Vec3(0.0, 0.004, 0.015), Vec3(0.025, 0.025, 0.015)}) {
    OneBall scene(block, {0, 0, -g}, at, Vec3::Zero(), 2e-5, {{2000.0, 1.0, 1.0}, {0.4, 2000.0, 0.1, 1.0}});
    REQUIRE(scene.world.run_for(0.2));  // damped with exp(-360/s t)
    const double weight = mass_of(scene.world, scene.ball) * g;
    CHECK((scene.world.surface_force(scene.surface) + Vec3(0, 0, weight)).norm() < 1e-9 * weight);
    CHECK(scene.world.velocity(scene.ball).norm() < 1e-12);
  }
}

TEST_CASE("a ball without friction gains no energy in a bowl of triangles") {
  // The lower half of a sphere seen from inside; a ball circles in it without damping, over a facet every 7 steps or
  // so. Its contact force has a potential (the greatest overlap of all facets), so what the energy swings by is the
  // error of the integrator at the kinks between facets: no trend may show.
  dem::IndexedMesh bowl = mesh::sphere(0.05, 3);
  std::erase_if(bowl.triangles, [&](const auto& t) {
    return bowl.vertices[t[0]].z() + bowl.vertices[t[1]].z() + bowl.vertices[t[2]].z() > 0.06;
  });
  const TriangleMesh surface(bowl.flipped(), {.side = MeshSide::one_sided, .facing = dem::MeshFacing::as_given});
  OneBall scene(surface, {0, 0, -g}, {0.02, 0, -0.039}, {0, 0.3, 0}, 5e-6, {{2000.0, 0.0, 1.0}, {0.0, 0.0, 0.0, 1.0}});
  const double start = scene.energy(), scale = mass_of(scene.world, scene.ball) * g * 0.045;
  double highest = -1.0, lowest = 1.0;
  for (int k = 0; k < 200; ++k) {
    REQUIRE(scene.world.run(1000));
    const double gain = (scene.energy() - start) / scale;
    highest = std::max(highest, gain);
    lowest = std::min(lowest, gain);
    REQUIRE(scene.world.position(scene.ball).norm() < 0.05);
  }
  CHECK(highest < 5e-4);
  CHECK(lowest > -5e-4);
}

TEST_CASE("a ball in a drum of triangles swings as a pendulum does") {
  // Rolling without slip inside a cylinder: omega^2 = 5/7 g/(R - r). The amplitude of 0.1 rad adds a^2/16 =
  // 6e-4 of it. The swing covers 24 of 768 facets; what it loses at their edges shows in the period by less than 0.3 %.
  const double R = 0.05, r = 5e-3, amplitude = 0.1;
  const TriangleMesh drum(mesh::cylinder(R, 0.1, 768), {.facing = dem::MeshFacing::inward});
  // Along y the drum's axis is level: gravity along -x instead of turning the drum.
  const Vec3 at = (R - r + 2e-6) * Vec3(-std::cos(amplitude), std::sin(amplitude), 0);
  OneBall scene(drum, {-g, 0, 0}, at, Vec3::Zero(), 1e-5, {{2000.0, 0.2, 1.0}, {0.8, 2000.0, 0.02, 1.0}});
  std::vector<double> crossings;
  double last = at.y(), t = 0.0;
  while (crossings.size() < 5 && t < 3.0) {
    REQUIRE(scene.world.run(10));
    t = scene.world.time();
    const double y = scene.world.position(scene.ball).y();
    if (last * y < 0.0) crossings.push_back(t - 1e-4 * y / (y - last));
    last = y;
  }
  REQUIRE(crossings.size() == 5);
  const double period = 0.5 * (crossings[4] - crossings[0]);
  const double exact = 2 * std::numbers::pi * std::sqrt(7.0 / 5.0 * (R - r) / g);
  CHECK(period == Approx(exact).epsilon(3e-3));
  // It rolls: the friction is never lost at a facet's edge.
  const Vec3 v = scene.world.velocity(scene.ball), x = scene.world.position(scene.ball);
  const Vec3 arm = r * Vec3(x.x(), x.y(), 0).normalized();
  const Vec3 slip = v + scene.world.angular_velocity(scene.ball).cross(arm);
  CHECK(slip.head(2).norm() < 0.02 * v.norm());
}

namespace {

/// A ball that also says how deep a point is inside of it: a small shape for the corners of surfaces. It shows no
/// sample points but its highest point, so that nothing else finds a contact.
class BluntBall : public Sphere {
 public:
  static constexpr bool has_orientation = false;
  explicit BluntBall(double radius) : Sphere(radius) {}
  template <class Callback>
  void sample_points(const double*, Callback&& callback) const {
    callback(0u, dem::contact::SamplePoint{{0, 0, radius()}, 0.0, radius()});
  }
  bool penetration(const double*, const dem::Vector3<double>& point, double& depth,
                   dem::Vector3<double>& outward) const {
    const double distance = norm(point);
    depth = radius() - distance;
    outward = (1.0 / distance) * point;
    return depth > 0.0;
  }
  static std::uint64_t contact_bits(const BluntBall& a, const double* pa, const BluntBall& b, const double* pb,
                                    const dem::Vector3<double>& d) {
    return Sphere::contact_bits(a, pa, b, pb, d);
  }
};

}  // namespace

TEST_CASE("a corner of a surface holds a grain that none of the grain's own points touches") {
  const dem::surface::Box box({0.02, 0.02, 0.02});
  const TriangleMesh triangles(mesh::box({0.02, 0.02, 0.02}));
  for (const Grains<BluntBall>::Surfaces& geometry :
       {Grains<BluntBall>::Surfaces(box), Grains<BluntBall>::Surfaces(triangles)}) {
    // A corner of the cube points up along (1, 1, 1); the ball sits on it, held in the middle by symmetry.
    dem::World<Grains<BluntBall>> w(options({0, 0, -g}, 2e-5));
    w.set_contact({{2000.0, 1.0, 1.0}, {0.5, 2000.0, 0.05, 1.0}});
    const auto species = w.add_species(BluntBall(5e-3));
    dem::SurfaceOptions o;
    o.rotation = dem::rotation_between(Vec3(1, 1, 1), Vec3::UnitZ());
    const auto s = w.add_surface(w.ground(), geometry, o);
    const double tip = 0.01 * std::sqrt(3.0);
    const auto ball = w.add_grain({species, Vec3(0, 0, tip + 5e-3)});
    REQUIRE(w.run_for(0.1));
    const double weight = mass_of(w, ball) * g;
    CHECK(w.position(ball).z() == Approx(tip + 5e-3 - weight / 2000.0).epsilon(1e-6));
    CHECK(w.surface_force(s).z() == Approx(-weight).epsilon(1e-4));  // its swing is damped with exp(-360/s t)
    CHECK(w.state().chunks[0].surface_contacts.committed() == 1);
  }
}

namespace {

/// A ball of 5 mm, and a surface that is added when the ball is there. Empty if the world accepts both.
std::string refusal_of(const TriangleMesh& geometry, const Vec3& ball, const Vec3& surface) {
  dem::World<Balls> world(options(Vec3::Zero(), 1e-5));
  world.set_contact(sand<Balls>());
  const auto species = world.add_species(Sphere(5e-3));
  world.add_grain({species, Vec3(1, 0, 0)});
  world.add_grain({species, ball});
  REQUIRE(world.run(1));
  world.add_surface(world.machine().add_fixed_body("part", surface), geometry, {.name = "block"});
  try {
    world.prepare();
  } catch (const dem::Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a ball too deep in a solid mesh to be felt is refused, wherever the mesh's body stands") {
  const TriangleMesh block(mesh::box({0.1, 0.1, 0.1}, 3));  // +-50 mm; a ball of 5 mm is felt down to 45 mm
  for (const Vec3& surface : {Vec3(0, 0, 0), Vec3(0.3, -0.2, 0.1)}) {
    // In the middle, under an edge, and on the planes through corners, where a way out meets edges.
    for (const Vec3& at : {Vec3(0, 0, 0), Vec3(0.044, 0.044, 0.044), Vec3(-0.03, 0.03, 0.03), Vec3(0.0, 0.0, -0.044)}) {
      CHECK_THAT(refusal_of(block, surface + at, surface),
                 Catch::Matchers::ContainsSubstring("grain 1 at (") &&
                     Catch::Matchers::ContainsSubstring("lies within surface 'block'"));
    }
    for (const Vec3& at : {Vec3(0, 0, 0.0551), Vec3(0.2, 0, 0), Vec3(0.0, 0.0, -0.0549)}) {
      CHECK(refusal_of(block, surface + at, surface).empty());
    }
  }
}

TEST_CASE("cavities and sheets hide no ball") {
  const dem::IndexedMesh box = mesh::box({0.1, 0.1, 0.1}, 3);
  CHECK(refusal_of(TriangleMesh(box, {.facing = dem::MeshFacing::inward}), Vec3(0, 0, 0), Vec3::Zero()).empty());
  CHECK(refusal_of(TriangleMesh(box, {.side = MeshSide::one_sided}), Vec3(0, 0, 0), Vec3::Zero()).empty());
  CHECK(refusal_of(TriangleMesh(box, {.side = MeshSide::two_sided}), Vec3(0, 0, 0), Vec3::Zero()).empty());
  // A hollow box: walls of 20 mm, in which a ball is hidden; within them it is free.
  dem::IndexedMesh hollow = box;
  const dem::IndexedMesh inner = mesh::box({0.06, 0.06, 0.06}, 3);
  const auto first = static_cast<std::uint32_t>(hollow.vertices.size());
  hollow.vertices.insert(hollow.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (auto t : inner.triangles)
    hollow.triangles.push_back({t[0] + first, t[2] + first, t[1] + first});  // looks inward
  CHECK(refusal_of(TriangleMesh(hollow), Vec3(0, 0, 0), Vec3::Zero()).empty());
  CHECK_FALSE(refusal_of(TriangleMesh(hollow), Vec3(0.04, 0.005, 0), Vec3::Zero()).empty());
}

TEST_CASE("no ball beside a solid mesh is refused, on a lattice from which ways out graze its edges") {
  // A channel along y: a floor and two walls of 10 mm, in one piece; all coordinates round, as those of the lattice.
  const std::vector<std::array<double, 2>> outline = {{-0.06, 0},   {0.06, 0},     {0.06, 0.11},  {0.05, 0.11},
                                                      {0.05, 0.01}, {-0.05, 0.01}, {-0.05, 0.11}, {-0.06, 0.11}};
  dem::IndexedMesh channel;
  for (const double y : {-0.1, 0.1}) {
    for (const auto& [x, z] : outline) channel.vertices.emplace_back(x, y, z);
  }
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t next = (k + 1) % 8;
    channel.triangles.push_back({k, next, next + 8});
    channel.triangles.push_back({k, next + 8, k + 8});
  }
  for (const std::uint32_t end : {0u, 8u}) {
    for (const auto& t :
         {std::array{0u, 1u, 4u}, {0u, 4u, 5u}, {1u, 2u, 3u}, {1u, 3u, 4u}, {0u, 5u, 6u}, {0u, 6u, 7u}}) {
      channel.triangles.push_back({end + t[0], end + t[1], end + t[2]});
    }
  }
  const TriangleMesh mesh(channel);
  int hidden = 0;
  for (int i = -94; i <= 94; ++i) {
    for (int j = -40; j <= 40; ++j) {
      for (int k = 0; k < 40; ++k) {
        hidden += mesh.hides({5e-4 * i, 5e-4 * j, 0.0125 + 2.5e-3 * k}, 1e-3, false);
      }
    }
  }
  CHECK(hidden == 0);
  CHECK(mesh.hides({0.055, 0.0, 0.05}, 1e-3, false));
  CHECK(mesh.hides({0.0, 0.03, 0.005}, 1e-3, false));
}

TEST_CASE("a ball that is put into a solid mesh later is refused too, and one in a mesh that is switched on") {
  dem::World<Balls> world(options(Vec3::Zero(), 1e-5));
  world.set_contact(sand<Balls>());
  const auto species = world.add_species(Sphere(5e-3));
  const auto free = world.add_grain({species, Vec3(1, 0, 0)});
  const auto block = world.add_surface(world.ground(), TriangleMesh(mesh::box({0.1, 0.1, 0.1}, 3)), {.name = "block"});
  REQUIRE(world.run(1));
  const auto refused = [](auto w) { CHECK_THROWS_WITH(w.run(1), Catch::Contains("lies within surface 'block'")); };
  auto added = world;
  added.add_grain({species, Vec3(0, 0, 0.01)});
  refused(added);
  auto moved = world;
  moved.set_position(free, {0, 0, 0.01});
  refused(moved);
  auto switched = world;
  switched.set_active(block, false);
  switched.set_position(free, {0, 0, 0.01});
  REQUIRE(switched.run(1));
  switched.set_active(block, true);
  refused(switched);
}
