#pragma once
// What the library says, in the words that the user of a program knows: the library speaks of fields that its caller
// sets, which are options of the program or are not to be had.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace dem::rig {

/// A word or phrase: `from` as the library says it, `to` as the program calls it.
struct OwnWord {
  std::string_view from, to;
};

namespace detail {

constexpr bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Where the text in single quotes ends that begins at `at`; `at` if none begins there. An apostrophe is no quote.
constexpr std::size_t end_of_quote(std::string_view text, std::size_t at) {
  if (text[at] != '\'' || (at > 0 && is_word(text[at - 1]))) return at;
  for (std::size_t end = text.find('\'', at + 1); end != text.npos; end = text.find('\'', end + 1)) {
    if (end + 1 == text.size() || !is_word(text[end + 1])) return end + 1;
  }
  return at;
}

/// Whether `phrase` stands at `at`, and not as a part of a longer word, an option or a path.
constexpr bool stands_at(std::string_view text, std::size_t at, std::string_view phrase) {
  if (!text.substr(at).starts_with(phrase)) return false;
  const std::size_t end = at + phrase.size();
  const auto joins = [](char c) { return is_word(c) || c == '-' || c == '/'; };
  const bool begins = at == 0 || !is_word(phrase.front()) || !(joins(text[at - 1]) || text[at - 1] == '.');
  const bool is_ending = end < text.size() && text[end] == '.' && end + 1 < text.size() && is_word(text[end + 1]);
  const bool ends = end == text.size() || !is_word(phrase.back()) || !(joins(text[end]) || is_ending);
  return begins && ends;
}

}  // namespace detail

/// The text in the program's words. What stands in single quotes, as paths do, stays. A phrase that another one begins
/// with comes after it.
[[nodiscard]] inline std::string in_own_words(std::string_view text, std::span<const OwnWord> words) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t end = detail::end_of_quote(text, at); end != at) {
      result += text.substr(at, end - at);
      at = end;
      continue;
    }
    const OwnWord* found = nullptr;
    for (const OwnWord& word : words) {
      if (found == nullptr && detail::stands_at(text, at, word.from)) found = &word;
    }
    result += found != nullptr ? found->to : text.substr(at, 1);
    at += found != nullptr ? found->from.size() : 1;
  }
  return result;
}

}  // namespace dem::rig
