#pragma once

#include <dem/io/file.hpp>
#include <dem/terramechanics/named_soils.hpp>
#include <dem/terramechanics/soil_text.hpp>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace dem::terramechanics {

namespace detail {

/// One line `name = value` of a soil file.
struct SoilLine {
  std::string name, value;
  std::size_t line;
  bool is_text;
};

inline std::string_view trimmed(std::string_view text) {
  const auto space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && space(text.front())) text.remove_prefix(1);
  while (!text.empty() && space(text.back())) text.remove_suffix(1);
  return text;
}

/// A number without what TOML allows in it besides: a plus before it, and underscores between digits (1_528_430).
inline std::string plain_number(std::string text) {
  const auto is_digit = [&](std::size_t k) { return k < text.size() && text[k] >= '0' && text[k] <= '9'; };
  for (std::size_t k = 1; k + 1 < text.size(); ++k) {
    if (text[k] == '_' && is_digit(k - 1) && is_digit(k + 1)) text.erase(k, 1);
  }
  if (text.starts_with('+') && (is_digit(1) || text.substr(1).starts_with('.'))) text.erase(0, 1);
  return text;
}

inline std::vector<SoilLine> soil_lines(std::string_view text, const std::string& where) {
  std::vector<SoilLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view row = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (row.empty() || row.front() == '#') continue;
    const std::size_t equals = row.find('=');
    if (equals == std::string_view::npos) fail("'{}', line {}: no '='; write name = value", where, number);
    SoilLine line{std::string(trimmed(row.substr(0, equals))), {}, number, false};
    std::string_view value = trimmed(row.substr(equals + 1));
    if (!value.empty() && (value.front() == '"' || value.front() == '\'')) {
      line.is_text = true;
      const char quote = value.front();
      std::size_t k = 1;
      for (; k < value.size() && value[k] != quote; ++k) {
        if (quote == '"' && value[k] == '\\' && k + 1 < value.size()) {
          ++k;
          if (value[k] != '"' && value[k] != '\\') {
            fail("'{}', line {}: {} has \\{}, but only \\\" and \\\\ are known in texts; write the character itself",
                 where, number, line.name, value[k]);
          }
        }
        line.value += value[k];
      }
      const std::string_view rest = k < value.size() ? trimmed(value.substr(k + 1)) : "?";
      if (!rest.empty() && rest.front() != '#') {
        fail("'{}', line {}: the text of {} does not end in a quote; write name = \"text\"", where, number, line.name);
      }
    } else {
      line.value = trimmed(value.substr(0, value.find('#')));
      line.value = plain_number(std::move(line.value));
    }
    for (const SoilLine& other : lines) {
      if (other.name == line.name) {
        fail("'{}', line {}: {} was already given in line {}; remove one", where, number, line.name, other.line);
      }
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace detail

/// The soil that a text describes, in the form that to_text writes; `where` names the text in messages. What has a
/// default may be left out. Throws Error, with the line, for names that no soil has, numbers that are none, what is
/// missing, and soils that check_soil refuses.
inline NamedSoil read_soil(std::string_view text, const std::string& where = "soil") {
  const auto lines = detail::soil_lines(text, where);
  NamedSoil named;
  std::string form;
  for (const auto& line : lines) {
    std::string* target = line.name == "name"       ? &named.name
                          : line.name == "source"   ? &named.source
                          : line.name == "pressure" ? &form
                                                    : nullptr;
    if (line.is_text != (target != nullptr)) {
      fail("'{}', line {}: {} takes {}", where, line.line, line.name,
           target ? "a text in quotes" : "a number; texts are name, source and pressure");
    }
    if (target) *target = line.value;
  }
  Soil& soil = named.soil;
  if (form == "bekker") {
    soil.pressure = Bekker{};
  } else if (form == "reece") {
    soil.pressure = Reece{};
  } else if (form == "wong-reece") {
    soil.pressure = WongReece{};
  } else {
    fail("'{}': pressure is \"{}\", but must be \"bekker\", \"reece\" or \"wong-reece\"", where, form);
  }
  double angles[2] = {0.0, 0.0};
  const detail::SoilNumbers numbers(soil, angles);
  std::vector<bool> found(numbers.count, false);
  for (const auto& line : lines) {
    if (line.is_text) continue;
    std::size_t k = 0;
    while (k < numbers.count && line.name != numbers.rows[k].name) ++k;
    if (k == numbers.count) {
      std::string known;
      for (std::size_t j = 0; j < numbers.count; ++j) known += std::string(j ? ", " : "") + numbers.rows[j].name;
      fail("'{}', line {}: a soil with pressure \"{}\" has no {}; it has {}", where, line.line, form, line.name, known);
    }
    const char *begin = line.value.data(), *end = begin + line.value.size();
    const auto [stop, error] = std::from_chars(begin, end, *numbers.rows[k].value);
    if (error != std::errc() || stop != end || !std::isfinite(*numbers.rows[k].value)) {
      fail("'{}', line {}: {} is '{}', but must be a finite number with a decimal point", where, line.line, line.name,
           line.value);
    }
    const double value = *numbers.rows[k].value;
    if (numbers.rows[k].value == &angles[0] && !(value >= 0.0 && value < 90.0)) {
      fail("'{}', line {}: friction_angle is {:g} degrees, but must be at least 0 and less than 90; give it in degrees",
           where, line.line, value);
    }
    if (numbers.rows[k].value == &angles[1] && !(value >= -90.0 && value <= 0.0)) {
      fail("'{}', line {}: exit_angle is {:g} degrees, but must lie between -90 and 0; give it in degrees", where,
           line.line, value);
    }
    found[k] = true;
  }
  for (std::size_t k = 0; k < numbers.required; ++k) {
    if (!found[k]) fail("'{}': {} is missing; add {} = ...", where, numbers.rows[k].name, numbers.rows[k].name);
  }
  soil.shear.friction_angle = radians(angles[0]);
  soil.exit_angle = radians(angles[1]);
  if (auto* reece = std::get_if<Reece>(&soil.pressure)) reece->cohesion = soil.shear.cohesion;
  check_soil(soil);
  return named;
}

/// Reads a soil file. Throws Error as read_soil does, and if the file cannot be read.
inline NamedSoil load_soil(const std::string& path) { return read_soil(io::read_file(path), path); }

/// The soil of that name (named_soils.hpp), or in the file of that path. Throws Error for what is neither.
inline NamedSoil find_soil(const std::string& name_or_path) {
  if (auto soil = known_soil_if(name_or_path)) return *std::move(soil);
  std::error_code ignored;
  if (!std::filesystem::exists(name_or_path, ignored)) {
    fail("'{}' is neither a soil that is known by name nor a file; known are {}", name_or_path, known_soil_names());
  }
  return load_soil(name_or_path);
}

/// Writes a soil file, complete or not at all; its folder is made when it is missing. Throws Error for a soil that
/// check_soil refuses, and if the file cannot be written.
inline void save_soil(const std::string& path, const NamedSoil& named) { io::write_file(path, to_text(named)); }

}  // namespace dem::terramechanics
