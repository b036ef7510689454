#pragma once

#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/core/macros.hpp>
#include <dem/geometry/surface.hpp>
#include <dem/math/random.hpp>
#include <dem/math/rotation.hpp>
#include <dem/world/mixture.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace dem {

using InletId = Id<struct InletTag>;  ///< a region that puts grains into the world

/// Where an inlet puts the centres of its grains: a box along the axes, or a disc, which may be thick.
class InletRegion {
 public:
  /// The box may be flat. Throws Error unless it is finite.
  static InletRegion box(const Vec3& low, const Vec3& high);
  /// Radius and thickness in m; the disc is centred in its thickness. Throws Error for a radius or thickness that is
  /// negative, and a normal that is none.
  static InletRegion disc(const Vec3& centre, const Vec3& normal, double radius, double thickness = 0.0);

  template <class V>
  void fields(V& v) {
    v.given("centre", centre_, "m"), v.given("half", half_, "m"), v.given("axes", axes_), v.given("round", is_round_);
  }

  Vec3 point(RandomStream& random) const;
  /// A box along the axes that holds it.
  surface::Aabb bounds() const;

 private:
  Vec3 centre_ = Vec3::Zero(), half_ = Vec3::Zero();  // m
  Mat3 axes_ = Mat3::Identity();
  bool is_round_ = false;
};

/// What an inlet puts in. One of the two flows has to be given.
struct InletOptions {
  std::string name = {};
  Mixture grains = {};               ///< one species, or several
  double mass_flow = 0.0;            ///< kg/s
  double grain_flow = 0.0;           ///< grains a second
  std::optional<double> start = {};  ///< s; none: when it is added
  double end = HUGE_VAL;             ///< s
  double total_mass = HUGE_VAL;      ///< kg, after which it ends, to half a grain
  double total_grains = HUGE_VAL;    ///< grains, after which it ends
  Vec3 velocity = Vec3::Zero();      ///< m/s
  double velocity_spread = 0.0;      ///< m/s, radius of the ball about `velocity` from which velocities are drawn
  bool random_orientation = true;    ///< else grains stand along the axes
  std::uint64_t seed = 1;            ///< of the inlet's own random numbers
};

/// Puts grains into a world, a flow of them over time. A grain comes when the flow has brought more than half of it, if
/// there is room: its bounding sphere must be clear of those of all grains, and it must touch no surface. What does not
/// fit is owed, and comes as soon as it fits.
class Inlet {
 public:
  Inlet(const InletRegion& region, const InletOptions& o, MixtureDraw grains, double now);

  template <class V>
  void fields(V& v) {
    const InletOptions& o = options_;
    v.given("name", o.name), v.given("region", region_), v.given("mass_flow", o.mass_flow, "kg/s");
    v.given("grain_flow", o.grain_flow, "1/s"), v.given("end", o.end, "s"), v.given("mixture", grains_drawn_);
    v.given("total_mass", o.total_mass, "kg"), v.given("total_grains", o.total_grains);
    v.given("velocity", o.velocity, "m/s"), v.given("velocity_spread", o.velocity_spread, "m/s");
    v.given("random_orientation", o.random_orientation), v.given("seed", o.seed);
    v("random", random_), v("start", start_, "s"), v("grains", grains_), v("mass", mass_, "kg"), v("due", due_);
    v("next", next_), v("is_blocked", is_blocked_), v("is_open", is_open_), v("closed_at", closed_at_, "s");
    v("closed_for", closed_for_, "s");
  }

  const std::string& name() const { return options_.name; }
  const InletRegion& region() const { return region_; }
  const InletOptions& options() const { return options_; }
  std::uint64_t grains() const { return grains_; }  ///< put in so far
  double mass() const { return mass_; }             ///< kg, put in so far
  /// What the flow has brought so far: kg, or grains if the flow is one of grains.
  double due() const { return due_; }
  /// What of it did not fit yet, in the same unit; less than one grain is always owed.
  double owed() const { return std::max(0.0, due_ - given()); }
  /// Whether it gives anything: see World::set_open.
  bool is_open() const { return is_open_; }
  /// It is open, and more than a twentieth of what was due is owed, as there was no room.
  bool is_short() const { return is_open_ && is_blocked_ && owed() > 0.05 * due_; }
  /// What is short, in words; empty if nothing is.
  std::string note() const;

  /// Opens or closes it at a time (s): World::set_open.
  void set_open(bool open, double now);

  // What follows is for the step.

  /// The flow until `time` (s) is due. Returns whether a grain is wanted; `mass_of(species)` is in kg.
  template <class MassOf>
  bool want(double time, MassOf&& mass_of) {
    if (!is_open_) return false;
    const double flow = by_mass() ? options_.mass_flow : options_.grain_flow;
    const double most = by_mass() ? options_.total_mass : options_.total_grains;
    due_ = std::min(most, flow * std::max(0.0, std::min(time, options_.end) - start_ - closed_for_));
    if (!next_.valid()) next_ = grains_drawn_.draw(random_);
    const double mass = mass_of(next_);
    return given() + 0.5 * (by_mass() ? mass : 1.0) <= due_ && mass_ + 0.5 * mass <= options_.total_mass &&
           static_cast<double>(grains_) + 0.5 <= options_.total_grains;
  }
  SpeciesId next() const { return next_; }  ///< species of the grain that is put in next
  RandomStream& random() { return random_; }
  void put(double mass);
  void block() { is_blocked_ = true; }

 private:
  bool by_mass() const { return options_.mass_flow > 0.0; }
  double given() const { return by_mass() ? mass_ : static_cast<double>(grains_); }

  InletOptions options_;
  InletRegion region_;
  MixtureDraw grains_drawn_;
  RandomStream random_;
  double start_;              // s
  std::uint64_t grains_ = 0;  // put in so far
  double mass_ = 0.0;         // kg, put in so far
  double due_ = 0.0;          // kg or grains
  SpeciesId next_;            // kept until it fits: small grains would else be preferred
  bool is_blocked_ = false;   // the last grain that was wanted did not fit
  bool is_open_ = true;
  double closed_at_ = 0.0, closed_for_ = 0.0;  // s, between its start and its end: since when, and how long before
};

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE InletRegion InletRegion::box(const Vec3& low, const Vec3& high) {
  if (!is_finite(low) || !is_finite(high) || !none_below(high, low)) {
    fail("the region of an inlet goes from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) m, which is no finite box", low.x(),
         low.y(), low.z(), high.x(), high.y(), high.z());
  }
  InletRegion r;
  r.centre_ = 0.5 * (low + high);
  r.half_ = 0.5 * (high - low);
  return r;
}

DEM_INLINE InletRegion InletRegion::disc(const Vec3& centre, const Vec3& normal, double radius, double thickness) {
  InletRegion r;
  require_positive(radius, "radius of an inlet", "m");
  require_non_negative(thickness, "thickness of an inlet", "m");
  const double size = norm(from_eigen(normal));
  if (!is_finite(centre) || !is_finite(normal) || !(size > 0.0)) {
    fail("an inlet has the normal ({:g}, {:g}, {:g}), or a centre that is not finite; give it a direction", normal.x(),
         normal.y(), normal.z());
  }
  r.centre_ = centre;
  r.axes_ = rotation_between(Vec3::UnitZ(), Vec3((1.0 / size) * normal));
  r.half_ = Vec3(radius, radius, 0.5 * thickness);
  r.is_round_ = true;
  return r;
}

DEM_INLINE Vec3 InletRegion::point(RandomStream& random) const {
  for (;;) {
    const Vec3 x = random.in_box(Vec3(-half_), half_);
    if (!is_round_ || x.x() * x.x() + x.y() * x.y() <= half_.x() * half_.x()) return centre_ + axes_ * x;
  }
}

DEM_INLINE surface::Aabb InletRegion::bounds() const {
  const Vec3 half = magnitudes(axes_) * half_;
  return {centre_ - half, centre_ + half};
}

DEM_INLINE Inlet::Inlet(const InletRegion& region, const InletOptions& o, MixtureDraw grains, double now)
    : options_(o), region_(region), grains_drawn_(std::move(grains)), random_(o.seed), start_(o.start.value_or(now)) {
  require_non_negative(o.mass_flow, "mass flow of an inlet", "kg/s");
  require_non_negative(o.grain_flow, "flow of grains of an inlet", "1/s");
  require_non_negative(o.velocity_spread, "spread of an inlet's velocities", "m/s");
  if ((o.mass_flow > 0.0) == (o.grain_flow > 0.0)) {
    fail("inlet '{}' has a mass flow of {:g} kg/s and a flow of {:g} grains/s; give it one of the two", o.name,
         o.mass_flow, o.grain_flow);
  }
  if (!(o.end > start_)) fail("inlet '{}' ends at {:g} s, but starts at {:g} s", o.name, o.end, start_);
  if (!(o.total_mass > 0.0) || !(o.total_grains > 0.0)) {
    fail("inlet '{}' is to give {:g} kg or {:g} grains in all; give it more than nothing", o.name, o.total_mass,
         o.total_grains);
  }
  if (!is_finite(o.velocity)) fail("inlet '{}' has a velocity that is not finite", o.name);
}

DEM_INLINE std::string Inlet::note() const {
  if (!is_short()) return {};
  const char* unit = by_mass() ? "kg" : "grains";
  return text(
      "inlet '{}' has put in {:.4g} of the {:.4g} {} that were due, as there was no more room in its region; enlarge "
      "the region, raise the velocity with which grains leave it, or lower the flow",
      options_.name, given(), due_, unit);
}

DEM_INLINE void Inlet::set_open(bool open, double now) {
  if (open == is_open_) return;
  is_open_ = open;
  const double counts = std::clamp(now, start_, options_.end);
  if (open) closed_for_ += counts - closed_at_;
  else closed_at_ = counts;
}

DEM_INLINE void Inlet::put(double mass) {
  ++grains_;
  mass_ += mass;
  next_ = {};
  is_blocked_ = false;
}

}  // namespace dem

#endif
