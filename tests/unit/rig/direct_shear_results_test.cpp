#include "catch.hpp"

#include <dem/rig/direct_shear/evaluate.hpp>

#include <cmath>

namespace direct_shear_results_test {

using Catch::Approx;
using namespace dem::rig::direct_shear;

namespace {

/// A test that is sheared by 6 mm, with a sample every hundredth of a millimetre and no smoothing to speak of.
Settings settings() {
  Settings s;
  s.shear_speed = 0.02;
  s.travel = 6e-3;
  s.smoothing = 1e-4;
  return s;
}

/// The load whose stress (Pa) is a function of the displacement (m).
template <class Stress>
LoadResult sheared(const Settings& s, Stress&& stress, double travel = 6e-3) {
  LoadResult r;
  r.load = 16.2;
  r.normal_stress = s.normal_stress(r.load);
  for (double u = 1e-5; u < travel + 1e-9; u += 1e-5) {
    const double tau = stress(u), normal = s.normal_stress(r.load, u);
    r.samples.push_back({u / s.shear_speed, u, tau, tau, 0.1 * u, normal, normal});
  }
  r.finished = true;
  return r;
}

}  // namespace

TEST_CASE("smoothing leaves a straight line as it is, up to both ends") {
  // Windows shrink towards the ends, so each lies symmetrically about its sample: exact but for rounding.
  const Settings s = settings();
  const auto r = sheared(s, [](double u) { return 1e6 * u; });
  const auto mean = smoothed(r.samples, &Sample::stress, 3e-4);
  REQUIRE(mean.size() == r.samples.size());
  // Rounding may put one sample more at one end of the window than at the other: half a sample's step, 5 Pa.
  for (std::size_t i = 0; i < mean.size(); ++i) CHECK(mean[i] == Approx(r.samples[i].stress).margin(5.01));
}

TEST_CASE("smoothing averages noise away over its window, and over nothing without one") {
  std::vector<Sample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back({0.0, 1e-5 * i, i % 2 == 0 ? 90.0 : 110.0, 0.0, 0.0, 0.0, 0.0});
  // Eleven or so samples of alternating sign leave one eleventh of the 10 Pa.
  const auto mean = smoothed(samples, &Sample::stress, 1.05e-4);
  for (std::size_t i = 6; i < 94; ++i) CHECK(mean[i] == Approx(100.0).margin(10.0 / 11.0 + 1e-9));
  const auto raw = smoothed(samples, &Sample::stress, 0.0);
  for (std::size_t i = 0; i < 100; ++i) CHECK(raw[i] == samples[i].stress);
  CHECK(smoothed({}, &Sample::stress, 1e-4).empty());
}

TEST_CASE("a peak and what remains after it are found") {
  const Settings s = settings();
  const auto curve = [](double u) { return 20e3 + 15e3 * std::exp(-std::pow((u - 2e-3) / 5e-4, 2)); };
  LoadResult r = sheared(s, curve);
  evaluate(r, s);
  // A window w flattens the peak by its curvature times w^2/24: 15e3 * 2/0.5^2 * 0.1^2/24 = 50 Pa.
  CHECK(r.maximum == Approx(35e3).margin(60.0));
  CHECK(r.maximum < 35e3);
  CHECK(r.at_maximum == Approx(2e-3).margin(1.1e-5));  // one sample
  CHECK(r.residual == Approx(20e3));                   // the peak is 5 of its widths away from the last quarter
  CHECK(r.dilation == Approx(6e-4));
  CHECK(r.drive_mismatch == 0.0);
  CHECK(r.lid_share == Approx(1.0));
  CHECK(r.plane_stress == Approx(44145.0));
  CHECK(r.normal_at_maximum == Approx(44145.0));
}

TEST_CASE("a lone spike is no maximum") {
  Settings s = settings();
  LoadResult r = sheared(s, [](double u) { return std::abs(u - 3e-3) < 2e-6 ? 100e3 : 30e3; });
  evaluate(r, s);
  // 70 kPa over the 10 or 11 samples of a window.
  CHECK(r.maximum == Approx(30e3 + 70e3 / 10.5).epsilon(0.02));
}

TEST_CASE("a drive that differs from the sensor is seen, but not while it starts up") {
  const Settings s = settings();
  LoadResult r = sheared(s, [](double) { return 30e3; });
  for (auto& x : r.samples) x.drive_stress += x.displacement < 3e-4 ? 9e3 : 600.0;  // the ramp ends at 0.4 mm
  evaluate(r, s);
  CHECK(r.drive_mismatch == Approx(0.02));
}

TEST_CASE("what there are too few samples for stays not known") {
  const Settings s = settings();
  LoadResult r = sheared(
      s, [](double) { return 30e3; }, 9e-5);  // less than one window
  evaluate(r, s);
  CHECK(std::isnan(r.maximum));
  CHECK(std::isnan(r.at_maximum));
  CHECK(std::isnan(r.residual));
  CHECK(std::isnan(r.drive_mismatch));
  LoadResult half = sheared(
      s, [](double u) { return 1e6 * u; }, 3e-3);  // interrupted in the middle
  evaluate(half, s);
  CHECK(half.maximum == Approx(2950.0).margin(10.0));  // half a window before the end, within a sample
  CHECK(std::isnan(half.residual));
  LoadResult none;
  evaluate(none, s);
  CHECK(std::isnan(none.maximum));
}

TEST_CASE("with area correction, shear and normal stress are over the same area") {
  // A constant force: the stress T/A(u) grows until the last whole window, and T/N is the ratio of the forces.
  Settings s = settings();
  s.area_correction = true;
  LoadResult r = sheared(s, [&](double u) { return 0.75 * s.normal_stress(16.2, u); });
  evaluate(r, s);
  CHECK(r.normal_stress == Approx(44145.0));
  CHECK(r.at_maximum == Approx(5.95e-3).margin(1.1e-5));
  CHECK(r.normal_at_maximum == Approx(44145.0 * 60.0 / 54.05).epsilon(2e-4));  // 0.01 mm of 54 mm
  CHECK(r.maximum / r.normal_at_maximum == Approx(0.75).epsilon(1e-5));  // a window's mean and its middle: (w/60 mm)^2
  CHECK(r.residual / r.normal_at_residual == Approx(0.75));
  CHECK(r.lid_share == Approx(1.0));
  const Fits fits = fit({.loads = {r}});
  REQUIRE(fits.origin);
  CHECK(std::tan(fits.origin->friction_angle) == Approx(0.75).epsilon(1e-5));
}

TEST_CASE("lines are fitted to the finished loads, where there are enough") {
  const auto load = [](double normal, double maximum, bool finished = true) {
    LoadResult r;
    r.normal_stress = r.normal_at_maximum = r.normal_at_residual = normal;
    r.maximum = maximum;
    r.residual = 0.5 * maximum;
    r.finished = finished;
    return r;
  };
  Campaign c;
  CHECK_FALSE(fit(c).origin);
  c.loads = {load(10e3, 8e3)};
  CHECK_FALSE(fit(c).free);
  REQUIRE(fit(c).origin);
  CHECK(std::tan(fit(c).origin->friction_angle) == Approx(0.8));
  CHECK(std::tan(fit(c).residual->friction_angle) == Approx(0.4));
  c.loads = {load(10e3, 8e3), load(20e3, 15e3), load(30e3, 1e3, false)};
  REQUIRE(fit(c).free);
  CHECK(std::tan(fit(c).free->friction_angle) == Approx(0.7));
  CHECK(fit(c).free->cohesion == Approx(1e3));
  c.loads = {load(10e3, 8e3), load(10e3, 9e3)};  // no line goes through one normal stress
  CHECK_FALSE(fit(c).free);
  CHECK(fit(c).origin);
  c.loads = {load(10e3, dem::rig::not_known)};
  CHECK_FALSE(fit(c).origin);
}

TEST_CASE("relative density is not known of what is no solid fraction") {
  const Settings s;
  CHECK(relative_density(s, 0.762) == Approx(0.0).margin(1e-12));
  CHECK(relative_density(s, 0.960) == Approx(1.0));
  CHECK(std::isnan(relative_density(s, 1.01)));
  CHECK(std::isnan(relative_density(s, 0.0)));
  CHECK(std::isnan(relative_density(s, dem::rig::not_known)));
}

TEST_CASE("relative density is counted between the limits of the grains' shape") {
  Settings s;
  for (const char* shape : {"cube8", "polyhedron", "superquadric"}) {
    s.shape = shape;
    const dem::soil::DensityLimits& limits = density_limits(s);
    CHECK(relative_density(s, limits.loosest) == Approx(0.0).margin(1e-12));
    CHECK(relative_density(s, limits.densest) == Approx(1.0));
  }
}

}  // namespace direct_shear_results_test
