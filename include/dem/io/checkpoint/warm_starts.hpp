#pragma once

#include <dem/core/error.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <variant>

namespace dem::io {

// A warm start of a search as bytes: those that mean something, all others zero. Of a std::variant that is the value in
// use, with its number as the last byte: what a variant keeps behind a smaller value is left from before.

/// Writes a warm start over sizeof(Start) zeros.
template <class Start>
void put_warm_start(const Start& start, std::uint8_t* to) {
  static_assert(std::is_trivially_copyable_v<Start>, "WarmStart: must be trivially copyable to be saved");
  if constexpr (!std::is_empty_v<Start>) std::memcpy(to, &start, sizeof(Start));
}
template <class... Starts>
void put_warm_start(const std::variant<Starts...>& start, std::uint8_t* to) {
  constexpr std::size_t last = sizeof(start) - 1;
  static_assert(((std::is_empty_v<Starts> || sizeof(Starts) <= last) && ...) && sizeof...(Starts) <= 255);
  std::visit([to](const auto& value) { put_warm_start(value, to); }, start);
  to[last] = static_cast<std::uint8_t>(start.index());
}

/// Reads it back. Throws Error for the number of a value that there is not.
template <class Start>
void get_warm_start(Start& start, const std::uint8_t* from) {
  if constexpr (!std::is_empty_v<Start>) std::memcpy(static_cast<void*>(&start), from, sizeof(Start));
}
template <class... Starts>
void get_warm_start(std::variant<Starts...>& start, const std::uint8_t* from) {
  const std::size_t index = from[sizeof(start) - 1];
  const auto take = [&]<std::size_t I>() {
    if (index == I) get_warm_start(start.template emplace<I>(), from);
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (take.template operator()<I>(), ...); }
  (std::index_sequence_for<Starts...>());
  if (index >= sizeof...(Starts))
    fail("the saved searches have a start of kind {}, and there are {}", index, sizeof...(Starts));
}

}  // namespace dem::io
