#pragma once

#include <string>

namespace hard_ground {

class Car;

/// Plots of a run, in a folder: <scene>_motion, <scene>_wheels.
void draw(const Car& car, const std::string& folder, const std::string& scene);

}  // namespace hard_ground
