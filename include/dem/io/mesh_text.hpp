#pragma once
// Words and numbers of text files (meshes, packings), with the line they stand in; the same in every locale.

#include <dem/core/error.hpp>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

namespace dem::io::detail {

/// `text` for a message: at most 40 characters, those that do not print as '?'.
[[nodiscard]] inline std::string shown(std::string_view text) {
  std::string s(text.substr(0, 40));
  for (char& c : s) {
    if (c < ' ' || c > '~') c = '?';
  }
  return s;
}

/// `word` in small letters.
[[nodiscard]] inline std::string lower(std::string_view word) {
  std::string s(word);
  for (char& c : s) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return s;
}

/// Walks through the words of a text. White space and line ends of all systems part words.
class Words {
 public:
  /// White space that parts lines for line() alone: two lines that a reader has joined.
  static constexpr char joined_line = '\v';

  Words(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  /// The next word; empty at the end.
  std::string_view next() {
    skip_space();
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(from, at_ - from);
  }
  /// The next word of this line; empty at its end.
  std::string_view next_in_line() {
    while (at_ < text_.size() && is_space(text_[at_]) && !is_line_end(text_[at_])) ++at_;
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(from, at_ - from);
  }
  std::string_view peek() const {
    Words copy = *this;
    return copy.next();
  }
  /// What is left of this line, without white space around it.
  std::string rest_of_line() {
    const std::size_t from = at_;
    skip_line();
    std::string_view rest = text_.substr(from, at_ - from);
    while (!rest.empty() && is_space(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
    return std::string(rest);
  }
  void skip_line() {
    while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
  }
  bool at_end() {
    skip_space();
    return at_ >= text_.size();
  }

  /// The line (from 1) of the word that was read last.
  std::size_t line() {
    std::size_t end = at_;
    while (end > 0 && is_space(text_[end - 1])) --end;
    for (; counted_ < end; ++counted_) {
      const bool crlf = text_[counted_] == '\n' && counted_ > 0 && text_[counted_ - 1] == '\r';
      if ((is_line_end(text_[counted_]) && !crlf) || text_[counted_] == joined_line) ++line_;
    }
    return line_;
  }
  const std::string& file() const { return file_; }

  /// A finite number, or an Error with the line.
  double number(std::string_view word, const char* what) {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      fail("'{}', line {}: {} is '{}', but must be a finite number; correct it", file_, line(), what, shown(word));
    }
    return value;
  }

 private:
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || is_line_end(c); }
  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0, counted_ = 0, line_ = 1;
};

}  // namespace dem::io::detail
