#include "catch.hpp"
#include "core/error_of.hpp"

#include <dem/geometry/mesh/mesh_mass_properties.hpp>
#include <dem/geometry/mesh/mesh_sweeps.hpp>
#include <dem/geometry/mesh/mesh_topology.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

using Catch::Approx;

TEST_CASE("the blade of a screw is a closed solid that winds as it should") {
  constexpr double pi = std::numbers::pi, inner = 0.01, outer = 0.03, pitch = 0.05, length = 0.1, thick = 0.004;
  // It is as thick everywhere, along z, over what its lower side covers: sectors of a ring, one for each segment, with
  // chords for arcs.
  for (const double sense : {1.0, -1.0}) {
    for (const int n : {64, 32}) {
      const dem::IndexedMesh m = dem::mesh::helix(inner, outer, sense * pitch, length, thick, n);
      const dem::MeshTopology topology = dem::topology_of(m);
      CHECK(topology.closed());
      CHECK(topology.oriented());
      const auto p = dem::mesh_mass_properties(m);
      const double sector = 0.5 * (outer * outer - inner * inner) * std::sin(2 * pi / n);
      CHECK(p.volume == Approx(thick * sector * n * length / pitch).epsilon(1e-12));
      CHECK(std::hypot(p.centre.x(), p.centre.y()) < 1e-12);  // these are whole turns
      // A segment is cut in two triangles. The one with two corners outside, which has the share outer/(inner +
      // outer) of it, has its middle at two thirds of the segment's height, the other one at a third.
      CHECK(p.centre.z() == Approx(pitch / n / 6 * (outer - inner) / (outer + inner)).epsilon(1e-9));
    }
  }
  // It begins along x at the lower end, and a quarter of a turn later it points along y, or -y if it is left-handed.
  for (const double sense : {1.0, -1.0}) {
    const dem::IndexedMesh m = dem::mesh::helix(inner, outer, sense * pitch, length, thick);
    CHECK((m.vertices[1] - dem::Vec3(outer, 0, -0.5 * length - 0.5 * thick)).norm() < 1e-15);
    const dem::Vec3 quarter(0, sense * outer, -0.5 * length + 0.25 * pitch - 0.5 * thick);
    CHECK((m.vertices[4 * 8 + 1] - quarter).norm() < 1e-15);
  }
  check_refused([] { (void)dem::mesh::helix(0.02, 0.01, 0.05, 0.1, 0.001); }, "0.02", "second be larger");
  check_refused([] { (void)dem::mesh::helix(0.01, 0.02, 0.05, 0.1, 0.05); }, "thinner than the pitch");
  check_refused([] { (void)dem::mesh::helix(0.01, 0.02, 0.0, 0.1, 0.001); }, "pitch of a helix is 0 m");
  check_refused([] { (void)dem::mesh::helix(0.01, 0.02, 0.05, 0.1, 0.001, 7); }, "7 segments", "at least 8");
}

TEST_CASE("a sheet is as large as its profile is long, and shows its faces outwards") {
  const std::vector<std::array<double, 2>> profile = {{3, 0}, {0, 4}, {-3, 0}};  // counter-clockwise about the origin
  const dem::IndexedMesh m = dem::mesh::sheet(profile, 2.0);
  CHECK(m.area() == Approx(2.0 * 10));
  CHECK(dem::topology_of(m).oriented());
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    CHECK(m.area_vector(t).dot(m.corner(t, 0) + m.corner(t, 1) + m.corner(t, 2)) > 0.0);
    CHECK(m.area_vector(t).z() == 0.0);
  }
  CHECK(m.vertices.front().z() == -1.0);
  CHECK(m.vertices.back() == dem::Vec3(-3, 0, 1));
  check_refused([] { (void)dem::mesh::sheet(std::vector<std::array<double, 2>>{{1, 1}}, 1); }, "has 1 points");
  check_refused([&] { (void)dem::mesh::sheet(profile, 0); }, "length of a sheet is 0 m");
  check_refused([] { (void)dem::mesh::sheet(std::vector<std::array<double, 2>>{{1, 1}, {1, 1}}, 1); }, "in one place");
}
