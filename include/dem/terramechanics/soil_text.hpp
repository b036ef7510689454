#pragma once

#include <dem/terramechanics/soil.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

namespace dem::terramechanics {

/// A soil with where it comes from.
struct NamedSoil {
  std::string name;
  std::string source;
  Soil soil;
};

namespace detail {

/// The shortest text that reads back as the same number, whatever the locale.
inline std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

inline std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;  // one line
  }
  return out + '"';
}

/// A number of the soil file: its name there, its unit, and where it is kept.
struct SoilNumber {
  const char* name;
  const char* unit;
  double* value;
};

/// The numbers of a soil whose pressure law has the form that is wanted; angles in degrees are `angles`.
struct SoilNumbers {
  static constexpr std::size_t most = 14;
  std::array<SoilNumber, most> rows{};
  std::size_t count = 0;

  SoilNumbers(Soil& soil, double (&angles)[2]) {
    if (auto* bekker = std::get_if<Bekker>(&soil.pressure)) {
      add("n", "", bekker->n);
      add("k_c", "Pa/m^(n-1)", bekker->k_c);
      add("k_phi", "Pa/m^n", bekker->k_phi);
    } else if (auto* reece = std::get_if<Reece>(&soil.pressure)) {
      add("n", "", reece->n);
      add("k_c", "", reece->k_c);
      add("k_phi", "", reece->k_phi);
      add("unit_weight", "N/m^3", reece->unit_weight);
    } else {
      auto& wong = std::get<WongReece>(soil.pressure);
      add("n", "", wong.n);
      add("k", "Pa", wong.k);
      add("plate_width", "m", wong.plate_width);
    }
    add("cohesion", "Pa", soil.shear.cohesion);
    add("friction_angle", "degrees", angles[0]);
    add("shear_displacement", "m", soil.shear.displacement);
    required = count;
    add("a0", "", soil.a0);
    add("a1", "", soil.a1);
    add("exit_angle", "degrees", angles[1]);
    add("exit_share", "", soil.exit_share);
    add("unloading_stiffness", "Pa/m", soil.unloading_stiffness);
    add("unloading_growth", "Pa/m^2", soil.unloading_growth);
  }
  void add(const char* name, const char* unit, double& value) { rows[count++] = {name, unit, &value}; }

  std::size_t required = 0;  ///< the first so many have no default
};

}  // namespace detail

/// The soil as lines `name = value` (a TOML file), SI units, angles in degrees. read_soil makes the same soil of it.
/// Throws Error for a soil that check_soil refuses.
inline std::string to_text(const NamedSoil& named) {
  check_soil(named.soil);
  Soil soil = named.soil;
  double angles[2] = {degrees(soil.shear.friction_angle), degrees(soil.exit_angle)};
  const detail::SoilNumbers numbers(soil, angles);
  const char* form = std::holds_alternative<Bekker>(soil.pressure)  ? "bekker"
                     : std::holds_alternative<Reece>(soil.pressure) ? "reece"
                                                                    : "wong-reece";
  std::string text = "# A soil for terramechanics: SI units, angles in degrees.\n";
  text += "name = " + detail::quoted(named.name) + '\n';
  text += "source = " + detail::quoted(named.source) + '\n';
  text += "pressure = " + detail::quoted(form) + '\n';
  for (std::size_t k = 0; k < numbers.count; ++k) {
    const auto& row = numbers.rows[k];
    text += std::string(row.name) + " = " + detail::shortest(*row.value);
    text += *row.unit ? std::string("  # ") + row.unit + '\n' : "\n";
  }
  return text;
}

}  // namespace dem::terramechanics
