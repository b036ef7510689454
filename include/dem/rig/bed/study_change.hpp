#pragma once
// What a study changes in a value, with errors, and what these decide.

#include <dem/core/text.hpp>
#include <dem/rig/number.hpp>
#include <dem/rig/scatter.hpp>
#include <dem/terramechanics/confidence.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig {

/// A value with its standard error; NaN: not known.
struct ValueAndError {
  double value = not_known, error = not_known;
};

/// A value of a run as set, and of the run with its seed whose box or speed a study changes.
struct AsSetAndChanged {
  double as_set = not_known, changed = not_known;
};

/// What a study changes in a value, in pairs of runs of one seed: so what two runs of one seed share does not count as
/// an error. Student's t at 95 % decides, as there are few pairs. One pair has a change, but no error.
class Change {
 public:
  Change() = default;
  explicit Change(std::vector<AsSetAndChanged> pairs) : pairs_(std::move(pairs)) {}

  [[nodiscard]] std::size_t pairs() const { return pairs_.size(); }
  /// The mean of the pairs' changes, with the error by how these scatter.
  [[nodiscard]] ValueAndError value() const { return less_share(0.0); }
  /// That of the mean as set, with the error of a ratio of means (Cochran, Sampling Techniques, 1977, section 6.3). A
  /// mean of the pairs' percentages would be ruled by those whose value as set is small. NaN where the mean as set is
  /// not told from zero: no error says then how far the ratio may be off.
  [[nodiscard]] ValueAndError percent() const {
    const double base = mean_as_set();
    if (pairs_.empty() || base == 0.0) return {};
    const double percent = 100.0 / std::abs(base), change = value().value;
    if (pairs_.size() < 2) return {percent * change, not_known};
    std::vector<double> as_set;
    for (const auto& p : pairs_) as_set.push_back(p.as_set);
    if (!(std::abs(base) > reach() * scatter_of(as_set).error())) return {};
    return {percent * change, percent * less_share(change / base).error};
  }

  /// Whether it is told from none: "yes", "no", or "-" where its error is not known.
  [[nodiscard]] const char* is_told() const {
    if (pairs_.size() < 2) return "-";
    const ValueAndError v = value();
    return std::abs(v.value) > reach() * v.error ? "yes" : "no";
  }
  /// Whether it is smaller than so many percent of the mean as set: "yes", "no", "not told", or "-" where its error is
  /// not known. By the interval of what is beyond that share of each pair's value as set, which holds also where the
  /// mean as set is not told from zero (Fieller, Journal of the Royal Statistical Society B 16, 1954).
  [[nodiscard]] const char* is_within(double limit) const {
    if (pairs_.size() < 2) return "-";
    const double share = 0.01 * limit * (mean_as_set() < 0.0 ? -1.0 : 1.0);
    const ValueAndError above = less_share(share), below = less_share(-share);
    const double a = reach() * above.error, b = reach() * below.error;
    if (above.value + a < 0.0 && below.value - b > 0.0) return "yes";
    return above.value - a > 0.0 || below.value + b < 0.0 ? "no" : "not told";
  }

 private:
  /// Standard errors on either side, within which a mean over the pairs is said to lie.
  [[nodiscard]] double reach() const { return terramechanics::student_t(pairs_.size() - 1); }
  [[nodiscard]] double mean_as_set() const {
    double sum = 0.0;
    for (const auto& p : pairs_) sum += p.as_set;
    return sum / static_cast<double>(pairs_.size());
  }
  /// The mean change less a share of the value as set, pair by pair.
  [[nodiscard]] ValueAndError less_share(double share) const {
    if (pairs_.empty()) return {};
    std::vector<double> rest;
    for (const auto& [as_set, changed] : pairs_) rest.push_back(changed - as_set - share * as_set);
    const Scatter all = scatter_of(rest);
    return {all.mean, all.error()};
  }

  std::vector<AsSetAndChanged> pairs_;
};

/// The verdict on a change in words: what changes which value by how much, whether that is told from none, and whether
/// it is within the `limit` (%) that is asked for. Values times `scale` are in the unit.
inline std::string verdict_text(const std::string& what, const std::string& of, const Change& c, double limit,
                                const std::string& unit, double scale = 1.0) {
  if (c.pairs() == 0) return text("{}: no two runs of one seed came to their end.", what);
  const ValueAndError value = c.value(), percent = c.percent();
  const bool has_percent = std::isfinite(percent.value);
  if (c.pairs() == 1) {
    return text("{} changes {} by {:+.2f} {}{} (one seed). How sure that is, one seed does not tell.", what, of,
                scale * value.value, unit, has_percent ? text(", {:+.1f} %", percent.value) : "");
  }
  const std::string told = c.is_told(), within = c.is_within(limit);
  return text("{} changes {} by {:+.2f} ± {:.2f} {}{} ({} seeds). That is {}told from none, and {} {:g} %.", what, of,
              scale * value.value, scale * value.error, unit,
              has_percent ? text(", {:+.1f} ± {:.1f} %", percent.value, percent.error) : "", c.pairs(),
              told == "yes" ? "" : "not ",
              within == "yes"  ? "within the"
              : within == "no" ? "more than the"
                               : "not told to be within or beyond",
              limit);
}

}  // namespace dem::rig
