#pragma once
// Names of files, by pattern.

#include <string_view>

namespace dem::rig {

/// Whether a name is what a pattern says, letter by letter: '#' in the pattern is a digit, "#+" one digit or more.
///
///     matches("load_16.9kPa.csv", "load_#+.#kPa.csv")
[[nodiscard]] constexpr bool matches(std::string_view name, std::string_view pattern) {
  const auto starts_with_digit = [&] { return !name.empty() && name.front() >= '0' && name.front() <= '9'; };
  while (!pattern.empty()) {
    if (pattern.front() != '#') {
      if (!name.starts_with(pattern.front())) return false;
      name.remove_prefix(1);
      pattern.remove_prefix(1);
      continue;
    }
    if (!starts_with_digit()) return false;
    const bool many = pattern.starts_with("#+");
    do {
      name.remove_prefix(1);
    } while (many && starts_with_digit());
    pattern.remove_prefix(many ? 2 : 1);
  }
  return name.empty();
}

}  // namespace dem::rig
