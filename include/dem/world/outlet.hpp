#pragma once

#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/core/macros.hpp>
#include <dem/geometry/surface.hpp>
#include <dem/math/eager.hpp>
#include <dem/mbd/sensor/sensor.hpp>

#include <cstdint>
#include <string>

namespace dem {

using OutletId = Id<struct OutletTag>;  ///< a region that takes grains out of the world

/// What becomes of a grain whose centre leaves WorldOptions::domain.
enum class BeyondDomain {
  report,  ///< the run ends with StepReport::Problem::lost; said once of each grain
  remove,  ///< it is taken out and counted in World::beyond_domain(); the run goes on
  go_on    ///< nothing: it flies on
};

struct OutletOptions {
  std::string name = {};
  double window = 0.1;  ///< s, that the mass flow is the mean over
};

/// Takes grains out of a world, and counts them. A grain is taken at the end of the step in which its centre is in the
/// region.
class Outlet {
 public:
  /// Everywhere.
  Outlet() : Outlet({filled(-HUGE_VAL), filled(HUGE_VAL)}, {.name = "everywhere"}) {}
  /// A box, which may be without end: corners may be infinite. Throws Error for a box that is none, and a window that
  /// is negative.
  Outlet(const surface::Aabb& region, const OutletOptions& o);

  template <class V>
  void fields(V& v) {
    v.given("name", name_), v.given("low", region_.low, "m"), v.given("high", region_.high, "m");
    v("flow", flow_), v("grains", grains_), v("mass", mass_, "kg"), v("mass_now", now_, "kg");
  }

  const std::string& name() const { return name_; }
  const surface::Aabb& region() const { return region_; }
  std::uint64_t grains() const { return grains_; }  ///< taken so far
  double mass() const { return mass_; }             ///< kg, taken so far
  /// kg/s, the mean over the window, or over the time that there is of it so far.
  double mass_flow() const { return flow_.mean().force.x; }

  void take(double mass);
  /// At the end of a step of dt (s).
  void end_step(double dt);

 private:
  std::string name_;
  surface::Aabb region_;
  mbd::WindowAverage flow_;  // kg/s, in force.x
  std::uint64_t grains_ = 0;
  double mass_ = 0.0, now_ = 0.0;  // kg; the second in this step
};

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE Outlet::Outlet(const surface::Aabb& region, const OutletOptions& o)
    : name_(o.name), region_(region), flow_(o.window) {
  if (all_below(region.low, region.high)) return;
  const Vec3 &a = region.low, &b = region.high;
  fail("outlet '{}' has the lower corner ({:g}, {:g}, {:g}) m, which is not below its upper one, ({:g}, {:g}, {:g}) m",
       name_, a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
}

DEM_INLINE void Outlet::take(double mass) {
  ++grains_;
  mass_ += mass;
  now_ += mass;
}

DEM_INLINE void Outlet::end_step(double dt) {
  flow_.add({{now_ / dt, 0, 0}, {0, 0, 0}}, dt);
  now_ = 0.0;
}

}  // namespace dem

#endif
