#pragma once

#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/core/macros.hpp>
#include <dem/math/random.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dem {

/// What shares of a mixture are counted by.
enum class ShareOf { mass, number };

/// Grains of several species, mixed. Shares need not add up to 1.
///
///     Mixture sand = {{{fine, 0.7}, {coarse, 0.3}}, ShareOf::mass};
struct Mixture {
  struct Part {
    SpeciesId species;
    double share = 1.0;
  };
  std::vector<Part> parts = {};
  ShareOf by = ShareOf::mass;

  Mixture() = default;
  Mixture(SpeciesId species) : parts({{species, 1.0}}) {}  // NOLINT: one species is a mixture
  Mixture(std::vector<Part> p, ShareOf b = ShareOf::mass) : parts(std::move(p)), by(b) {}

  /// Puts `share` of another mixture, and 1 - share of this one, together. Both must count by the same. Throws Error
  /// if they do not, if a mixture is empty, and for a share that is not from 0 to 1.
  Mixture with(double share, const Mixture& other) const;
  /// Of all shares. Throws Error for a share that is negative or not finite, and if none is positive.
  double sum() const;
};

/// Draws grains of a mixture, one after the other, each independent of the others.
class MixtureDraw {
 public:
  MixtureDraw() = default;
  /// `mass_of(species)`: kg, of a grain. Throws Error as Mixture::sum() does.
  template <class MassOf>
  MixtureDraw(const Mixture& m, MassOf&& mass_of) {
    m.sum();
    double total = 0.0;
    for (const Mixture::Part& p : m.parts) {
      const double mass = mass_of(p.species);
      total += m.by == ShareOf::mass ? p.share / mass : p.share;
      species_.push_back(p.species);
      up_to_.push_back(total);
    }
    for (double& share : up_to_) share /= total;
  }
  template <class V>
  void fields(V& v) {
    v.given("species", species_), v.given("share_of_grains_up_to_species", up_to_);
  }
  SpeciesId draw(RandomStream& random) const;

 private:
  std::vector<SpeciesId> species_;
  std::vector<double> up_to_;  // share of the number of grains, of this species and those before
};

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE Mixture Mixture::with(double share, const Mixture& other) const {
  require_within(share, 0.0, 1.0, "share of a mixture in another");
  if (by != other.by) fail("one mixture counts by mass and one by number; give both by the same");
  Mixture both({}, by);
  const double own = sum(), others = other.sum();
  for (const Part& p : parts) both.parts.push_back({p.species, (1.0 - share) * p.share / own});
  for (const Part& p : other.parts) both.parts.push_back({p.species, share * p.share / others});
  return both;
}

DEM_INLINE double Mixture::sum() const {
  double total = 0.0;
  for (const Part& p : parts) total += require_non_negative(p.share, "share of a species in a mixture", "(no unit)");
  if (!(total > 0.0)) fail("a mixture has no grains in it; give it a species with a positive share");
  return total;
}

DEM_INLINE SpeciesId MixtureDraw::draw(RandomStream& random) const {
  const auto at = std::upper_bound(up_to_.begin(), up_to_.end() - 1, random.uniform());
  return species_[static_cast<std::size_t>(at - up_to_.begin())];
}

}  // namespace dem

#endif
