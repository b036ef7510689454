#include "core/error_of.hpp"
#include "random.hpp"
#include "surface_contacts.hpp"

#include <dem/geometry/box/box.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>

#include <set>

using Catch::Approx;
using dem::IndexedMesh;
using dem::Vec3;
using dem::surface::MeshSide;
using dem::surface::TriangleMesh;
namespace mesh = dem::mesh;

namespace {

/// Distance from a point to a triangle without regions: the least over its plane, if the foot lies inside, and its
/// edges.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_edge = [&](const Vec3& u, const Vec3& v) {
    const double t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (u + t * (v - u) - p).norm();
  };
  double best = std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
  const Vec3 n = (b - a).cross(c - a);
  const Vec3 foot = p - n * (n.dot(p - a) / n.squaredNorm());
  const bool inside =
      n.dot((b - a).cross(foot - a)) >= 0 && n.dot((c - b).cross(foot - b)) >= 0 && n.dot((a - c).cross(foot - c)) >= 0;
  if (inside) best = std::min(best, (foot - p).norm());
  return best;
}

/// The name that contacts on one group of triangles share, whatever way they point.
std::uint32_t group_of(const SurfaceContact& t) { return t.feature >> dem::surface::direction_bits; }

}  // namespace

TEST_CASE("a box of triangles is touched as a box is") {
  const Vec3 edges(2, 4, 6);
  const dem::surface::Box box(edges);
  for (const int pieces : {1, 3}) {
    const TriangleMesh triangles(mesh::box(edges, pieces), {.depth = 0.5});
    Random random(7);
    int outside = 0, inside = 0;
    for (int trial = 0; trial < 4000; ++trial) {
      const Vec3 p = random.in(0.5 * edges + Vec3::Constant(0.6));
      const double radius = trial % 3 == 0 ? 0.0 : random.between(0.05, 0.6);
      const auto expected = surface_contacts(box, p, radius);
      const auto found = surface_contacts(triangles, p, radius);
      const double depth = expected.empty() ? 0.0 : -expected[0].gap;
      if (depth > 0.45) continue;  // near the middle two ways out are equally short, and deeper is not promised
      REQUIRE(found.size() == expected.size());
      if (found.empty()) continue;
      (depth > 0.0 ? inside : outside) += 1;
      CHECK(found[0].gap == Approx(expected[0].gap).margin(1e-14));
      CHECK(group_of(found[0]) == expected[0].feature);  // 0: one group
      // Where two faces are equally near, either may be the way out.
      if (depth <= 0.0 || (p.cwiseAbs() - 0.5 * edges).cwiseAbs().minCoeff() > 1e-9) {
        CHECK((found[0].normal - expected[0].normal).norm() < 1e-12);
      }
    }
    CHECK(outside > 500);
    CHECK(inside > 200);
  }
}

TEST_CASE("the nearest triangle through the tree is the nearest of all") {
  const IndexedMesh tyre = mesh::tyre(0.97, 0.254, 1500);
  const TriangleMesh surface(tyre, {.depth = 0.005});  // no deeper than the spheres are large
  Random random(7);
  int touching = 0, inside = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Vec3 p = random.in({0.55, 0.55, 0.2});
    double nearest = 1e300;
    for (std::size_t t = 0; t < tyre.triangles.size(); ++t) {
      nearest = std::min(nearest, distance_to_triangle(p, tyre.corner(t, 0), tyre.corner(t, 1), tyre.corner(t, 2)));
    }
    const double radius = random.between(0.01, 0.06);
    const auto found = surface_contacts(surface, p, radius);
    CHECK(found.empty() == !(nearest < radius));
    if (found.empty()) continue;
    ++touching;
    double deepest = 1e300;
    for (const SurfaceContact& t : found) deepest = std::min(deepest, t.gap);
    CHECK(std::abs(deepest) == Approx(nearest).epsilon(1e-12));
    // Inside the surface covers the whole sky, 4 pi, and outside nothing (van Oosterom & Strackee 1983).
    double sky = 0.0;
    for (std::size_t t = 0; t < tyre.triangles.size(); ++t) {
      const Vec3 a = tyre.corner(t, 0) - p, b = tyre.corner(t, 1) - p, c = tyre.corner(t, 2) - p;
      sky += 2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
    }
    CHECK((deepest < 0.0) == (sky > 2.0 * std::numbers::pi));
    inside += deepest < 0.0;
    CHECK(surface.near(dem::from_eigen(p), radius));
  }
  CHECK(touching > 300);
  CHECK(inside > 100);
}

TEST_CASE("a sphere on a flat mesh has one contact, wherever it is, with one name") {
  const TriangleMesh flat(mesh::rectangle(2.0, 2.0, 7, 5), {.side = MeshSide::one_sided});
  Random random(7);
  std::set<std::uint32_t> names;
  for (int trial = 0; trial < 3000; ++trial) {
    Vec3 p = random.in({0.8, 0.8, 0});
    // On vertices and edges exactly, too.
    if (trial % 3 == 0) p.x() = 2.0 * (std::floor(random.between(0, 6)) / 7 - 0.5) + 2.0 / 7;
    if (trial % 6 == 0) p.y() = 2.0 * (std::floor(random.between(0, 4)) / 5 - 0.5) + 2.0 / 5;
    p.z() = random.between(-0.05, 0.29);
    const auto found = surface_contacts(flat, p, 0.3);
    REQUIRE(found.size() == 1);
    CHECK((found[0].normal - Vec3(0, 0, -1)).norm() < 1e-14);
    CHECK(std::abs(found[0].gap - p.z()) < 1e-15);
    names.insert(found[0].feature);
  }
  CHECK(names.size() == 1);
}

TEST_CASE("a convex edge pushes once, a concave one from both sides") {
  // A step: floor z = 0 for x < 0, wall x = 0 up to z = 1, floor z = 1 for x > 0. Each strip is cut into triangles.
  IndexedMesh step = mesh::rectangle(2, 2, 3, 3).moved({-1, 0, 0});
  const dem::Mat3 up = Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  step += mesh::rectangle(1, 2, 3, 3).moved({0, 0, 0.5}, up);
  step += mesh::rectangle(2, 2, 3, 3).moved({1, 0, 1});
  const TriangleMesh surface(step, {.side = MeshSide::one_sided});
  CHECK(surface.report().components == 1);
  CHECK(surface.data().groups.count == 2);  // the wall and the upper floor are one, the lower floor must be another

  const auto corner = surface_contacts(surface, {-0.2, 0.1, 0.25}, 0.3);  // touches floor and wall
  REQUIRE(corner.size() == 2);
  CHECK(corner[0].normal.dot(corner[1].normal) == Approx(0.0).margin(1e-14));
  CHECK(corner[0].gap + corner[1].gap == Approx(0.45));
  const auto edge = surface_contacts(surface, {-0.12, 0.1, 1.16}, 0.3);  // above the upper edge, outside
  check_one(edge, Vec3(0.6, 0, -0.8), 0.2, 1e-12);
  // Round the upper edge: the contact keeps its name.
  const auto above = surface_contacts(surface, {0.05, 0.1, 1.2}, 0.3),
             beside = surface_contacts(surface, {-0.2, 0.1, 0.9}, 0.3);
  check_one(above, {0, 0, -1}, 0.2, 1e-12);
  check_one(beside, {1, 0, 0}, 0.2, 1e-12);
  CHECK(group_of(above[0]) == group_of(edge[0]));
  CHECK(group_of(above[0]) == group_of(beside[0]));
  // The floor's contact has the same name with and without the wall's.
  const auto floor = surface_contacts(surface, {-0.5, 0.1, 0.25}, 0.3);
  REQUIRE(floor.size() == 1);
  const SurfaceContact& same = std::abs(corner[0].normal.z()) > 0.5 ? corner[0] : corner[1];
  CHECK(floor[0].feature == same.feature);
}

TEST_CASE("the contact with a mesh moves steadily over its edges and corners") {
  const TriangleMesh box(mesh::box({2, 2, 2}, 2));
  Random random(7);
  for (int walk = 0; walk < 20; ++walk) {
    const Vec3 from = random.in({1, 1, 1}).normalized() * 1.9, to = random.in({1, 1, 1}).normalized() * 1.9;
    SurfaceContact last{};
    Vec3 last_p = from;
    bool any = false;
    for (double t = 0; t <= 1.0; t += 0.002) {
      const Vec3 p = ((1 - t) * from + t * to).normalized() * 1.85;
      const auto found = surface_contacts(box, p, 1.0);
      REQUIRE(found.size() <= 1);  // a convex body has one nearest point
      if (!found.empty() && any) {
        const double step = (p - last_p).norm();
        CHECK(std::abs(found[0].gap - last.gap) < step + 1e-12);
        CHECK((found[0].normal - last.normal).norm() < step / 0.117);  // the nearest that the path comes to the box
        CHECK(group_of(found[0]) == group_of(last));
      }
      any = !found.empty();
      last_p = p;
      if (any) last = found[0];
    }
  }
}

TEST_CASE("inside a finely cut bowl a sphere has one contact with one name and a steady overlap") {
  // A drum seen from inside: 96 facets of 3.75 degrees, radius 1; a ball of radius 0.4 at a given depth.
  const TriangleMesh drum(mesh::cylinder(1.0, 4.0, 96), {.facing = dem::MeshFacing::inward});
  std::set<std::uint32_t> names;
  double last = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double angle = 2 * std::numbers::pi * k / 5000;
    const Vec3 p(0.61 * std::cos(angle), 0.61 * std::sin(angle), 0.3);
    const auto found = surface_contacts(drum, p, 0.4);
    REQUIRE(found.size() == 1);
    names.insert(group_of(found[0]));
    // Between the inscribed circle and the round wall; facets change where their distances are equal.
    CHECK(found[0].gap > std::cos(std::numbers::pi / 96) - 0.61 - 1e-12);
    CHECK(found[0].gap < 0.39 + 1e-12);
    if (k > 0) CHECK(std::abs(found[0].gap - last) < 0.61 * 2 * std::numbers::pi / 5000 * 0.05);
    last = found[0].gap;
  }
  CHECK(names.size() == 1);
  // At an end there are two contacts, and the wall keeps its name.
  const auto found = surface_contacts(drum, {0.61, 0, 1.7}, 0.4);
  REQUIRE(found.size() == 2);
  CHECK((names.contains(group_of(found[0])) != names.contains(group_of(found[1]))));
}

TEST_CASE("a ball that nearly fills a drum still feels its end, however many facets are near") {
  // Some 30 facets of the lateral surface are local minima of the distance, all nearer than the end.
  const TriangleMesh drum(mesh::cylinder(1.0, 4.0, 768), {.facing = dem::MeshFacing::inward});
  const double r = 0.97, into_lateral = 1e-3;
  for (const double into_end : {1e-6, 1e-4, 5e-4, 2e-3}) {
    CAPTURE(into_end);
    const auto found = surface_contacts(drum, {1.0 - r + into_lateral, 0, 2.0 - r + into_end}, r);
    REQUIRE(found.size() == 2);
    const auto& end = found[0].normal.z() > 0.5 ? found[0] : found[1];
    const auto& lateral = found[0].normal.z() > 0.5 ? found[1] : found[0];
    CHECK((end.normal - Vec3(0, 0, 1)).norm() < 1e-12);
    CHECK(std::abs(r - end.gap - into_end) < 1e-14);
    CHECK(lateral.normal.x() > 0.99);
    // A facet's middle is nearer to the axis by R (1 - cos(pi / 768)) = 8e-6.
    CHECK(std::abs(r - lateral.gap - into_lateral) < 1e-5);
  }
}

TEST_CASE("flanks of a slot keep names of their own") {
  const TriangleMesh wheel(mesh::wheel({0.3, 0.2, 24, 0.04, 0.02, 240}));
  // A ball between two grousers, at rim height, touching the left flank, the right one, and both.
  const double middle = std::numbers::pi / 24, flank = 0.32 * std::sin(middle) - 0.01;
  const auto at = [&](double shift, double r) {
    const double radius = 0.3 + 0.02;
    return surface_contacts(
        wheel, Vec3(radius * std::cos(middle + shift / radius), radius * std::sin(middle + shift / radius), 0), r);
  };
  const auto left = at(-0.015, 0.019), right = at(0.015, 0.019), both = at(0.0, flank + 0.001);
  REQUIRE(left.size() == 1);
  REQUIRE(right.size() == 1);
  CHECK(group_of(left[0]) != group_of(right[0]));
  std::set<std::uint32_t> names;
  for (const SurfaceContact& t : both) names.insert(group_of(t));
  CHECK(names.contains(group_of(left[0])));
  CHECK(names.contains(group_of(right[0])));
}

TEST_CASE("points see how deep they are in a solid, by the normals of faces, edges and corners") {
  const TriangleMesh box(mesh::box({2, 2, 2}), {.depth = 0.4});
  check_one(surface_contacts(box, {0.9, 0.1, -0.2}, 0.0), {-1, 0, 0}, -0.1);
  check_one(surface_contacts(box, {0.1, -0.75, 0.2}, 0.0), {0, 1, 0}, -0.25);
  CHECK(surface_contacts(box, {0.0, 0.0, 0.0}, 0.0).empty());  // deeper than it is looked for
  Random random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 p = random.in({1.2, 1.2, 1.2});
    const double depth = 1.0 - p.cwiseAbs().maxCoeff();
    if (std::abs(depth - 0.4) < 1e-9) continue;
    CHECK(surface_contacts(box, p, 0.0).empty() == !(depth > 0.0 && depth < 0.4));
  }
  // A needle's tip: face normals there disagree about the side, the angle-weighted one does not.
  IndexedMesh spike = {{{0, 0, 5}, {0.3, 0, 0}, {-0.2, 0.3, 0}, {-0.2, -0.3, 0}},
                       {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  const TriangleMesh needle(spike, {.depth = 0.1});
  CHECK(needle.report().enclosed_volume > 0.0);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 p = Vec3(0, 0, 5) + random.in({0.05, 0.05, 0.05});
    bool inside = true;
    for (std::size_t t = 0; t < 4; ++t) {
      inside &= needle.mesh().area_vector(t).dot(p - needle.mesh().corner(t, 0)) < 0.0;
    }
    CHECK(surface_contacts(needle, p, 0.0).empty() == !inside);
  }
}

TEST_CASE("a point that is held at a gap before a solid is pushed out from as deep as any other point") {
  // Far less gap than depth, as where cohesion reaches less far than the grain is pressed in.
  const TriangleMesh box(mesh::box({2, 2, 2}, 3), {.depth = 0.4}), chosen(mesh::box({2, 2, 2}, 3));
  const double gap = 0.01;
  const auto held = [&](const TriangleMesh& m, const Vec3& p) {
    std::vector<SurfaceContact> found;
    m.point_contacts(dem::from_eigen(p), gap, [&](std::uint32_t feature, const dem::Vector3<double>& normal, double d) {
      found.push_back({feature, to_eigen(normal), d});
    });
    return found;
  };
  check_one(held(box, {0.1, 0.2, 1.009}), {0, 0, -1}, 0.009);
  CHECK(held(box, {0.1, 0.2, 1.011}).empty());
  check_one(held(chosen, {0.1, 0.2, 0.9}), {0, 0, -1}, -0.1);  // without a depth of the user's
  Random random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 p = random.in({1.2, 1.2, 1.2});
    const auto found = held(box, p), alone = surface_contacts(box, p, 0.0);
    if (alone.empty()) {
      CHECK(std::all_of(found.begin(), found.end(), [](const SurfaceContact& t) { return t.gap >= 0.0; }));
    } else {
      REQUIRE(found.size() == 1);
      CHECK(found[0].feature == alone[0].feature);
      CHECK(found[0].gap == alone[0].gap);
      CHECK(found[0].normal == alone[0].normal);
    }
  }
}

TEST_CASE("sheets are touched from one side, or from both") {
  const IndexedMesh square = mesh::rectangle(2, 2, 2, 2);
  const TriangleMesh one(square, {.side = MeshSide::one_sided}), two(square, {.side = MeshSide::two_sided});
  check_one(surface_contacts(one, {0.1, 0.2, 0.2}, 0.3), {0, 0, -1}, 0.2);
  check_one(surface_contacts(one, {0.1, 0.2, -0.2}, 0.3), {0, 0, -1}, -0.2);  // pushed back to the front
  check_one(surface_contacts(one, {0.1, 0.2, -0.2}, 0.0), {0, 0, -1}, -0.2);
  check_one(surface_contacts(two, {0.1, 0.2, 0.2}, 0.3), {0, 0, -1}, 0.2);
  check_one(surface_contacts(two, {0.1, 0.2, -0.2}, 0.3), {0, 0, 1}, 0.2);
  CHECK(surface_contacts(two, {0.1, 0.2, -0.01}, 0.0).empty());
  for (const TriangleMesh& sheet : {one, two}) {  // beside the rim it is pushed away from the rim
    check_one(surface_contacts(sheet, {1.12, 0.2, -0.16}, 0.3), Vec3(-0.6, 0, 0.8), 0.2, 1e-12);
  }
}

TEST_CASE("a thin plate is touched on the side where the sphere is") {
  const TriangleMesh plate(mesh::box({2, 2, 0.01}, 4));
  check_one(surface_contacts(plate, {0.1, 0.2, 0.105}, 0.3), {0, 0, -1}, 0.1, 1e-13);
  check_one(surface_contacts(plate, {0.1, 0.2, -0.105}, 0.3), {0, 0, 1}, 0.1, 1e-13);
}

TEST_CASE("points of a mesh: its vertices, points on long sharp edges, and which of them are corners") {
  const TriangleMesh box(mesh::box({1, 1, 1}, 2), {.point_spacing = 0.26});
  std::size_t points = 0, corners = 0, near = 0;
  box.points({Vec3::Constant(-9), Vec3::Constant(9)}, [&](auto...) { ++points; });
  // Seen from far away no edge is long enough for points of its own.
  box.corners({0, 0, 0}, 9.0, [&](auto...) { ++corners; });
  box.corners({0.5, 0.5, 0.5}, 0.3, [&](auto, const auto& p, double) {
    CHECK((to_eigen(p) - Vec3(0.5, 0.5, 0.5)).norm() <= 0.3);
    ++near;
  });
  CHECK(points == 26 + 24);       // 24 half edges, each halved again
  CHECK(corners == 26 - 6 + 24);  // without the middles of the faces
  CHECK(near == 4 + 3);           // the corner, one fixed point on each edge, and the one half a radius away
  // A smooth surface sticks out everywhere, seen from inside nowhere.
  std::size_t convex = 0, concave = 0;
  const auto ball = mesh::sphere(1.0, 3);
  TriangleMesh(ball).corners({0, 0, 0}, 9.0, [&](auto...) { ++convex; });
  TriangleMesh(ball, {.facing = dem::MeshFacing::inward}).corners({0, 0, 0}, 9.0, [&](auto...) { ++concave; });
  CHECK(convex == ball.vertices.size());
  CHECK(concave == 0);
}

TEST_CASE("a mesh that does not enclose a solid is refused in words, or taken as a sheet") {
  IndexedMesh open = mesh::box({1, 1, 1});
  open.triangles.pop_back();
  check_refused([&] { TriangleMesh{open}; }, "not closed", "3 edges belong to one triangle only", "one_sided");
  CHECK(TriangleMesh(open, {.side = MeshSide::one_sided}).report().boundary_edges == 3);
  check_refused([&] { TriangleMesh(mesh::box({1, 1, 1}), {.smooth_angle = 120}); }, "smooth angle", "120");
  check_refused([&] { TriangleMesh(mesh::box({1, 1, 1}), {.depth = -1}); }, "depth of a mesh is -1 m");
  check_refused([&] { TriangleMesh(mesh::box({1, 1, 1}), {.point_spacing = 1e-7}); }, "raise point_spacing");
}

TEST_CASE("what is called for a contact may ask meshes in turn") {
  const TriangleMesh room(mesh::box({1, 1, 1}), {.facing = dem::MeshFacing::inward});
  using V = dem::Vector3<double>;
  const auto walls = [&](const V& p, auto&& in_turn) {
    std::vector<double> gaps;
    room.contacts(p, 0.2, [&](std::uint32_t, const V&, double gap) {
      in_turn();
      gaps.push_back(gap);
    });
    return gaps;
  };
  const V corner = {0.4, 0.39, 0.38};
  const auto alone = walls(corner, [] {});
  REQUIRE(alone.size() == 3);
  CHECK(walls(corner, [&] { CHECK(walls({-0.4, 0, 0}, [] {}).size() == 1); }) == alone);
}
