#pragma once

#include <dem/soil/container.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace dem::soil {

/// A slice of a bed.
struct SolidLayer {
  double from, to;  ///< m, heights
  double fraction;  ///< solid volume by bulk volume
};

/// The share of a ball that lies below a height `h` (in radii, from its middle).
inline double share_below(double h) {
  const double t = std::clamp(h, -1.0, 1.0) + 1.0;
  return 0.25 * t * t * (3.0 - t);
}

/// Solid volume (m^3) of all grains of a world.
template <class World>
double solid_volume(const World& world) {
  double sum = 0.0;
  for (const GrainId p : world.grains()) sum += world.species(world.species_of(p)).shape.volume();
  return sum;
}

/// Solid fractions of a bed by depth, in layers of this thickness (m) from the floor up to `top` (m); the last may be
/// thinner. A grain that a border cuts counts as a ball of its volume; one whose centre is outside the container does
/// not count. Layers reach to the walls, which loosen what lies beside them. Throws Error for a thickness and a top
/// that are not positive.
template <class World>
std::vector<SolidLayer> solid_layers(const World& world, const Container& c, double thickness, double top) {
  require_positive(thickness, "thickness of a layer", "m");
  require_positive(top, "height up to which a bed is cut into layers", "m");
  std::vector<SolidLayer> layers;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(top / thickness - 1e-9)));
  for (std::size_t k = 0; k < count; ++k) {
    const double from = static_cast<double>(k) * thickness;
    layers.push_back({from, std::min(from + thickness, top), 0.0});
  }
  for (const GrainId p : world.grains()) {
    if (c.clearance(world.position(p)) < 0.0) continue;
    const double volume = world.species(world.species_of(p)).shape.volume(), z = world.position(p).z();
    const double radius = std::cbrt(0.75 / std::numbers::pi * volume);
    const auto first = static_cast<std::size_t>(std::clamp((z - radius) / thickness, 0.0, static_cast<double>(count)));
    for (std::size_t k = first; k < count && layers[k].from < z + radius; ++k) {
      const double share = share_below((layers[k].to - z) / radius) - share_below((layers[k].from - z) / radius);
      layers[k].fraction += share * volume;
    }
  }
  for (SolidLayer& layer : layers) layer.fraction /= c.volume(layer.to) - c.volume(layer.from);
  return layers;
}

/// Solid fraction of a bed between two heights (m) above the floor, by the same rules. Throws Error unless the second
/// is above the first and above the floor.
template <class World>
double solid_fraction_between(const World& world, const Container& c, double low, double high) {
  if (!(high > low && high > 0.0 && std::isfinite(low) && std::isfinite(high))) {
    fail(
        "the solid fraction between the heights {:g} and {:g} m was asked for; the second must be above the first and "
        "above the floor, 0",
        low, high);
  }
  double solid = 0.0;
  for (const GrainId p : world.grains()) {
    if (c.clearance(world.position(p)) < 0.0) continue;
    const double volume = world.species(world.species_of(p)).shape.volume(), z = world.position(p).z();
    const double radius = std::cbrt(0.75 / std::numbers::pi * volume);
    solid += volume * (share_below((high - z) / radius) - share_below((low - z) / radius));
  }
  return solid / (c.volume(high) - c.volume(low));
}

}  // namespace dem::soil
