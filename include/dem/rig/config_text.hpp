#pragma once
// The text of a settings file: lines of `option = value` as in TOML, without tables.
//
//     # a comment
//     size = "quick"
//     loads = [6.2, 16.2]      # may go over several lines
//     output = "out/a \"b\""   # \" \\ \b \t \n \f \r \u0001; 'as it stands' between single quotes
//
// A word or a number may stand without quotes, numbers with commas or blanks between them are a list, and a name alone
// is a switch that is on.

#include <dem/core/error.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::rig {

/// What a settings file gives for one option.
struct ConfigLine {
  std::string key = {};
  std::vector<std::string> values = {};
  int line = 0;
};

/// A text as a value that read_config() reads back as the very same.
[[nodiscard]] inline std::string toml_text(std::string_view value) {
  std::string q = "\"";
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') q += '\\';
    if (c == '\n') q += "\\n";
    else if (c == '\t') q += "\\t";
    else if (c == '\r') q += "\\r";
    else if (byte < 0x20U) q += text("\\u{:04X}", static_cast<int>(byte));
    else q += c;
  }
  return q + '"';
}

namespace detail {

/// Reads a settings file from its start to its end.
class ConfigReader {
 public:
  explicit ConfigReader(std::string_view text) : text_(text) {}

  std::vector<ConfigLine> read() {
    std::vector<ConfigLine> lines;
    for (skip_empty(); !at_end(); skip_empty()) {
      lines.push_back(read_line());
      skip_blanks();
      if (!at_line_end()) wrong(text("'{}' stands behind the value", rest_of_line()));
    }
    return lines;
  }

 private:
  [[noreturn]] void wrong(const std::string& why) const {
    fail("the --config file cannot be read: in line {}, {}; texts stand in quotes, and lists in brackets", line_, why);
  }
  bool at_end() const { return at_ == text_.size(); }
  char now() const { return at_end() ? '\n' : text_[at_]; }
  bool is_blank() const { return !at_end() && (now() == ' ' || now() == '\t' || now() == '\r'); }
  bool at_line_end() const { return now() == '\n' || now() == '#'; }
  char take() {
    if (at_end()) wrong("the file ends before the value does");
    if (now() == '\n') ++line_;
    return text_[at_++];
  }
  void skip_blanks() {
    while (is_blank()) ++at_;
  }
  void skip_line() {
    while (!at_end() && now() != '\n') ++at_;
  }
  std::string_view rest_of_line() const { return text_.substr(at_, text_.find('\n', at_) - at_); }

  /// Goes on to the next character that says something; over comments.
  void skip_empty(bool in_list = false) {
    for (;; take()) {
      skip_blanks();
      if (now() == '#' || (now() == ';' && !in_list)) skip_line();
      if (at_end() || now() != '\n') return;
    }
  }

  ConfigLine read_line() {
    ConfigLine result{.line = line_};
    if (now() == '[') {
      const std::string_view header = rest_of_line();
      refuse_table(std::string(header.substr(1, header.find_last_of(']') - 1)));
    }
    const bool is_quoted = now() == '"' || now() == '\'';
    result.key = is_quoted ? read_text() : read_bare("=#");
    if (const auto dot = result.key.find('.'); !is_quoted && dot != std::string::npos) {
      refuse_table(result.key.substr(0, dot));
    }
    skip_blanks();
    if (at_line_end()) result.values = {"true"};
    else {
      if (now() != '=') wrong(text("'{}' stands where '=' should", rest_of_line()));
      take();
      skip_blanks();
      read_values(result);
    }
    return result;
  }

  [[noreturn]] static void refuse_table(const std::string& name) {
    fail("the --config file has a table [{}], but must have none; give its options without that header", name);
  }

  void read_values(ConfigLine& result) {
    if (at_line_end()) wrong(text("'{}' has no value", result.key));
    if (now() == '[') {
      take();
      for (skip_empty(true); now() != ']'; skip_empty(true)) {
        result.values.push_back(read_value());
        skip_empty(true);
        if (now() == ',') take();
        else if (now() != ']') wrong(text("'{}' stands where a comma or ']' should", rest_of_line()));
      }
      take();
      return;
    }
    while (!at_line_end()) {
      result.values.push_back(read_value());
      skip_blanks();
      if (now() == ',') {
        take();
        skip_blanks();
      }
    }
  }

  std::string read_value() { return now() == '"' || now() == '\'' ? read_text() : read_bare(",]# \t"); }

  /// What stands without quotes, up to one of `ends` or the end of the line.
  std::string read_bare(std::string_view ends) {
    const std::size_t start = at_;
    while (!at_end() && now() != '\n' && ends.find(now()) == std::string_view::npos) ++at_;
    std::string_view bare = text_.substr(start, at_ - start);
    while (!bare.empty() && (bare.back() == ' ' || bare.back() == '\t' || bare.back() == '\r')) bare.remove_suffix(1);
    if (bare.empty()) wrong(text("'{}' stands where a name or a value should", rest_of_line()));
    return std::string(bare);
  }

  std::string read_text() {
    const char quote = take();
    std::string text;
    for (char c = 0;;) {
      if (at_end() || now() == '\n') wrong("a text has no quote at its end");
      c = take();
      if (c == quote) return text;
      text += c == '\\' && quote == '"' ? read_escape() : c;
    }
  }

  char read_escape() {
    const char c = take();
    switch (c) {
      case '"': return '"';
      case '\\': return '\\';
      case 'b': return '\b';
      case 't': return '\t';
      case 'n': return '\n';
      case 'f': return '\f';
      case 'r': return '\r';
      case 'u': return read_code();
      default: wrong(text("'\\{}' is no character; a backslash is written twice", c));
    }
  }

  /// Four hexadecimal digits of a character below 128: others stand as they are.
  char read_code() {
    int code = 0;
    for (int k = 0; k < 4; ++k) {
      const char c = take();
      const int digit = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                               : -1;
      if (digit < 0) wrong("'\\u' is not followed by four hexadecimal digits");
      code = 16 * code + digit;
    }
    if (code > 0x7F) wrong("'\\u' is above 007F; write the character itself");
    return static_cast<char>(code);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace detail

/// Reads the text of a settings file. Throws Error, with the line, for what is not in that form.
[[nodiscard]] inline std::vector<ConfigLine> read_config(std::string_view text) {
  return detail::ConfigReader(text).read();
}

}  // namespace dem::rig
