#pragma once

#include "catch.hpp"

#include <dem/math/vector.hpp>

#include <vector>

struct SurfaceContact {
  std::uint32_t feature;
  dem::Vec3 normal;
  double gap;
};

/// All contacts of a sphere with a surface. Features have to ascend.
template <class Surface>
std::vector<SurfaceContact> surface_contacts(const Surface& surface, const dem::Vec3& p, double radius) {
  std::vector<SurfaceContact> found;
  surface.contacts(dem::from_eigen(p), radius,
                   [&](std::uint32_t feature, const dem::Vector3<double>& normal, double gap) {
                     if (!found.empty()) CHECK(found.back().feature < feature);
                     CHECK(norm(normal) == Catch::Approx(1.0).epsilon(1e-12));
                     found.push_back({feature, to_eigen(normal), gap});
                   });
  return found;
}

/// One contact, of that normal and gap.
inline void check_one(const std::vector<SurfaceContact>& found, const dem::Vec3& normal, double gap,
                      double tolerance = 1e-14) {
  REQUIRE(found.size() == 1);
  CHECK((found[0].normal - normal).norm() < tolerance);
  CHECK(std::abs(found[0].gap - gap) < tolerance);
}
