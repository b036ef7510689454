#pragma once
// What is said of the rigs of a search: each keeps what its own program has, unless another is given.

#include <dem/rig/bed/small_bed.hpp>
#include <dem/rig/calibrate/trial.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::calibrate {

/// The grains of a rig, and its K over the half-edge that this is for (N/m^2).
struct RigWords {
  std::string words;
  double stiffness_of_size;
  std::string note = {};  ///< of what may spoil what it tells
};

/// The rigs of the targets, in their order.
inline std::vector<RigWords> rigs_of(const Settings& s) {
  const auto constants = constants_of(s);
  Trial middle;
  for (const Constant c : constants) middle.values.push_back(value_at(s, c, 0.5));
  const auto value = [&](Constant c, double held) {
    return std::count(constants.begin(), constants.end(), c) > 0 ? "looked for" : text("{:g}", held);
  };
  std::vector<RigWords> rigs;
  const auto add = [&](const char* rig, const auto& grains, std::string more) {
    rigs.push_back({text("{}: half-edge {:g} mm, friction {}, K {} N/m for half-edge {:g} mm, {}.", rig,
                         1e3 * grains.half_edge, value(Constant::friction, grains.friction),
                         value(Constant::stiffness, grains.stiffness), 1e3 * grains.constants_for, more),
                    grains.stiffness / grains.constants_for});
  };
  const auto dense = [&](double density) { return "relative density " + value(Constant::density, density); };
  bool has_plate = false;
  for (const Quantity q : quantities_of(s)) {
    if (q == Quantity::phi) {
      const auto d = detail::shear_settings(s, middle, s.output);
      add("Shear test", d, dense(d.relative_density));
    } else if (q == Quantity::repose) {
      add("Pile", detail::pile_settings(s, middle, s.output), "of " + s.kind);
    } else if (!std::exchange(has_plate, true)) {
      const auto p = detail::plate_settings(s, middle, s.output);
      const double width = p.widths.front();
      add("Plate", p.grains,
          text("{}; {:g} x {:g} mm of friction {:g}, pressed by {:g} mm into a bed of {:g} x {:g} x {:g} m{}",
               dense(p.bed.relative_density), 1e3 * p.length, 1e3 * width, p.plate_friction, 1e3 * p.sinkage,
               p.bed.length, p.bed.width, p.bed.depth, fall_text(p.bed)));
      rigs.back().note = small_bed_note(width, p.bed.width, p.bed.depth);
    }
  }
  return rigs;
}

/// That the rigs have different stiffnesses; empty where they have one, or where it is looked for.
inline std::string stiffness_note(const Settings& s) {
  const auto constants = constants_of(s);
  if (std::count(constants.begin(), constants.end(), Constant::stiffness) > 0) return {};
  const auto rigs = rigs_of(s);
  const auto [least, most] = std::minmax_element(rigs.begin(), rigs.end(), [](const RigWords& a, const RigWords& b) {
    return a.stiffness_of_size < b.stiffness_of_size;
  });
  if (most->stiffness_of_size <= 1.01 * least->stiffness_of_size) return {};
  return "Note: the rigs have different stiffnesses, each as its own program has it. Give --stiffness and "
         "--constants-for for one of all.";
}

/// That one friction is looked for in grains of two shapes; empty where there is one shape.
inline std::string shape_note(const Settings& s) {
  const auto quantities = quantities_of(s);
  const auto piles = std::count(quantities.begin(), quantities.end(), Quantity::repose);
  if (piles == 0 || piles == static_cast<long>(quantities.size()) || s.kind == "cube8") return {};
  return text(
      "Note: the pile is of {}, the other rigs have cubes of eight spheres: what is found is a compromise between "
      "grains "
      "of two shapes. Give --pile-kind cube8 for one of all.",
      s.kind);
}

/// What the rigs differ in, which one set of constants has to fit.
inline std::vector<std::string> notes_of_differences(const Settings& s) {
  std::vector<std::string> notes{stiffness_note(s), shape_note(s)};
  std::erase(notes, "");
  return notes;
}

}  // namespace dem::rig::calibrate
