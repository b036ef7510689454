#pragma once

#include <dem/core/text.hpp>

#include <string>

namespace dem::rig {

// What a bed should have at least, in widths of the plate: a plate in 2.4 widths carried three times as much as in 4.8
// and more. At these a bed twice as wide still carried 10 +- 12 % less (95 %), and one twice as deep, of grains that
// fall freely, 20 +- 5 % more (three pairs each; examples/plate_sinkage/RESULTS.md).
inline constexpr double plate_widths_across = 5.0, plate_widths_deep = 2.0;

/// What is said of a bed (m) that is too small for its widest plate (m): in numbers, and what to change. Empty of one
/// that is large enough; a depth that is not known is NaN. `is_given`: the bed is that of a file.
inline std::string small_bed_note(double widest_plate, double bed_width, double bed_depth, bool is_given = false) {
  const double width = plate_widths_across * widest_plate, depth = plate_widths_deep * widest_plate, same = 1.0 - 1e-9;
  const bool narrow = bed_width < same * width, shallow = bed_depth < same * depth;
  if (!narrow && !shallow) return {};
  std::string is, helps, change;
  const auto add = [&](double size, double wanted, const char* what, const char* helper, const char* option) {
    const auto more = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : " and ") + item; };
    more(is, text("{:.1f} widths {}", size / widest_plate, what));
    more(helps, helper);
    more(change, text("{} {:.4g}", option, wanted));
  };
  if (narrow) add(bed_width, width, "wide", "walls", "--bed-width");
  if (shallow) add(bed_depth, depth, "deep", "floor", "--bed-depth");
  return text(
      "Note: for the plate of {:.0f} mm the bed is {}. Below {:g} widths across and {:g} of depth {} may help to "
      "carry a plate, most of all a wide one. Give {}, or narrower --plates.",
      1e3 * widest_plate, is, plate_widths_across, plate_widths_deep, helps, is_given ? "another --bed-file" : change);
}

}  // namespace dem::rig
