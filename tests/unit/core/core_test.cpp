#include "core/error_of.hpp"

#include <dem/core/aligned.hpp>
#include <dem/core/ids.hpp>
#include <dem/core/version.hpp>

#include <cstdint>
#include <limits>
#include <type_traits>

namespace {
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
}  // namespace

TEST_CASE("a value in its range is handed back") {
  CHECK(dem::require_positive(2.5, "mass", "kg") == 2.5);
  CHECK(dem::require_non_negative(0.0, "damping", "N s/m") == 0.0);
  CHECK(dem::require_within(1.0, 0.0, 1.0, "factor") == 1.0);
  CHECK(dem::require_within(0.0, 0.0, 1.0, "factor") == 0.0);
}

TEST_CASE("a value out of its range is refused with name, value, unit and range") {
  check_refused([] { dem::require_positive(-2.5, "mass", "kg"); }, "mass is -2.5 kg", "finite and greater than zero");
  check_refused([] { dem::require_positive(0.0, "mass", "kg"); }, "mass is 0 kg");
  check_refused([] { dem::require_non_negative(-1e-9, "damping", "N s/m"); }, "damping is -1e-09 N s/m",
                "not negative");
  check_refused([] { dem::require_within(1.5, 0.0, 1.0, "factor"); }, "factor is 1.5", "between 0 and 1");
  check_refused([] { dem::require_within(-0.5, 0.0, 1.0, "factor"); }, "factor is -0.5");
}

TEST_CASE("what is not a finite number is refused") {
  for (const double value : {not_a_number, infinite, -infinite}) {
    CHECK_THROWS_AS(dem::require_positive(value, "x", "m"), dem::Error);
    CHECK_THROWS_AS(dem::require_non_negative(value, "x", "m"), dem::Error);
    CHECK_THROWS_AS(dem::require_within(value, -1.0, 1.0, "x"), dem::Error);
  }
}

TEST_CASE("fail formats its text") {
  check_refused([] { dem::fail("{} of {} grains", 3, 7); }, "3 of 7 grains");
  // A library's error can be caught without knowing the library.
  CHECK_THROWS_AS(dem::fail("x"), std::runtime_error);
}

TEST_CASE("ids of different kinds cannot be mixed up") {
  STATIC_REQUIRE(!std::is_convertible_v<dem::BodyId, dem::SurfaceId>);
  STATIC_REQUIRE(!std::is_convertible_v<std::size_t, dem::BodyId>);
  STATIC_REQUIRE(!std::is_constructible_v<dem::BodyId, dem::SurfaceId>);
  CHECK(!dem::BodyId().valid());
  CHECK(dem::BodyId(0).valid());
  CHECK(dem::BodyId(7).index() == 7);
  CHECK(dem::BodyId(7) == dem::BodyId(7));
  CHECK(dem::BodyId(6) < dem::BodyId(7));
}

TEST_CASE("an aligned vector starts on a cache line however it grows") {
  dem::AlignedVector<double> v;
  for (int n = 0; n < 100; ++n) {
    v.push_back(n);
    CHECK(reinterpret_cast<std::uintptr_t>(v.data()) % 64 == 0);
  }
  const dem::AlignedVector<double> copy = v;
  CHECK(copy == v);
  CHECK(reinterpret_cast<std::uintptr_t>(copy.data()) % 64 == 0);
}

TEST_CASE("the version text is made of the version numbers") {
  CHECK(std::string(DEM_VERSION_STRING) ==
        fmt::format("{}.{}.{}", DEM_VERSION_MAJOR, DEM_VERSION_MINOR, DEM_VERSION_PATCH));
}
