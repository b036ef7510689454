#pragma once

#include <dem/rig/direct_shear/apparatus.hpp>
#include <dem/rig/direct_shear/results.hpp>
#include <dem/rig/stages.hpp>
#include <dem/soil/bulk_density.hpp>

#include <span>

namespace dem::rig::direct_shear {

/// m, from walls, floor, and top or lid: so far away from them density is measured. One and a half edges.
inline double measuring_margin(const Settings& s) { return 3.0 * s.half_edge; }

/// Solid fraction of the inside of a specimen of grains of `volume` (m^3); not known of one that has no inside.
inline double inner_fraction(std::span<const soil::Placement> grains, double volume, const Settings& s,
                             double lid_low = -1.0) {
  return soil::inner_fraction(grains, s.half_edge, volume, s.box_length, s.box_width, measuring_margin(s), lid_low);
}
template <class Model>
double inner_fraction(const Apparatus<Model>& rig, const Settings& s, double lid_low = -1.0) {
  return inner_fraction(soil::placements(rig.world), rig.grain_volume(), s, lid_low);
}

/// Says that a density could not be measured.
inline void warn_of_no_density(const char* where, const Settings& s, Stages& stages) {
  stages.message(
      text("warning: the density {} is not known: the specimen is too small to measure it {:g} mm away from "
           "walls, floor and top; take more --grains or a smaller --half-edge if that matters",
           where, 1e3 * measuring_margin(s)));
}

/// m, how high the solid of the grains would fill the box without gaps.
inline double solid_height(const Settings& s, double grain_volume) {
  return static_cast<double>(s.grains) * grain_volume / s.area();
}

}  // namespace dem::rig::direct_shear
