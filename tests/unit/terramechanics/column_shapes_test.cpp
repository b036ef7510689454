#include <dem/math/rotation.hpp>
#include <dem/terramechanics/column_field.hpp>
#include <dem/terramechanics/column_shapes.hpp>

#include <cmath>

#include "catch.hpp"

using namespace dem;
using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

/// Sums over all columns of a grid: the area under the shape, and the volume below z = 0.
struct Sums {
  double area = 0.0, volume = 0.0, area_beside = 0.0;
  Vector3<double> push = {0, 0, 0};  ///< the integral of depth times surface normal
};
Sums sums(const ColumnShape& shape, const ShapePose& pose, double spacing, double top = 0.0) {
  Sums s;
  const PlanBox box = shape.shadow(pose, top);
  const auto n = static_cast<std::size_t>(std::ceil(1.0 / spacing));
  const ColumnGrid grid = {-0.5 + 0.31 * spacing, -0.5 + 0.17 * spacing, spacing, n, n};
  for (std::size_t iy = 0; iy < n; ++iy) {
    for (std::size_t ix = 0; ix < n; ++ix) {
      const double x = grid.x(ix), y = grid.y(iy);
      ColumnContactPoint t;
      if (!shape.column_contact(pose, grid.place(ix, iy), top, t)) continue;
      const double area = t.share * spacing * spacing, h = spacing;
      s.area += area;
      s.volume += area * (top - t.point.z);
      s.push += (area * (top - t.point.z) / -t.normal.z) * t.normal;
      if (x < box.low_x - h || x > box.high_x + h || y < box.low_y - h || y > box.high_y + h) s.area_beside += area;
      CHECK(norm(t.normal) == Approx(1.0));
    }
  }
  return s;
}

Matrix3<double> turned(double x, double y, double z) { return rotation_from_vector(Vector3<double>{x, y, z}); }

}  // namespace

TEST_CASE("a level plate covers its area to the last digit, on any grid and turned by right angles") {
  const ColumnBox plate({0.13, 0.05, 0.01});
  for (const double spacing : {0.01, 0.013, 0.004, 0.07}) {
    for (const double yaw : {0.0, 0.5 * std::acos(-1.0)}) {
      const Sums s = sums(plate, {{0.0123, -0.0078, 0.002}, turned(0, 0, yaw)}, spacing);
      CHECK(s.area == Approx(0.13 * 0.05).epsilon(1e-9));
      CHECK(s.volume == Approx(0.13 * 0.05 * 0.003).epsilon(1e-9));
      CHECK(s.area_beside == 0.0);
    }
  }
  CHECK(plate.width() == 0.05);
}

TEST_CASE("plates at an angle, tilted ones and blocks that lean cover what they should") {
  // Edges that cross columns askew count by a straight line of shares: some parts in a thousand of the area.
  const ColumnBox plate({0.2, 0.1, 0.02});
  const Sums askew = sums(plate, {{0.001, 0.002, 0.005}, turned(0, 0, 0.5)}, 0.01);
  CHECK(askew.area == Approx(0.02).epsilon(5e-3));
  CHECK(askew.area_beside == 0.0);
  const Sums tilted = sums(plate, {{0, 0, -0.03}, turned(0, 0.3, 0)}, 0.001);
  // Its lower face, and its side of 0.02 sin(0.3) below it.
  CHECK(tilted.area == Approx(0.1 * (0.2 * std::cos(0.3) + 0.02 * std::sin(0.3))).epsilon(0.02));
  const ColumnBox block({0.1, 0.1, 0.1});
  const Sums cube = sums(block, {{0, 0, -0.2}, turned(0, 0.25 * std::acos(-1.0), 0)}, 0.004);
  CHECK(cube.area == Approx(0.1 * 0.1 * std::sqrt(2.0)).epsilon(0.02));
  CHECK(cube.push.x == Approx(0.0).margin(0.05 * cube.volume));
}

TEST_CASE("a wheel displaces its segment, on any grid and in any direction") {
  // 10 mm deep: segment r^2 (a - sin a cos a), by rows of columns with an error of (h/l)^1.5 at the ends.
  const ColumnCylinder wheel(0.13, 0.16);
  const double a = std::acos(0.12 / 0.13), segment = 0.13 * 0.13 * (a - std::sin(a) * std::cos(a));
  for (const double yaw : {0.0, 0.3, 0.25 * std::acos(-1.0), 1.2}) {
    const Sums s = sums(wheel, {{0.003, 0.004, 0.12}, turned(0, 0, yaw)}, 0.005);
    CHECK(s.volume == Approx(segment * 0.16).epsilon(0.01));
    CHECK(s.push.x == Approx(0.0).margin(0.01 * s.volume));
    CHECK(s.area_beside == 0.0);
  }
  for (const double spacing : {0.01, 0.007, 0.002}) {
    for (const double width : {0.16, 0.163, 0.151}) {  // no multiples of the spacing
      const Sums s = sums(ColumnCylinder(0.13, width), {{0, 0.001, 0.12}, turned(0, 0.7, 0)}, spacing);
      CHECK(s.volume == Approx(segment * width).epsilon(0.02 * spacing / 0.005));
    }
  }
  CHECK(wheel.width() == 0.16);
  CHECK(ColumnCylinder(0.05, 0.5).width() == 0.1);
}

TEST_CASE("a cambered wheel and one that lies on its side press with what is lowest") {
  const ColumnCylinder wheel(0.13, 0.16);
  const Sums leaning = sums(wheel, {{0, 0, 0.14}, turned(0.3, 0, 0)}, 0.004);
  CHECK(leaning.volume > 0.0);
  CHECK(leaning.area_beside == 0.0);
  const Sums flat = sums(wheel, {{0, 0, 0.07}, turned(0.5 * std::acos(-1.0), 0, 0)}, 0.004);
  CHECK(flat.area == Approx(std::acos(-1.0) * 0.13 * 0.13).epsilon(0.01));
  CHECK(flat.volume == Approx(std::acos(-1.0) * 0.13 * 0.13 * 0.01).epsilon(0.01));
}

TEST_CASE("a wheel whose rotation is one but for rounding has a shadow") {
  const ColumnCylinder wheel(0.13, 0.16);
  for (const double off : {-4e-16, 0.0, 4e-16}) {
    const Matrix3<double> turn = {{1, 1e-9, 0}, {-1e-9, 1.0 + off, 1e-9}, {0, -1e-9, 1.0}};
    CHECK(!wheel.shadow({{0, 0, 0.12}, turn}, 0.0).empty());
  }
}

TEST_CASE("a ball displaces its cap and is pushed straight up") {
  const ColumnBall ball(0.1);
  const Sums s = sums(ball, {{0.001, 0.002, 0.08}, turned(0.1, 0.2, 0.3)}, 0.002);
  CHECK(s.volume == Approx(std::acos(-1.0) * 0.02 * 0.02 * (0.1 - 0.02 / 3.0)).epsilon(5e-3));
  CHECK(s.push.x == Approx(0.0).margin(5e-3 * s.volume));
  CHECK(s.area_beside == 0.0);
  CHECK(ball.shadow({{0, 0, 0.1}, turned(0, 0, 0)}, 0.0).empty());
}

TEST_CASE("shapes without size are refused") {
  CHECK_THROWS_WITH(ColumnBall(0.0), ContainsSubstring("radius of a ball"));
  CHECK_THROWS_WITH(ColumnCylinder(-0.1, 0.1), ContainsSubstring("radius of a wheel"));
  CHECK_THROWS_WITH(ColumnCylinder(0.1, std::nan("")), ContainsSubstring("width of a wheel"));
  CHECK_THROWS_WITH(ColumnBox({0.1, 0.0, 0.1}), ContainsSubstring("edge of a box"));
}
