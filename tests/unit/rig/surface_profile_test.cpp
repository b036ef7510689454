#include "catch.hpp"

#include <dem/rig/bed/surface_profile.hpp>

#include <array>
#include <cmath>

namespace surface_profile_test {

using Catch::Approx;
using namespace dem::rig;

TEST_CASE("the depth and the width of a rut are those of its profile") {
  SurfaceProfile before, after;
  for (int k = 0; k < 20; ++k) {
    const double y = 0.05 * k - 0.475;
    before.y.push_back(y);
    before.z.push_back(0.2);
    after.y.push_back(y);
    after.z.push_back(std::abs(y - 0.1) < 0.15 ? 0.14 : 0.21);
  }
  after.z[1] = after.z[2] = 0.14;  // a hollow far from the track, as deep as the rut, is none of it
  const Rut rut = rut_between(before, after, 0.1, 0.25);
  CHECK(rut.depth == Approx(0.06));
  CHECK(rut.width == Approx(0.3));
  const Rut heap = rut_between(after, before, 0.1, 0.25);
  CHECK(heap.depth == Approx(-0.06));
  CHECK(std::isnan(heap.width));  // nothing sank there
  CHECK(std::isnan(rut_between(before, {}, 0.1, 0.25).depth));
  CHECK(std::isnan(rut_between(before, after, 2.0, 0.25).depth));  // no strip there
}

TEST_CASE("a surface is as high as its profiles in the mean, each strip alike") {
  const std::array<SurfaceProfile, 2> two{{{{0.0, 0.1}, {0.2, 0.3}}, {{1.0}, {0.7}}}};
  CHECK(mean_surface(two) == Approx(0.4));
  CHECK(std::isnan(mean_surface({})));
}

}  // namespace surface_profile_test
