#pragma once

#include <dem/core/macros.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace dem::grain {

/// Chooses the skin of the neighbour lists while a world runs. A wide skin makes lists last, and makes each step look
/// at more candidates. What both cost is reckoned from counts alone, never from clocks: so results are the same bits on
/// every machine and for any number of threads.
///
/// A list with the skin s lasts s/u steps, where u is twice the way that the fastest grain goes in a step. It holds
/// M(s) candidates a grain, which grow with the volume of the shell. The skin is the one of a ladder for which
///   evaluations a step * M(s) + (new_list + per_candidate M(s)) u/s
/// is least. A list that lasts is looked at again when its needless candidates have cost as much as a new list: if a
/// narrower skin suits the motion that was seen, a new list is made.
struct SkinChoice {
  /// What a new list costs, a grain, in units of a candidate that is looked at once; measured with spheres when
  /// lists cost twice what they do now. The bits of all results depend on it.
  static constexpr double new_list = 100.0, per_candidate = 10.0;
  /// In mean bounding radii: skins that suit a few large grains would fill the lists of all small ones.
  static constexpr std::array<double, 9> ladder = {0.1, 0.14, 0.2, 0.28, 0.4, 0.55, 0.75, 1.0, 1.3};
  static constexpr std::uint64_t never = ~std::uint64_t{0};

  double radius = 0.0;            ///< m, mean bounding radius of the grains
  double skin = 0.0;              ///< m, of the present list; 0: there was none yet
  double diameter = 0.0;          ///< m, mean of the grains' bounding spheres, with the range of cohesion
  double candidates = 0.0;        ///< of a grain, in the present list
  double moved = -1.0;            ///< m, farthest way of a grain in a list that was given up; negative: not known
  std::uint64_t made = 0;         ///< steps before the present list
  std::uint64_t look_at = never;  ///< the number of steps after which the present list is looked at
  bool looked_at = false;         ///< and a new one was found better
  double list_weight = 1.0;       ///< how many times as dear a list is, beside a candidate, where the executor says so

  template <class V>
  void fields(V& v) {
    v("radius", radius, "m"), v("skin", skin, "m"), v("diameter", diameter, "m"), v("candidates", candidates),
        v("moved", moved, "m");
    v("made", made), v("look_at", look_at), v("looked_at", looked_at);
  }

  /// Candidates of a grain in a list with the skin s.
  double candidates_at(double s) const;
  double list_cost(double s) const { return list_weight * (new_list + per_candidate * candidates_at(s)); }

  /// The best skin (m) for grains of which the fastest goes half of `speed` (m) in a step. `evaluations`: of forces, a
  /// step; `lists`: new lists a step that are made whatever the skin is.
  double best(double speed, double evaluations, double lists) const;

  /// Before a new list: its skin (m), the same as before where nobody knows how far grains have moved. `step`: steps so
  /// far.
  double choose(std::uint64_t step, double evaluations);
  /// After a new list was made; `range`: m, of cohesion.
  void made_list(double range, double candidates_of_a_grain, std::uint64_t step, double evaluations);
  /// After `step` steps, when the list is due to be looked at: whether a new list is better, with grains that have
  /// moved so far (m).
  bool is_too_wide(double so_far, std::uint64_t step, double evaluations);
};

}  // namespace dem::grain

#if DEM_DEFINES

namespace dem::grain {

DEM_INLINE double SkinChoice::candidates_at(double s) const {
  const double ratio = (diameter + s) / (diameter + skin);
  return candidates * ratio * ratio * ratio;
}

DEM_INLINE double SkinChoice::best(double speed, double evaluations, double lists) const {
  double best = 0.0, least = 0.0;
  for (const double share : ladder) {
    const double s = share * radius;
    const double cost = evaluations * candidates_at(s) + list_cost(s) * std::max(lists, speed / s);
    if (best > 0.0 && cost >= least) continue;
    best = s;
    least = cost;
  }
  return best;
}

DEM_INLINE double SkinChoice::choose(std::uint64_t step, double evaluations) {
  if (skin == 0.0) skin = ladder[0] * radius;
  else if (moved >= 0.0) {
    const double steps = static_cast<double>(std::max<std::uint64_t>(1, step - made));
    const bool outlived = looked_at || 2.0 * moved >= skin;  // else something other than motion asked for it
    skin = best(2.0 * moved / steps, evaluations, outlived ? 0.0 : 1.0 / steps);
  }
  looked_at = false;
  moved = -1.0;
  return skin;
}

DEM_INLINE void SkinChoice::made_list(double range, double candidates_of_a_grain, std::uint64_t step,
                                      double evaluations) {
  diameter = 2.0 * radius + range;
  candidates = candidates_of_a_grain;
  made = step;
  look_at = never;
  const double least = ladder[0] * radius;
  const double needless = evaluations * (candidates - candidates_at(least));
  if (skin > least && needless > 0.0) look_at = step + 1 + static_cast<std::uint64_t>(list_cost(least) / needless);
}

DEM_INLINE bool SkinChoice::is_too_wide(double so_far, std::uint64_t step, double evaluations) {
  const std::uint64_t steps = step - made;
  looked_at = best(2.0 * so_far / static_cast<double>(steps), evaluations, 0.0) < skin;
  look_at = step + steps;
  return looked_at;
}

}  // namespace dem::grain

#endif
