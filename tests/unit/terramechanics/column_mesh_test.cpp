#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/math/rotation.hpp>
#include <dem/terramechanics/column_mesh.hpp>
#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/soil_columns.hpp>

#include <array>

#include "catch.hpp"

namespace column_mesh_test {

using namespace dem;
using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

const Soil sand = {.pressure = WongReece{2e4, 1.0, 0.01},
                   .shear = {.cohesion = 0.0, .friction_angle = 0.6, .displacement = 1e-3},
                   .unloading_stiffness = 5e7};

SoilColumns field(double spacing) {
  return SoilColumns(
      {.low_x = -0.3, .low_y = -0.25, .length_x = 0.6, .length_y = 0.5, .spacing = spacing, .soil = sand});
}
/// A cylinder about z, as the mesh is drawn, turned to lie along y.
const Matrix3<double> along_y = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};

ColumnLoad press(SoilColumns& soil, std::shared_ptr<const ColumnShape> shape, const integrator::Motion<double>& body,
                 const Matrix3<double>& rotation = Matrix3<double>::identity()) {
  const std::array<ColumnPart, 1> parts = {ColumnPart{.shape = std::move(shape), .body = body, .rotation = rotation}};
  CHECK(soil.apply(parts, 1e-3).ok);
  return soil.loads()[0];
}

}  // namespace

TEST_CASE("a plate of triangles presses like a plate, also standing askew") {
  // Its edges lie on the grid of rays, a third of a column apart, so the shares are exact where it stands straight.
  const auto shape = std::make_shared<ColumnMesh>(surface::TriangleMesh(mesh::box({0.12, 0.06, 0.02}, 3)), 0.06);
  const auto box = std::make_shared<ColumnBox>(Vector3<double>{0.12, 0.06, 0.02});
  for (const double angle : {0.0, 0.4}) {
    const Matrix3<double> turn = rotation_from_vector(Vector3<double>{0.0, 0.0, angle});
    const integrator::Motion<double> body = {{0, 0, 0.01 - 0.02}, {0, 0, 0}, {0, 0, 0}, turn};
    SoilColumns one = field(0.01), other = field(0.01);
    const ColumnLoad a = press(one, shape, body), b = press(other, box, body);
    CHECK(a.force.z == Approx(b.force.z).epsilon(angle == 0.0 ? 1e-9 : 0.02));
    CHECK(b.force.z == Approx(0.12 * 0.06 * 2e6 * 0.02).epsilon(0.005));
  }
}

TEST_CASE("a finely cut cylinder rolls like a wheel") {
  // 96 sides: its mean radius is r (1 - (pi/96)^2/6 ...), some 0.02 mm less of 20 mm, and rays miss its side by up to a
  // sixth of a column.
  const auto shape = std::make_shared<ColumnMesh>(surface::TriangleMesh(mesh::cylinder(0.13, 0.16, 96)), 0.16);
  const auto wheel = std::make_shared<ColumnCylinder>(0.13, 0.16);
  SoilColumns one = field(0.01), other = field(0.01);
  ColumnLoad a, b;
  for (int k = 0; k < 100; ++k) {
    const double angle = 0.01 * k, c = std::cos(angle), s = std::sin(angle);
    const integrator::Motion<double> body = {
        {1e-3 * k, 0.001, 0.11}, {1.0, 0, 0}, {0, 10.0, 0}, {{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
    a = press(one, shape, body, along_y);
    b = press(other, wheel, body);
  }
  CHECK(a.force.z == Approx(b.force.z).epsilon(0.02));
  CHECK(a.force.x == Approx(b.force.x).epsilon(0.02));
  CHECK(a.torque.y == Approx(b.torque.y).epsilon(0.02));
}

TEST_CASE("grousers leave their prints beside the rim's rut") {
  // The rim is 10 mm deep, the tips 12 mm deeper; p = 2 MPa/m z springs back by z/25.
  const mesh::Wheel spec = {
      .radius = 0.13, .width = 0.16, .grousers = 12, .grouser_height = 0.012, .grouser_thickness = 0.004};
  const auto shape = std::make_shared<ColumnMesh>(surface::TriangleMesh(mesh::wheel(spec)), 0.16, 2);
  SoilColumns soil = field(0.004);
  for (int k = 0; k < 200; ++k) {  // rolls without slip, over one and a half grousers
    const double angle = 1e-3 / 0.13 * k - 0.2, c = std::cos(angle), s = std::sin(angle);
    press(soil, shape,
          {{1e-3 * k - 0.1, 0.001, 0.12}, {1.0, 0, 0}, {0, 1.0 / 0.13, 0}, {{c, 0, s}, {0, 1, 0}, {-s, 0, c}}},
          along_y);
  }
  const ColumnField& f = soil.field();
  double deepest = 0.0;
  int rim = 0;
  for (std::size_t ix = 0; ix < f.grid.nx; ++ix) {
    const double z = f.sunk[f.grid.row(ix, f.grid.ny / 2)];
    deepest = std::max(deepest, z);
    rim += z > 0.0094 && z < 0.0098 ? 1 : 0;
  }
  CHECK(deepest == Approx(0.022 * 24.0 / 25.0).epsilon(0.03));
  CHECK(rim > 10);
}

TEST_CASE("meshes without a width, and rays without end, are refused") {
  const surface::TriangleMesh mesh(mesh::box({0.1, 0.1, 0.1}));
  CHECK_THROWS_WITH(ColumnMesh(mesh, 0.0), ContainsSubstring("width of a mesh on soil columns"));
  CHECK_THROWS_WITH(ColumnMesh(mesh, 0.1, 0), ContainsSubstring("has 0 rays"));
}

}  // namespace column_mesh_test
