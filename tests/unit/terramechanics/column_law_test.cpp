#include <dem/terramechanics/column_law.hpp>
#include <dem/terramechanics/column_shear.hpp>

#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"

using namespace dem::terramechanics;
using Catch::Approx;
using dem::Vector3;

namespace {

double uniform(std::mt19937& engine) { return static_cast<double>(engine()) / 4294967296.0; }

Soil soil_with(double n, double stiffness, double growth) {
  return {.pressure = Bekker{0.0, 2e6, n},
          .shear = {0.0, 0.6, 1e-3},
          .unloading_stiffness = stiffness,
          .unloading_growth = growth};
}

}  // namespace

TEST_CASE("a column that was never loaded follows the pressure law, by steps of any size") {
  const ColumnLaw law(mojave_martian_simulant, 0.05);
  const PressureCurve curve = under(mojave_martian_simulant.pressure, 0.05);
  for (const int steps : {1, 7, 1000}) {
    double deepest = 0.0, pressure = 0.0;
    for (int k = 1; k <= steps; ++k) {
      const ColumnStress s = law.at(0.03 * k / steps, deepest);
      CHECK(s.compacts);
      deepest = s.deepest;
      pressure = s.pressure;
    }
    CHECK(pressure == Approx(curve.pressure(0.03)).epsilon(1e-14));
  }
  CHECK(law.at(-0.01, 0.0).pressure == 0.0);
  CHECK(law.at(0.0, 0.0).pressure == 0.0);
}

TEST_CASE("unloading and loading again follow one straight line down to the rut") {
  for (const double n : {0.5, 1.0, 1.4}) {
    for (const double growth : {0.0, 5e9}) {
      const ColumnLaw law(soil_with(n, 6e7, growth), 0.1);
      const double z = 0.01, p = law.curve.pressure(z), k = 6e7 + growth * z;
      REQUIRE(law.slope(z, p) == k);
      CHECK(law.residual(z) == Approx(z - p / k).epsilon(1e-14));
      for (const double share : {1.0, 0.6, 0.1, 0.0, 0.3}) {
        const double at = z - (1.0 - share) * p / k;
        const ColumnStress s = law.at(at, z);
        CHECK(s.pressure == Approx(share * p).margin(1e-9 * p));
        CHECK(s.deepest == z);
        CHECK(s.residual == law.residual(z));
      }
      CHECK(law.at(0.999 * law.residual(z), z).pressure == 0.0);
      CHECK(law.at(1.1 * z, z).pressure == Approx(law.curve.pressure(1.1 * z)).epsilon(1e-14));
    }
  }
}

TEST_CASE("the line is never so flat that soil gives back what it took") {
  // Bekker's curves take p z/(n + 1); a line of c p/z gives p z/(2 c). c is at least 2 max(1, n), so at most a quarter
  // or (n + 1)/(4 n) of it comes back.
  for (const double n : {0.3, 0.5, 1.0, 1.4, 3.0}) {
    for (const double stiffness : {0.0, 1.0, 1e7}) {
      const ColumnLaw law(soil_with(n, stiffness, 0.0), 0.1);
      for (const double z : {1e-5, 1e-3, 0.1}) {
        const ColumnStress s = law.at(z, 0.0);
        CHECK(law.stored(s) <= law.curve.work(z) * (n + 1.0) / (4.0 * std::max(1.0, n)) * (1.0 + 1e-12));
        CHECK(s.residual >= 0.5 * z * (1.0 - 1e-12));
        CHECK(law.deepest_of(s.residual) == Approx(z).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("no energy comes from a column, whatever way it is pressed") {
  // What went in, less what is stored, never shrinks. The work of a step is that of the trapezium rule, exact along the
  // line; where a step passes from the line (slope k) to the curve it is short by up to k dz^2/8.
  std::mt19937 engine(3);
  for (const double n : {0.5, 1.0, 1.4, 2.0}) {
    for (const double stiffness : {0.0, 6e7}) {
      const ColumnLaw law(soil_with(n, stiffness, 1e9), 0.1);
      double z = 0.0, deepest = 0.0, work = 0.0, lost = 0.0, pressure = 0.0;
      const double scale = law.curve.work(0.02);
      for (int k = 0; k < 4000; ++k) {
        const double to = std::max(0.0, z + (uniform(engine) - 0.49) * 4e-4);
        for (int part = 1; part <= 40; ++part) {
          const double at = z + (to - z) * part / 40;
          const ColumnStress s = law.at(at, deepest);
          work += 0.5 * (s.pressure + pressure) * (to - z) / 40;
          pressure = s.pressure;
          deepest = s.deepest;
          const double now = work - law.stored(s), dz = (to - z) / 40;
          if (now < lost - 0.125 * s.slope * dz * dz - 1e-12 * scale) FAIL("from the soil: " << now - lost << " J/m^2");
          lost = now;
        }
        z = to;
      }
      CHECK(deepest > 0.01);
      CHECK(lost > 0.5 * law.curve.work(deepest));
    }
  }
}

TEST_CASE("soil without k0 unloads ten times as steeply as its chord at least, whatever A is") {
  const ColumnLaw grows(soil_with(1.0, 0.0, 1e10), 0.1), unknown(soil_with(1.0, 0.0, 0.0), 0.1);
  const double z = 0.01, p = grows.curve.pressure(z);
  CHECK(grows.slope(z, p) == 1e10 * z);  // 50 times the chord of 2e6 Pa/m
  CHECK(grows.slope(1e-4, grows.curve.pressure(1e-4)) == Approx(10.0 * 2e6));
  CHECK(unknown.slope(z, p) == Approx(10.0 * 2e6));
}

TEST_CASE("soil on hard ground stops at it") {
  const ColumnLaw law(soil_with(1.0, 6e7, 0.0), 0.1, 0.02);
  const ColumnStress before = law.at(0.0199, 0.0), on = law.at(0.021, 0.0);
  CHECK(!before.on_base);
  CHECK(on.on_base);
  CHECK(on.deepest == 0.02);
  CHECK(on.pressure == Approx(law.curve.pressure(0.02) + 6e7 * 0.001));
  const ColumnStress again = law.at(0.021, 0.02);
  CHECK(again.pressure == on.pressure);
  CHECK(again.on_base);
  CHECK(!law.at(0.0195, 0.02).on_base);
}

TEST_CASE("sliding straight on mobilises the strength after Janosi and Hanamoto, by steps of any size") {
  const Vector3<double> normal = {0, 0, -1};
  for (const int steps : {1, 10, 333}) {
    ShearMemory m;
    for (int k = 0; k < steps; ++k) m = slide(m, {3e-3 / steps, 4e-3 / steps, 0}, normal, 1e4, false, 2e-3);
    const double share = 1.0 - std::exp(-5e-3 / 2e-3);
    CHECK(m.mobilised.x == Approx(0.6 * share).epsilon(1e-12));
    CHECK(m.mobilised.y == Approx(0.8 * share).epsilon(1e-12));
    CHECK(m.mobilised.z == 0.0);
  }
}

TEST_CASE("the memory of sliding turns with the contact and keeps its size") {
  ShearMemory m = slide({}, {1e-3, 0, 0}, {0, 0, -1}, 1e4, false, 1e-3);
  const double size = dem::norm(m.mobilised);
  const double c = std::cos(0.4), s = std::sin(0.4);
  m = slide(m, {0, 0, 0}, {s, 0, -c}, 1e4, false, 1e-3);
  CHECK(m.mobilised.x == Approx(size * c));
  CHECK(m.mobilised.z == Approx(size * s));
}

TEST_CASE("a load that trembles elastically does not wear off the shear stress") {
  ShearMemory m = slide({}, {5e-4, 0, 0}, {0, 0, -1}, 1e4, false, 1e-3);
  const double share = m.mobilised.x;
  CHECK(share == Approx(1.0 - std::exp(-0.5)));
  for (int k = 0; k < 100; ++k) {
    m = slide(m, {0, 0, 0}, {0, 0, -1}, 0.8e4, false, 1e-3);
    CHECK(m.mobilised.x == Approx(share / std::sqrt(0.8)));  // K tau^2/(2 strength) stays
    m = slide(m, {0, 0, 0}, {0, 0, -1}, 1.2e4, false, 1e-3);
  }
  m = slide(m, {0, 0, 0}, {0, 0, -1}, 1e4, false, 1e-3);
  CHECK(m.mobilised.x == Approx(share).epsilon(1e-12));
  // It is never more than the strength; what is lost by that stays lost.
  m = slide(m, {0, 0, 0}, {0, 0, -1}, 1e2, false, 1e-3);
  CHECK(m.mobilised.x == Approx(1.0).epsilon(1e-12));
  m = slide(m, {0, 0, 0}, {0, 0, -1}, 1e4, false, 1e-3);
  CHECK(m.mobilised.x == Approx(0.1));
}

TEST_CASE("no energy comes from sliding to and fro, also while the load changes elastically") {
  // Never more comes back than went in. Against the force at the end of each short step the work is right to |dj|/K.
  std::mt19937 engine(5);
  const double k = 1e-3;
  for (int run = 0; run < 30; ++run) {
    ShearMemory m;
    double work = 0.0, put_in = 0.0, strength = 1e4;
    for (int turn = 0; turn < 400; ++turn) {
      strength *= std::exp(3.0 * (uniform(engine) - 0.5) + 0.05 * (std::log(1e4) - std::log(strength)));
      m = slide(m, {0, 0, 0}, {0, 0, -1}, strength, false, k);
      const double angle = run % 3 == 0 ? std::acos(-1.0) * (turn % 2) : 2.0 * std::acos(-1.0) * uniform(engine);
      const double length = 2.0 * k * uniform(engine) / 200;
      for (int part = 0; part < 200; ++part) {
        const Vector3<double> way = {length * std::cos(angle), length * std::sin(angle), 0.0};
        const Vector3<double> before = m.mobilised;
        m = slide(m, way, {0, 0, -1}, strength, false, k);
        const double dw = 0.5 * strength * dem::dot(before + m.mobilised, way);
        work += dw;
        put_in += std::max(0.0, dw);
      }
      CHECK(work >= -1e-3 * put_in);
    }
    CHECK(work > 0.1 * put_in);  // most of it is lost
  }
}
