#pragma once

#include "results.hpp"

#include <string>

namespace direct_shear {

/// Writes results.csv into the output folder, prints the results, and writes the plots and report.html, with all
/// settings (`config`, the text of settings.toml) in it. Shows what there is when the run ended early. A part that
/// fails is named on stderr and keeps no other from being made; returns whether all were.
bool report(const Settings& settings, const Campaign& campaign, const std::string& config);

}  // namespace direct_shear
