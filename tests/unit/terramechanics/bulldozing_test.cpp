#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/soil_columns.hpp>

#include <array>
#include <cmath>
#include <numeric>

#include "catch.hpp"

namespace bulldozing_test {

using namespace dem;
using namespace dem::terramechanics;
using Catch::Approx;

namespace {

ColumnsSpec field(double share, double spacing = 0.01) {
  return {.low_x = -0.3,
          .low_y = -0.3,
          .length_x = 0.6,
          .length_y = 0.6,
          .spacing = spacing,
          .soil = melanz_sand,
          .bulldozing = share,
          .angle_of_repose = 0.6};
}
double sum(const std::vector<double>& column) { return std::accumulate(column.begin(), column.end(), 0.0); }

/// A plate that sinks by 20 mm, and then stands still while loose soil rolls.
void press(SoilColumns& soil, Vector3<double> speed = {0, 0, 0}) {
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.01});
  for (int k = 0; k <= 800; ++k) {
    const std::array<ColumnPart, 1> parts = {
        ColumnPart{.shape = plate,
                   .body = {{0, 0, 0.005 - 1e-4 * std::min(k, 200)}, speed, {0, 0, 0}, Matrix3<double>::identity()}}};
    soil.apply(parts, 1e-3);
  }
}

}  // namespace

TEST_CASE("a share of the compacted soil stands beside the plate, and none is lost") {
  for (const double share : {0.5, 1.0}) {
    SoilColumns soil(field(share));
    press(soil);
    const ColumnField& f = soil.field();
    CHECK(sum(f.sunk) > 0.0);
    CHECK(sum(f.heap) == Approx(share * sum(f.sunk)).epsilon(1e-12));
    CHECK(sum(f.ground) == 0.0);
  }
}

TEST_CASE("none is pushed aside unless asked for") {
  SoilColumns soil(field(0.0));
  press(soil);
  CHECK(sum(soil.field().heap) == 0.0);
}

TEST_CASE("heaps lie no steeper than their angle, the same on all sides, and on finer columns too") {
  double volume_beyond[2] = {}, spacing = 0.01;
  for (double& beyond : volume_beyond) {
    SoilColumns soil(field(1.0, spacing));
    press(soil);
    const ColumnField& f = soil.field();
    const ColumnGrid& g = f.grid;
    for (std::size_t iy = 1; iy + 1 < g.ny; ++iy) {
      for (std::size_t ix = 1; ix + 1 < g.nx; ++ix) {
        const std::size_t row = g.row(ix, iy);
        CHECK(f.heap[row] == Approx(f.heap[g.row(g.nx - 1 - ix, iy)]).margin(1e-12));
        CHECK(f.heap[row] == Approx(f.heap[g.row(ix, g.ny - 1 - iy)]).margin(1e-12));
        if (!(f.heap[row] > 0.0)) continue;
        for (const std::size_t other : {row - 1, row + 1, row - g.nx, row + g.nx}) {
          if (f.touched[other] == soil.steps()) continue;
          // Rolling slows down as the slope comes to its angle: within 3 %.
          CHECK(f.surface(row) - f.surface(other) < 1.03 * std::tan(0.6) * g.spacing);
        }
        if (std::max(std::abs(g.x(ix)), std::abs(g.y(iy))) > 0.06) beyond += f.heap[row] * g.area();
      }
    }
    spacing *= 0.5;
  }
  CHECK(volume_beyond[0] == Approx(volume_beyond[1]).epsilon(0.15));
}

TEST_CASE("a part that moves along heaps soil at its two sides only") {
  SoilColumns soil(field(1.0));
  press(soil, {0.1, 0, 0});
  const ColumnField& f = soil.field();
  CHECK(f.heap[f.grid.row(30, 35)] > 0.0);  // beside, at y = 0.055
  CHECK(f.heap[f.grid.row(30, 24)] > 0.0);
  CHECK(f.heap[f.grid.row(36, 30)] == 0.0);  // in front, at x = 0.065
  CHECK(f.heap[f.grid.row(23, 30)] == 0.0);
}

TEST_CASE("soil that was heaped up is soil when it is driven over, but gives way in a rut") {
  SoilColumns soil(field(1.0));
  press(soil);
  const ColumnField& f = soil.field();
  const auto plate = std::make_shared<ColumnBox>(Vector3<double>{0.01, 0.01, 0.01});
  const auto force_on_plate = [&](std::size_t ix, double height) {
    const std::array<ColumnPart, 1> parts = {ColumnPart{
        .shape = plate,
        .body = {{f.grid.x(ix), f.grid.y(30), height + 0.005}, {0, 0, 0}, {0, 0, 0}, Matrix3<double>::identity()}}};
    soil.apply(parts, 1e-3);
    return soil.loads()[0].force.z;
  };
  const std::size_t beside = f.grid.row(36, 30), rut = f.grid.row(33, 30);
  const double heap = f.heap[beside];
  REQUIRE(heap > 1e-3);
  CHECK(force_on_plate(36, heap - 1e-4) == Approx(1e-4 * under(melanz_sand.pressure, 0.01).pressure(1e-4)));
  CHECK(f.ground[beside] == Approx(heap));
  CHECK(f.heap[beside] == 0.0);
  // Some has rolled back to the edge of the rut by now, as the plate there is gone.
  for (int k = 0; k < 300; ++k) force_on_plate(38, 0.0);
  const double in_rut = f.heap[rut], floor = f.surface(rut) - in_rut;
  CHECK(in_rut > 1e-4);
  CHECK(force_on_plate(33, floor + 0.5 * in_rut) == 0.0);
  CHECK(force_on_plate(33, floor - 1e-4) > 0.0);
}

}  // namespace bulldozing_test
