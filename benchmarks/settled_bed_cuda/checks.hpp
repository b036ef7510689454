#pragma once

// Whether a step on the GPU is the ordinary step of the same world, and the same bits twice.

#include "settled_bed/boxes.hpp"

#include <dem/world/step.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>

namespace bench {

/// What two worlds differ by, relative to the largest of its kind.
struct Difference {
  std::size_t contacts = 0, contacts_that_differ = 0;
  double force = 0.0, torque = 0.0, history = 0.0, position = 0.0;  ///< position in m
};

/// The larger one; infinite if one is not a number.
inline double larger(double a, double b) { return a == a && b == b ? std::max(a, b) : HUGE_VAL; }

template <class Model>
Difference difference(const dem::World<Model>& a, const dem::World<Model>& b) {
  Difference d;
  double force = 0.0, torque = 0.0, history = 0.0;
  for (const dem::GrainId p : a.grains()) {
    force = std::max(force, b.force(p).norm());
    torque = std::max(torque, b.torque(p).norm());
    d.force = larger(d.force, (a.force(p) - b.force(p)).norm());
    d.torque = larger(d.torque, (a.torque(p) - b.torque(p)).norm());
    d.position = larger(d.position, (a.position(p) - b.position(p)).norm());
  }
  const auto compare = [&](const auto& x, const auto& y) {
    d.contacts += static_cast<std::size_t>(y.count);
    if (x.count != y.count) {
      d.contacts_that_differ += static_cast<std::size_t>(std::max(x.count, y.count));
      return;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(x.count); ++k) {
      d.contacts_that_differ += x.key[k] != y.key[k] ? 1 : 0;
      for (std::size_t h = 0; h < x.history.size(); ++h) {
        history = std::max(history, std::abs(y.history[h][k]));
        d.history = larger(d.history, std::abs(x.history[h][k] - y.history[h][k]));
      }
    }
  };
  for (std::size_t c = 0; c < a.state().chunks.size(); ++c) {
    compare(a.state().chunks[c].pair_contacts.last, b.state().chunks[c].pair_contacts.last);
    compare(a.state().chunks[c].surface_contacts.last, b.state().chunks[c].surface_contacts.last);
  }
  d.force /= std::max(force, 1e-300);
  d.torque /= std::max(torque, 1e-300);
  d.history /= std::max(history, 1e-300);
  return d;
}

/// The grain whose forces differ most.
template <class Model>
void print_worst(const dem::World<Model>& a, const dem::World<Model>& b) {
  dem::GrainId worst(0);
  double most = -1.0;
  for (const dem::GrainId p : a.grains()) {
    const double difference = (a.force(p) - b.force(p)).norm();
    if (difference > most) most = difference, worst = p;
  }
  const dem::Vec3 f = a.force(worst), g = b.force(worst), x = b.position(worst);
  std::printf("    grain %u at (%g, %g, %g) m: (%g, %g, %g) N on the GPU, (%g, %g, %g) N here\n", worst.value, x.x(),
              x.y(), x.z(), f.x(), f.y(), f.z(), g.x(), g.y(), g.z());
}

/// Whether two worlds are the same bits.
template <class World>
bool same_bits(const World& a, const World& b) {
  const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof(x)) == 0; };
  for (const dem::GrainId p : a.grains()) {
    const dem::Vec3 xa = a.position(p), xb = b.position(p), va = a.velocity(p), vb = b.velocity(p),
                    wa = a.angular_velocity(p), wb = b.angular_velocity(p);
    if (!same(xa, xb) || !same(va, vb) || !same(wa, wb)) return false;
  }
  return true;
}

/// A box of grains that fall for some steps. False if a step on the GPU is not the ordinary one, or not the same twice.
template <class Model>
bool check(const char* name, int grains, int steps) {
  const Settings settings;
  const double width = Model::width * per_row / Model::per_row;
  dem::World<Model> world = loose_bed<Model>(settings, grains, per_row, width);
  std::printf("%s: %d grains prepared\n", name, grains);
  bool good = true;
  for (int k = 0; k < 3; ++k) {
    run_or_fail(world, steps);
    dem::World<Model> here = world;
    run_or_fail(world, 1);
    dem::advance(here.state());
    const Difference d = difference(world, here);
    const bool is_same = d.contacts_that_differ == 0 && d.force < 1e-12 && d.torque < 1e-12 && d.history < 1e-12;
    std::printf(
        "%s, step %llu: %zu contacts, %zu differ; largest difference of forces %.2g, torques %.2g, histories %.2g of "
        "the largest, places %.2g m; %llu lists: %s\n",
        name, static_cast<unsigned long long>(world.steps()), d.contacts, d.contacts_that_differ, d.force, d.torque,
        d.history, d.position, static_cast<unsigned long long>(world.state().rebuilds),
        is_same ? "ok" : "NOT THE SAME");
    if (!is_same) print_worst(world, here);
    good = good && is_same;
  }
  dem::World<Model> again = world;
  run_or_fail(world, steps);
  run_or_fail(again, steps);
  const bool repeats = same_bits(world, again);
  std::printf("%s: %d steps twice: %s\n", name, steps, repeats ? "the same bits" : "OTHER BITS");
  return good && repeats;
}

}  // namespace bench
