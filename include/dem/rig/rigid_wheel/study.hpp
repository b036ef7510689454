#pragma once
// How far the pull depends on the box, the speed and the seed of the bed, with errors.

#include <dem/io/csv.hpp>
#include <dem/rig/bed/study_rows.hpp>
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

/// At each slip. A larger box is to change it by less than 5 %, and so is half the speed.
inline StudiedValue studied_pull(const Settings& s) {
  StudiedValue of{.name = "pull",
                  .unit = "N",
                  .si_unit = "N",
                  .place = "slip",
                  .file_place = "slip_1-v/(omega*r)",
                  .box_limit = 5.0,
                  .speed_limit = 5.0};
  for (const double slip : s.slips) {
    of.add_place(number(slip), text("{}", slip), text("the pull at slip {:g}", slip));
  }
  return of;
}

/// The mean pull (N) at a slip of a run that was finished, else NaN.
inline double study_pull(const VariantResult& v, std::size_t slip) {
  return slip < v.slips.size() && v.slips[slip].finished ? v.slips[slip].pull.mean : not_known;
}

inline std::vector<StudyRow> study_rows(const Campaign& c) {
  return rig::study_rows<VariantResult>(all_runs(c), studied_pull(c.variant.settings), study_pull);
}

inline constexpr const char* study_caption =
    "Pull: mean over the seeds (± standard error) and what the study changes, slip s = 1 - v/(omega r)";
inline constexpr const char* runs_text =
    "The ± of the pull of one run is the standard error of its mean in time, by ten parts of the steady window. How "
    "far another bed, or the same bed at another moment, would be from it, is not told by that.";

/// Each run of a study by itself.
inline io::Table runs_table(const Campaign& c) {
  io::Table t{.caption = "Runs of the study (± standard error of the mean in time), slip s = 1 - v/(omega r)",
              .header = {"run", "grains", "solid fraction", "rel. density", "slip", "pull [N]", "±", "torque [N m]",
                         "sinkage [mm]", "done"}};
  for (const VariantResult* v : all_runs(c)) {
    const double density = v->variant.settings.grains.relative_density(v->solid_fraction);
    for (const SlipResult& r : v->slips) {
      t.row(v->variant.text, v->grains, number(v->solid_fraction, "{:.3f}"), number(density), number(r.slip),
            number(r.pull.mean), number(r.pull_error), number(r.torque.mean), number(1e3 * r.sinkage.mean, "{:.1f}"),
            r.finished ? "yes" : "no");
    }
  }
  return t;
}

inline void write_runs(const std::filesystem::path& path, const Campaign& c) {
  io::CsvWriter csv(path, {"run", "slip_1-v/(omega*r)", "grains", "solid_fraction", "drawbar_pull_N", "pull_error_N",
                           "torque_Nm", "sinkage_m", "finished"});
  for (const VariantResult* v : all_runs(c)) {
    for (const SlipResult& r : v->slips) {
      csv.row(v->variant.text, r.slip, v->grains, cell(v->solid_fraction), cell(r.pull.mean), cell(r.pull_error),
              cell(r.torque.mean), cell(r.sinkage.mean), r.finished);
    }
  }
  csv.flush();
}

}  // namespace dem::rig::rigid_wheel
