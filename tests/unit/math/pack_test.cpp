#include "catch.hpp"

#include <dem/math/pack.hpp>

#include <limits>

using dem::Pack;

namespace {

double number(int k) { return -1.3 + 0.7 * k; }

template <class F, class G>
void check_lanes(F&& of_packs, G&& of_doubles) {
  const Pack result = of_packs(dem::generate(number));
  for (int k = 0; k < dem::pack_width; ++k) {
    CAPTURE(k);
    CHECK(dem::lane(result, k) == of_doubles(number(k)));
  }
}

}  // namespace

TEST_CASE("functions of a pack are those of its lanes") {
  check_lanes([](const Pack& x) { return dem::exp(x); }, [](double x) { return std::exp(x); });
  check_lanes([](const Pack& x) { return dem::cbrt(x); }, [](double x) { return std::cbrt(x); });
  check_lanes([](const Pack& x) { return dem::tanh(x); }, [](double x) { return std::tanh(x); });
  check_lanes([](const Pack& x) { return dem::abs(x); }, [](double x) { return std::abs(x); });
  check_lanes([](const Pack& x) { return dem::log(x * x); }, [](double x) { return std::log(x * x); });
  check_lanes([](const Pack& x) { return dem::pow(x * x, 1.2); }, [](double x) { return std::pow(x * x, 1.2); });
  check_lanes([](const Pack& x) { return dem::pow(Pack(2.0), x); }, [](double x) { return std::pow(2.0, x); });
  const auto sine = [](double x) { return std::sin(x); };
  check_lanes([&](const Pack& x) { return dem::by_lane(x, sine); }, sine);
  CHECK(dem::by_lane(0.3, sine) == std::sin(0.3));
}

TEST_CASE("the absolute value of a NaN stays one") {
  const Pack x = dem::abs(Pack(std::numeric_limits<double>::quiet_NaN()));
  for (int k = 0; k < dem::pack_width; ++k) CHECK(std::isnan(dem::lane(x, k)));
}
