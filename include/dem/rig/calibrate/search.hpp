#pragma once
// Where the constants are that measurements ask for, how sure that is, and where to try next.

#include <dem/math/solve_positive.hpp>
#include <dem/rig/calibrate/surrogate.hpp>
#include <dem/terramechanics/confidence.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace dem::rig::calibrate {

/// Number `index` (from 1) of the even spread of numbers in [0, 1) that J. H. Halton found (1960), for a prime base.
inline double halton(std::size_t index, unsigned base) {
  double value = 0.0, share = 1.0;
  for (; index > 0; index /= base) {
    share /= base;
    value += share * static_cast<double>(index % base);
  }
  return value;
}

/// One measured quantity over the places that were tried. Values that are not finite are runs that failed.
struct Measurements {
  std::size_t dimensions = 1;
  std::vector<double> places = {};               ///< of the unit cube, one after the other
  std::vector<std::vector<double>> values = {};  ///< of each quantity, as many as there are places
};

/// What each quantity shall be.
struct Goal {
  double value, error;  ///< with its standard error
  double runs = 0.0;    ///< that it is the mean of; 0: it was given
  /// Standard error where one run scatters by so much. Few runs that happen to be close to each other are no better
  /// than that says.
  [[nodiscard]] double error_with(double scatter) const {
    return runs > 0.0 ? std::max(error, scatter / std::sqrt(runs)) : error;
  }
  /// Degrees of freedom of that error, where the scatter has so many.
  [[nodiscard]] double freedom_with(double scatter, double of_scatter) const {
    return runs > 1.0 && error > scatter / std::sqrt(runs) ? runs - 1.0 : of_scatter;
  }
};

/// Finds the least value of a function over the unit cube. `start` is where it begins.
using Minimise = std::vector<double>(double (*function)(const double* x, const void* data), const void* data,
                                     const std::vector<double>& start);

/// The constants that fit the goals best.
struct Found {
  std::vector<double> place = {};  ///< in the unit cube
  std::vector<double> error = {};  ///< standard errors there; infinite where the goals do not determine a constant
  std::size_t freedom = 0;         ///< of the errors
  std::vector<double> low = {}, high = {};  ///< in the unit cube: between these places runs were tried
  std::vector<double> other = {};           ///< a place apart from this one that fits as well; empty: none is known
  /// Whether the place lies where nothing was tried: the surfaces are extrapolated there.
  [[nodiscard]] bool is_beyond(std::size_t k) const { return place[k] < low[k] - 1e-6 || place[k] > high[k] + 1e-6; }
  [[nodiscard]] bool is_beyond() const {
    for (std::size_t k = 0; k < place.size(); ++k) {
      if (is_beyond(k)) return true;
    }
    return false;
  }
  std::vector<Surrogate> surrogates = {};
};

namespace detail {

struct Misfit {
  const std::vector<Surrogate>* surrogates;
  std::span<const Goal> goals;
  std::vector<double> low, high;  // of the box that is looked through

  [[nodiscard]] std::vector<double> place(const double* x) const {
    std::vector<double> at(low.size());
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = low[k] + x[k] * (high[k] - low[k]);
    return at;
  }
};

/// Squares of what the surrogates miss the goals by, over their variances. `x` is a share of the box.
inline double misfit(const double* x, const void* data) {
  const auto& m = *static_cast<const Misfit*>(data);
  const std::vector<double> place = m.place(x);
  double sum = 0.0;
  for (std::size_t q = 0; q < m.goals.size(); ++q) {
    const double rest = (*m.surrogates)[q].value(place) - m.goals[q].value, scatter = (*m.surrogates)[q].scatter();
    const double of_goal = m.goals[q].error_with(scatter);
    sum += rest * rest / std::max(1e-300, of_goal * of_goal + scatter * scatter);
  }
  return sum;
}

inline std::size_t distinct_places(const std::vector<double>& places, std::size_t d) {
  std::size_t count = 0;
  for (std::size_t i = 0; i * d < places.size(); ++i) {
    bool is_new = true;
    for (std::size_t j = 0; j < i && is_new; ++j) {
      is_new = !std::equal(places.begin() + static_cast<std::ptrdiff_t>(i * d),
                           places.begin() + static_cast<std::ptrdiff_t>((i + 1) * d),
                           places.begin() + static_cast<std::ptrdiff_t>(j * d));
    }
    count += is_new ? 1 : 0;
  }
  return count;
}

/// Whether places are so far from each other that they are two answers.
inline bool are_apart(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (std::abs(a[k] - b[k]) > 0.02) return true;
  }
  return false;
}

/// Looks for the place of the least misfit: that between the tried points goes before another that fits as well.
inline void find_place(Found& found, std::span<const Goal> goals, Minimise* minimise) {
  const std::size_t d = found.low.size();
  const std::vector<double> middle(d, 0.5);
  const Misfit whole{&found.surrogates, goals, std::vector<double>(d, 0.0), std::vector<double>(d, 1.0)};
  const Misfit tried{&found.surrogates, goals, found.low, found.high};
  found.place = minimise(&misfit, &whole, middle);
  const double least = misfit(found.place.data(), &whole);
  if (found.is_beyond()) {
    const std::vector<double> x = minimise(&misfit, &tried, middle), within = tried.place(x.data());
    if (misfit(x.data(), &tried) <= least + 1e-3 && are_apart(within, found.place)) {
      found.other = found.place;
      found.place = within;
    }
  }
  if (d != 1 || !found.other.empty()) return;
  // A parabola may cross its target twice.
  constexpr int steps = 1000;
  const auto at = [&](int k) {
    const double x = static_cast<double>(k) / steps;
    return misfit(&x, &whole);
  };
  for (int k = 1; k < steps; ++k) {
    const std::vector<double> x = {static_cast<double>(k) / steps};
    if (at(k) > at(k - 1) || at(k) > at(k + 1) || at(k) > least + 1.0 || !are_apart(x, found.place)) continue;
    if (found.other.empty() || at(k) < misfit(found.other.data(), &whole)) found.other = x;
  }
}

}  // namespace detail

/// Surfaces through the measurements, and the constants at which they are nearest to the goals; those between the
/// tried points go before others that fit as well. Errors are those of the surfaces and of the goals, carried over by
/// the surfaces' slopes. Throws Error for too few measurements.
inline Found find_constants(const Measurements& m, std::span<const Goal> goals, Minimise* minimise) {
  Found found;
  const std::size_t d = m.dimensions;
  found.low.assign(d, 1.0);
  found.high.assign(d, 0.0);
  for (const auto& values : m.values) {
    std::vector<double> places, known;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) continue;
      places.insert(places.end(), m.places.begin() + static_cast<std::ptrdiff_t>(i * d),
                    m.places.begin() + static_cast<std::ptrdiff_t>((i + 1) * d));
      known.push_back(values[i]);
      for (std::size_t k = 0; k < d; ++k) {
        found.low[k] = std::min(found.low[k], m.places[i * d + k]);
        found.high[k] = std::max(found.high[k], m.places[i * d + k]);
      }
    }
    found.surrogates.emplace_back(places, known, d, detail::distinct_places(places, d));
  }
  detail::find_place(found, goals, minimise);
  // (G^T W G)^-1, and the least freedom of surfaces and goals together (Welch and Satterthwaite).
  std::vector<double> information(d * d, 0.0);
  found.freedom = found.surrogates.front().freedom();
  for (std::size_t q = 0; q < goals.size(); ++q) {
    const auto slopes = found.surrogates[q].gradient(found.place);
    const double error = found.surrogates[q].error(found.place);
    const double of_goal = goals[q].error_with(found.surrogates[q].scatter());
    const double weight = 1.0 / std::max(1e-300, error * error + of_goal * of_goal);
    for (std::size_t a = 0; a < d; ++a) {
      for (std::size_t b = 0; b < d; ++b) information[a * d + b] += weight * slopes[a] * slopes[b];
    }
    const auto of_surface = static_cast<double>(found.surrogates[q].freedom());
    const double e = error * error, g = of_goal * of_goal;
    const double spread = e * e / of_surface + g * g / goals[q].freedom_with(found.surrogates[q].scatter(), of_surface);
    const double both = spread > 0.0 ? std::clamp((e + g) * (e + g) / spread, 1.0, of_surface) : of_surface;
    found.freedom = std::min(found.freedom, static_cast<std::size_t>(both));
  }
  std::vector<double> factor = information;
  factorise_positive(factor, d, 1e-9);
  bool is_determined = true;
  for (std::size_t a = 0; a < d; ++a) is_determined = is_determined && factor[a * d + a] > 0.0;
  for (std::size_t a = 0; a < d; ++a) {
    std::vector<double> matrix = information, unit(d, 0.0);
    unit[a] = 1.0;
    solve_positive(matrix, unit);
    found.error.push_back(is_determined ? std::sqrt(unit[a]) : std::numeric_limits<double>::infinity());
  }
  return found;
}

/// Place number `index` (from 0) to try: the first ones are spread over the cube, later ones about what was found so
/// far, within three standard errors and at least a fifth of the cube each way, so that the surfaces know their slopes
/// there.
inline std::vector<double> next_place(std::size_t index, std::size_t dimensions, const std::optional<Found>& found) {
  static constexpr unsigned primes[] = {2, 3, 5, 7};
  std::vector<double> place(dimensions);
  for (std::size_t k = 0; k < dimensions; ++k) {
    const double even = halton(index + 1, primes[k]);
    if (!found) {
      place[k] = even;
      continue;
    }
    const double reach = std::clamp(3.0 * found->error[k], 0.2, 0.5);
    const double middle = std::clamp(found->place[k], reach, 1.0 - reach);
    place[k] = std::clamp(middle + (2.0 * even - 1.0) * reach, 0.0, 1.0);
  }
  return place;
}

}  // namespace dem::rig::calibrate
