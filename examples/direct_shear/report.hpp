#pragma once

#include "results.hpp"

#include <string>

namespace direct_shear {

/// Prints the results, and writes results.csv, the plots, and report.html into the output folder. Shows what there is
/// when the run ended early.
void report(const Settings& settings, const Campaign& campaign, const std::string& command);

}  // namespace direct_shear
