#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/macros.hpp>
#include <dem/coupling/surface_contacts.hpp>
#include <dem/world/in_words.hpp>
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
}  // namespace detail

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

}  // namespace dem::detail

#endif
