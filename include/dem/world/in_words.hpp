#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/macros.hpp>
#include <dem/world/state.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace dem {

namespace detail {

/// "at t = 0.1 s (step 1000)".
std::string when_in_words(const WorldCommon& w);
std::string surface_in_words(const WorldCommon& w, std::size_t number, const SurfaceOnBody& s, bool name_is_unique);
// What befell the grain of that number.
std::string not_finite_in_words(const WorldCommon& w, std::uint32_t grain);
std::string lost_in_words(const WorldCommon& w, std::uint32_t grain, const Vec3& x);
std::string passed_in_words(const WorldCommon& w, std::uint32_t grain, double radius, const std::string& surface,
                            double went);
std::string body_overlap_in_words(const WorldCommon& w, const SurfaceOnBody& a, const SurfaceOnBody& b, double overlap);

}  // namespace detail

/// A surface in words: its name, with its number and body where it has none or others are called the same.
template <class Model>
DEM_SETUP std::string surface_in_words(const WorldState<Model>& w, std::size_t s) {
  const std::string& name = w.surfaces[s].name;
  const auto is_called_so = [&](const auto& other) { return other.name == name; };
  const bool name_is_unique = !name.empty() && std::count_if(w.surfaces.begin(), w.surfaces.end(), is_called_so) == 1;
  return detail::surface_in_words(w, s, w.surfaces[s], name_is_unique);
}

/// Why a surface of a periodic world, where it is now, does not fit the cell, in words; empty if it does. Grains meet
/// the nearest image of a short surface. A longer one has to reach beyond the cell as far as a grain may: its bounding
/// radius, and half of the widest skin.
template <class Model>
std::string misfit_in_period(const WorldState<Model>& w, std::size_t number,
                             const typename WorldState<Model>::Surface& s) {
  if constexpr (Model::Domain::has_images) {
    constexpr const char* axes[] = {"x", "y", "z"};
    const double reach = shape::widened(w.largest_radius, w.materials.range());
    const double skin = w.options.skin > 0.0 ? w.options.skin : grain::SkinChoice::ladder.back() * w.largest_radius;
    const double margin = reach + 0.5 * skin;
    for (std::size_t k = 0; k < 3; ++k) {
      const double period = w.domain.period()[k], from = w.domain.low(k) - margin;
      const double to = w.domain.low(k) + period + margin;
      const double low = s.low.data()[k], high = s.high.data()[k];
      if (period == 0.0 || !s.active || w.domain.repeats(k, high - low, reach) || (low <= from && high >= to)) continue;
      return dem::text(
          "{} reaches from {:g} to {:g} m in {}, where the domain repeats itself every {:g} m: a surface there must be "
          "shorter than {:g} m, so that grains fit between its images, or fill the cell and more, from {:g} to {:g} m",
          surface_in_words(w, number), low, high, axes[k], period, period - 2.0 * reach, from, to);
    }
  }
  return {};
}

/// "grain 4 at (0, 0, 0.1) m overlaps surface 'wheel' by 0.3 of their effective diameter".
template <class Model>
DEM_SETUP std::string overlap_in_words(const WorldState<Model>& w, const DeepestContact& deepest) {
  const auto& p = w.grains;
  const Vec3 x = to_eigen(p.position[deepest.i]);
  const std::string partner =
      deepest.with_surface ? surface_in_words(w, deepest.partner) : dem::text("grain {}", p.number_at(deepest.partner));
  return dem::text("grain {} at ({:.4g}, {:.4g}, {:.4g}) m overlaps {} by {:.3g} of their effective diameter",
                   p.number_at(deepest.i), x.x(), x.y(), x.z(), partner, deepest.overlap);
}

}  // namespace dem

#if DEM_DEFINES

namespace dem::detail {

DEM_INLINE std::string when_in_words(const WorldCommon& w) {
  return dem::text("at t = {:.6g} s (step {})", w.time, w.step);
}

DEM_INLINE std::string surface_in_words(const WorldCommon& w, std::size_t number, const SurfaceOnBody& s,
                                        bool name_is_unique) {
  if (name_is_unique) return dem::text("surface '{}'", s.name);
  const std::string& body = w.machine.bodies()[s.body.index()].name;
  return s.name.empty() ? dem::text("surface {} of body '{}'", number, body)
                        : dem::text("surface {} ('{}' of body '{}')", number, s.name, body);
}

DEM_INLINE std::string not_finite_in_words(const WorldCommon& w, std::uint32_t grain) {
  return dem::text(
      "grain {} has a position or velocity that is not a number {}: the simulation blew up; lower time_step (now {:g} "
      "s) or the stiffness, or raise the damping",
      grain, when_in_words(w), w.time_step);
}

DEM_INLINE std::string lost_in_words(const WorldCommon& w, std::uint32_t grain, const Vec3& x) {
  return dem::text(
      "grain {} left the domain {} and is at ({:.4g}, {:.4g}, {:.4g}) m; close the walls, lower time_step (now {:g} "
      "s), or enlarge domain",
      grain, when_in_words(w), x.x(), x.y(), x.z(), w.time_step);
}

DEM_INLINE std::string passed_in_words(const WorldCommon& w, std::uint32_t grain, double radius,
                                       const std::string& surface, double went) {
  return dem::text(
      "{} went {:.3g} m within the step to t = {:.6g} s (step {}), more than the radius of grain {} there, {:.3g} m, "
      "which it may have passed without touching it; let its motion go without a jump (Signal::smooth_step), let it "
      "touch nothing meanwhile (set_active), or lower time_step (now {:g} s)",
      surface, went, w.time, w.step, grain, radius, w.time_step);
}

DEM_INLINE std::string body_overlap_in_words(const WorldCommon& w, const SurfaceOnBody& a, const SurfaceOnBody& b,
                                             double overlap) {
  const auto name = [&](const SurfaceOnBody& s) -> const std::string& {
    return w.machine.bodies()[s.body.index()].name;
  };
  return dem::text(
      "body '{}' overlaps body '{}' by {:.3g} of their effective diameter {}, more than overlap_limit {:g}; raise the "
      "normal stiffness between their materials, lower time_step (now {:g} s), or start with the bodies apart",
      name(a), name(b), overlap, when_in_words(w), w.options.overlap_limit, w.time_step);
}

}  // namespace dem::detail

#endif
