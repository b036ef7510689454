#pragma once
// How far the pressure depends on the box, the speed and the seed of the bed, with errors.

#include <dem/rig/bed/study_rows.hpp>
#include <dem/rig/plate_sinkage/tables.hpp>

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

/// Under each plate, and the mean of all where there are several. A larger box is to change it by less than 5 %, and
/// half the speed by less than 3 %.
inline StudiedValue studied_pressure(const Settings& s) {
  StudiedValue of{.name = "pressure",
                  .unit = "kPa",
                  .scale = 1e-3,
                  .si_unit = "Pa",
                  .place = "plate [mm]",
                  .file_place = "plate_m",
                  .box_limit = 5.0,
                  .speed_limit = 3.0};
  for (const double w : s.widths) of.add_place(number(1e3 * w, "{:.0f}"), text("{}", w), "the mean pressure");
  if (s.widths.size() > 1) of.add_place("mean", "", "the mean pressure of the plates");
  return of;
}

inline std::vector<StudyRow> study_rows(const Campaign& c) {
  std::vector<const VariantResult*> runs;
  for (const VariantResult& v : c.variants) runs.push_back(&v);
  if (runs.empty()) return {};
  return rig::study_rows<VariantResult>(runs, studied_pressure(runs.front()->variant.settings), study_pressure);
}

inline constexpr const char* study_caption =
    "Mean pressure over the second half of the sinkage: mean over the seeds (± standard error) and what the study "
    "changes";
inline constexpr const char* study_note = "The plates of one bed are not independent of each other.";

}  // namespace dem::rig::plate_sinkage
