#pragma once

#include <dem/core/error.hpp>
#include <dem/law/cohesion/cohesion_law.hpp>

namespace dem::cohesion {

/// Adhesion of small, hard grains (Derjaguin, Muller and Toporov 1975, doi:10.1016/0021-9797(75)90018-1): while the
/// partners touch, a pull of 2 pi w R*, which is the pull-off force. For use with Hertz. Like
/// Hertz it knows round contacts only: on flat faces it is the pull of round grains of their radii, as
/// ContactStress says.
struct DMT {
  template <class T>
  struct Parameters {
    T work_of_adhesion;  ///< w, J/m^2, of both surfaces together
    static constexpr const char* names[] = {"work_of_adhesion"};
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT Attraction<T> force(const Parameters<T>& p, const NormalState<T>& s, History<T>&) {
    const T pull = T(6.28318530717958647693) * p.work_of_adhesion * s.effective_radius;
    return {select(s.overlap > T(0), pull, T(0)), T(0)};
  }

  static double stiffness(const Parameters<double>&, const NormalState<double>&) { return 0.0; }
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>&) {
    return -6.28318530717958647693 * p.work_of_adhesion * s.effective_radius * max(0.0, s.overlap);
  }
  static void check(const Parameters<double>& p) {
    require_non_negative(p.work_of_adhesion, "work of adhesion", "J/m^2");
  }
};

}  // namespace dem::cohesion
