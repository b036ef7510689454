#pragma once
// What a study changes in a value, with errors, and what these decide.

#include <dem/core/text.hpp>
#include <dem/rig/steady_window.hpp>
#include <dem/terramechanics/confidence.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace dem::rig {

/// A value with its standard error; NaN: not known.
struct ValueAndError {
  double value = std::nan(""), error = std::nan("");
};

/// The mean over beds, and how the beds scatter.
struct BedScatter {
  std::size_t beds = 0;
  double mean = std::nan(""), deviation = std::nan("");  ///< the latter between the beds; NaN of one
  [[nodiscard]] double error() const { return deviation / std::sqrt(static_cast<double>(beds)); }  ///< of the mean
};
inline BedScatter scatter_of(std::span<const double> values) {
  const MeanAndDeviation all = mean_of(values);
  const double n = static_cast<double>(values.size());
  return {values.size(), all.mean, n > 1.0 ? all.deviation * std::sqrt(n / (n - 1.0)) : std::nan("")};
}

/// A value of a run as set, and of the run with its seed whose box or speed a study changes.
struct AsSetAndChanged {
  double as_set = std::nan(""), changed = std::nan("");
};

/// What a study changes in a value.
struct Change {
  std::size_t pairs = 0;     ///< of runs that it was found in; 0: not known
  ValueAndError value = {};  ///< in the unit of the value
  ValueAndError percent = {};
  double reach = 2.0;  ///< standard errors on either side, within which the change is said to lie

  /// Whether it is told from none: "yes", "no", or "-" where its error is not known.
  [[nodiscard]] const char* is_told() const {
    if (!is_known()) return "-";
    return std::abs(percent.value) > reach * percent.error ? "yes" : "no";
  }
  /// Whether it is smaller than so many percent: "yes", "no", "not told", or "-" where its error is not known.
  [[nodiscard]] const char* is_within(double limit) const {
    if (!is_known()) return "-";
    const double size = std::abs(percent.value), spread = reach * percent.error;
    return size + spread < limit ? "yes" : size - spread > limit ? "no" : "not told";
  }
  [[nodiscard]] bool is_known() const { return std::isfinite(percent.value) && std::isfinite(percent.error); }
};

/// Of pairs of runs, each pair of one seed: the change of their mean, with the error by how the pairs scatter. So what
/// two runs of one seed share does not count as an error. In percent it is that of a ratio of means (the residuals'
/// scatter about it; Cochran, Sampling Techniques, 1977, section 6.3): a mean of the pairs' percentages would be ruled
/// by those whose value as set is small. Student's t at 95 % decides, as there are few pairs. One pair has a change,
/// but no error.
inline Change change_of(std::span<const AsSetAndChanged> pairs) {
  if (pairs.empty()) return {};
  const double n = static_cast<double>(pairs.size());
  double as_set = 0.0, changed = 0.0;
  for (const auto& [a, b] : pairs) as_set += a / n, changed += b / n;
  std::vector<double> changes, residuals;
  for (const auto& [a, b] : pairs) changes.push_back(b - a), residuals.push_back(b - changed / as_set * a);
  const BedScatter value = scatter_of(changes);
  return {.pairs = pairs.size(),
          .value = {value.mean, value.error()},
          .percent = {100.0 * value.mean / std::abs(as_set), 100.0 * scatter_of(residuals).error() / std::abs(as_set)},
          .reach = pairs.size() > 1 ? terramechanics::student_t(pairs.size() - 1) : 2.0};
}

/// The verdict on a change in words: what changes which value by how much, whether that is told from none, and whether
/// it is within the `limit` (%) that is asked for.
inline std::string verdict_text(const std::string& what, const std::string& of, const Change& c, double limit) {
  if (c.pairs == 0) return text("{}: no two runs of one seed came to their end.", what);
  if (!c.is_known()) {
    return text("{} changes {} by {:+.1f} % (one seed). How sure that is, one seed does not tell.", what, of,
                c.percent.value);
  }
  const std::string told = c.is_told(), within = c.is_within(limit);
  return text("{} changes {} by {:+.1f} ± {:.1f} % ({} seeds). That is {}told from none, and {} {:g} %.", what, of,
              c.percent.value, c.percent.error, c.pairs, told == "yes" ? "" : "not ",
              within == "yes"  ? "within the"
              : within == "no" ? "more than the"
                               : "not told to be within or beyond",
              limit);
}

}  // namespace dem::rig
