#pragma once

#include <dem/terramechanics/column_field.hpp>

#include <span>
#include <vector>

namespace dem::terramechanics {

/// What a field of columns remembers, as a row of numbers: for saved states. Whole numbers of 32 bits are kept exactly.
struct ColumnMemory {
  /// What belongs to all columns.
  struct Rest {
    std::uint32_t step = 0;  ///< number of the newest step that was kept
    double top = 0.0;        ///< m, no column is higher
    std::size_t margin = 0;  ///< of Bulldozing
  };
  static constexpr std::size_t of_field = 3, of_column = 12;

  static void collect(const ColumnField& f, const Rest& rest, std::vector<double>& numbers) {
    const std::size_t n = f.grid.size();
    numbers.reserve(numbers.size() + of_field + of_column * n);
    numbers.insert(numbers.end(), {static_cast<double>(rest.step), rest.top, static_cast<double>(rest.margin)});
    for (const auto* column : {&f.ground, &f.deepest, &f.modulus, &f.sunk, &f.heap, &f.pressure}) {
      numbers.insert(numbers.end(), column->begin(), column->end());
    }
    for (std::size_t k = 0; k < n; ++k) {
      const ShearMemory& s = f.shear[k];
      numbers.insert(numbers.end(), {s.mobilised.x, s.mobilised.y, s.mobilised.z, s.strength,
                                     static_cast<double>(f.touched[k]), static_cast<double>(f.touched_by[k])});
    }
  }

  /// Throws Error, and changes nothing, if there are not as many numbers as the field has.
  static Rest restore(ColumnField& f, std::span<const double> numbers) {
    const std::size_t n = f.grid.size();
    if (numbers.size() != of_field + of_column * n) {
      fail("the saved memory of soil columns has {} numbers, but {} columns have {}", numbers.size(), n,
           of_field + of_column * n);
    }
    const double* at = numbers.data();
    const Rest rest = {static_cast<std::uint32_t>(at[0]), at[1], static_cast<std::size_t>(at[2])};
    at += of_field;
    for (auto* column : {&f.ground, &f.deepest, &f.modulus, &f.sunk, &f.heap, &f.pressure}) {
      column->assign(at, at + n);
      at += n;
    }
    for (std::size_t k = 0; k < n; ++k, at += 6) {
      f.shear[k] = {{at[0], at[1], at[2]}, at[3]};
      f.touched[k] = static_cast<std::uint32_t>(at[4]);
      f.touched_by[k] = static_cast<std::int32_t>(at[5]);
    }
    return rest;
  }
};

}  // namespace dem::terramechanics
