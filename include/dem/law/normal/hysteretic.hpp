#pragma once

#include <dem/core/error.hpp>
#include <dem/law/normal/normal_law.hpp>

namespace dem::contact {

/// Linear hysteretic contact (Walton and Braun 1986, doi:10.1122/1.549893): plastic flow as a stiffer spring on the way
/// out than on the way in. With the largest overlap D so far,
///   F = min(k1 d, k2 (d - d0)), never pulling,   d0 = D (1 - k1/k2):
/// loading along k1, unloading and reloading along k2. Independent of rates; restitution sqrt(k1/k2). What a contact
/// remembers ends when the grains part. A point that is new in a patch takes over how far the others have come out of
/// their imprint, D - d: so a patch that renames its points, as a body slides over an edge, gives nothing back.
struct Hysteretic {
  template <class T>
  struct Parameters {
    T loading_stiffness;    ///< k1, N/m (per unit area if the shape's contact points have areas)
    T unloading_stiffness;  ///< k2 >= k1, N/m
    static constexpr const char* names[] = {"loading_stiffness", "unloading_stiffness"};
  };
  template <class T>
  struct History {
    T largest_overlap;  ///< D, m
    T overlap;          ///< d, m, of the evaluation before
  };

  /// Constants with the given coefficient of restitution e in [0.01, 1]: k2 = k1/e^2. Throws Error for another e.
  static Parameters<double> with_restitution(double loading_stiffness, double restitution) {
    require_within(restitution, 0.01, 1.0, "coefficient of restitution");
    return {loading_stiffness, loading_stiffness / (restitution * restitution)};
  }

  template <class T>
  static DEM_HOT T force(const Parameters<T>& p, const NormalState<T>& s, History<T>& h) {
    h.largest_overlap = max(h.largest_overlap, s.overlap);
    // k2 (d - d0), written such that it is k1 d to the last bit where k1 = k2.
    const T f = p.loading_stiffness * s.overlap -
                (p.unloading_stiffness - p.loading_stiffness) * (h.largest_overlap - s.overlap);
    h.overlap = s.overlap;
    return max(T(0), f);
  }

  static History<double> inherited(const History<double>& mean, double overlap) {
    return {overlap + mean.largest_overlap - mean.overlap, overlap};
  }

  static double stiffness(const Parameters<double>& p, const NormalState<double>&) { return p.unloading_stiffness; }
  /// What the spring on the way out gives back: F^2/(2 k2).
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>& h) {
    History<double> same = h;
    const double f = force(p, s, same);
    return 0.5 * f * f / p.unloading_stiffness;
  }

  static void check(const Parameters<double>& p) {
    require_positive(p.loading_stiffness, "loading stiffness", "N/m");
    require_positive(p.unloading_stiffness, "unloading stiffness", "N/m");
    if (p.unloading_stiffness < p.loading_stiffness) {
      fail(
          "unloading stiffness is {:g} N/m, but must be at least the loading stiffness of {:g} N/m: a contact cannot "
          "give back more than it took",
          p.unloading_stiffness, p.loading_stiffness);
    }
  }
};

}  // namespace dem::contact
