#pragma once

#include <string_view>

namespace dem {

/// The name of a type, for reports. Compilers spell some template arguments in their own ways.
template <class T>
constexpr std::string_view type_name() {
  constexpr std::string_view function = __PRETTY_FUNCTION__;
  constexpr std::size_t start = function.find("T = ") + 4, end = function.find_first_of(";]", start);
  return function.substr(start, end - start);
}

}  // namespace dem
