#include <dem/terramechanics/wheel_load.hpp>

#include <cmath>
#include <cstring>
#include <vector>

#include "catch.hpp"
#include "rolling_wheel.hpp"

using namespace dem;
using namespace dem::terramechanics;
using Catch::Approx;

namespace {

ColumnsSpec lane(const Soil& soil, double spacing, double travel) {
  return {
      .low_x = -0.12, .low_y = -0.11, .length_x = travel + 0.24, .length_y = 0.22, .spacing = spacing, .soil = soil};
}
RollingWheel::Mean rolled(const Soil& soil, RollingWheel wheel, double spacing, double travel = 0.12) {
  SoilColumns columns(lane(soil, spacing, travel));
  const auto mean = wheel.roll(columns, travel);
  CHECK(wheel.failures == 0);
  return mean;
}

}  // namespace

TEST_CASE("columns half as wide change a wheel's pull, torque and sinkage by less than 3 %, and by far less") {
  // The contact is 50 mm long: 20 mm are 2.5 columns. As columns take their heights at different points of themselves,
  // the wheel feels eight times as many; what is left is the shake of its first contact.
  for (const Soil& soil : {melanz_sand, mojave_martian_simulant}) {
    for (const double slip : {-0.3, 0.0, 0.3}) {
      const RollingWheel wheel = {.slip = slip, .y = 0.003};
      auto coarse = rolled(soil, wheel, 0.02), middle = rolled(soil, wheel, 0.01), fine = rolled(soil, wheel, 0.005);
      CHECK(coarse.pull == Approx(middle.pull).epsilon(0.03));
      CHECK(coarse.torque == Approx(middle.torque).epsilon(0.03));
      CHECK(coarse.sinkage == Approx(middle.sinkage).epsilon(0.03));
      CHECK(middle.pull == Approx(fine.pull).epsilon(0.003));
      CHECK(middle.torque == Approx(fine.torque).epsilon(0.003));
      CHECK(middle.sinkage == Approx(fine.sinkage).epsilon(0.003));
      CHECK(fine.load == Approx(130.0).epsilon(5e-3));  // it still swings a little
    }
  }
}

TEST_CASE("a wheel that runs along the files of columns feels what one along the rows feels, and one askew too") {
  const double travel = 0.12;
  const auto towards = [&](double yaw) {
    ColumnsSpec spec = lane(melanz_sand, 0.01, travel);
    spec = {.low_x = -0.2, .low_y = -0.2, .length_x = 0.5, .length_y = 0.5, .spacing = 0.01, .soil = melanz_sand};
    SoilColumns columns(spec);
    const double c = std::cos(yaw), s = std::sin(yaw), v = 0.13 * 0.8;
    const Matrix3<double> turn = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
    const auto shape = std::make_shared<ColumnCylinder>(0.13, 0.16);
    double pull = 0.0, load = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const double x = v * 1e-3 * k;
      const std::array<ColumnPart, 1> parts = {
          ColumnPart{.shape = shape, .body = {{c * x, s * x, 0.122}, {c * v, s * v, 0}, {0, 1, 0}, turn}}};
      CHECK(columns.apply(parts, 1e-3).ok);
      if (k < 500) continue;
      pull += (c * columns.loads()[0].force.x + s * columns.loads()[0].force.y) / 500;
      load += columns.loads()[0].force.z / 500;
    }
    return std::array<double, 2>{pull, load};
  };
  const auto along = towards(0.0);
  for (const double yaw : {0.5 * std::acos(-1.0), 0.3, 0.25 * std::acos(-1.0)}) {
    const auto other = towards(yaw);
    CHECK(other[0] == Approx(along[0]).epsilon(0.01));
    CHECK(other[1] == Approx(along[1]).epsilon(0.01));
  }
}

TEST_CASE("where the wheel runs on the grid and how long the steps are does not matter either") {
  const auto base = rolled(melanz_sand, {.slip = 0.2}, 0.01);
  for (const RollingWheel& other : {RollingWheel{.slip = 0.2, .y = 0.0037}, RollingWheel{.slip = 0.2, .dt = 5e-4}}) {
    const auto same = rolled(melanz_sand, other, 0.01);
    CHECK(same.pull == Approx(base.pull).epsilon(0.003));
    CHECK(same.sinkage == Approx(base.sinkage).epsilon(0.003));
  }
}

TEST_CASE("a wheel on stiffly unloading columns feels equations 2 to 10, with the pressure largest below it") {
  // Nothing presses behind the lowest point, as the soil does not spring back; a0 = a1 = 0. The strength is reached at
  // once, so it does not matter that columns count shear by soil and eq. 11 by rim.
  for (Soil soil : {melanz_sand, mojave_martian_simulant}) {
    soil.a0 = soil.a1 = 0.0;
    soil.unloading_stiffness = 1e13;
    soil.shear.displacement = 1e-7;
    for (const double slip : {0.0, 0.3}) {
      RollingWheel wheel{.slip = slip, .fixed_sinkage = 0.01};
      const auto columns = rolled(soil, wheel, 0.005);
      const auto law =
          wheel_forces({.radius = 0.13, .width = 0.16}, soil, {slip}, 0.01, {.braked = BrakedShear::one_path});
      CHECK(columns.load == Approx(law.load).epsilon(0.01));
      CHECK(columns.torque == Approx(law.torque).epsilon(0.01));
      CHECK(columns.pull == Approx(law.pull).epsilon(0.01));
    }
  }
}

TEST_CASE("a towed wheel without shear strength meets Bekker's compaction resistance") {
  Soil soil = mojave_martian_simulant;
  soil.shear.cohesion = soil.shear.friction_angle = 0.0;
  soil.unloading_stiffness = 1e13;
  const auto mean = rolled(soil, {.slip = 0.0, .fixed_sinkage = 0.01}, 0.005);
  CHECK(-mean.pull == Approx(0.16 * under(soil.pressure, 0.16).work(0.01)).epsilon(0.01));
  CHECK(std::abs(mean.torque) < 1e-9);
}

TEST_CASE("a column is sheared by the way that the rim slides over it") {
  // While the wheel passes, dj = (omega r - v cos theta) dt with r cos theta d theta = -v dt: from the first contact at
  // theta_f to theta j = r [sin/(1 - s) - theta/2 - sin(2 theta)/4], the difference of both. A column just ahead of the
  // lowest point was only compacted so far: its share is that of j. Its first contact is known to a step's share.
  Soil soil = melanz_sand;
  soil.unloading_stiffness = 1e13;
  soil.shear.displacement = 0.02;  // far from saturated
  const double travel = 0.06, slip = 0.3;
  SoilColumns columns(lane(soil, 0.005, travel));
  RollingWheel wheel{.slip = slip, .dt = 2e-4, .fixed_sinkage = 0.01};
  wheel.roll(columns, travel);
  const ColumnField& f = columns.field();
  const std::size_t ix = static_cast<std::size_t>((travel + 0.005 + 0.12) / 0.005), row = f.grid.row(ix, 22);
  const double first = std::acos(0.12 / 0.13), now = std::asin((f.grid.place(ix, 22).at_x - travel) / 0.13);
  const auto way = [&](double theta) {
    return 0.13 * (std::sin(theta) / (1.0 - slip) - 0.5 * theta - 0.25 * std::sin(2.0 * theta));
  };
  const double j = way(first) - way(now);
  CHECK(now > 0.0);
  CHECK(now < 0.1);
  CHECK(norm(f.shear[row].mobilised) == Approx(1.0 - std::exp(-j / 0.02)).epsilon(0.02));
}

TEST_CASE("each pass in the rut sinks less further than the last, and meets less resistance") {
  const double travel = 0.4;
  SoilColumns columns(lane(melanz_sand, 0.01, travel));
  RollingWheel wheel{.slip = 0.3};  // enough for the full shear strength, also in the short contact of later passes
  const auto first = wheel.roll(columns, travel);
  const ColumnField& f = columns.field();
  const std::size_t middle = f.grid.row(42, 11);
  CHECK(-f.surface(middle) < first.sinkage);  // by what the soil springs back, a tenth over n
  CHECK(-f.surface(middle) == Approx(first.sinkage * (1.0 - 0.1 / 1.387)).epsilon(0.01));
  const auto second = wheel.roll(columns, travel), third = wheel.roll(columns, travel);
  CHECK(second.sinkage > first.sinkage);
  CHECK(third.sinkage > second.sinkage);
  CHECK(third.sinkage - second.sinkage < 0.7 * (second.sinkage - first.sinkage));
  // What the soil takes: thrust less pull. Compacting anew cost most of it.
  const double thrust = 1.0 / 0.13;
  CHECK(thrust * second.torque - second.pull < 0.6 * (thrust * first.torque - first.pull));
}

TEST_CASE("soil that is pushed aside lies beside the rut, and changes no force") {
  double top[2] = {}, spacing = 0.01;
  const auto bare = rolled(melanz_sand, {.slip = 0.3}, 0.01);
  for (double& highest : top) {
    ColumnsSpec spec = lane(melanz_sand, spacing, 0.2);
    spec.low_y = -0.2, spec.length_y = 0.4;
    spec.bulldozing = 1.0;
    SoilColumns columns(spec);
    RollingWheel wheel{.slip = 0.3};
    const auto mean = wheel.roll(columns, 0.2);
    CHECK(mean.pull == Approx(bare.pull).epsilon(0.01));
    CHECK(mean.sinkage == Approx(bare.sinkage).epsilon(0.01));
    const ColumnField& f = columns.field();
    for (std::size_t row = 0; row < f.grid.size(); ++row) {
      highest = std::max(highest, f.heap[row]);
      const double y = f.grid.y(row / f.grid.nx);
      // It rolls back over the edge of the rut, but not to its middle.
      if (std::abs(y) < 0.04) CHECK(f.heap[row] == 0.0);
    }
    spacing *= 0.5;
  }
  CHECK(top[0] == Approx(top[1]).epsilon(0.2));
}

TEST_CASE("results are the same bits for any number of threads") {
  const auto run = [](int threads) {
    ColumnsSpec spec = lane(mojave_martian_simulant, 0.01, 0.1);
    spec.length_y = 0.5;
    spec.bulldozing = 0.8;
    spec.damping = 1e3;
    SoilColumns columns(spec);
    columns.set_threads(threads);
    const auto wheel = std::make_shared<ColumnCylinder>(0.13, 0.16),
               thin = std::make_shared<ColumnCylinder>(0.12, 0.05);
    std::vector<double> numbers;
    for (int k = 0; k < 100; ++k) {
      const double x = 1e-3 * k;
      const std::vector<ColumnPart> parts = {
          {.shape = wheel, .body = {{x, 0, 0.118}, {0.1, 0.01, 0}, {0, 1.1, 0}, Matrix3<double>::identity()}},
          {.shape = thin, .body = {{x, 0.09, 0.107}, {0.1, 0, 0}, {0, 0.7, 0.1}, Matrix3<double>::identity()}}};
      columns.apply(parts, 1e-2);
      for (const ColumnLoad& load : columns.loads()) {
        numbers.insert(numbers.end(),
                       {load.force.x, load.force.y, load.force.z, load.torque.x, load.torque.y, load.torque.z});
      }
    }
    const ColumnField& f = columns.field();
    numbers.insert(numbers.end(), f.sunk.begin(), f.sunk.end());
    numbers.insert(numbers.end(), f.ground.begin(), f.ground.end());
    for (const ShearMemory& m : f.shear) numbers.push_back(m.mobilised.x);
    return numbers;
  };
  const std::vector<double> one = run(1);
  for (const int threads : {2, 3, 8}) {
    const std::vector<double> many = run(threads);
    REQUIRE(many.size() == one.size());
    CHECK(std::memcmp(many.data(), one.data(), one.size() * sizeof(double)) == 0);
  }
}
