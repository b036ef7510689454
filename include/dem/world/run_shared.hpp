#pragma once

// Calls that ranks make together of a world whose grains they share (domain::Ranks).

#include <dem/core/error.hpp>
#include <dem/domain/call.hpp>
#include <dem/world/field_hash.hpp>
#include <dem/world/gather.hpp>
#include <dem/world/report.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>

namespace dem {

namespace detail {

/// What ranks compare at the start of a call besides what every call compares.
struct Compared {
  std::uint64_t asked = 0;  ///< a number of steps, say
  bool set_up = false;      ///< what was set up too: it was changed
  bool grains = false;      ///< all grains too: some were added or changed by hand
  bool steered = false;     ///< inlets, outlets and the state of the machine too: a run begins
};

/// The parts of a world by which ranks tell each other what differs.
inline constexpr const char* parts_of_a_world[] = {
    "the time, how many grains or other things there are, open inlets, what was changed or counted, or what is asked",
    "options or the shear rate",
    "materials or contact constants",
    "species",
    "surfaces",
    "the machine (its parts, set points, switches, or how it moves), an outlet or an inlet",
    "grains"};

template <class Model>
domain::CallHashes hashes_of(const WorldState<Model>& world, const Compared& compared) {
  auto& w = const_cast<WorldState<Model>&>(world);  // fields serve both ways; hashing changes nothing
  const auto& p = w.grains;
  Hash size, options, grains;
  // Lists have a type, as nvcc does not find it by itself.
  for (const std::size_t n : std::initializer_list<std::size_t>{
           p.count, p.row_of.size(), w.to_remove.size(), w.species.size(), w.surfaces.size(), w.machine.bodies().size(),
           w.outlets.size(), w.inlets.size()}) {
    size.mix(std::uint64_t{n});
  }
  for (const std::uint64_t n : {compared.asked, w.step, std::uint64_t{w.list_valid}, std::uint64_t{compared.set_up},
                                std::uint64_t{compared.grains}, std::uint64_t{w.ledger.on}}) {
    size.mix(n);
  }
  for (const auto& inlet : w.inlets) size.mix(std::uint64_t{inlet.is_open()});
  const Vec3& g = w.options.gravity;
  const auto& o = w.options;
  for (const double x :
       std::initializer_list<double>{o.time_step, o.time_step_safety, o.skin, o.overlap_limit, g.x(), g.y(), g.z()}) {
    options.mix(x);
  }
  for (const std::uint64_t x :
       std::initializer_list<std::uint64_t>{o.sleep.has_value(), o.domain.has_value(),
                                            static_cast<std::uint64_t>(o.beyond_domain), o.allow_unstable_time_step}) {
    options.mix(x);
  }
  if (o.sleep) {
    for (const double x :
         std::initializer_list<double>{o.sleep->balance, o.sleep->change, o.sleep->jolt, o.sleep->motion,
                                       double(o.sleep->window), double(o.sleep->mean)}) {
      options.mix(x);
    }
  }
  for (int k = 0; k < 3 && o.domain; ++k) options.mix(o.domain->low[k]), options.mix(o.domain->high[k]);
  if constexpr (Model::Domain::has_images) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double x : {w.domain.low(k), w.domain.period()[k]}) options.mix(x);
    }
    if constexpr (domain::IsSheared<typename Model::Domain>) options.mix(w.domain.shear_rate());
  }
  FieldHash materials, species, surfaces, machine;
  if (compared.set_up) {
    materials("", w.materials), species("", w.species), surfaces("", w.surfaces);
    surfaces("", w.surface_sensors), surfaces("", w.body_contacts.pairs);
    machine("", w.machine);
  }
  if (compared.steered) {
    StateHash state;
    state("", w.machine);
    machine.fingerprint("", state.value());
    machine("", w.outlets), machine("", w.inlets);
  }
  if (compared.grains) {
    for (const auto* c : {&p.position, &p.velocity, &p.local_angular_velocity}) {
      for (const auto* x : {&c->x, &c->y, &c->z}) {
        for (std::size_t i = 0; i < p.count; ++i) grains.mix((*x)[i]);
      }
    }
    for (std::size_t i = 0; i < p.count; ++i) grains.mix(std::uint64_t{p.species[i]});
  }
  return {size.value(),     options.value(), materials.value(), species.value(),
          surfaces.value(), machine.value(), grains.value()};
}

}  // namespace detail

/// Every call that ranks make together of a world begins with it. Throws Error, on every rank, unless all are in this
/// call, have set up the same world and ask the same of it. Ranks that do not would wait for each other for ever.
template <class Model>
void check_agreement(const WorldState<Model>& w, domain::Call call, const detail::Compared& compared = {}) {
  if (!w.domain.is_shared()) return;
  const std::size_t part = w.domain.compare(call, detail::hashes_of(w, compared));
  if (part == std::size(detail::parts_of_a_world)) return;
  fail(
      "the ranks do not have the same world, or ask different things of it: at t = {:g} s they differ in {}; set it "
      "up, "
      "change and run it alike on every rank, with no random numbers or clocks of each rank's own. Queries of single "
      "grains may be made on one rank; contacts_of, count_energy, energy_of, averages, save, ... on all ranks",
      w.time, detail::parts_of_a_world[part]);
}

/// f(), in which ranks that share a world tell each other things: all ranks begin it together, and exceptions end all
/// of them. `where` they were, in words.
template <class Model, class F>
auto together(const WorldState<Model>& w, domain::Call call, const char* where, F&& f,
              [[maybe_unused]] const detail::Compared& compared = {}) {
  if constexpr (Model::Domain::has_ranks) {
    check_agreement(w, call, compared);
    return w.domain.guarded(where, f);
  } else {
    return f();
  }
}

/// A run of n steps, as f() does it on this rank. Afterwards every rank knows all grains. Exceptions end all ranks.
template <class Model, class F>
StepReport run_shared(WorldState<Model>& w, std::uint64_t n, F&& f) {
  check_agreement(w, domain::Call::run, {.asked = n});
  w.domain.moved2_of_all.reset();  // grains may have been moved by hand
  return w.domain.guarded("in a step", [&] {
    StepReport report = f();
    gather_rows(w);
    return report;
  });
}

}  // namespace dem
