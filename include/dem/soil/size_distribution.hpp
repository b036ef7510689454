#pragma once

#include <dem/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

// Sizes of grains. A size is a diameter in m: of a sphere, of the mesh of a sieve, or of what else a program makes of
// it. A world knows sizes as species (see size_classes.hpp).

namespace dem::soil {

/// Whether a distribution counts grains or weighs them. A sieve weighs; photographs count.
enum class Counted { by_number, by_mass };

/// The part of the sizes that is kept, in m; 0: see each distribution.
struct SizeLimits {
  double low = 0.0, high = 0.0;
};

/// A point of a sieve curve: the share of the mass that passes a mesh of this width (m).
struct Passing {
  double size, share;
};

namespace detail {

/// Of the standard normal distribution.
inline double normal_share_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

}  // namespace detail

/// A distribution of sizes between two limits. All are cut at both ends: an unbounded one would need a grain of every
/// size, and a world pays for its largest and its smallest grains.
class SizeDistribution {
 public:
  /// Evenly between two sizes. Throws Error unless 0 < low < high.
  static SizeDistribution uniform(double low, double high, Counted by = Counted::by_number) {
    return {Kind::uniform, by, low, high, {low, high}};
  }
  /// Normal, cut at the limits; those that are 0 stand three deviations from the mean. Throws Error if the lower limit
  /// is not positive, and for a deviation that is not.
  static SizeDistribution normal(double mean, double deviation, Counted by = Counted::by_number, SizeLimits cut = {}) {
    require_positive(deviation, "standard deviation of a size", "m");
    return {Kind::normal, by, mean, deviation, limits(cut, mean - 3.0 * deviation, mean + 3.0 * deviation)};
  }
  /// Normal in the logarithm: half is smaller than the median, and 68 % lie within a factor of `geometric_deviation`
  /// (more than 1) of it. Limits that are 0 stand three geometric deviations away.
  static SizeDistribution lognormal(double median, double geometric_deviation, Counted by = Counted::by_number,
                                    SizeLimits cut = {}) {
    require_positive(median, "median size", "m");
    if (!(geometric_deviation > 1.0) || !(geometric_deviation < 1e3)) {
      fail("geometric standard deviation of a size is {:g}, but must be greater than 1 (1.3: a well sorted sand)",
           geometric_deviation);
    }
    const double factor = std::pow(geometric_deviation, 3.0);
    return {Kind::lognormal, by, std::log(median), std::log(geometric_deviation),
            limits(cut, median / factor, median * factor)};
  }
  /// Weibull (by mass: Rosin-Rammler), a share of 1 - exp(-(d/scale)^shape) is smaller than d. Limits that are 0 cut
  /// off 1/1000 at each end.
  static SizeDistribution weibull(double scale, double shape, Counted by = Counted::by_mass, SizeLimits cut = {}) {
    require_positive(scale, "scale of a size", "m");
    require_within(shape, 0.1, 100.0, "shape of a Weibull distribution");
    const auto size_at = [&](double share) { return scale * std::pow(-std::log1p(-share), 1.0 / shape); };
    return {Kind::weibull, by, scale, shape, limits(cut, size_at(1e-3), size_at(1.0 - 1e-3))};
  }
  /// From a sieve analysis: shares of the mass that pass, ascending from 0 to 1 (or to 100, in percent), straight lines
  /// over the logarithm of the size between. Throws Error unless sizes and shares ascend.
  static SizeDistribution sieve_curve(std::vector<Passing> curve) {
    if (curve.size() < 2) fail("a sieve curve has {} points, but needs two or more", curve.size());
    const double first = curve.front().share, all = curve.back().share;
    if (first != 0.0 || (all != 1.0 && all != 100.0)) {
      fail("a sieve curve begins with a share of {:g} and ends with {:g}, but must go from 0 to 1 or to 100", first,
           all);
    }
    for (std::size_t k = 0; k < curve.size(); ++k) {
      curve[k].share /= all;
      if (k > 0 && !(curve[k].size > curve[k - 1].size && curve[k].share >= curve[k - 1].share)) {
        fail("a sieve curve goes from {:g} of {:g} m to {:g} of {:g} m, but sizes and shares must ascend",
             curve[k - 1].share, curve[k - 1].size, curve[k].share, curve[k].size);
      }
    }
    SizeDistribution d(Kind::sieve, Counted::by_mass, 0.0, 0.0, {curve.front().size, curve.back().size});
    d.curve_ = std::move(curve);
    return d;
  }

  Counted counted() const { return by_; }
  double low() const { return cut_.low; }    ///< m, the smallest size
  double high() const { return cut_.high; }  ///< m, the largest size

  /// The share of grains, or of mass, below a size (m).
  double share_below(double d) const {
    if (!(d > cut_.low)) return 0.0;
    if (d >= cut_.high) return 1.0;
    return (uncut(d) - below_) / (above_ - below_);
  }
  /// The size (m) below which a share lies: the inverse of share_below, by halving.
  double size_at(double share) const {
    require_within(share, 0.0, 1.0, "share of grains below a size");
    double low = cut_.low, high = cut_.high;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      if (!(middle > low && middle < high)) break;
      (share_below(middle) < share ? low : high) = middle;
    }
    return share_below(low) >= share ? low : high;
  }
  /// The integral of d^power over the distribution from one size to another (m^power): for the powers 0 to 3, the share
  /// and the moments of the grains between, counted as the distribution counts.
  double moment(double power, double from, double to) const {
    from = std::clamp(from, cut_.low, cut_.high), to = std::clamp(to, cut_.low, cut_.high);
    if (!(to > from)) return 0.0;
    // By parts, with s = ln d: [d^p F] - p times the integral of d^p F over s, where F is smooth but for a sieve's
    // corners. Gauss's three points on 256 pieces.
    constexpr double node = 0.7745966692414834;  // sqrt(3/5)
    constexpr int pieces = 256;
    double sum = 0.0;
    const double start = std::log(from), step = (std::log(to) - start) / pieces;
    const auto f = [&](double s) { return std::exp(power * s) * share_below(std::exp(s)); };
    for (int k = 0; k < pieces; ++k) {
      const double middle = start + (k + 0.5) * step;
      sum +=
          step / 18.0 * (5.0 * f(middle - 0.5 * step * node) + 8.0 * f(middle) + 5.0 * f(middle + 0.5 * step * node));
    }
    return std::pow(to, power) * share_below(to) - std::pow(from, power) * share_below(from) - power * sum;
  }

 private:
  enum class Kind { uniform, normal, lognormal, weibull, sieve };

  SizeDistribution(Kind kind, Counted by, double a, double b, SizeLimits cut)
      : kind_(kind), by_(by), a_(a), b_(b), cut_(cut) {
    if (!(cut.low > 0.0) || !(cut.high > cut.low) || !(cut.high < 1e300)) {
      fail("sizes go from {:g} to {:g} m, but must be positive and ascend; give other limits or a smaller deviation",
           cut.low, cut.high);
    }
    if (kind == Kind::sieve) return;
    below_ = uncut(cut.low), above_ = uncut(cut.high);
    if (!(above_ > below_)) fail("no grain of a distribution lies between {:g} and {:g} m", cut.low, cut.high);
  }
  static SizeLimits limits(SizeLimits given, double low, double high) {
    return {given.low == 0.0 ? low : given.low, given.high == 0.0 ? high : given.high};
  }
  /// The share below a size before the ends are cut off.
  double uncut(double d) const {
    switch (kind_) {
      case Kind::uniform: return (d - a_) / (b_ - a_);
      case Kind::normal: return detail::normal_share_below((d - a_) / b_);
      case Kind::lognormal: return detail::normal_share_below((std::log(d) - a_) / b_);
      case Kind::weibull: return -std::expm1(-std::pow(d / a_, b_));
      case Kind::sieve: break;
    }
    const auto next = std::upper_bound(curve_.begin() + 1, curve_.end() - 1, d,
                                       [](double size, const Passing& p) { return size < p.size; });
    const Passing &p = *(next - 1), &q = *next;
    return p.share + (q.share - p.share) * std::log(d / p.size) / std::log(q.size / p.size);
  }

  Kind kind_;
  Counted by_;
  double a_, b_;
  SizeLimits cut_;
  double below_ = 0.0, above_ = 1.0;  // uncut shares at the limits
  std::vector<Passing> curve_;
};

}  // namespace dem::soil
