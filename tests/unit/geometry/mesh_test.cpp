#include "core/error_of.hpp"

#include <dem/geometry/mesh/mesh_mass_properties.hpp>
#include <dem/geometry/mesh/mesh_repair.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/math/rotation.hpp>

#include <random>

using Catch::Approx;
using dem::IndexedMesh;
using dem::MeshFacing;
using dem::Vec3;
namespace mesh = dem::mesh;

namespace {

/// Each triangle with vertices of its own, as an STL file has them.
IndexedMesh exploded(const IndexedMesh& m) {
  IndexedMesh result;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const auto base = static_cast<std::uint32_t>(result.vertices.size());
    for (int k = 0; k < 3; ++k) result.vertices.push_back(m.corner(t, k));
    result.triangles.push_back({base, base + 1, base + 2});
  }
  return result;
}

}  // namespace

TEST_CASE("meshes made by code are closed solids of the right size") {
  const double pi = std::numbers::pi;
  struct Case {
    IndexedMesh mesh;
    double volume, tolerance;
  };
  // A regular n-gon has n/2 sin(2 pi/n) of the squared radius; spheres of 4^5 * 20 triangles miss 1e-3 of theirs.
  const auto polygon = [&](int n) { return 0.5 * n * std::sin(2 * pi / n); };
  const mesh::Wheel wheel = {0.3, 0.2, 24, 0.02, 0.01, 72};
  const std::vector<Case> cases = {{mesh::box({1, 2, 3}), 6.0, 1e-14},
                                   {mesh::box({1, 2, 3}, 5), 6.0, 1e-13},
                                   {mesh::cylinder(0.5, 2.0, 48), 0.5 * polygon(48), 1e-13},
                                   {mesh::sphere(0.7, 5), 4.0 / 3.0 * pi * 0.343, 1e-3},
                                   {mesh::wheel({0.3, 0.2, 0, 0, 0, 60}), 0.09 * 0.2 * polygon(60), 1e-13}};
  for (const Case& c : cases) {
    const auto r = dem::repaired(c.mesh);
    CHECK(r.report.closed());
    CHECK(r.report.oriented());
    CHECK(r.report.components == 1);
    CHECK(r.report.flipped_triangles + r.report.degenerate_triangles + r.report.duplicate_triangles == 0);
    CHECK(r.report.merged_vertices + r.report.unused_vertices == 0);
    CHECK(r.report.enclosed_volume == Approx(c.volume).epsilon(c.tolerance));
    CHECK(dem::mesh_mass_properties(c.mesh).volume == Approx(c.volume).epsilon(c.tolerance));
  }
  // The grousers add their bars: height * thickness * width each, and the sliver between chord and rim polygon.
  const auto r = dem::repaired(mesh::wheel(wheel));
  CHECK(r.report.closed());
  CHECK(r.report.enclosed_volume == Approx(0.09 * 0.2 * pi + 24 * 0.02 * 0.01 * 0.2).epsilon(2e-3));
  CHECK(dem::repaired(mesh::box({1, 1, 1})).mesh.area() == Approx(6.0));
}

TEST_CASE("the tyre of 0.97 m has about the number of triangles that was asked for") {
  const IndexedMesh tyre = mesh::tyre(0.97, 0.254, 6662);
  CHECK(tyre.triangles.size() == Approx(6662).epsilon(0.01));
  const auto r = dem::repaired(tyre);
  CHECK(r.report.closed());
  CHECK(r.report.components == 1);
  Vec3 low = tyre.vertices[0], high = low;
  for (const Vec3& v : tyre.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  CHECK(high.x() == Approx(0.485));
  // The widest place of the profile lies between two of its points.
  CHECK(high.z() - low.z() == Approx(0.254).epsilon(2e-3));
  // Pappus: area of the superellipse |x/a|^4 + |z/b|^4 = 1, 4 a b Gamma(5/4)^2/Gamma(3/2), times the way of its middle;
  // polygons miss up to 1 %.
  const double a = 0.12125, b = 0.127, middle = 0.36375;
  const double area = 4 * a * b * std::pow(std::tgamma(1.25), 2) / std::tgamma(1.5);
  CHECK(r.report.enclosed_volume == Approx(2 * std::numbers::pi * middle * area).epsilon(0.01));
}

TEST_CASE("volume integrals of meshes agree with closed forms") {
  const dem::Mat3 turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 shift(10, -20, 5);
  const auto box = dem::mesh_mass_properties(mesh::box({1, 2, 3}, 3).moved(shift, turn));
  const auto exact = dem::box_mass_properties({1, 2, 3});
  CHECK(box.volume == Approx(6.0));
  CHECK((box.centre - shift).norm() < 1e-13 * shift.norm());
  CHECK((box.inertia - turn * exact.inertia * turn.transpose()).norm() < 1e-12 * exact.inertia.norm());
  // The error of an inscribed sphere falls with the square of the edge: by 4 for each refinement.
  const auto error = [](int refinements) {
    const auto m = dem::mesh_mass_properties(mesh::sphere(1.0, refinements));
    return (m.inertia - dem::sphere_mass_properties(1.0).inertia).norm();
  };
  CHECK(error(3) / error(4) == Approx(4.0).epsilon(0.02));
  CHECK_THAT(message_of([] {
               dem::mesh_mass_properties(mesh::box({1, 1, 1}).flipped());
             }),
             Catch::Matchers::ContainsSubstring("counter-clockwise"));
}

TEST_CASE("a broken mesh is repaired, and the report says what was done") {
  std::mt19937 engine(4);
  IndexedMesh m = exploded(mesh::sphere(1.0, 2));  // 320 triangles, 162 vertices
  std::uniform_real_distribution<double> noise(-2e-10, 2e-10);
  for (Vec3& v : m.vertices) v += Vec3(noise(engine), noise(engine), noise(engine));
  int flipped = 0;
  for (std::size_t t = 0; t < m.triangles.size(); t += 3) {
    std::swap(m.triangles[t][1], m.triangles[t][2]);
    ++flipped;
  }
  m.triangles.push_back(m.triangles[7]);                                             // twice
  m.triangles.push_back({m.triangles[9][2], m.triangles[9][1], m.triangles[9][0]});  // twice, reversed
  m.triangles.push_back({m.triangles[1][0], m.triangles[1][1], m.triangles[1][0]});  // a line
  m.vertices.emplace_back(0, 0, 0);                                                  // unused
  const auto r = dem::repaired(m);
  CHECK(r.report.vertices == 162);
  CHECK(r.report.triangles == 320);
  CHECK(r.report.merged_vertices == 960 - 162);
  CHECK(r.report.unused_vertices == 1);
  CHECK(r.report.duplicate_triangles == 2);
  CHECK(r.report.degenerate_triangles == 1);
  CHECK(r.report.flipped_triangles == static_cast<std::size_t>(flipped));
  CHECK(r.report.closed());
  CHECK(r.report.enclosed_volume == Approx(dem::mesh_mass_properties(mesh::sphere(1.0, 2)).volume).epsilon(1e-8));
  for (const char* words :
       {"320 triangles over 162 vertices", "2 triangles were there twice", "turned round", "closed"}) {
    CHECK_THAT(r.report.text(), Catch::Matchers::ContainsSubstring(words));
  }
  // Nothing is left to do.
  const auto again = dem::repaired(r.mesh);
  CHECK(again.report.merged_vertices + again.report.flipped_triangles + again.report.duplicate_triangles == 0);
  CHECK(again.report.triangles == 320);
  CHECK(again.report.enclosed_volume == Approx(r.report.enclosed_volume).epsilon(1e-14));
}

TEST_CASE("a triangle whose corners lie in a line is joined to its neighbour, so the surface stays closed") {
  IndexedMesh m = mesh::box({2, 2, 2});
  // The edge 0-1 of one side gets a vertex in its middle that the other side does not have: a T-junction closed by a
  // needle.
  const auto [a, b, c] = m.triangles[0];
  const auto middle = static_cast<std::uint32_t>(m.vertices.size());
  m.vertices.push_back(0.5 * (m.vertices[a] + m.vertices[b]));
  m.triangles[0] = {a, middle, c};
  m.triangles.push_back({middle, b, c});
  m.triangles.push_back({a, b, middle});
  const auto r = dem::repaired(m);
  CHECK(r.report.degenerate_triangles == 1);
  CHECK(r.report.closed());
  CHECK(r.report.oriented());
  CHECK(r.report.triangles == 14);
  CHECK(r.report.enclosed_volume == Approx(8.0));
}

TEST_CASE("holes and edges of three triangles are found, not hidden") {
  IndexedMesh open = mesh::box({1, 1, 1});
  open.triangles.pop_back();
  const auto hole = dem::repaired(open).report;
  CHECK(hole.boundary_edges == 3);
  CHECK(!hole.closed());
  CHECK_THAT(hole.text(), Catch::Matchers::ContainsSubstring("3 edges belong to one triangle only"));

  IndexedMesh fin = mesh::box({1, 1, 1});
  fin.vertices.emplace_back(2, 2, 2);
  fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], 8});
  const auto finned = dem::repaired(fin).report;
  CHECK(finned.non_manifold_edges == 1);
  const Vec3 edge = 0.5 * (fin.corner(0, 0) + fin.corner(0, 1));
  CHECK((finned.non_manifold_at - edge).norm() < 1e-15);
  CHECK_THAT(finned.text(), Catch::Matchers::ContainsSubstring(
                                dem::text("lies at ({:g}, {:g}, {:g}) m", edge.x(), edge.y(), edge.z())));

  IndexedMesh strip;  // a band of 10 quads with half a turn
  for (int k = 0; k < 10; ++k) {
    const double u = 2 * std::numbers::pi * k / 10;
    for (const double w : {-0.3, 0.3}) {
      strip.vertices.emplace_back((2 + w * std::cos(u / 2)) * std::cos(u), (2 + w * std::cos(u / 2)) * std::sin(u),
                                  w * std::sin(u / 2));
    }
  }
  for (std::uint32_t k = 0; k < 9; ++k) strip.add_quad(2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2);
  strip.add_quad(18, 19, 0, 1);
  const auto moebius = dem::repaired(strip).report;
  CHECK(moebius.inconsistent_edges > 0);
  CHECK_THAT(moebius.text(), Catch::Matchers::ContainsSubstring("Moebius"));
}

TEST_CASE("a solid inside out is turned; a hollow inside stays a hollow") {
  const auto turned = dem::repaired(mesh::box({1, 1, 1}).flipped());
  CHECK(turned.report.enclosed_volume == Approx(1.0));
  CHECK(turned.report.flipped_triangles == 12);
  CHECK(dem::repaired(mesh::box({1, 1, 1}), MeshFacing::inward).report.enclosed_volume == Approx(-1.0));
  IndexedMesh shell = mesh::box({2, 2, 2});
  shell += mesh::box({1, 1, 1}).flipped();
  CHECK(dem::repaired(shell).report.enclosed_volume == Approx(7.0));
  CHECK(dem::repaired(shell.flipped()).report.enclosed_volume == Approx(7.0));
  CHECK(dem::repaired(shell).report.components == 2);
  IndexedMesh two = mesh::box({2, 2, 2});  // side by side: each has to look outward
  two += mesh::box({1, 1, 1}).flipped().moved({5, 0, 0});
  CHECK(dem::repaired(two).report.enclosed_volume == Approx(9.0));
}

TEST_CASE("what stands in a vessel is a solid, and what is within that a hollow, whichever way they were given") {
  for (int k = 0; k < 8; ++k) {
    IndexedMesh vessel = mesh::box({4, 4, 4});
    const auto add = [&](const IndexedMesh& piece, int flag) { vessel += k & flag ? piece.flipped() : piece; };
    add(mesh::box({2, 2, 2}), 1);                           // an obstacle ...
    add(mesh::box({1, 1, 1}), 2);                           // ... that is hollow
    add(mesh::box({0.5, 0.5, 0.5}).moved({1.5, 0, 0}), 4);  // and another one beside it
    const auto r = dem::repaired(vessel, MeshFacing::inward);
    CHECK(r.report.enclosed_volume == Approx(-64.0 + 8.0 - 1.0 + 0.125));
    CHECK(r.report.components == 4);
  }
}

TEST_CASE("solids in a vessel that overlap stay solids") {
  // The block's box lies in that of the hub, whose round wall it crosses.
  IndexedMesh vessel = mesh::box({4, 4, 4}).flipped();
  const IndexedMesh hub = mesh::cylinder(1.0, 1.0, 32), block = mesh::box({0.3, 0.3, 0.3}).moved({0.7, 0.7, 0});
  vessel += hub;
  vessel += block;
  const auto r = dem::repaired(vessel, MeshFacing::inward);
  CHECK(r.report.flipped_triangles == 0);
}

TEST_CASE("a hub in the hole of a tyre is not inside of the tyre") {
  // Each has to look outward, whichever of them was given inside out.
  const IndexedMesh tyre = mesh::tyre(1.0, 0.25, 600), hub = mesh::cylinder(0.2, 0.2, 24),
                    block = mesh::box({0.2, 0.2, 0.2});
  for (const IndexedMesh& inner : {hub, block}) {
    const double volume = dem::repaired(tyre).report.enclosed_volume + dem::repaired(inner).report.enclosed_volume;
    for (int k = 0; k < 8; ++k) {
      IndexedMesh ring = k & 1 ? tyre.flipped() : tyre, middle = k & 2 ? inner.flipped() : inner;
      IndexedMesh both = k & 4 ? middle : ring;
      both += k & 4 ? ring : middle;
      const auto r = dem::repaired(both);
      CHECK(r.report.enclosed_volume == Approx(volume).epsilon(1e-12));
      CHECK(r.report.flipped_triangles == (k & 1 ? tyre.triangles.size() : 0) + (k & 2 ? inner.triangles.size() : 0));
      CHECK(dem::repaired(both, MeshFacing::inward).report.enclosed_volume == Approx(-volume).epsilon(1e-12));
    }
  }
  // A hollow in the rubber is inside of it: it keeps its way relative to the tyre's.
  const IndexedMesh bubble = mesh::sphere(0.05, 1).flipped().moved({0.375, 0, 0});
  IndexedMesh hollow = tyre;
  hollow += bubble;
  const double rubber = dem::repaired(tyre).report.enclosed_volume - dem::mesh_mass_properties(bubble.flipped()).volume;
  for (const IndexedMesh& given : {hollow, hollow.flipped()}) {
    CHECK(dem::repaired(given).report.enclosed_volume == Approx(rubber).epsilon(1e-12));
  }
}

TEST_CASE("pieces that touch from inside are inside, those that touch from outside are not") {
  IndexedMesh inside = mesh::box({2, 2, 2}, 2);  // a hollow that touches a wall with its whole face
  inside += mesh::box({1, 1, 1}).flipped().moved({0.5, 0.1, 0.1});
  CHECK(dem::repaired(inside.flipped()).report.enclosed_volume == Approx(7.0));
  IndexedMesh beside = mesh::tyre(1.0, 0.25, 600);  // a ring's bounding box holds a block that touches its flat cells
  const Vec3 on_boundary = (beside.corner(0, 0) + beside.corner(0, 1) + beside.corner(0, 2)) / 3.0;
  const Vec3 out = beside.area_vector(0).normalized();
  beside += mesh::box({0.01, 0.01, 0.01})
                .flipped()
                .moved(on_boundary + 0.005 * out, dem::rotation_between(Vec3::UnitZ(), out));
  const double volume = dem::repaired(mesh::tyre(1.0, 0.25, 600)).report.enclosed_volume;
  CHECK(dem::repaired(beside).report.enclosed_volume == Approx(volume + 1e-6).epsilon(1e-12));
}

TEST_CASE("meshes that make no sense are refused") {
  check_refused([] { dem::repaired({{Vec3(0, 0, 0)}, {{0, 0, 7}}}); }, "triangle 0", "vertex 7");
  check_refused([] { dem::repaired({{Vec3(0, 0, std::nan(""))}, {{0, 0, 0}}}); }, "vertex 0", "finite");
  check_refused([] { dem::repaired({}); }, "0 triangles");
  check_refused([] { dem::repaired({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, {{0, 1, 2}}}); }, "has an area");
  check_refused([] { mesh::cylinder(1.0, 0.0); }, "length of a cylinder mesh is 0 m");
  check_refused([] { mesh::wheel({0.1, 0.1, 20, 0.01, 0.05}); }, "20 grousers", "fewer or thinner");
  check_refused([] { mesh::sphere(1.0, 12); }, "refinements");
  check_refused([] { mesh::tyre(1.0, 0.2, 20); }, "at least 60");
}

TEST_CASE("a mesh with a corrupt coordinate is refused, however far out that is") {
  for (const double far : {1e12, 5e35, 1e60, -3.4e38, 1e99}) {
    IndexedMesh box = mesh::box({1, 1, 1}, 2);
    box.vertices[3].y() = far;
    check_refused([&] { dem::repaired(box); }, "of the 48 triangles of a mesh are smaller", "seems to be corrupt");
  }
  // As large as one likes, if all of it is.
  IndexedMesh large = mesh::box({1, 1, 1}, 2);
  for (Vec3& v : large.vertices) v *= 5e35;
  CHECK(dem::repaired(large).report.enclosed_volume == Approx(1.25e107));
  // Triangles that were points before are no sign of it.
  IndexedMesh dots = mesh::box({1, 1, 1});
  for (int k = 0; k < 50; ++k) dots.triangles.push_back({0, 0, 1});
  CHECK(dem::repaired(dots).report.triangles == 12);
}

TEST_CASE("no triangle of a repaired mesh is without a normal, whatever the mesh was") {
  // Corners at few places, so that many lie in lines: more than are joined leave a triangle in some of 2,000 meshes.
  std::mt19937 random(1);
  int repaired = 0, refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    IndexedMesh junk = mesh::box({1, 1, 1}, 3);
    for (Vec3& v : junk.vertices) {
      for (int c = 0; c < 3; ++c) {
        constexpr double places[] = {0.0, 5e35, 1e30, -5e35};
        v[c] = places[random() % 4] * (1.0 + static_cast<double>(random() % 3));
      }
    }
    const std::string text = message_of([&] {
      const IndexedMesh m = dem::repaired(junk).mesh;
      ++repaired;
      for (std::size_t t = 0; t < m.triangles.size(); ++t) REQUIRE(m.area_vector(t).norm() > 0.0);
    });
    refused += text.find("has no area and could not be joined") != std::string::npos ? 1 : 0;
  }
  CHECK(repaired > 1900);
  CHECK(refused > 0);
}
