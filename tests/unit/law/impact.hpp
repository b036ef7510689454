#pragma once

#include <dem/law/state.hpp>

/// What comes of an impact of one mass against a wall.
struct Rebound {
  double restitution = 0.0, peak_force = 0.0, lowest_force = 0.0, peak_overlap = 0.0, duration = 0.0;
};

/// Integrates m d'' = m gravity - F from first contact until the overlap is gone, with a time step that resolves
/// sqrt(m/k) in `steps` steps, k the law's stiffness at the overlap `depth`. The error of a step is 1/steps of what
/// happens in it.
template <class Law>
Rebound impact(const typename Law::template Parameters<double>& p, double mass, double radius, double speed,
               double depth, double steps = 20000.0, double gravity = 0.0) {
  dem::contact::NormalState<double> s = {depth, 0.0, radius, mass, 0.0};
  s.time_step = std::sqrt(mass / Law::stiffness(p, s)) / steps;
  s.overlap = 0.0;
  s.approach_speed = speed;
  typename Law::template History<double> h = {};
  Rebound result;
  while (s.overlap >= 0.0) {
    const double f = Law::force(p, s, h);
    s.approach_speed += (gravity - f / mass) * s.time_step;
    s.overlap += s.approach_speed * s.time_step;
    result.peak_force = std::max(result.peak_force, f);
    result.lowest_force = std::min(result.lowest_force, f);
    result.peak_overlap = std::max(result.peak_overlap, s.overlap);
    result.duration += s.time_step;
  }
  result.restitution = -s.approach_speed / speed;
  return result;
}
