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
  TextArgument(double x) : kind_(Kind::real), real_(x) {}
  TextArgument(bool x) : kind_(Kind::truth), truth_(x) {}
  TextArgument(char x) : kind_(Kind::character), character_(x) {}
  TextArgument(int x) : TextArgument(static_cast<long long>(x)) {}
  TextArgument(unsigned x) : TextArgument(static_cast<unsigned long long>(x)) {}
  TextArgument(long x) : TextArgument(static_cast<long long>(x)) {}
  TextArgument(unsigned long x) : TextArgument(static_cast<unsigned long long>(x)) {}
  TextArgument(long long x) : kind_(Kind::integer), integer_(x) {}
  TextArgument(unsigned long long x) : kind_(Kind::natural), natural_(x) {}
  TextArgument(std::string_view x) : kind_(Kind::words), words_(x) {}
  TextArgument(const char* x) : TextArgument(std::string_view(x)) {}
  TextArgument(const std::string& x) : TextArgument(std::string_view(x)) {}

 private:
  friend std::string text_of(std::string_view, std::initializer_list<TextArgument>);
  enum class Kind { real, truth, character, integer, natural, words };

  Kind kind_;
  union {
    double real_;
    bool truth_;
    char character_;
    long long integer_;
    unsigned long long natural_;
    std::string_view words_;
  };
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
#include <vector>

namespace dem {

DEM_INLINE std::string text_of(std::string_view format, std::initializer_list<TextArgument> arguments) {
  using Argument = fmt::basic_format_arg<fmt::format_context>;
  const auto of = [](const auto& x) { return Argument(fmt::format_args(fmt::make_format_args(x)).get(0)); };
  std::vector<Argument> list;
  for (const TextArgument& a : arguments) {
    switch (a.kind_) {
      case TextArgument::Kind::real: list.push_back(of(a.real_)); break;
      case TextArgument::Kind::truth: list.push_back(of(a.truth_)); break;
      case TextArgument::Kind::character: list.push_back(of(a.character_)); break;
      case TextArgument::Kind::integer: list.push_back(of(a.integer_)); break;
      case TextArgument::Kind::natural: list.push_back(of(a.natural_)); break;
      case TextArgument::Kind::words: list.push_back(of(fmt::string_view(a.words_.data(), a.words_.size()))); break;
    }
  }
  return fmt::vformat(fmt::string_view(format.data(), format.size()),
                      fmt::format_args(list.data(), static_cast<int>(list.size())));
}

}  // namespace dem

#endif
