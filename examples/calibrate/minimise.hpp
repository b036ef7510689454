#pragma once

#include <vector>

/// The least value of a function over the unit cube, by NLopt: DIRECT-L over the whole cube, then BOBYQA from there.
/// Throws what NLopt throws.
std::vector<double> minimise(double (*function)(const double* x, const void* data), const void* data,
                             const std::vector<double>& start);
