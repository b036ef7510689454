#include <dem/math/rotation.hpp>
#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/soil_columns.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "catch.hpp"

namespace soil_columns_test {

using namespace dem;
using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

const Matrix3<double> upright = Matrix3<double>::identity();

Soil sand(double n = 1.0, double stiffness = 5e7) {
  return {.pressure = WongReece{2e4, n, 0.01},  // 2 MPa/m for n = 1
          .shear = {.cohesion = 0.0, .friction_angle = 0.6, .displacement = 1e-3},
          .unloading_stiffness = stiffness};
}
ColumnsSpec field(const Soil& soil, double spacing = 0.01) {
  return {.low_x = -0.3, .low_y = -0.25, .length_x = 0.6, .length_y = 0.5, .spacing = spacing, .soil = soil};
}
ColumnPart part(std::shared_ptr<const ColumnShape> shape, Vector3<double> at, Vector3<double> speed = {0, 0, 0}) {
  return {.shape = std::move(shape), .body = {at, speed, {0, 0, 0}, upright}};
}
ColumnLoad press(SoilColumns& soil, const ColumnPart& p, double dt = 1e-3) {
  const std::array<ColumnPart, 1> parts = {p};
  const ColumnsReport report = soil.apply(parts, dt);
  CHECK(report.ok);
  return soil.loads()[0];
}

}  // namespace

TEST_CASE("a plate on columns has the pressure of the soil's law, wherever it stands on the grid") {
  for (const double spacing : {0.01, 0.017}) {
    for (const Soil& law : {mojave_martian_simulant, melanz_sand, sand()}) {
      SoilColumns soil(field(law, spacing));
      const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.13, 0.05, 0.01});
      const PressureCurve curve = under(law.pressure, 0.05);
      for (int k = 1; k <= 30; ++k) {
        const double z = 1e-3 * k;
        const ColumnLoad load = press(soil, part(plate, {0.0123, -0.0077, 0.005 - z}));
        CHECK(load.force.z == Approx(0.13 * 0.05 * curve.pressure(z)).epsilon(1e-9));
        CHECK(std::abs(load.force.x) + std::abs(load.force.y) < 1e-9 * load.force.z);
        // The pressure is the same all over, so it has no torque about the middle.
        CHECK(norm(load.torque) < 1e-9 * load.force.z);
      }
    }
  }
}

TEST_CASE("a plate that is lifted unloads along the elastic line and leaves its rut") {
  SoilColumns soil(field(sand()));
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.01});
  const double area = 0.01, z = 0.02, p = 2e6 * z;
  CHECK(press(soil, part(plate, {0, 0, 0.005 - z})).force.z == Approx(area * p));
  for (const double back : {1e-4, 4e-4, 7e-4, 2e-4}) {
    CHECK(press(soil, part(plate, {0, 0, 0.005 - z + back})).force.z == Approx(area * (p - 5e7 * back)).epsilon(1e-9));
  }
  CHECK(press(soil, part(plate, {0, 0, 0.005 - z + 9e-4})).force.z == 0.0);
  const ColumnField& f = soil.field();
  const std::size_t under_it = f.grid.row(30, 25), beside = f.grid.row(10, 10);
  CHECK(f.surface(under_it) == Approx(-(z - p / 5e7)));
  CHECK(f.surface(beside) == 0.0);
  // The same load on the same place again: back to the same depth, along the line.
  CHECK(press(soil, part(plate, {0, 0, 0.005 - z})).force.z == Approx(area * p));
  CHECK(f.deepest[under_it] == Approx(z));
}

TEST_CASE("a plate that is dragged feels Janosi and Hanamoto's stress, and starts anew once it was lifted") {
  Soil law = sand();
  law.shear.cohesion = 500.0;
  SoilColumns soil(field(law));
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.01});
  const double z = 0.01, dt = 1e-3, speed = 0.05, sigma = 2e4;
  ColumnPart p = part(plate, {0, 0, 0.005 - z});
  press(soil, p, dt);
  // Held at its depth. The edge in front meets fresh soil, so sheared for less: a column's edge counts by its share,
  // and 3 mm of way are 3 % of the plate.
  for (int k = 1; k <= 60; ++k) {
    p.body.velocity = {speed, 0, 0};
    p.body.position.x = speed * dt * k;
    const ColumnLoad load = press(soil, p, dt);
    const double tau = law.shear.stress(sigma, speed * dt * k);
    CHECK(-load.force.x == Approx(0.01 * tau).epsilon(0.035));
  }
  p.body.velocity = {0, 0, 0};
  const double held = press(soil, p, dt).force.x;
  CHECK(held < -0.95 * 0.01 * law.shear.strength(sigma));  // it stays strained
  const double x = p.body.position.x;
  press(soil, part(plate, {x, 0, 0.1}));
  CHECK(press(soil, part(plate, {x, 0, 0.005 - z})).force.x == 0.0);
}

TEST_CASE("a ball and a wheel are carried by the volume that they displace, for n = 1") {
  // Pressure 2 MPa/m times depth acts on the plan area: force = 2e6 times volume. A wheel's rows end in the air, with
  // an error of (h/l)^1.5 of the row, l = 50 mm.
  SoilColumns one(field(sand(), 0.002)), two(field(sand(), 0.005));
  ColumnPart ball = part(std::make_shared<ColumnBall>(0.1), {0.001, 0.002, 0.08});
  ball.width = 0.05;
  const double cap = std::acos(-1.0) * 0.02 * 0.02 * (0.1 - 0.02 / 3.0);
  CHECK(press(one, ball).force.z == Approx(2e6 * cap).epsilon(0.005));
  const double a = std::acos(0.12 / 0.13), segment = 0.13 * 0.13 * (a - std::sin(a) * std::cos(a));
  const ColumnLoad wheel = press(two, part(std::make_shared<ColumnCylinder>(0.13, 0.16), {0.001, 0.002, 0.12}));
  CHECK(wheel.force.z == Approx(2e6 * segment * 0.16).epsilon(0.01));
  CHECK(std::abs(wheel.force.x) < 0.01 * wheel.force.z);
}

TEST_CASE("force times way is the work of the columns, whichever way a part goes") {
  // Without shear strength the force is the gradient of the columns' energy: what a ball that sinks and ploughs along
  // puts in is what the columns took, less what they gave back where it left them. Trapezium rule: the error, where
  // columns come free, is of first order in the step, 1.2e-3 at steps of 10 um.
  Soil smooth = sand(1.2);
  smooth.shear.friction_angle = 0.0;
  SoilColumns soil(field(smooth, 0.005));
  ColumnPart ball = part(std::make_shared<ColumnBall>(0.1), {0, 0, 0.101});
  ball.width = 0.05;
  ball.body.angular_velocity = {3.0, 2.0, 1.0};
  double work = 0.0;
  ColumnLoad last;
  const double dt = 1e-4;
  for (int k = 0; k < 4000; ++k) {
    const Vector3<double> speed = k < 2000 ? Vector3<double>{0.04, 0.02, -0.1} : Vector3<double>{0.1, -0.03, 0.0};
    ball.body.velocity = speed;
    const ColumnLoad load = press(soil, ball, dt);
    work -= 0.5 * dt * dot(load.force + last.force, speed);
    last = load;
    ball.body.position = ball.body.position + dt * speed;
  }
  const ColumnField& f = soil.field();
  const ColumnLaw law(smooth, 0.05);
  double taken = 0.0;
  for (std::size_t row = 0; row < f.grid.size(); ++row) {
    if (f.deepest[row] == 0.0) continue;
    const double p = law.curve.pressure(f.deepest[row]), now = f.touched[row] == soil.steps() ? f.pressure[row] : 0.0;
    taken +=
        f.grid.area() * (law.curve.work(f.deepest[row]) - 0.5 * (p * p - now * now) / law.slope(f.deepest[row], p));
  }
  CHECK(work == Approx(taken).epsilon(2e-3));
}

TEST_CASE("no energy comes from soil under a plate that is pressed, dragged and lifted in circles") {
  SoilColumns soil(field(sand()));
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.08, 0.01});
  double work = 0.0, last_cycle = 0.0;
  const double dt = 1e-4;
  for (int cycle = 0; cycle < 6; ++cycle) {
    ColumnLoad last;
    for (int k = 0; k < 2000; ++k) {
      const double phase = 2.0 * std::acos(-1.0) * k / 2000, rate = 2.0 * std::acos(-1.0) / (2000 * dt);
      const Vector3<double> speed = {2e-3 * std::cos(phase) * rate, 0.0, -3e-3 * std::sin(phase) * rate};
      ColumnPart p = part(plate, {2e-3 * std::sin(phase), 0, 0.005 - 8e-3 + 3e-3 * std::cos(phase)}, speed);
      if (cycle % 2 == 1) {  // the other way round
        p.body.position.x = -p.body.position.x;
        p.body.velocity.x = -p.body.velocity.x;
      }
      const ColumnLoad load = press(soil, p, dt);
      work -= 0.5 * dt * dot(load.force + last.force, p.body.velocity);
      last = load;
    }
    CHECK(work >= last_cycle);
    last_cycle = work;
  }
}

TEST_CASE("damping resists both ways but never pulls") {
  ColumnsSpec spec = field(sand());
  spec.damping = 1e4;
  SoilColumns soil(spec);
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.01});
  const double p = 2e6 * 0.01;
  CHECK(press(soil, part(plate, {0, 0, -0.005}, {0, 0, -0.2})).force.z == Approx(0.01 * (p + 1e4 * 0.2)));
  CHECK(press(soil, part(plate, {0, 0, -0.005}, {0, 0, 0.2})).force.z == Approx(0.01 * (p - 1e4 * 0.2)));
  CHECK(press(soil, part(plate, {0, 0, -0.005}, {0, 0, 20.0})).force.z == 0.0);
}

TEST_CASE("the lowest of several parts has a column, and all parts press on their own") {
  SoilColumns soil(field(sand()));
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.01});
  std::vector<ColumnPart> parts = {part(plate, {0, 0, 0.0}), part(plate, {0.05, 0, -0.005}),
                                   part(plate, {-0.2, 0, -0.005})};
  CHECK(soil.apply(parts, 1e-3).columns == 100 + 50 + 100);
  CHECK(soil.loads()[0].force.z == Approx(0.005 * 2e6 * 0.005));  // the half that the second leaves it
  CHECK(soil.loads()[1].force.z == Approx(0.01 * 2e6 * 0.01));
  CHECK(soil.loads()[2].force.z == Approx(0.01 * 2e6 * 0.01));
  // Its columns lie to the left of its middle: 50 N 25 mm off.
  CHECK(soil.loads()[0].torque.y == Approx(0.025 * soil.loads()[0].force.z));
}

TEST_CASE("wider parts press the same rut on along their own curve") {
  Soil law = mojave_martian_simulant;
  law.unloading_stiffness = 1e8;
  SoilColumns soil(field(law));
  const auto narrow = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.03, 0.01});
  const auto wide = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.01});
  press(soil, part(narrow, {0, 0, 0.005 - 0.01}));
  press(soil, part(narrow, {0, 0, 0.1}));
  const std::size_t middle = soil.field().grid.row(30, 25);
  const double rut = soil.field().sunk[middle];
  const PressureCurve curve = under(law.pressure, 0.1);
  // Where the wide one has pressed deeper than both it is on its own curve, also where the rut was.
  const ColumnLoad load = press(soil, part(wide, {0, 0, 0.005 - 0.02}));
  CHECK(load.force.z == Approx(0.01 * curve.pressure(0.02)).epsilon(1e-9));
  CHECK(soil.field().sunk[middle] > rut);
  CHECK(soil.field().deepest[middle] == Approx(0.02));
}

TEST_CASE("soil has the shape that it is given, and hard ground below") {
  ColumnsSpec spec = field(sand());
  spec.thickness = 0.01;
  SoilColumns soil(spec);
  soil.shape_ground([](double x, double) { return x > 0.0 ? 0.02 : 0.0; });
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.01});
  CHECK(press(soil, part(plate, {-0.1, 0, 0.003})).force.z == Approx(0.01 * 2e6 * 0.002));
  CHECK(press(soil, part(plate, {0.1, 0, 0.023})).force.z == Approx(0.01 * 2e6 * 0.002));
  const std::array<ColumnPart, 1> deep = {part(plate, {0.1, 0, 0.005 + 0.02 - 0.011})};
  const ColumnsReport report = soil.apply(deep, 1e-3);
  CHECK(report.on_base == 100);
  CHECK(soil.loads()[0].area == Approx(0.01));
  CHECK(soil.loads()[0].force.z == Approx(0.01 * (2e6 * 0.01 + 5e7 * 0.001)));
  CHECK_THROWS_WITH(soil.shape_ground([](double x, double) { return 1.0 / (x > 0.0 ? 0.0 : 1.0); }),
                    ContainsSubstring("must be finite"));
}

TEST_CASE("looking twice at a step keeps nothing") {
  SoilColumns once(field(sand())), twice(field(sand()));
  const auto wheel = std::make_shared<ColumnCylinder>(0.13, 0.16);
  for (int k = 0; k < 50; ++k) {
    const std::array<ColumnPart, 1> now = {part(wheel, {1e-3 * k, 0, 0.12}, {1.0, 0, 0})};
    const std::array<ColumnPart, 1> trial = {part(wheel, {1e-3 * k, 0, 0.11}, {-1.0, 0, 0})};
    once.apply(now, 1e-3);
    twice.evaluate(trial, 1e-3);
    twice.evaluate(now, 1e-3);
    twice.commit();
    CHECK(once.loads()[0].force.x == twice.loads()[0].force.x);
  }
  CHECK(once.field().sunk == twice.field().sunk);
}

TEST_CASE("parts that leave the soil or are nowhere are reported, not thrown") {
  SoilColumns soil(field(sand()));
  const auto wheel = std::make_shared<ColumnCylinder>(0.13, 0.16);
  const std::array<ColumnPart, 1> edge = {part(wheel, {0.29, 0, 0.12})}, gone = {part(wheel, {5.0, 0, 0.12})},
                                  nowhere = {part(wheel, {std::nan(""), 0, 0.12})},
                                  above = {part(wheel, {5.0, 0, 1.0})};
  const ColumnsReport half = soil.apply(edge, 1e-3);
  CHECK(!half.ok);
  CHECK_THAT(half.text, ContainsSubstring("part 0 on soil columns leaves the soil at (0.29, 0) m"));
  CHECK(half.part == 0);
  CHECK(soil.loads()[0].force.z > 0.0);
  CHECK(soil.loads()[0].leaves);
  CHECK(!soil.apply(gone, 1e-3).ok);
  CHECK(soil.loads()[0].force.z == 0.0);
  CHECK(soil.apply(above, 1e-3).ok);
  const ColumnsReport lost = soil.apply(nowhere, 1e-3);
  CHECK_THAT(lost.text, ContainsSubstring("is nowhere"));
  std::array<ColumnPart, 1> bent = {part(wheel, {0, 0, 0.12})};
  bent[0].body.rotation = {{1, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  CHECK(!soil.apply(bent, 1e-3).ok);
}

TEST_CASE("fields and parts that cannot be are refused in words") {
  const auto refused = [](auto&& change) {
    ColumnsSpec spec = field(sand());
    change(spec);
    return spec;
  };
  CHECK_THROWS_WITH(SoilColumns(refused([](auto& s) { s.spacing = 0.0; })),
                    ContainsSubstring("spacing of soil columns"));
  CHECK_THROWS_WITH(SoilColumns(refused([](auto& s) { s.spacing = 1e-6; })), ContainsSubstring("raise the spacing"));
  CHECK_THROWS_WITH(SoilColumns(refused([](auto& s) { s.length_x = -1.0; })), ContainsSubstring("length of the soil"));
  CHECK_THROWS_WITH(SoilColumns(refused([](auto& s) { s.thickness = -1.0; })), ContainsSubstring("thickness"));
  CHECK_THROWS_WITH(SoilColumns(refused([](auto& s) { s.bulldozing = 3.0; })), ContainsSubstring("pushed aside"));
  CHECK_THROWS_WITH(SoilColumns(refused([](auto& s) { s.soil.shear.displacement = 0.0; })), ContainsSubstring("K of"));
  CHECK_THROWS_WITH(SoilColumns(refused([](auto& s) { s.height = std::nan(""); })),
                    ContainsSubstring("height of the soil"));
  CHECK_THROWS_WITH(SoilColumns(refused([](auto& s) { s.length_x = 1e12, s.length_y = 1e-9; })),
                    ContainsSubstring("raise the spacing"));
  SoilColumns soil(field(sand()));
  const std::array<ColumnPart, 1> bare = {part(nullptr, {0, 0, 0})},
                                  ball = {part(std::make_shared<ColumnBall>(0.1), {})};
  CHECK_THROWS_WITH(soil.apply(bare, 1e-3), ContainsSubstring("part 0 on soil columns has no shape"));
  CHECK_THROWS_WITH(soil.apply(ball, 1e-3), ContainsSubstring("has no width"));
}

TEST_CASE("a smooth part slides on the soil at its own friction, and not above the strength of the soil") {
  const auto drag = [](double friction) {
    SoilColumns soil({.low_x = -0.2, .low_y = -0.2, .length_x = 0.6, .length_y = 0.4, .soil = melanz_sand});
    const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.05, 0.01});
    std::array<double, 2> drag_and_load = {};
    for (int k = 0; k < 100; ++k) {  // 20 mm: 39 times the shear displacement, from which the stress is the strength
      const std::array<ColumnPart, 1> parts = {
          ColumnPart{.shape = plate,
                     .body = {{2e-4 * k, 0, 0.0}, {0.2, 0, 0}, {0, 0, 0}, Matrix3<double>::identity()},
                     .friction = friction}};
      REQUIRE(soil.apply(parts, 1e-3).ok);
      drag_and_load = {-soil.loads()[0].force.x, soil.loads()[0].force.z};
    }
    return drag_and_load;
  };
  const auto smooth = drag(0.1), rough = drag(ColumnPart::rough), sticky = drag(5.0);
  // Columns at the leading edge were only just met: a fiftieth of the plate's length.
  CHECK(smooth[0] == Catch::Approx(0.1 * smooth[1]).epsilon(0.02));
  const double tangent = std::tan(melanz_sand.shear.friction_angle);
  CHECK(rough[0] == Catch::Approx(0.1 * 0.05 * melanz_sand.shear.cohesion + tangent * rough[1]).epsilon(0.02));
  CHECK(sticky[0] == rough[0]);
}

TEST_CASE("soils that differ over a field answer each by its own law") {
  Soil firm = melanz_sand;
  firm.pressure = WongReece{.k = 10.0 * 2.54e5, .n = 1.387, .plate_width = 0.03};
  const std::array<Soil, 1> others = {firm};
  SoilColumns soil({.low_x = 0, .low_y = 0, .length_x = 1.0, .length_y = 0.2, .soil = melanz_sand});
  soil.lay_soils(others, [](double x, double) { return x > 0.5 ? 1 : 0; });
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.05, 0.01});
  std::array<ColumnPart, 2> parts;
  for (std::size_t k = 0; k < 2; ++k) {
    const double x = k == 0 ? 0.25 : 0.75;
    parts[k] = {.shape = plate, .body = {{x, 0.1, 0.0}, {0, 0, 0}, {0, 0, 0}, Matrix3<double>::identity()}};
  }
  REQUIRE(soil.apply(parts, 1e-3).ok);
  CHECK(soil.loads()[1].force.z == Catch::Approx(10.0 * soil.loads()[0].force.z).epsilon(1e-9));
  CHECK_THROWS_WITH(soil.lay_soils(others, [](double, double) { return 2; }),
                    Catch::Matchers::ContainsSubstring("soil 2 is to lie at"));
}

TEST_CASE(
    "a tread of pieces in a row presses and shears the soil as one part, also while it slides from one to the next") {
  // A plate of 200 x 100 mm, whole or as four pieces of 50 mm, 2 mm deep, slides by 30 mm along its row, 1.5 K. Columns
  // of 5 mm pass from piece to piece. At its two ends the tread counts whole columns, one in forty.
  const auto sheared = [](int pieces, bool as_one) {
    Soil soil = sand();
    soil.shear.displacement = 0.02;
    SoilColumns columns(field(soil, 0.005));
    const double length = 0.2 / pieces;
    const auto shape = std::make_shared<ColumnBox>(Vector3<double>{length, 0.1, 0.02}, pieces > 1);
    const double dt = 1e-3, speed = 0.3;
    Vector3<double> force = {0, 0, 0};
    for (int k = 0; k <= 100; ++k) {
      std::vector<ColumnPart> parts;
      for (int i = 0; i < pieces; ++i) {
        const double x = -0.1 + (i + 0.5) * length + k * dt * speed - 0.015;
        parts.push_back(part(shape, {x, 0, 0.01 - 0.002}, {speed, 0, 0}));
        if (as_one && i > 0) parts.back().continues = 0;
      }
      CHECK(columns.apply(parts, dt).ok);
      force = {0, 0, 0};
      for (const ColumnLoad& load : columns.loads()) force += load.force;
    }
    return force;
  };
  const auto whole = sheared(1, true), tread = sheared(4, true), loose = sheared(4, false);
  CHECK(tread.z == Approx(whole.z).epsilon(0.03));
  CHECK(tread.x == Approx(whole.x).epsilon(0.03));
  CHECK(loose.z == Approx(tread.z).epsilon(1e-9));
  // Columns that began on the way have slid by 0 to 30 mm, the others by all of it: 15 % began on the way under the
  // plate, 60 % under pieces where each counts for itself.
  const double all = 1.0 - std::exp(-1.5), some = 1.0 - all / 1.5;
  CHECK(-tread.x == Approx(tread.z * std::tan(0.6) * (0.85 * all + 0.15 * some)).epsilon(0.03));
  CHECK(-loose.x == Approx(loose.z * std::tan(0.6) * (0.4 * all + 0.6 * some)).epsilon(0.03));
  SoilColumns columns(field(sand()));
  std::vector<ColumnPart> wrong = {part(std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.02}), {0, 0, 0})};
  wrong[0].continues = 0;
  CHECK_THROWS_WITH(columns.apply(wrong, 1e-3), ContainsSubstring("goes on with part 0, but can only with one before"));
}

}  // namespace soil_columns_test
