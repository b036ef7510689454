#pragma once

#include <dem/core/error.hpp>
#include <dem/law/cohesion/cohesion_law.hpp>

#include <numbers>

namespace dem::cohesion {

/// A constant adhesive stress on a whole contact: s times the area pi R* d of Hertz's circle. The pull grows with the
/// overlap, so a linear spring must be stiffer than s pi R*, which the pull takes off it. Then it pushes at every
/// overlap: beside a linear spring this law makes contacts softer and rougher, but never holds them together. Take it
/// with contact::Hysteretic, which holds what was pressed, or with Hertz. Where contact points have areas in m^2,
/// Constant is such a stress.
///
/// It knows round contacts only: on flat faces (polyhedra, flat superquadrics) the circle of their radii may be
/// thousands of times smaller than what touches. To stick face on face with a stress, take Constant with the force
/// stress times face area: edges and corners then get their shares of it.
struct ContactStress {
  template <class T>
  struct Parameters {
    T stress;  ///< s, Pa
    static constexpr const char* names[] = {"stress"};
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT Attraction<T> force(const Parameters<T>& p, const NormalState<T>& s, History<T>&) {
    return {T(pi) * p.stress * s.effective_radius * max(T(0), s.overlap), T(0)};
  }

  static double stiffness(const Parameters<double>& p, const NormalState<double>& s) {
    return pi * p.stress * s.effective_radius;
  }
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>&) {
    const double d = max(0.0, s.overlap);
    return -0.5 * pi * p.stress * s.effective_radius * d * d;
  }
  static void check(const Parameters<double>& p) { require_non_negative(p.stress, "adhesive stress", "Pa"); }

 private:
  static constexpr double pi = std::numbers::pi;
};

}  // namespace dem::cohesion
