#pragma once
// Rows of numbers that a stage keeps: their means and their CSV file. A row is a struct of doubles of the rig's own.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace dem::rig {

/// A number of a row, and what its column is called, with the unit.
template <class Row>
struct Column {
  const char* name;
  double Row::*value;
};

/// Means of `values` over a window of x about each row, as wide as there are rows on both sides: it shrinks towards
/// both ends, so that it stays in the middle of its rows. x must not fall.
template <class Row>
std::vector<double> smoothed(std::span<const Row> rows, double Row::*x_of, double Row::*values, double window) {
  std::vector<double> mean(rows.size());
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double x = rows[i].*x_of;
    const double half = std::min({0.5 * window, x - rows.front().*x_of, rows.back().*x_of - x});
    while (from < i && rows[from].*x_of < x - half) ++from;
    while (to < rows.size() && rows[to].*x_of <= x + half) ++to;
    double sum = 0.0;
    for (std::size_t k = from; k < std::max(to, i + 1); ++k) sum += rows[k].*values;
    mean[i] = sum / static_cast<double>(std::max(to, i + 1) - from);
  }
  return mean;
}

}  // namespace dem::rig
