#include "catch.hpp"

#include <dem/math/vector.hpp>

#include <random>

using dem::from_eigen;
using dem::Mat3;
using dem::Pack;
using dem::to_eigen;
using dem::Vec3;

namespace {
// Each result is a sum of three products of numbers of size 1: a few rounding errors of 1e-16.
constexpr double rounding = 1e-15;

struct Random {
  std::mt19937 engine{7};
  std::uniform_real_distribution<double> unit{-1.0, 1.0};
  Vec3 vector() { return {unit(engine), unit(engine), unit(engine)}; }
  Mat3 matrix() {
    Mat3 m;
    for (int k = 0; k < 3; ++k) m.col(k) = vector();
    return m;
  }
};
}  // namespace

TEST_CASE("the plain structs compute what Eigen computes") {
  Random random;
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 a = random.vector(), b = random.vector();
    const Mat3 m = random.matrix(), n = random.matrix();
    const auto pa = from_eigen(a), pb = from_eigen(b);
    const auto pm = from_eigen(m), pn = from_eigen(n);

    CHECK((to_eigen(pa + pb) - (a + b)).norm() == 0.0);
    CHECK((to_eigen(pa - pb) - (a - b)).norm() == 0.0);
    CHECK((to_eigen(-pa) + a).norm() == 0.0);
    CHECK((to_eigen(2.5 * pa) - 2.5 * a).norm() < rounding);
    CHECK(std::abs(dot(pa, pb) - a.dot(b)) < rounding);
    CHECK((to_eigen(cross(pa, pb)) - a.cross(b)).norm() < rounding);
    CHECK(std::abs(norm(pa) - a.norm()) < rounding);
    CHECK((to_eigen(pm * pa) - m * a).norm() < rounding);
    CHECK((to_eigen(transpose_times(pm, pa)) - m.transpose() * a).norm() < rounding);
    CHECK((to_eigen(pm * pn) - m * n).norm() < 3 * rounding);
    auto sum = pa;
    sum += pb;
    CHECK((to_eigen(sum) - (a + b)).norm() == 0.0);
    sum -= pb;
    CHECK((to_eigen(sum) - a).norm() < rounding);
  }
}

TEST_CASE("a matrix keeps its rows and columns on the way from Eigen and back") {
  Mat3 m;
  m << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const auto plain = from_eigen(m);
  CHECK(plain.row0.z == 3);
  CHECK(plain.row2.x == 7);
  CHECK(to_eigen(plain) == m);
  CHECK(to_eigen(dem::Matrix3<double>::identity()) == Mat3::Identity());
}

TEST_CASE("a pack holds one number a lane") {
  const Pack a = dem::generate([](int k) { return k + 1.0; });
  const Pack b = dem::generate([](int k) { return 2.0 * k - 1.0; });
  for (int k = 0; k < dem::pack_width; ++k) {
    const double x = k + 1.0, y = 2.0 * k - 1.0;
    CHECK(dem::lane(a, k) == x);
    CHECK(dem::lane(dem::min(a, b), k) == std::min(x, y));
    CHECK(dem::lane(dem::max(a, b), k) == std::max(x, y));
    CHECK(dem::lane(dem::sqrt(a), k) == std::sqrt(x));
    CHECK(dem::lane(dem::select(a < b, a, b), k) == (x < y ? x : y));
    CHECK((dem::bits(a < b) >> k & 1u) == (x < y ? 1u : 0u));
  }
  CHECK(dem::bits(a < b) >> dem::pack_width == 0);
  CHECK(dem::smallest(a) == 1.0);
  CHECK(dem::largest(a) == dem::pack_width);
  CHECK(dem::any_of(a > Pack(dem::pack_width - 0.5)));
  CHECK(!dem::any_of(a > Pack(dem::pack_width + 0.5)));
}

TEST_CASE("a pack is stored where it was loaded from") {
  alignas(64) double from[2 * dem::pack_width + 1], to[2 * dem::pack_width + 1] = {};
  for (int k = 0; k < 2 * dem::pack_width + 1; ++k) from[k] = 0.1 * k;
  dem::store(dem::load(from), to);
  dem::store_unaligned(dem::load_unaligned(from + 1), to + dem::pack_width + 1);
  for (int k = 0; k < dem::pack_width; ++k) {
    CHECK(to[k] == from[k]);
    CHECK(to[dem::pack_width + 1 + k] == from[k + 1]);
  }
}

TEST_CASE("numbers are rounded up to whole packs") {
  for (int n = 0; n < 40; ++n) {
    const int up = dem::round_up_to_pack(n);
    CHECK(up % dem::pack_width == 0);
    CHECK(up >= n);
    CHECK(up < n + dem::pack_width);
  }
}
