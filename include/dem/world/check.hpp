#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/macros.hpp>
#include <dem/coupling/surface_contacts.hpp>
#include <dem/mbd/solver/odd_parts.hpp>
#include <dem/world/report.hpp>
#include <dem/world/state.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace dem {

namespace detail {

/// A problem of a world, now.
StepReport report_of(const WorldCommon& w, StepReport::Problem kind, GrainId grain, std::string text);
inline StepReport no_problem(const WorldCommon& w) { return report_of(w, StepReport::Problem::none, {}, {}); }
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

/// Of surfaces that are there twice, in words; else empty.
template <class Model>
DEM_SETUP std::string note_of_twins(const WorldState<Model>& w) {
  for (std::size_t b = 1; b < w.surfaces.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const auto &first = w.surfaces[a], &second = w.surfaces[b];
      if (!first.active || !second.active || !second.coincides_with(first)) continue;
      return dem::text("Surfaces {} and {} of body '{}' have one shape and one place: both push on what touches them.",
                       a, b, w.machine.bodies()[first.body.index()].name);
    }
  }
  return {};
}

/// Of bodies that nothing holds and that have nothing to lie on, in words; else empty.
template <class Model>
DEM_SETUP std::string note_of_loose_bodies(const WorldState<Model>& w) {
  if (w.options.gravity.isZero() || !w.held.empty()) return {};
  std::vector<std::uint32_t> loose = mbd::loose_bodies(w.machine.parts());
  std::erase_if(loose, [&](std::uint32_t body) {
    return std::any_of(w.surfaces.begin(), w.surfaces.end(), [&](const auto& s) { return s.body.index() == body; });
  });
  return mbd::note_of_loose(w.machine.parts(), loose);
}

/// Of densities that hardly any solid has, as those in g/cm^3 or t/mm^3, in words; else empty.
template <class Model>
DEM_SETUP std::string note_of_density(const WorldState<Model>& w) {
  for (std::size_t k = 0; k < w.species.size(); ++k) {
    if (const double density = w.species[k].density; density < 5.0 || density > 30e3) {
      return dem::text("Species {} has a density of {:g} kg/m^3; is it in another unit? Sand has 2650 kg/m^3.", k,
                       density);
    }
  }
  return {};
}

/// Of gravity along a direction in which a cell repeats itself and has nothing that could carry grains, in words; else
/// empty. What grains are held by is a surface or a held grain.
template <class Model>
DEM_SETUP std::string note_of_free_fall(const WorldState<Model>& w) {
  if constexpr (Model::Domain::has_images) {
    if (!w.surfaces.empty() || !w.held.empty()) return {};
    for (const auto& kind : w.species) {
      if (kind.is_held()) return {};
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double g = w.options.gravity[static_cast<int>(k)];
      if (g == 0.0 || w.domain.period()[k] == 0.0 || w.grains.count == 0) continue;
      return dem::text(
          "Gravity is {:g} m/s^2 along {}, where the cell repeats itself and has no surface: all grains fall "
          "for ever. Set WorldOptions::gravity to zero, or add a floor.",
          g, "xyz"[k]);
    }
  }
  return {};
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

/// Whether a contact is of something that was put somewhere by hand just before the newest step: then it is as deep as
/// it was placed.
template <class Model>
bool is_as_placed(const WorldState<Model>& w, const DeepestContact& deepest) {
  if (w.step != w.placed.at + 1) return false;
  const auto& id = w.grains.id;
  if (w.placed.has_grain(id[deepest.i])) return true;
  return deepest.with_surface ? w.placed.has_surface(deepest.partner) : w.placed.has_grain(id[deepest.partner]);
}

/// Notes the deepest overlap of what was just placed, where it is deep enough to throw grains about.
template <class Model>
DEM_SETUP void note_deep(WorldState<Model>& w) {
  double most = 0.1;
  for (const auto& chunk : w.chunks) {
    if (!(chunk.deepest.overlap > most) || !is_as_placed(w, chunk.deepest)) continue;
    most = chunk.deepest.overlap;
    w.placed_note = overlap_in_words(w, chunk.deepest) + " as it was placed, and is thrown out by it.";
  }
}

/// What to do about an overlap of a grain.
template <class Model>
DEM_SETUP std::string overlap_remedy(const WorldState<Model>& w, const DeepestContact& deepest) {
  if (is_as_placed(w, deepest)) return "they overlap as they were placed: put one of them elsewhere";
  return dem::text(
      "raise the normal stiffness, lower time_step (now {:g} s), the load or the speed of moving parts, or start from "
      "a looser packing",
      w.time_step);
}

/// Whether a surface went so far from one evaluation to the next that it may have passed the smallest grain.
template <class Model>
bool may_have_passed(const WorldState<Model>& w, const typename WorldState<Model>::Surface& s) {
  return s.active && s.went > w.smallest_radius;
}

/// A grain of this process's chunks that a surface may have passed within the step without touching it, in words: it is
/// where the surface went, which was farther than the grain's radius.
template <class Model>
StepReport find_passed_grain(const WorldState<Model>& w) {
  const auto& p = w.grains;
  const auto [first, last] = w.own_chunks();
  for (std::size_t k = 0; k < w.surfaces.size(); ++k) {
    if (!may_have_passed(w, w.surfaces[k])) [[likely]]
      continue;
    const auto& s = w.surfaces[k];
    for (std::size_t c = first; c < last; ++c) {
      if (!coupling::may_meet(w.domain, w.chunks[c].low, w.chunks[c].high, s.went_over, w.largest_radius)) continue;
      for (std::size_t i = c * chunk_size, end = std::min(i + chunk_size, p.count); i < end; ++i) {
        const auto& kind = w.species[p.species[i]];
        if (kind.is_held()) continue;  // it meets no surface
        const double radius = kind.shape.bounding_radius();
        const Vec3 x = to_eigen(p.position[i]);
        if (radius >= s.went || p.row_of[p.id[i]] == p.gone || !coupling::may_meet(w.domain, x, x, s.went_over, radius))
          continue;
        return detail::report_of(w, StepReport::Problem::machine, p.name(p.id[i]),
                                 detail::passed_in_words(w, p.number_at(i), radius, surface_in_words(w, k), s.went));
      }
    }
  }
  return detail::no_problem(w);
}

/// Looks for grains of this process's chunks that are not finite, lost, pressed too deep into something, or passed by a
/// surface. Costs a look at each chunk; only when something is wrong the grain is searched.
template <class Model>
StepReport find_problem_of_grains(WorldState<Model>& w) {
  const auto& p = w.grains;
  using Problem = StepReport::Problem;
  const auto problem = [&](Problem kind, std::size_t row, std::string text) {
    return detail::report_of(w, kind, p.name(p.id[row]), std::move(text));
  };
  const auto [first, last] = w.own_chunks();
  for (std::size_t c = first; c < last; ++c) {
    const auto& chunk = w.chunks[c];
    const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, p.count);
    if (!chunk.finite) [[unlikely]] {
      for (std::size_t i = begin; i < end; ++i) {
        const Vector3<double> x = p.position[i], v = p.velocity[i], turn = p.local_angular_velocity[i];
        // The sum that the chunk was judged by, so that one of its grains fails it: 1e308 twice is infinite as well.
        if (0.0 * (x.x + x.y + x.z + v.x + v.y + v.z + turn.x + turn.y + turn.z) == 0.0) continue;
        return problem(Problem::not_finite, i, detail::not_finite_in_words(w, p.number_at(i)));
      }
    }
    if (const auto& domain = w.borders; domain && w.options.beyond_domain == BeyondDomain::report &&
                                        !(none_below(chunk.low, domain->low) && none_below(domain->high, chunk.high)))
        [[unlikely]] {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 x = to_eigen(p.position[i]);
        if ((none_below(x, domain->low) && none_below(domain->high, x)) || p.row_of[p.id[i]] == p.gone) continue;
        if (!w.known_lost.insert(p.id[i]).second) continue;
        return problem(Problem::lost, i, detail::lost_in_words(w, p.number_at(i), x));
      }
    }
    if (const DeepestContact& deepest = chunk.deepest; deepest.overlap > w.options.overlap_limit) [[unlikely]] {
      return problem(Problem::overlap, deepest.i,
                     dem::text("{} {}, more than overlap_limit {:g}; {}", overlap_in_words(w, deepest),
                               detail::when_in_words(w), w.options.overlap_limit, overlap_remedy(w, deepest)));
    }
  }
  return find_passed_grain(w);
}

/// The report of the lowest rank that has one, on every rank: that of the first chunk. The same message tells how far
/// grains went, which the next step asks for first.
template <class Model>
StepReport first_report(WorldState<Model>& w, StepReport mine) {
  auto& d = w.domain;
  const double before_last = mine ? 0.0 : d.ranks() - d.rank();  // of the lowest rank it is largest
  const auto [moved2, largest] = d.largest(std::array<double, 2>{w.own_moved2(), before_last});
  d.moved2_of_all = moved2;
  const int first = d.ranks() - static_cast<int>(largest);
  if (first == d.ranks()) return mine;
  using Problem = StepReport::Problem;
  if (first != d.rank() && mine.problem == Problem::lost) w.known_lost.erase(mine.grain.slot);  // to be told later
  mine.problem = static_cast<Problem>(std::stoi(d.text_of(first, std::to_string(static_cast<int>(mine.problem)))));
  const auto grain = static_cast<std::uint32_t>(std::stoul(d.text_of(first, std::to_string(mine.grain.slot))));
  mine.grain = w.grains.name(grain);
  mine.text = d.text_of(first, std::move(mine.text));
  if (mine.problem == Problem::lost) w.known_lost.insert(grain);
  return mine;
}

/// Looks for grains that are not finite, lost, or pressed too deep into something, and at the machine.
template <class Model>
StepReport find_problem(WorldState<Model>& w) {
  using Problem = StepReport::Problem;
  const auto problem = [&](Problem kind, std::string text) { return detail::report_of(w, kind, {}, std::move(text)); };
  StepReport of_grains = find_problem_of_grains(w);
  for (auto& s : w.surfaces) s.went = 0.0;  // looked at; the next step begins
  if constexpr (Model::Domain::has_ranks) of_grains = first_report(w, std::move(of_grains));
  if (!of_grains) return of_grains;
  if (w.body_contacts.worst_overlap > w.options.overlap_limit) [[unlikely]] {
    const coupling::BodyPair& pair = w.body_contacts.pairs[w.body_contacts.worst_pair];
    return problem(Problem::overlap,
                   detail::body_overlap_in_words(w, w.surfaces[pair.a.index()], w.surfaces[pair.b.index()],
                                                 w.body_contacts.worst_overlap));
  }
  if constexpr (Model::Domain::has_images) {
    for (std::size_t s = 0; s < w.surfaces.size(); ++s) {
      if (!w.surfaces[s].moved) continue;
      if (const std::string why = misfit_in_period(w, s, w.surfaces[s]); !why.empty()) {
        return problem(Problem::machine, why + " (" + detail::when_in_words(w) + ")");
      }
    }
  }
  if (const auto report = w.machine_solver.report(w.machine); !report) {
    return problem(Problem::machine, report.text);
  }
  if (const auto report = w.machine_solver.newly_opened(w.machine); !report) {
    return problem(Problem::joint, report.text);
  }
  if (!w.machine.parts().terrains.empty()) [[unlikely]] {
    if (std::string text = mbd::take_terrain_problem(w.machine.parts()); !text.empty())
      return problem(Problem::machine, text + " (" + detail::when_in_words(w) + ")");
  }
  return detail::no_problem(w);
}

}  // namespace dem

#if DEM_DEFINES

namespace dem::detail {

DEM_INLINE StepReport report_of(const WorldCommon& w, StepReport::Problem kind, GrainId grain, std::string text) {
  return {kind, w.time, w.step, grain, std::move(text), {}};
}

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
