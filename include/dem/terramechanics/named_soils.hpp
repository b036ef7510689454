#pragma once

#include <dem/terramechanics/soil_text.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace dem::terramechanics {

/// Soils by name. The moduli, cohesion and friction angles are those of the tables in J. Y. Wong, Theory of Ground
/// Vehicles (3rd ed., 2001, section 2.4), which the Land Locomotion Laboratory and others measured. Shear displacements
/// K are typical of such soils there: 25 mm in loose sand and loam, 12 mm in firm sand, 6 mm in clay, 40 mm in snow.
/// Hard ground is no soil: it yields as a tyre does, 9 mm under a wheel of 12 kN, with a friction of 0.8.
inline std::array<NamedSoil, 8> known_soils() {
  const auto soil = [](double n, double k_c, double k_phi, double cohesion, double angle, double k) {
    return Soil{.pressure = Bekker{.k_c = 1e3 * k_c, .k_phi = 1e3 * k_phi, .n = n},
                .shear = {.cohesion = 1e3 * cohesion, .friction_angle = radians(angle), .displacement = k}};
  };
  Soil lete = soil(0.79, 102.0, 5301.0, 1.3, 31.1, 0.012);
  lete.unloading_growth = 503e6;
  return {{{"dry-sand", "Land Locomotion Laboratory, in Wong", soil(1.1, 0.99, 1528.43, 1.04, 28.0, 0.025)},
           {"sandy-loam", "Land Locomotion Laboratory, 15 % moisture, in Wong",
            soil(0.7, 5.27, 1515.04, 1.72, 29.0, 0.025)},
           {"lete-sand", "Wong", lete},
           {"clayey", "Thailand, 38 % moisture, in Wong", soil(0.5, 13.19, 692.15, 4.14, 13.0, 0.006)},
           {"snow", "United States, in Wong", soil(1.6, 4.37, 196.72, 1.03, 19.7, 0.04)},
           {"hard", "chosen here", soil(1.0, 0.0, 4e4, 0.0, degrees(std::atan(0.8)), 0.005)},
           {"p1", "D. Melanz", melanz_sand},
           {"p3", "Mojave Martian Simulant, arXiv:1901.10667", mojave_martian_simulant}}};
}

/// Their names, with commas between them.
inline std::string known_soil_names() {
  std::string names;
  for (const NamedSoil& s : known_soils()) names += (names.empty() ? "" : ", ") + s.name;
  return names;
}

/// One of them; none of another name.
inline std::optional<NamedSoil> known_soil_if(std::string_view name) {
  for (NamedSoil& s : known_soils()) {
    if (s.name == name) return std::move(s);
  }
  return {};
}
/// The same. Throws Error, with their names, for another name.
inline NamedSoil known_soil(std::string_view name) {
  if (auto soil = known_soil_if(name)) return *std::move(soil);
  fail("there is no soil '{}'; these are known: {}", std::string(name), known_soil_names());
}

}  // namespace dem::terramechanics
