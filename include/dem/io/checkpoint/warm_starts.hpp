#pragma once

#include <dem/core/error.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <variant>

namespace dem::io {

// A warm start of a search as bytes: those that mean something, all others zero. Of a std::variant that is the value in
// use, with its number as the last byte (two bytes of more than 255 kinds): what a variant keeps behind a smaller value
// is left from before.

namespace detail {

template <class Variant>
using KindNumber = std::conditional_t<(std::variant_size_v<Variant> <= 255), std::uint8_t, std::uint16_t>;

}  // namespace detail

/// Writes a warm start over sizeof(Start) zeros.
template <class Start>
void put_warm_start(const Start& start, std::uint8_t* to) {
  static_assert(std::is_trivially_copyable_v<Start>, "WarmStart: must be trivially copyable to be saved");
  if constexpr (!std::is_empty_v<Start>) std::memcpy(to, &start, sizeof(Start));
}
template <class... Starts>
void put_warm_start(const std::variant<Starts...>& start, std::uint8_t* to) {
  using Number = detail::KindNumber<std::variant<Starts...>>;
  constexpr std::size_t last = sizeof(start) - sizeof(Number);
  static_assert(((std::is_empty_v<Starts> || sizeof(Starts) <= last) && ...),
                "the number has a place behind each value");
  std::visit([to](const auto& value) { put_warm_start(value, to); }, start);
  const auto number = static_cast<Number>(start.index());
  std::memcpy(to + last, &number, sizeof number);
}

/// Reads it back. Throws Error for the number of a value that there is not.
template <class Start>
void get_warm_start(Start& start, const std::uint8_t* from) {
  if constexpr (!std::is_empty_v<Start>) std::memcpy(static_cast<void*>(&start), from, sizeof(Start));
}
template <class... Starts>
void get_warm_start(std::variant<Starts...>& start, const std::uint8_t* from) {
  detail::KindNumber<std::variant<Starts...>> number;
  std::memcpy(&number, from + sizeof(start) - sizeof number, sizeof number);
  const auto take = [&]<std::size_t I>() {
    if (number == I) get_warm_start(start.template emplace<I>(), from);
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (take.template operator()<I>(), ...); }
  (std::index_sequence_for<Starts...>());
  if (number >= sizeof...(Starts)) {
    fail("the saved searches have a start of kind {}, and there are {}", number, sizeof...(Starts));
  }
}

}  // namespace dem::io
