#pragma once

namespace dem::detail {

/// The widths of packs that the sources of this program were compiled for: one, or something goes wrong.
struct PackWidths {
  int first = 0, other = 0;

  bool add(int width) {
    if (first == 0) first = width;
    else if (width != first) other = width;
    return true;
  }
};
inline PackWidths pack_widths;

}  // namespace dem::detail
