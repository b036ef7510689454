#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

/// The share of its length that a test's run should have, from the environment variable DEM_TEST_SCALE. Sanitizers,
/// which make every step ten times as dear, set it below one (CMakePresets.json).
inline double test_scale() {
  const char* text = std::getenv("DEM_TEST_SCALE");
  const double share = text ? std::atof(text) : 1.0;
  return share > 0.0 && share < 1.0 ? share : 1.0;
}

/// So many steps, or that share of them: for tests that ask the same of a shorter run.
template <class N>
N scaled(N steps) {
  return std::max(N(1), static_cast<N>(std::lround(test_scale() * static_cast<double>(steps))));
}
