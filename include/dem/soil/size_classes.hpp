#pragma once

#include <dem/soil/size_distribution.hpp>
#include <dem/world/mixture.hpp>
#include <dem/world/options.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace dem::soil {

/// Grains of about one size.
struct SizeClass {
  double size;      ///< m
  double number;    ///< share of all grains
  double mass;      ///< share of the mass of all grains
  double from, to;  ///< m, the sizes that it stands for
};

/// Cuts a distribution into n classes of equal shares, of number or of mass, as it counts. The size of a class is the
/// one with which it has both the number and the mass of the grains that it stands for (the cube root of their mean
/// cube), so the number and the mass of all grains are those of the distribution, whatever n is. Other moments err by
/// about 1/n^2: of a lognormal one with a geometric deviation of 1.5, eight classes have the mean diameter to 0.3 %.
/// Throws Error unless n is from 1 to 1000.
inline std::vector<SizeClass> size_classes(const SizeDistribution& d, std::size_t n) {
  if (n < 1 || n > 1000) fail("a distribution of sizes is cut into {} classes, but must be into 1 to 1000", n);
  const bool by_number = d.counted() == Counted::by_number;
  std::vector<SizeClass> classes;
  double numbers = 0.0, masses = 0.0;
  double from = d.low();
  for (std::size_t k = 1; k <= n; ++k) {
    const double to = k == n ? d.high() : d.size_at(static_cast<double>(k) / static_cast<double>(n));
    const double share = d.share_below(to) - d.share_below(from);
    if (!(share > 0.0)) continue;
    const double other = d.moment(by_number ? 3.0 : -3.0, from, to);
    const double number = by_number ? share : other, volume = by_number ? other : share;
    classes.push_back({std::cbrt(volume / number), number, volume, from, to});
    numbers += number, masses += volume;
    from = to;
  }
  for (SizeClass& c : classes) c.number /= numbers, c.mass /= masses;
  return classes;
}

/// Gives a world a species for each of n classes of a distribution, and returns them as a mixture by mass:
/// `shape_of(size)` makes the shape of a grain of that size (m).
///
///     const auto sand = soil::add_sizes(world, soil::SizeDistribution::lognormal(2e-3, 1.3, soil::Counted::by_mass),
///     6,
///                                       [](double d) { return shape::Sphere(0.5 * d); });
template <class World, class ShapeOf>
Mixture add_sizes(World& world, const SizeDistribution& d, std::size_t n, ShapeOf&& shape_of,
                  const SpeciesOptions& o = {}) {
  Mixture mixture;
  for (const SizeClass& c : size_classes(d, n)) {
    mixture.parts.push_back({world.add_species(shape_of(c.size), o), c.mass});
  }
  return mixture;
}

}  // namespace dem::soil
