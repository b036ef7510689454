#pragma once

// Couplings that leave a coordinate no motion at all.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd::detail {

/// Whether a part is switched on; one that has no switch is.
template <class T>
constexpr bool is_on(const T& part) {
  if constexpr (requires { part.on; }) return part.on;
  else return true;
}

/// Throws Error if couplings together lock a coordinate: two gears of different ratio between the same two shafts.
/// Those of given stiffness are springs and lock nothing; one that repeats another is no harm.
void check_locked(const Parts& m);
/// The same, if a coupling was added, switched on or given another ratio since. To be called before each step.
void check_changed_couplings(Parts& m);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void check_locked(const Parts& m) {
  using Column = std::pair<std::uint32_t, Dof>;
  std::vector<Column> columns;
  std::vector<std::vector<double>> rows;
  std::vector<std::size_t> of;  // the coupling that a row was made from
  const auto column_of = [&](const CouplingSpec::Term& t) {
    const Column c = {t.joint.value, t.dof};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns[k] == c) return k;
    }
    columns.push_back(c);
    return columns.size() - 1;
  };
  for (const Coupling& g : m.couplings) {
    if (is_on(g.spec) && !g.spec.stiffness) {
      for (const auto& t : g.spec.terms) column_of(t);
    }
  }
  for (std::size_t i = 0; i < m.couplings.size(); ++i) {
    const CouplingSpec& s = m.couplings[i].spec;
    if (!is_on(s) || s.stiffness) continue;
    std::vector<double> row(columns.size(), 0.0);
    for (const auto& t : s.terms) row[column_of(t)] += t.ratio;
    rows.push_back(std::move(row));
    of.push_back(i);
  }
  // Gauss and Jordan: a coordinate is locked if in the end a row holds it alone.
  std::vector<bool> done(rows.size(), false);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::size_t pivot = rows.size();
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (!done[r] && std::abs(rows[r][c]) > (pivot < rows.size() ? std::abs(rows[pivot][c]) : 1e-9)) pivot = r;
    }
    if (pivot == rows.size()) continue;
    done[pivot] = true;
    const double by = 1.0 / rows[pivot][c];
    for (double& x : rows[pivot]) x *= by;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double times = rows[r][c];
      if (r == pivot || times == 0.0) continue;
      for (std::size_t k = 0; k < columns.size(); ++k) {
        rows[r][k] -= times * rows[pivot][k];
        if (std::abs(rows[r][k]) < 1e-9) rows[r][k] = 0.0;
      }
    }
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::size_t alone = columns.size(), count = 0;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (std::abs(rows[r][c]) > 1e-9) {
        alone = c;
        ++count;
      }
    }
    if (!done[r] || count != 1) continue;
    std::string names;
    for (const std::size_t i : of) {
      bool takes_part = false;
      for (const auto& t : m.couplings[i].spec.terms) takes_part |= t.joint.value == columns[alone].first;
      if (takes_part) names += (names.empty() ? "'" : ", '") + m.couplings[i].spec.name + "'";
    }
    fail(
        "the couplings on joint '{}' ({}) leave it no {}: together with the others they hold it where it is, as two "
        "gears of different ratio between the same two shafts do; remove one, check the ratios, or give one a "
        "stiffness",
        m.joint_specs[columns[alone].first].name, names, name_of(columns[alone].second));
  }
}

DEM_INLINE void check_changed_couplings(Parts& m) {
  if (!m.couplings_changed) return;
  check_locked(m);
  m.couplings_changed = false;
}

}  // namespace dem::mbd::detail

#endif
