#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/core/pack_widths.hpp>
#include <dem/geometry/surface.hpp>
#include <dem/grain/sleep_options.hpp>
#include <dem/math/vector.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/world/inlet.hpp>
#include <dem/world/outlet.hpp>

#include <optional>
#include <string>

namespace dem {

/// Directions in which a domain repeats itself.
struct PeriodicAxes {
  bool x = false, y = false, z = false;
};

/// Settings of a world. All have defaults that suit a first try.
struct WorldOptions {
  Vec3 gravity = {0.0, 0.0, -9.81};       ///< m/s^2
  double time_step = 0.0;                 ///< s; 0: `time_step_safety` times the largest stable one
  double time_step_safety = 0.5;          ///< in (0, 1]
  bool allow_unstable_time_step = false;  ///< accept a time step above the stable one
  double skin = 0.0;                      ///< m, reach of the neighbour lists; 0: chosen while it runs (grain/skin.hpp)
  /// Overlap, in effective diameters 2 Ri Rj/(Ri + Rj), that is reported as a problem. A ball passes a two-sided sheet
  /// or a very thin box at 0.5: give 0.4 to be told before.
  double overlap_limit = 0.5;
  std::optional<surface::Aabb> domain = {};           ///< where grains are expected; none: anywhere
  BeyondDomain beyond_domain = BeyondDomain::report;  ///< what becomes of a grain whose centre leaves it
  PeriodicAxes periodic = {};              ///< in which the domain repeats itself; for models with a periodic Domain
  double shear_rate = 0.0;                 ///< 1/s, dv_x/dz; for models with a sheared Domain
  int threads = 0;                         ///< 0: as many as the executor offers
  std::optional<SleepOptions> sleep = {};  ///< lets grains at rest sleep, so that they cost next to nothing
};

namespace detail {
/// Throws Error if an option is out of range, or the sources of the program were compiled for different processors.
void check_options(const WorldOptions& options);
/// Throws Error for a vector that is not finite; `what` it is.
void require_finite(const Vec3& v, const char* what);
}  // namespace detail

/// A grain to be added.
struct NewGrain {
  SpeciesId species = {};
  Vec3 position = Vec3::Zero();          ///< m
  Vec3 velocity = Vec3::Zero();          ///< m/s
  Mat3 rotation = Mat3::Identity();      ///< grain frame -> global
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, global axes
};

/// What a species is made of.
struct SpeciesOptions {
  std::string material = "grain";
  double density = 2650.0;  ///< kg/m^3; the default is quartz
  bool held = false;  ///< its grains do not move by themselves: they stand still, as a rough base does, or go with
                      ///< a machine part (World::attach). They feel grains that move, but neither each other nor
                      ///< surfaces
};

/// Where a surface sits on its body: by default where it was drawn. The two frames are one for boxes, cylinders,
/// spheres and bodies that are given by their principal moments about the origin; not for meshes, sums of parts, and
/// bodies with a centre of mass or a tensor of their own.
struct SurfaceOptions {
  std::string material = "wall";
  std::string name = {};
  Vec3 position = Vec3::Zero();            ///< m, in `frame`
  Mat3 rotation = Mat3::Identity();        ///< surface frame -> `frame`
  BodyFrame frame = BodyFrame::reference;  ///< of the body, in which position and rotation are given
};

}  // namespace dem

#if DEM_DEFINES

namespace dem::detail {

DEM_INLINE void check_options(const WorldOptions& options) {
  if (const PackWidths& widths = pack_widths; widths.other != 0) {
    fail(
        "the sources of this program were compiled for different processors: packs hold {} numbers in one, {} in "
        "another; compile all with the same flags (link all to dem::native, or none)",
        widths.first, widths.other);
  }
  require_non_negative(options.time_step, "time step", "s (0 chooses one)");
  require_within(options.time_step_safety, 1e-6, 1.0, "time step safety");
  require_non_negative(options.skin, "skin", "m (0 chooses one)");
  require_positive(options.overlap_limit, "overlap limit", "effective diameters");
  require_finite(options.gravity, "gravity");
  if (options.sleep) check_sleep(*options.sleep);
  if (const auto& d = options.domain; d && !all_below(d->low, d->high)) {
    fail("the domain's lower corner ({:g}, {:g}, {:g}) m is not below its upper one, ({:g}, {:g}, {:g}) m", d->low.x(),
         d->low.y(), d->low.z(), d->high.x(), d->high.y(), d->high.z());
  }
}

DEM_INLINE void require_finite(const Vec3& v, const char* what) {
  if (!is_finite(v)) fail("{} is ({:g}, {:g}, {:g}), but must be finite", what, v.x(), v.y(), v.z());
}

}  // namespace dem::detail

#endif
