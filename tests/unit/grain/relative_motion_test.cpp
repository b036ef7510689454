#include <dem/grain/relative_motion.hpp>

#include "catch.hpp"

using namespace dem;
using namespace dem::grain;

TEST_CASE("partners of a pack come out lane by lane, whatever the width of a pack") {
  // All numbers are small integers and halves, so every sum is exact and the comparisons may be.
  PartnerView a[pack_width], b[pack_width];
  PartnerLanes partners;
  for (int k = 0; k < pack_width; ++k) {
    a[k] = {{1.0 + k, 2, 3}, 0.5, {1, 2, 3.0 * k}, 0.25, {7.0 + k, 8, 9}};
    b[k] = {{5, 6.0 + k, 7}, 1.5, {4, 4.0 - k, 4}, 0.5, {1, 2, 3.0 + k}};
    partners.set(k, a[k], b[k]);
  }
  const auto [x, y, z, reach] = separations(partners);
  const RelativeMotion<Pack> e = relative_motions(partners);
  for (int k = 0; k < pack_width; ++k) {
    CHECK(lane(x, k) == 4.0 - k);
    CHECK(lane(y, k) == 4.0 + k);
    CHECK(lane(z, k) == 4.0);
    CHECK(lane(reach, k) == 2.0);
    CHECK(lane(e.separation.y, k) == 4.0 + k);
    CHECK(lane(e.velocity.x, k) == -3.0);
    CHECK(lane(e.velocity.y, k) == -2.0 + k);
    CHECK(lane(e.velocity.z, k) == 3.0 * k - 4.0);
    CHECK(lane(e.inverse_mass, k) == 0.75);
    CHECK(lane(e.angular_velocity_i.x, k) == 7.0 + k);
    CHECK(lane(e.angular_velocity_i.z, k) == 9.0);
    CHECK(lane(e.angular_velocity_j.x, k) == 1.0);
    CHECK(lane(e.angular_velocity_j.z, k) == 3.0 + k);
  }
}
