#pragma once

// Runs of a world whose grains several ranks share (domain::Ranks).

#include <dem/core/error.hpp>
#include <dem/world/gather.hpp>
#include <dem/world/report.hpp>

#include <bit>
#include <cstdint>
#include <initializer_list>

namespace dem {

/// Throws Error, on every rank, unless all ranks have set up the same world and ask the same of it. Ranks that do not
/// would wait for each other for ever. `has_changed`: grains too are compared.
template <class Model>
void check_agreement(const WorldState<Model>& w, std::uint64_t asked, bool has_changed) {
  if (!w.domain.is_shared()) return;
  const auto& p = w.particles;
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto mix = [&](std::uint64_t x) { hash = (hash ^ x) * 0x9e3779b97f4a7c15ULL, hash ^= hash >> 29; };
  for (const std::size_t n : {p.count, p.row_of.size(), w.to_remove.size(), w.species.size(), w.surfaces.size(),
                              w.machine.bodies().size(), w.outlets.size(), w.inlets.size()}) {
    mix(n);
  }
  for (const std::uint64_t n : {asked, w.step, std::uint64_t{w.list_valid}, std::uint64_t{has_changed},
                                std::uint64_t{w.options.sleep.has_value()}}) {
    mix(n);
  }
  const Vec3& g = w.options.gravity;
  for (const double x : {w.options.time_step, w.options.skin, g.x(), g.y(), g.z()})
    mix(std::bit_cast<std::uint64_t>(x));
  if constexpr (Model::Domain::has_images) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double x : {w.domain.low(k), w.domain.period()[k]}) mix(std::bit_cast<std::uint64_t>(x));
    }
  }
  if (has_changed) {
    for (std::size_t i = 0; i < p.count; ++i) {
      for (const auto* c : {&p.position, &p.velocity}) {
        for (const auto* x : {&c->x, &c->y, &c->z}) mix(std::bit_cast<std::uint64_t>((*x)[i]));
      }
    }
  }
  if (w.domain.agree(hash)) return;
  fail(
      "the ranks do not have the same world, or ask different things of it at t = {:g} s: set it up, change and run it "
      "alike on every rank, with no random numbers or clocks of each rank's own; only look at it on one rank alone",
      w.time);
}

/// A run of n steps, as f() does it on this rank. Afterwards every rank knows all grains. Exceptions end all ranks.
template <class Model, class F>
StepReport run_shared(WorldState<Model>& w, std::uint64_t n, F&& f) {
  check_agreement(w, n, false);
  return w.domain.guarded([&] {
    StepReport report = f();
    gather_rows(w);
    return report;
  });
}

}  // namespace dem
