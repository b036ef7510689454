#pragma once

#include <dem/core/macros.hpp>
#include <dem/core/stable_time_step.hpp>
#include <dem/mbd/solver/derive.hpp>
#include <dem/mbd/solver/part_kind.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dem::mbd {

namespace detail {

/// Whether integrator I keeps x'' = -k x - c x' bounded over 400 steps of dt, from x = 1 and a given speed over scale.
template <class I>
bool stays_bounded(double k, double c, double dt, double start) {
  integrator::Motion<double> m = {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, Matrix3<double>::identity()};
  typename I::template Memory<double> memory{};
  const double scale = std::sqrt(k) + c;  // 1/s, makes a speed comparable with a displacement
  m.velocity.x = start * scale;
  const auto acceleration = [&] {
    return integrator::Acceleration<double>{{-k * m.position.x - c * m.velocity.x, 0, 0}, {0, 0, 0}};
  };
  I::template initialise<double>(memory, acceleration());
  for (int step = 0; step < 400; ++step) {
    for (int stage = 0; stage < I::stages; ++stage) {
      if constexpr (I::predicts_before_forces) I::template before_forces<double>(stage, dt, m, memory);
      I::template after_forces<double>(stage, dt, m, memory, acceleration());
    }
    if (!(std::abs(m.position.x) < 100.0 && std::abs(m.velocity.x) < 100.0 * scale)) return false;
  }
  return true;
}

/// The largest stable time step of x'' = -k x - c x' with integrator I, by bisection with the integrator itself.
template <class I>
double largest_stable_step(double k, double c) {
  if (k <= 0.0 && c <= 0.0) return 1e300;
  double low = 0.0, high = 4.0 / std::max(std::sqrt(k), c);
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    // Two starts: one of them might by chance be the one that does not grow.
    const bool stable = stays_bounded<I>(k, c, middle, 0.5) && stays_bounded<I>(k, c, middle, -0.37);
    (stable ? low : high) = middle;
  }
  return low;
}

/// Squared frequency (1/s^2) and damping (1/s) that those of the machine do not exceed in an element, by two bounds: of
/// the element with equal shares, and of the sum over everything on its bodies.
struct ElementBounds {
  double k[2] = {0, 0}, c[2] = {0, 0};
};

/// One for each element; a part without any stiffness limits nothing.
std::vector<ElementBounds> bounds_of(const Parts& m, const std::vector<Element>& elements);

/// The part to blame where the parts on one of an element's bodies are too stiff together: of those whose stiffness or
/// damping was given the one that adds most, if it adds a tenth or more, as what is derived follows the step. Else the
/// element itself.
std::string culprit(const Parts& m, const std::vector<Element>& elements, std::size_t worst, double dt);

}  // namespace detail

/// The largest time step at which all joints, couplings, springs and actuators are stable with integrator I, and the
/// part that limits it. Two bounds on the highest frequency are known (ElementBounds), and the better one counts. No
/// safety factor is in it.
template <class I>
StableTimeStep stable_time_step_of(const Parts& m) {
  using namespace detail;
  const std::vector<Element> elements = elements_of(m);
  const std::vector<ElementBounds> bounds = bounds_of(m, elements);
  constexpr double as_stiff = 1.0 + 1e-9;  // derived parts are alike but for rounding: one of them stands for all
  StableTimeStep found[2];
  std::size_t worst_of[2] = {elements.size(), elements.size()};
  for (int i = 0; i < 2; ++i) {
    double worst_k = 0.0, worst_c = 0.0;
    std::size_t worst = elements.size();
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const double k = bounds[e].k[i], c = bounds[e].c[i];
      if (k <= as_stiff * worst_k && c <= as_stiff * worst_c) continue;
      const double dt = largest_stable_step<I>(k, c);
      if (dt < found[i].dt) {
        found[i].dt = dt;
        worst = e;
        worst_k = k;
        worst_c = c;
      }
    }
    if (worst < elements.size()) worst_of[i] = worst;
  }
  const int better = found[0].dt > found[1].dt ? 0 : 1;
  if (worst_of[better] < elements.size()) {
    found[better].limited_by = culprit(m, elements, worst_of[better], found[better].dt);
  }
  return found[better];
}

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE std::vector<ElementBounds> bounds_of(const Parts& m, const std::vector<Element>& elements) {
  const std::vector<double> n = shares_of(m, elements);
  std::vector<double> k(m.bodies.size(), 0.0), c(m.bodies.size(), 0.0);
  for (const Element& e : elements) {
    for (const Element::Side& s : e.sides) {
      k[s.body] += s.k;
      c[s.body] += s.c;
    }
  }
  std::vector<ElementBounds> bounds(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    ElementBounds b;
    double own = 0.0;
    for (const Element::Side& s : elements[i].sides) {
      b.k[0] += n[s.body] * s.k;
      b.c[0] += n[s.body] * s.c;
      b.k[1] += k[s.body];
      b.c[1] += c[s.body];
      own += s.k + s.c;
    }
    if (own > 0.0) bounds[i] = b;
  }
  return bounds;
}

DEM_INLINE std::string culprit(const Parts& m, const std::vector<Element>& elements, std::size_t worst, double dt) {
  const auto added = [&](const std::vector<Element>& all, std::size_t e, std::uint32_t body) {
    double sum = 0.0;
    for (const Element::Side& s : all[e].sides) sum += s.body == body ? s.k * dt * dt + 2.0 * s.c * dt : 0.0;
    return sum;
  };
  const std::vector<Element> given = elements_of(without_derived(m));  // the same, in the same order
  std::size_t blamed = worst;
  double most = 0.0, total = 0.0;
  for (const Element::Side& s : elements[worst].sides) {
    double on_body = 0.0;
    for (std::size_t e = 0; e < elements.size(); ++e) on_body += added(elements, e, s.body);
    total = std::max(total, on_body);
    for (std::size_t e = 0; e < given.size(); ++e) {
      const double by_given = added(given, e, s.body);
      if (by_given > most) {
        most = by_given;
        blamed = e;
      }
    }
  }
  if (most < 0.1 * total) blamed = worst;
  return elements[blamed].kind->name_of(m, elements[blamed].index);
}

}  // namespace dem::mbd::detail

#endif
