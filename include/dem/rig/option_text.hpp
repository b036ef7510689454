#pragma once
// Values of options as text, the same in every locale.

#include <dem/rig/options.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace dem::rig {

/// The value as text that read_value() reads back as the very same.
[[nodiscard]] inline std::string text_of(const Option& option) {
  const auto write = [&](const auto* v) -> std::string {
    using T = std::remove_cvref_t<decltype(*v)>;
    if constexpr (std::same_as<T, std::string>) {
      return *v;
    } else if constexpr (std::same_as<T, bool>) {
      return option.is_flag ? (*v ? "true" : "false") : (*v ? "1" : "0");
    } else if constexpr (std::same_as<T, std::vector<double>>) {
      std::string all;
      for (const double x : *v) all += (all.empty() ? "" : ",") + text("{}", x);
      return all;
    } else {
      return text("{}", *v);
    }
  };
  return std::visit(write, option.value);
}

namespace detail {

/// A decimal number; also "nan" and "inf", which the rig refuses in words of its own.
inline bool read_number(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && error == std::errc() && end == text.data() + text.size();
}

/// A whole number, also written as 1e6. Throws Error for any other number: what was meant is not known.
template <class T>
bool read_whole_number(const std::string& name, std::string_view text, T& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* end_of_text = text.data() + text.size();
  if (const auto [end, error] = std::from_chars(text.data(), end_of_text, value);
      !text.empty() && error == std::errc() && end == end_of_text) {
    return true;
  }
  double number = 0.0;
  if (!read_number(text, number)) return false;
  const double highest = std::ldexp(1.0, std::numeric_limits<T>::digits);
  const double lowest = std::is_signed_v<T> ? -highest : 0.0;
  if (number >= lowest && number < highest && number == std::floor(number)) {
    value = static_cast<T>(number);
    return true;
  }
  fail("{} is {}, but must be a whole number from {} to {}", name, text, std::numeric_limits<T>::min(),
       std::numeric_limits<T>::max());
}

inline bool read_switch(std::string text, bool& value) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto is_one_of = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* w) { return text == w; });
  };
  value = is_one_of({"true", "on", "yes", "enable", "1", "t", "y", "+"});
  return value || is_one_of({"false", "off", "no", "disable", "0", "f", "n", "-"});
}

}  // namespace detail

/// Reads the value of an option from its texts: several of a list, one of anything else. Returns false when they are
/// none of its kind. Throws Error for whole numbers that are out of range or have a fraction.
inline bool read_value(const Option& option, std::span<const std::string> texts) {
  if (auto* const* list = std::get_if<std::vector<double>*>(&option.value)) {
    std::vector<double> numbers(texts.size());
    for (std::size_t i = 0; i < texts.size(); ++i) {
      if (!detail::read_number(texts[i], numbers[i])) return false;
    }
    **list = std::move(numbers);
    return true;
  }
  if (texts.size() != 1) return false;
  const std::string& text = texts.front();
  const auto read = [&](auto* v) {
    using T = std::remove_cvref_t<decltype(*v)>;
    if constexpr (std::same_as<T, std::string>) {
      *v = text;
      return true;
    } else if constexpr (std::same_as<T, bool>) {
      return detail::read_switch(text, *v);
    } else if constexpr (std::same_as<T, double>) {
      return detail::read_number(text, *v);
    } else if constexpr (std::integral<T>) {
      return detail::read_whole_number(option.name, text, *v);
    } else {
      return false;
    }
  };
  return std::visit(read, option.value);
}

}  // namespace dem::rig
