#pragma once
// What a line plot shows.

#include <optional>
#include <string>
#include <vector>

namespace dem::io {

enum class SeriesStyle { Line, Dashed, Dotted, Points, LinePoints };

/// One curve or one set of points. A value that is not finite leaves a gap.
struct Series {
  std::string name = {};  ///< in the legend; empty: not in the legend
  std::vector<double> x = {};
  std::vector<double> y = {};  ///< as many as x
  SeriesStyle style = SeriesStyle::Line;
  int color = -1;  ///< number in the palette of 8 colours (equal numbers: equal colours); -1: the next one
};

/// Limits of an axis; a side that is not set follows the data.
struct Range {
  std::optional<double> min = {};
  std::optional<double> max = {};
};

/// Text at a place of the plot, in the units of the axes.
struct Annotation {
  double x = 0;
  double y = 0;
  std::string text = {};
  bool point = false;  ///< also marks the place with a dot
};

/// A text in place of a number below an axis.
struct Tick {
  double at = 0;
  std::string text = {};
};

enum class Legend { Below, TopLeft, TopRight, BottomLeft, BottomRight, Right, None };

/// A line plot. Texts are literal UTF-8 (no markup is interpreted; write "m²", "σ"); '\n' breaks a line.
struct Plot {
  std::string title = {};
  std::string x_label = {};  ///< with unit: "displacement [mm]"
  std::string y_label = {};
  std::vector<Series> series = {};
  Range x_range = {};
  Range y_range = {};
  bool log_x = false;
  bool log_y = false;
  std::vector<Annotation> annotations = {};
  Legend legend = Legend::Below;
  int width = 800;  ///< [px] of the SVG; the PNG has twice as many
  int height = 500;
  std::vector<Tick> x_ticks = {};  ///< in place of all numbers below the x axis; empty: numbers
};

}  // namespace dem::io
