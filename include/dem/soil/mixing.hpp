#pragma once

#include <dem/soil/average.hpp>
#include <dem/world/world.hpp>

#include <concepts>
#include <vector>

namespace dem::soil {

/// How well two parts of a mixture are mixed: Lacey's index (1954, J. appl. Chem. 4, 257-268). The share p_i of the
/// first part is taken in each cell, of n_i grains:
///   variance   sum of n_i (p_i - p)^2 / N, over the cells
///   apart      p (1 - p): each cell has one part alone
///   by chance  p (1 - p) (K - 1) / (N - 1): the mean over all ways to deal N grains out to K cells
/// Cells count by their grains, so a cell that is hardly filled counts little, and one without any does not count.
struct Mixing {
  double index = 0.0;       ///< 0: apart; 1: as by chance; above 1: more evenly
  double share = 0.0;       ///< p, of the first part in all grains
  double variance = 0.0;    ///< of the share among the cells
  double apart = 0.0;       ///< the variance of parts that are apart
  double by_chance = 0.0;   ///< that of parts that are mixed by chance
  std::size_t grains = 0;   ///< N, that are in the grid
  std::size_t outside = 0;  ///< grains that are not, and do not count
  std::size_t cells = 0;    ///< K, that have grains
};

/// Of the grains whose centres lie in the grid's box. `is_first(id)` says which are of the first part; a grain counts
/// once, whatever its size. The index depends on how large the cells are: 10 to 50 grains in each are usual. Throws
/// Error unless both parts are there, in at least 2 cells.
///
///     soil::mixing_of(world, {{low, high}, {8, 8, 4}}, [&](GrainId g) { return world.species_of(g) == red; }).index
template <class Model, std::predicate<GrainId> F>
Mixing mixing_of(const World<Model>& world, const AverageGrid& grid, F&& is_first) {
  grid.check();
  struct Cell {
    double first = 0.0, all = 0.0;
  };
  std::vector<Cell> cells(grid.count());
  Mixing m;
  double first = 0.0;
  for (const GrainId id : world.grains()) {
    const auto k = grid.cell_at(world.position(id));
    if (!k) {
      ++m.outside;
      continue;
    }
    const double counts = is_first(id) ? 1.0 : 0.0;
    cells[*k].first += counts, first += counts;
    cells[*k].all += 1.0, ++m.grains;
  }
  for (const Cell& cell : cells) m.cells += cell.all > 0.0 ? 1 : 0;
  const auto n = static_cast<double>(m.grains);
  if (first == 0.0 || first == n) {
    fail("{} of the {} grains in the grid ({} are outside) are of the first part, but a mixture has grains of both",
         first, m.grains, m.outside);
  }
  if (m.cells < 2)
    fail("all {} grains are in one cell of the grid, but mixing needs at least 2 that have grains", m.grains);
  m.share = first / n;
  for (const Cell& cell : cells) {
    if (cell.all == 0.0) continue;
    const double off = cell.first / cell.all - m.share;
    m.variance += cell.all / n * off * off;
  }
  m.apart = m.share * (1.0 - m.share);
  m.by_chance = m.apart * static_cast<double>(m.cells - 1) / (n - 1.0);
  if (m.grains == m.cells) {
    fail(
        "each of the {} cells that have grains has a single one, so parts cannot be told from mixed; make cells larger",
        m.cells);
  }
  m.index = (m.apart - m.variance) / (m.apart - m.by_chance);
  return m;
}

}  // namespace dem::soil
