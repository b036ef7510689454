#pragma once

// A wheel that rolls over soil columns with a slip, loaded by a mass of its own that is free to rise and sink.

#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/soil_columns.hpp>

#include <array>
#include <cmath>
#include <memory>

struct RollingWheel {
  double radius = 0.13, width = 0.16;  // m
  double mass = 130.0 / 9.81;          // kg
  double spin = 1.0;                   // rad/s
  double slip = 0.2;                   // 1 - v/(omega r)
  double y = 0.0;                      // m
  double dt = 1e-3;                    // s
  double fixed_sinkage = 0.0;          // m; above 0: held there instead

  struct Mean {
    double pull = 0.0, torque = 0.0, sinkage = 0.0, load = 0.0;
  };

  /// Rolls from x = 0 for a travel (m); means over its second half.
  Mean roll(dem::terramechanics::SoilColumns& soil, double travel) {
    using namespace dem;
    const double v = spin * radius * (1.0 - slip);
    const bool held = fixed_sinkage > 0.0;
    std::array<terramechanics::ColumnPart, 1> parts = {terramechanics::ColumnPart{
        .shape = std::make_shared<terramechanics::ColumnCylinder>(radius, width), .body = {}}};
    double z = held ? radius - fixed_sinkage : radius, vz = 0.0;
    Mean mean;
    const int steps = static_cast<int>(travel / v / dt);
    for (int k = 0; k < steps; ++k) {
      const double angle = spin * dt * k, c = std::cos(angle), s = std::sin(angle);
      parts[0].body = {{v * dt * k, y, z}, {v, 0, vz}, {0, spin, 0}, {{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
      if (!soil.apply(parts, dt)) ++failures;
      const terramechanics::ColumnLoad& load = soil.loads()[0];
      if (!held) vz += dt * (load.force.z / mass - 9.81);
      z += dt * vz;
      if (2 * k < steps) continue;
      const double share = 1.0 / (steps - (steps + 1) / 2);
      mean.pull += share * load.force.x;
      mean.torque -= share * load.torque.y;
      mean.load += share * load.force.z;
      mean.sinkage += share * (radius - z);
    }
    return mean;
  }
  int failures = 0;
};
