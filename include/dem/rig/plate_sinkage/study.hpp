#pragma once
// How far the pressure depends on the box, the speed and the seed of the bed, with errors.

#include <dem/io/csv.hpp>
#include <dem/rig/bed/study_change.hpp>
#include <dem/rig/plate_sinkage/tables.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace dem::rig::plate_sinkage {

/// The mean pressure (Pa) under a plate of a run over the second half of its sinkage; of the plate after the last one:
/// the mean of all plates. NaN of a run that has not all it needs.
inline double study_pressure(const VariantResult& v, std::size_t plate) {
  const std::size_t plates = v.variant.settings.widths.size();
  if (v.plates.size() != plates) return not_known;  // it ended early
  if (plate < plates) return mean_pressure(v.plates[plate], v.variant.settings);
  double sum = 0.0;
  for (std::size_t k = 0; k < plates; ++k) sum += study_pressure(v, k);
  return sum / static_cast<double>(plates);
}

/// The runs of all seeds with the box and speed as set, or with one of them changed, under a plate.
struct StudyRow {
  std::string change = {};   ///< of Variant
  double width = not_known;  ///< m; NaN: the mean of all plates
  BedScatter pressure = {};  ///< Pa, over the seeds
  Change from_as_set = {};   ///< of the pressure, Pa; none of runs as set
  double limit = not_known;  ///< %, that the change should be within
};

/// In percent: a larger box is to change the pressure by less, and half the speed.
inline constexpr double box_limit = 5.0, speed_limit = 3.0;

/// What a study changes, in words.
inline std::string change_text(const std::string& change) {
  if (change.empty()) return "as set";
  return change == "slow" ? "half the speed" : change == "wide" ? "bed twice as wide" : "bed twice as deep";
}

/// Each plate of each kind of run, and their mean where there are several plates.
inline std::vector<StudyRow> study_rows(const Campaign& c) {
  std::vector<StudyRow> rows;
  if (c.variants.size() < 2) return rows;
  const Settings& s = c.variants.front().variant.settings;
  const auto run_of = [&](const std::string& change, const std::string& seed) -> const VariantResult* {
    for (const VariantResult& v : c.variants) {
      if (v.variant.change == change && v.variant.seed == seed) return &v;
    }
    return nullptr;
  };
  std::vector<std::string> changes = {""};
  for (const char* change : study_changes) {
    if (run_of(change, "") != nullptr) changes.emplace_back(change);
  }
  const std::size_t plates = s.widths.size();
  for (const std::string& change : changes) {
    for (std::size_t k = 0; k < (plates > 1 ? plates + 1 : plates); ++k) {
      StudyRow& row = rows.emplace_back(StudyRow{.change = change});
      if (k < plates) row.width = s.widths[k];
      std::vector<double> pressures;
      std::vector<AsSetAndChanged> pairs;
      for (const VariantResult& v : c.variants) {
        if (v.variant.change != change) continue;
        const double p = study_pressure(v, k);
        if (!std::isfinite(p)) continue;
        pressures.push_back(p);
        const VariantResult* as_set = run_of("", v.variant.seed);
        const double before = as_set == nullptr ? not_known : study_pressure(*as_set, k);
        if (!change.empty() && std::isfinite(before)) pairs.push_back({before, p});
      }
      row.pressure = scatter_of(pressures);
      if (change.empty()) continue;
      row.from_as_set = change_of(pairs);
      row.limit = change == "slow" ? speed_limit : box_limit;
    }
  }
  return rows;
}

/// Means over the seeds, how they scatter, and what is changed.
inline io::Table study_table(const Campaign& c) {
  io::Table t{.caption =
                  "Mean pressure over the second half of the sinkage: mean over the seeds (± standard error) and "
                  "what the study changes",
              .header = {"runs", "plate [mm]", "seeds", "pressure [kPa]", "±", "deviation of a bed [%]", "pairs",
                         "change [kPa]", "±", "change [%]", "±", "told from none", "within the limit"}};
  for (const StudyRow& r : study_rows(c)) {
    const BedScatter& p = r.pressure;
    const Change& change = r.from_as_set;
    const bool is_change = !r.change.empty();
    const auto of_change = [&](double value, const char* format) { return is_change ? number(value, format) : ""; };
    t.row(change_text(r.change), std::isfinite(r.width) ? number(1e3 * r.width, "{:.0f}") : "mean", p.beds,
          number(1e-3 * p.mean), number(1e-3 * p.error()), number(100.0 * p.deviation / p.mean, "{:.1f}"),
          is_change ? text("{}", change.pairs) : "", of_change(1e-3 * change.value.value, "{:+.2f}"),
          of_change(1e-3 * change.value.error, "{:.2f}"), of_change(change.percent.value, "{:+.1f}"),
          of_change(change.percent.error, "{:.1f}"), is_change ? change.is_told() : "",
          is_change ? text("{:g} %: {}", r.limit, change.is_within(r.limit)) : std::string());
  }
  return t;
}
inline constexpr const char* study_text =
    "A change is that of two runs of one seed, and its mean over the seeds. Its ± is the standard error by how the "
    "seeds "
    "scatter. With one seed there is none. A change is told from none, or within or beyond its limit, where Student's "
    "t "
    "at 95 % decides it. The plates of one bed are not independent of each other.";

/// The spread of the seeds and the verdicts, on the mean of all plates.
inline std::vector<std::string> study_findings(const Campaign& c) {
  std::vector<std::string> list;
  const std::vector<StudyRow> rows = study_rows(c);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const StudyRow& r = rows[k];
    if (k + 1 < rows.size() && rows[k + 1].change == r.change) continue;  // the last one of a kind is that of all
    const std::string of = std::isfinite(r.width) ? "the mean pressure" : "the mean pressure of the plates";
    if (!r.change.empty()) {
      const std::string what = r.change == "slow"   ? "Half the speed"
                               : r.change == "wide" ? "A bed twice as wide"
                                                    : "A bed twice as deep";
      list.push_back(verdict_text(what, of, r.from_as_set, r.limit));
    } else if (r.pressure.beds > 1) {
      list.push_back(text("Beds of {} seeds in the box as set deviate by {:.1f} % in {}, {:.2f} ± {:.2f} kPa.",
                          r.pressure.beds, 100.0 * r.pressure.deviation / r.pressure.mean, of, 1e-3 * r.pressure.mean,
                          1e-3 * r.pressure.error()));
    }
  }
  return list;
}

inline void write_study(const std::filesystem::path& path, const Campaign& c) {
  io::CsvWriter csv(path, {"runs", "plate_m", "seeds", "mean_pressure_Pa", "pressure_error_Pa", "bed_deviation_Pa",
                           "pairs", "change_Pa", "change_error_Pa", "change_percent", "change_error_percent",
                           "told_from_none", "limit_percent", "within_limit"});
  const auto cell = [](double value) { return std::isfinite(value) ? text("{}", value) : ""; };
  for (const StudyRow& r : study_rows(c)) {
    const Change& change = r.from_as_set;
    const bool is_change = !r.change.empty();
    csv.row(change_text(r.change), cell(r.width), r.pressure.beds, cell(r.pressure.mean), cell(r.pressure.error()),
            cell(r.pressure.deviation), change.pairs, cell(change.value.value), cell(change.value.error),
            cell(change.percent.value), cell(change.percent.error), is_change ? change.is_told() : "", cell(r.limit),
            is_change ? change.is_within(r.limit) : "");
  }
  csv.flush();
}

}  // namespace dem::rig::plate_sinkage
