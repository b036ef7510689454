#pragma once

#include <string>

namespace hard_ground {

/// Presses a pneumatic tyre of the car on a plate at several pressures: its load over its deflection, printed, as
/// tyres.csv and as a plot in a folder, beside the curves that public models of such a tyre have.
void press_tyres(const std::string& folder);

}  // namespace hard_ground
