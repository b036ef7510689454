#pragma once

#include "catch.hpp"

#include <dem/law/state.hpp>

#include <array>
#include <bit>
#include <random>

// The laws' structs are nothing but numbers, so a test can fill and compare them field by field.

template <class Struct>
auto fields_of(const Struct& s) {
  if constexpr (std::is_empty_v<Struct>) {
    return std::array<double, 0>{};
  } else {
    return std::bit_cast<std::array<double, sizeof(Struct) / sizeof(double)>>(s);
  }
}

/// The struct of packs whose lane k holds the k-th of the structs.
template <class Packed, class Struct>
Packed packed(const std::array<Struct, static_cast<std::size_t>(dem::pack_width)>& lanes) {
  Packed result{};
  if constexpr (!std::is_empty_v<Packed>) {
    std::array<dem::Pack, sizeof(Packed) / sizeof(dem::Pack)> packs;
    for (std::size_t f = 0; f < packs.size(); ++f) {
      packs[f] = dem::generate([&](int k) { return fields_of(lanes[static_cast<std::size_t>(k)])[f]; });
    }
    result = std::bit_cast<Packed>(packs);
  }
  return result;
}

/// Every lane of a pack gets what a double gets: `force(parameters, state, history)` is called with packs and with each
/// lane's doubles, ten times over so that histories build up. `state_of(uniform)` makes a random state, where
/// uniform(low, high) is a random number. Fused multiply-adds and the library's vector functions may differ by a few
/// roundings, of the largest of the numbers that come out: 1e-12 is thousands of them.
template <template <class> class Parameters, template <class> class State, template <class> class History, class Force,
          class StateOf>
void check_lanes(const Parameters<double>& p, Force&& force, StateOf&& state_of) {
  using dem::Pack;
  constexpr auto width = static_cast<std::size_t>(dem::pack_width);
  std::mt19937 engine(7);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
  std::array<Parameters<double>, width> constants;
  constants.fill(p);
  for (int trial = 0; trial < 20; ++trial) {
    std::array<State<double>, width> states;
    std::array<History<double>, width> histories = {};
    History<Pack> packed_history = packed<History<Pack>>(histories);
    for (int step = 0; step < 10; ++step) {
      for (auto& s : states) s = state_of(uniform);
      const auto result = force(packed<Parameters<Pack>>(constants), packed<State<Pack>>(states), packed_history);
      const auto packs = std::bit_cast<std::array<Pack, sizeof(result) / sizeof(Pack)>>(result);
      double largest = 0.0, difference = 0.0;
      for (std::size_t k = 0; k < width; ++k) {
        const auto expected = fields_of(force(constants[k], states[k], histories[k]));
        for (std::size_t f = 0; f < expected.size(); ++f) {
          largest = std::max(largest, std::abs(expected[f]));
          difference = std::max(difference, std::abs(dem::lane(packs[f], static_cast<int>(k)) - expected[f]));
        }
      }
      CHECK(difference <= 1e-12 * largest);
    }
  }
}
