#pragma once
// How far the pull depends on the box, the speed and the seed of the bed, with errors.

#include <dem/io/csv.hpp>
#include <dem/rig/bed/study_change.hpp>
#include <dem/rig/rigid_wheel/tables.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace dem::rig::rigid_wheel {

/// The run itself and those of its study.
inline std::vector<const VariantResult*> all_runs(const Campaign& c) {
  std::vector<const VariantResult*> list{&c};
  for (const VariantResult& v : c.study) list.push_back(&v);
  return list;
}

/// Mean pull (N) of the beds in the box as set at a slip, whose run was finished, and how they scatter.
inline BedScatter scatter_of_beds(const Campaign& c, std::size_t slip) {
  std::vector<double> pulls;
  for (const VariantResult* v : all_runs(c)) {
    if (!v->variant.is_of_seed()) continue;
    if (slip < v->slips.size() && v->slips[slip].finished) pulls.push_back(v->slips[slip].pull.mean);
  }
  return scatter_of(pulls);
}

/// What a run of a study changes in the pull (N) at a slip.
inline Change pull_change(const Campaign& c, const VariantResult& v, std::size_t slip) {
  const SlipResult &base = c.slips[slip], &other = v.slips[slip];
  if (&v == &c || !base.finished || !other.finished) return {};
  // In the same bed the errors are those of means in time, else at least what a bed deviates by.
  const double bed = scatter_of_beds(c, slip).deviation;
  const auto with_error = [&](const SlipResult& r) -> ValueAndError {
    if (v.variant.shares_bed()) return {r.pull.mean, r.pull_error};
    return {r.pull.mean, std::isnan(bed) ? bed : std::fmax(r.pull_error, bed)};
  };
  return change_of(with_error(base), with_error(other));
}

inline io::Table study_table(const Campaign& c) {
  io::Table t{
      .caption = "Pull of the run and of its study (± standard error of the mean in time), slip s = 1 - v/(omega r)",
      .header = {"run", "grains", "solid fraction", "rel. density", "slip", "pull [N]", "±", "change [N]", "±",
                 "change [%]", "±", "below 5 %"}};
  for (const VariantResult* v : all_runs(c)) {
    const double density =
        std::isfinite(v->solid_fraction) ? soil::relative_density(v->solid_fraction, soil::cube8_limits) : not_known;
    for (std::size_t k = 0; k < v->slips.size(); ++k) {
      const SlipResult& r = v->slips[k];
      std::vector<std::string> row{v->variant.text,     text("{}", v->grains), number(v->solid_fraction, "{:.3f}"),
                                   number(density),     number(r.slip),        number(r.pull.mean),
                                   number(r.pull_error)};
      const Change change = pull_change(c, *v, k);
      if (v == &c) {
        row.resize(t.header.size());
      } else {
        row.insert(row.end(), {number(change.value.value, "{:+.2f}"), number(change.value.error),
                               number(change.percent.value, "{:+.1f}"), number(change.percent.error, "{:.1f}"),
                               change.is_within(5.0)});
      }
      t.rows.push_back(std::move(row));
    }
  }
  return t;
}
inline constexpr const char* study_text =
    "± of a pull is the standard error of its mean in time, by ten parts of the steady window. A change in "
    "the same bed has these errors. A change with other grains has at least the error of a bed: the standard deviation "
    "between the "
    "seeds in the box as set. 'Below 5 %' says yes or no where the change and two of its errors decide it, else 'not "
    "told'.";

/// Between the beds in the box as set.
inline io::Table beds_table(const Campaign& c) {
  io::Table t{.caption = "Between beds of several seeds, in the box as set, slip s = 1 - v/(omega r)",
              .header = {"slip", "beds", "mean pull [N]", "±", "deviation of a bed [N]", "deviation [%]"}};
  for (std::size_t k = 0; k < c.slips.size(); ++k) {
    const BedScatter b = scatter_of_beds(c, k);
    t.row(number(c.slips[k].slip), b.beds, number(b.mean), number(b.error()), number(b.deviation),
          number(100.0 * b.deviation / std::abs(b.mean), "{:.1f}"));
  }
  return t;
}

/// The tables of a study; none without one.
inline std::vector<io::Table> study_tables(const Campaign& c) {
  std::vector<io::Table> list;
  if (c.study.empty()) return list;
  list.push_back(study_table(c));
  if (c.variant.settings.study != "speed") list.push_back(beds_table(c));
  return list;
}

inline void write_study(const std::filesystem::path& path, const Campaign& c) {
  io::CsvWriter csv(
      path, {"run", "slip_1-v/(omega*r)", "grains", "solid_fraction", "drawbar_pull_N", "pull_error_N", "torque_Nm",
             "sinkage_m", "change_N", "change_error_N", "change_percent", "change_error_percent", "finished"});
  const auto cell = [](double value) { return std::isfinite(value) ? text("{}", value) : ""; };
  for (const VariantResult* v : all_runs(c)) {
    for (std::size_t k = 0; k < v->slips.size(); ++k) {
      const SlipResult& r = v->slips[k];
      const Change change = pull_change(c, *v, k);
      csv.row(v->variant.text, r.slip, v->grains, cell(v->solid_fraction), cell(r.pull.mean), cell(r.pull_error),
              cell(r.torque.mean), cell(r.sinkage.mean), cell(change.value.value), cell(change.value.error),
              cell(change.percent.value), cell(change.percent.error), r.finished);
    }
  }
  csv.flush();
}

}  // namespace dem::rig::rigid_wheel
