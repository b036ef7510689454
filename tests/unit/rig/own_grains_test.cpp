// The direct shear test of the library with grains and friction of somebody else's: capsules that weaken as they slip.

#include "catch.hpp"

#include <dem/rig/direct_shear.hpp>
#include <own_law/slip_weakening.hpp>
#include <own_shape/capsule.hpp>

namespace own_grains_test {

namespace {

struct Pills : dem::Model {
  using Shape = Capsule;
  using Surfaces = dem::surface::Set<dem::surface::Box>;
  using Friction = SlipWeakening;
  using Integrator = dem::integrator::VelocityVerlet;
};

dem::rig::DirectShear<Pills> shear_test(double mu) {
  dem::rig::direct_shear::Settings settings;
  settings.own_kind = {.name = "capsule", .plural = "capsules"};
  settings.half_edge = 2e-3;
  settings.grains = 60;
  settings.box_length = settings.box_width = 0.014;
  settings.travel = 1e-3;
  settings.shear_speed = 0.04;
  settings.ramp_time = 0.01;
  settings.smoothing = 1e-4;
  const dem::ContactParameters<Pills> contact = {.normal = {500, 0.15, 1.0},
                                                 .friction = {mu, 0.8 * mu, 1e-4, 500, 0.05}};
  return {settings, {.shape = Capsule{1.5e-3, 1.5e-3}, .on_grain = contact, .on_wall = contact}};
}

}  // namespace

TEST_CASE("anybody's grains are packed and sheared") {
  const double load = 0.4;  // kg: 20 kPa
  const auto rough = shear_test(0.5);
  const auto packing = rough.make_packing();
  REQUIRE(packing.packing.grains.size() == 60);
  CHECK(packing.packing.shape == "capsule");
  // Rained capsules of twice their width lie at solid fractions of about 0.6. The inside of so few is three grains.
  CHECK(packing.solid_fraction > 0.4);
  CHECK(packing.solid_fraction < 0.8);
  CHECK(packing.coordination > 2.5);

  const auto result = rough.test(packing, load);
  CHECK(result.finished);
  CHECK(result.normal_stress == Catch::Approx(9.81 * load / (0.014 * 0.014)));
  // What shears is measured twice. The lid is a dead load on a frictionless slide: in the 35 ms its speed changes by
  // less than 30 mm/s, a mean acceleration below 0.1 g.
  CHECK(result.drive_mismatch < 0.1);
  CHECK(result.lid_share == Catch::Approx(1.0).margin(0.1));

  // The same grains where they lie, without friction between them or with walls, resist by their interlocking only. It
  // was 0.3 to 0.5 of the resistance with friction (three sizes of specimen).
  const auto smooth = shear_test(0.0);
  const auto weaker = smooth.test(packing, load);
  CHECK(weaker.finished);
  CHECK(weaker.residual < 0.75 * result.residual);
}

}  // namespace own_grains_test
