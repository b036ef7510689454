#include <dem/terramechanics/numerics.hpp>

#include <cmath>
#include <numbers>

#include "catch.hpp"

using namespace dem::terramechanics;
using Catch::Approx;

TEST_CASE("integrals with powers and thin layers at their ends") {
  std::array<double, 3> sums{};
  integrate(
      0.0, 2.0,
      [](double x) -> std::array<double, 3> {
        return {std::sqrt(x), std::exp(-1e3 * x), std::cos(x)};
      },
      sums);
  CHECK(sums[0] == Approx(2.0 / 3.0 * std::pow(2.0, 1.5)).epsilon(1e-13));
  CHECK(sums[1] == Approx(1e-3).epsilon(2e-9));  // a layer of 1/2000 of the range, on 81 places
  CHECK(sums[2] == Approx(std::sin(2.0)).epsilon(1e-13));
  integrate(
      2.0, 1.0,
      [](double) -> std::array<double, 3> {
        return {1, 1, 1};
      },
      sums);  // nothing, not negative
  CHECK(sums[2] == Approx(std::sin(2.0)).epsilon(1e-13));
}

TEST_CASE("zeros are found to rounding, also flat and steep ones, in few calls") {
  int calls = 0;
  const auto count = [&](auto f) {
    return [&calls, f](double x) {
      ++calls;
      return f(x);
    };
  };
  CHECK(find_root(count([](double x) { return x * x - 2.0; }), 0.0, 2.0) == Approx(std::numbers::sqrt2).epsilon(1e-15));
  CHECK(calls < 20);
  calls = 0;
  CHECK(find_root(count([](double x) { return std::pow(x, 9.0) - 1e-9; }), 0.0, 1.0) == Approx(0.1).epsilon(1e-14));
  CHECK(calls < 100);
  CHECK(find_root([](double x) { return std::atan(1e6 * (x - 0.3)); }, 0.0, 1.0) == Approx(0.3).epsilon(1e-14));
  CHECK(find_root([](double x) { return x < 0.7 ? -1.0 : 1.0; }, 0.0, 1.0) == Approx(0.7).epsilon(1e-14));
  CHECK(find_root([](double x) { return x; }, 0.0, 1.0) == 0.0);
}
