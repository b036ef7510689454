#pragma once
// What the runs of a study say of a value, in a table, in words and as a file.

#include <dem/io/csv.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/bed/study.hpp>
#include <dem/rig/bed/study_change.hpp>
#include <dem/rig/number.hpp>
#include <dem/rig/scatter.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig {

/// The value that a study looks at, at one or more places of a run (under each plate, at each slip).
struct StudiedValue {
  struct Place {
    std::string in_tables, in_files;
    std::string phrase;  ///< of the value there: "the mean pressure of the plates"
  };
  std::string name;                                       ///< of the value: "pressure"
  std::string unit;                                       ///< of tables: "kPa"
  double scale = 1.0;                                     ///< of this unit to that of files: 1e-3
  std::string si_unit;                                    ///< of files: "Pa"
  std::string place;                                      ///< what a place is, in tables: "plate [mm]"
  std::string file_place;                                 ///< the same in files: "plate_m"
  double box_limit = not_known, speed_limit = not_known;  ///< %, that a change should be within
  std::vector<Place> places = {};

  void add_place(std::string in_tables, std::string in_files, std::string phrase) {
    places.push_back({std::move(in_tables), std::move(in_files), std::move(phrase)});
  }
};

/// The runs of all seeds with the box and speed as set, or with one of them changed, at a place.
struct StudyRow {
  std::string change = {};   ///< of Variant
  std::size_t place = 0;     ///< of StudiedValue
  Scatter value = {};        ///< over the seeds
  Change from_as_set = {};   ///< none of runs as set
  double limit = not_known;  ///< %, that the change should be within
};

/// `value_at(run, place)` is NaN where a run has none. `runs` point to what has a Variant as its `variant`. Empty where
/// there is one run.
template <class Run, class ValueAt>
std::vector<StudyRow> study_rows(std::span<const Run* const> runs, const StudiedValue& value, ValueAt&& value_at) {
  std::vector<StudyRow> rows;
  if (runs.size() < 2) return rows;
  const auto run_of = [&](const std::string& change, const std::string& seed) -> const Run* {
    for (const Run* r : runs) {
      if (r->variant.change == change && r->variant.seed == seed) return r;
    }
    return nullptr;
  };
  std::vector<std::string> changes = {""};
  for (const char* change : study_changes) {
    if (run_of(change, "") != nullptr) changes.emplace_back(change);
  }
  for (const std::string& change : changes) {
    for (std::size_t k = 0; k < value.places.size(); ++k) {
      StudyRow& row = rows.emplace_back(StudyRow{.change = change, .place = k});
      std::vector<double> values;
      std::vector<AsSetAndChanged> pairs;
      for (const Run* r : runs) {
        const double x = r->variant.change == change ? value_at(*r, k) : not_known;
        if (!std::isfinite(x)) continue;
        values.push_back(x);
        const Run* as_set = run_of("", r->variant.seed);
        const double before = as_set == nullptr ? not_known : value_at(*as_set, k);
        if (!change.empty() && std::isfinite(before)) pairs.push_back({before, x});
      }
      if (!values.empty()) row.value = scatter_of(values);
      if (change.empty()) continue;
      row.from_as_set = Change(std::move(pairs));
      row.limit = change == "slow" ? value.speed_limit : value.box_limit;
    }
  }
  return rows;
}

/// Means over the seeds, how they scatter, and what is changed, if anything is.
inline io::Table study_table(const StudiedValue& of, std::span<const StudyRow> rows, std::string caption) {
  io::Table t{.caption = std::move(caption),
              .header = {"runs", of.place, "seeds", text("{} [{}]", of.name, of.unit), "±",
                         text("deviation of a bed [{}]", of.unit)}};
  const bool any_change = std::any_of(rows.begin(), rows.end(), [](const StudyRow& r) { return !r.change.empty(); });
  if (any_change) {
    t.header.insert(t.header.end(), {"pairs", text("change [{}]", of.unit), "±", "change [%]", "±", "told from none",
                                     "within the limit"});
  }
  for (const StudyRow& r : rows) {
    const Scatter& x = r.value;
    std::vector<std::string> row{change_text(r.change),        of.places[r.place].in_tables,
                                 text("{}", x.count),          number(of.scale * x.mean),
                                 number(of.scale * x.error()), number(of.scale * x.deviation)};
    if (!r.change.empty()) {
      const Change& c = r.from_as_set;
      const ValueAndError value = c.value(), percent = c.percent();
      row.insert(row.end(),
                 {text("{}", c.pairs()), number(of.scale * value.value, "{:+.2f}"), number(of.scale * value.error),
                  number(percent.value, "{:+.1f}"), number(percent.error, "{:.1f}"), c.is_told(),
                  text("{:g} %: {}", r.limit, c.is_within(r.limit))});
    }
    row.resize(t.header.size());
    t.rows.push_back(std::move(row));
  }
  return t;
}
inline constexpr const char* study_text =
    "A change is that of two runs of one seed, in the mean over the seeds. Its ± is the standard error by how the "
    "seeds scatter. With one seed there is none. In percent it is that change over the mean as set, if that is told "
    "from zero. A change is told from none, or within or beyond its limit, where Student's t at 95 % decides it.";

/// The spread of the seeds and the verdicts, at `first_place` and the places after it.
inline std::vector<std::string> study_findings(const StudiedValue& of, std::span<const StudyRow> rows,
                                               std::size_t first_place = 0) {
  std::vector<std::string> list;
  for (const StudyRow& r : rows) {
    if (r.place < first_place) continue;
    const std::string& phrase = of.places[r.place].phrase;
    if (!r.change.empty()) {
      const std::string what = r.change == "slow" ? "Half the speed" : "A " + change_text(r.change);
      list.push_back(verdict_text(what, phrase, r.from_as_set, r.limit, of.unit, of.scale));
    } else if (r.value.count > 1) {
      list.push_back(text("Beds of {} seeds in the box as set deviate by {:.2f} {} in {}, {:.2f} ± {:.2f} {}.",
                          r.value.count, of.scale * r.value.deviation, of.unit, phrase, of.scale * r.value.mean,
                          of.scale * r.value.error(), of.unit));
    }
  }
  return list;
}

/// Columns in SI units; an empty cell is what is not known.
inline void write_study(const std::filesystem::path& path, const StudiedValue& of, std::span<const StudyRow> rows) {
  const std::string& unit = of.si_unit;
  io::CsvWriter csv(
      path, {"runs", of.file_place, "seeds", text("mean_{}_{}", of.name, unit), text("{}_error_{}", of.name, unit),
             "bed_deviation_" + unit, "pairs", "change_" + unit, "change_error_" + unit, "change_percent",
             "change_error_percent", "told_from_none", "limit_percent", "within_limit"});
  for (const StudyRow& r : rows) {
    const Change& c = r.from_as_set;
    const ValueAndError value = c.value(), percent = c.percent();
    const bool is_known = c.pairs() > 1;
    csv.row(change_text(r.change), of.places[r.place].in_files, r.value.count, cell(r.value.mean),
            cell(r.value.error()), cell(r.value.deviation), c.pairs(), cell(value.value), cell(value.error),
            cell(percent.value), cell(percent.error), is_known ? c.is_told() : "", cell(r.limit),
            is_known ? c.is_within(r.limit) : "");
  }
  csv.flush();
}

}  // namespace dem::rig
