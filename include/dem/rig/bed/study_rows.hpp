#pragma once
// What the runs of a study say of a value, in a table, in words and as a file.

#include <dem/io/csv.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/bed/study.hpp>
#include <dem/rig/bed/study_change.hpp>
#include <dem/rig/number.hpp>

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
  BedScatter value = {};     ///< over the seeds
  Change from_as_set = {};   ///< none of runs as set
  double limit = not_known;  ///< %, that the change should be within
};

/// `value_at(run, place)` is NaN where a run has none. `runs` point to what has a Variant as its `variant`. None of a
/// single run.
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
      row.from_as_set = change_of(pairs);
      row.limit = change == "slow" ? value.speed_limit : value.box_limit;
    }
  }
  return rows;
}

/// Means over the seeds, how they scatter, and what is changed.
inline io::Table study_table(const StudiedValue& of, std::span<const StudyRow> rows, std::string caption) {
  io::Table t{
      .caption = std::move(caption),
      .header = {"runs", of.place, "seeds", text("{} [{}]", of.name, of.unit), "±", "deviation of a bed [%]", "pairs",
                 text("change [{}]", of.unit), "±", "change [%]", "±", "told from none", "within the limit"}};
  for (const StudyRow& r : rows) {
    const BedScatter& x = r.value;
    const Change& change = r.from_as_set;
    const bool is_change = !r.change.empty();
    const auto of_change = [&](double value, const char* format) { return is_change ? number(value, format) : ""; };
    t.row(change_text(r.change), of.places[r.place].in_tables, x.beds, number(of.scale * x.mean),
          number(of.scale * x.error()), number(100.0 * x.deviation / std::abs(x.mean), "{:.1f}"),
          is_change ? text("{}", change.pairs) : "", of_change(of.scale * change.value.value, "{:+.2f}"),
          of_change(of.scale * change.value.error, "{:.2f}"), of_change(change.percent.value, "{:+.1f}"),
          of_change(change.percent.error, "{:.1f}"), is_change ? change.is_told() : "",
          is_change ? text("{:g} %: {}", r.limit, change.is_within(r.limit)) : std::string());
  }
  return t;
}
inline constexpr const char* study_text =
    "A change is that of two runs of one seed, and its mean over the seeds. Its ± is the standard error by how the "
    "seeds scatter. With one seed there is none. A change is told from none, or within or beyond its limit, where "
    "Student's t at 95 % decides it.";

/// The spread of the seeds and the verdicts, at the places from the first that is given.
inline std::vector<std::string> study_findings(const StudiedValue& of, std::span<const StudyRow> rows,
                                               std::size_t first_place = 0) {
  std::vector<std::string> list;
  for (const StudyRow& r : rows) {
    if (r.place < first_place) continue;
    if (!r.change.empty()) {
      const std::string what = r.change == "slow" ? "Half the speed" : "A " + change_text(r.change);
      list.push_back(verdict_text(what, of.places[r.place].phrase, r.from_as_set, r.limit));
    } else if (r.value.beds > 1) {
      list.push_back(text("Beds of {} seeds in the box as set deviate by {:.1f} % in {}, {:.2f} ± {:.2f} {}.",
                          r.value.beds, 100.0 * r.value.deviation / std::abs(r.value.mean), of.places[r.place].phrase,
                          of.scale * r.value.mean, of.scale * r.value.error(), of.unit));
    }
  }
  return list;
}

/// Columns in SI units; an empty cell is a value that is not known.
inline void write_study(const std::filesystem::path& path, const StudiedValue& of, std::span<const StudyRow> rows) {
  const std::string& unit = of.si_unit;
  io::CsvWriter csv(
      path, {"runs", of.file_place, "seeds", text("mean_{}_{}", of.name, unit), text("{}_error_{}", of.name, unit),
             "bed_deviation_" + unit, "pairs", "change_" + unit, "change_error_" + unit, "change_percent",
             "change_error_percent", "told_from_none", "limit_percent", "within_limit"});
  const auto cell = [](double value) { return std::isfinite(value) ? text("{}", value) : ""; };
  for (const StudyRow& r : rows) {
    const Change& change = r.from_as_set;
    const bool is_change = !r.change.empty();
    csv.row(change_text(r.change), of.places[r.place].in_files, r.value.beds, cell(r.value.mean), cell(r.value.error()),
            cell(r.value.deviation), change.pairs, cell(change.value.value), cell(change.value.error),
            cell(change.percent.value), cell(change.percent.error), is_change ? change.is_told() : "", cell(r.limit),
            is_change ? change.is_within(r.limit) : "");
  }
  csv.flush();
}

}  // namespace dem::rig
