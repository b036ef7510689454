#pragma once

#include <dem/core/error.hpp>
#include <dem/law/cohesion/cohesion_law.hpp>

namespace dem::cohesion {

/// A constant pull while the partners touch (the thesis's normal stiction force, a function of the penetration): F
/// min(1, d/depth). With depth = 0 it is there at once; with a depth it comes on with the overlap d. Beside a normal
/// spring k they part at a pull of F - k depth, so it holds them together only where depth < F/k: else the spring
/// always pushes more than F pulls, and F only softens the contact.
struct Constant {
  template <class T>
  struct Parameters {
    T force;           ///< F, N (Pa if the shape's contact points have areas)
    T depth = T(0.0);  ///< m, overlap from which the pull is whole
    static constexpr const char* names[] = {"force", "depth"};
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT Attraction<T> force(const Parameters<T>& p, const NormalState<T>& s, History<T>&) {
    const T share = min(T(1), max(T(0), s.overlap) / max(p.depth, T(1e-300)));
    return {p.force * share, T(0)};
  }

  static double stiffness(const Parameters<double>& p, const NormalState<double>&) {
    return p.depth > 0.0 ? p.force / p.depth : 0.0;
  }
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>&) {
    const double d = max(0.0, s.overlap);
    return d < p.depth ? -0.5 * p.force * d * d / p.depth : -p.force * (d - 0.5 * p.depth);
  }
  static void check(const Parameters<double>& p) {
    require_non_negative(p.force, "cohesive force", "N");
    require_non_negative(p.depth, "depth of a cohesive force", "m");
  }
};

}  // namespace dem::cohesion
