#pragma once

// Texts made of numbers and names, in fmt's format language. Arguments lose their types before fmt sees them. Otherwise
// fmt would make a template for each list of types, and every program would spend seconds on compiling texts that it
// never prints.

// fmt 9 switches its constexpr off under nvcc, and then its own format strings do not compile.
#if defined(__CUDACC__) && !defined(FMT_USE_CONSTEXPR)
#define FMT_USE_CONSTEXPR 1
#endif
#include <dem/core/macros.hpp>

#include <fmt/core.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>

namespace dem {

/// A number or a piece of text to be put into a text. It refers to the characters that it is made from.
class TextArgument {
 public:
  TextArgument(double x) : argument_(of(x)) {}
  TextArgument(bool x) : argument_(of(x)) {}
  TextArgument(char x) : argument_(of(x)) {}
  TextArgument(int x) : argument_(of(x)) {}
  TextArgument(unsigned x) : argument_(of(x)) {}
  TextArgument(long x) : argument_(of(static_cast<long long>(x))) {}
  TextArgument(unsigned long x) : argument_(of(static_cast<unsigned long long>(x))) {}
  TextArgument(long long x) : argument_(of(x)) {}
  TextArgument(unsigned long long x) : argument_(of(x)) {}
  TextArgument(std::string_view x) : argument_(of(fmt::string_view(x.data(), x.size()))) {}
  TextArgument(const char* x) : TextArgument(std::string_view(x)) {}
  TextArgument(const std::string& x) : TextArgument(std::string_view(x)) {}

 private:
  friend std::string text_of(std::string_view, std::initializer_list<TextArgument>);
  using Argument = fmt::basic_format_arg<fmt::format_context>;

  template <class T>
  static Argument of(const T& x) {
    return fmt::format_args(fmt::make_format_args(x)).get(0);
  }

  Argument argument_;
};

std::string text_of(std::string_view format, std::initializer_list<TextArgument> arguments);

// With DEM_CHECK_TEXTS a format that does not suit its arguments does not compile.
#if defined(DEM_CHECK_TEXTS)
template <class... Args>
using TextFormat = fmt::format_string<const Args&...>;
#else
template <class...>
using TextFormat = fmt::string_view;
#endif

/// The format with its arguments filled in.
template <class... Args>
std::string text(TextFormat<std::type_identity_t<Args>...> format, const Args&... arguments) {
  const fmt::string_view view = format;
  return text_of({view.data(), view.size()}, {TextArgument(arguments)...});
}

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE std::string text_of(std::string_view format, std::initializer_list<TextArgument> arguments) {
  static_assert(sizeof(TextArgument) == sizeof(TextArgument::Argument));
  const auto* first = arguments.size() == 0 ? nullptr : &arguments.begin()->argument_;
  return fmt::vformat(fmt::string_view(format.data(), format.size()),
                      fmt::format_args(first, static_cast<int>(arguments.size())));
}

}  // namespace dem

#endif
