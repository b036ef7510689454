#pragma once
// The file that repeats a run: written from options, and read in words.

#include <dem/rig/config_text.hpp>
#include <dem/rig/option_text.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace dem::rig {

/// The lines of a settings file that must be understood as a whole. Throws Error for what is not in the form, a name
/// that is no option, and one that is given twice.
[[nodiscard]] inline std::vector<ConfigLine> read_settings_file(std::string_view text, const Options& options) {
  std::vector<ConfigLine> lines = read_config(text);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Option* option = options.find("--" + lines[k].key);
    if (option == nullptr) {
      fail("the --config file gives '{}', but there is no such option; --help lists them", lines[k].key);
    }
    for (std::size_t before = 0; before < k; ++before) {
      if (options.find("--" + lines[before].key) != option) continue;
      fail("the --config file gives '{}' twice; leave one out", lines[k].key);
    }
  }
  return lines;
}

/// Whether someone asked for the value of this option: on the command line, or by a file that does not just list
/// defaults, as the file that repeats a run does.
[[nodiscard]] inline bool is_wish(const Option& option) {
  if (option.given.empty()) return false;
  const bool is_default = option.given.size() == 1 && option.given.front() == option.default_text;
  return !(is_default && option.in_file);
}

/// Throws Error for an option that was asked for but changes nothing.
inline void refuse_idle(const Options& options, const IdleOptions& idle) {
  for (const IdleOption& o : idle.all()) {
    const Option* option = options.find(o.name);
    if (option == nullptr) fail("'{}' is said to count only {}, but there is no such option", o.name, o.when_it_counts);
    if (!is_wish(*option)) continue;
    std::string value;
    for (const std::string& text : option->given) value += (value.empty() ? "" : ",") + text;
    fail("{} is {}, but counts only {}; leave it out, or change the other option", o.name, value, o.when_it_counts);
  }
}

/// The text of a settings file that repeats the run: every option that counts, as given or with its default. Empty
/// texts and lists are defaults and are left out.
[[nodiscard]] inline std::string settings_text(const Options& options, const IdleOptions& idle) {
  std::string lines;
  for (const Option& option : options.all()) {
    if (!option.is_setting) continue;
    std::vector<std::string> values = option.given;
    if (values.empty() && !option.default_text.empty()) values = {option.default_text};
    if (values.empty() || values.front().empty() || idle.contains(option.name)) continue;
    const bool is_text = std::holds_alternative<std::string*>(option.value);
    std::string joined;
    for (const std::string& v : values) joined += (joined.empty() ? "" : ", ") + (is_text ? toml_text(v) : v);
    lines += text("{}={}\n", option.key(), values.size() > 1 ? "[" + joined + "]" : joined);
  }
  return lines;
}

/// Throws Error unless two texts of settings files are those of runs with the same results: `then` of one that was
/// stopped, `now` of the one that is to go on with it. The option that differs is named.
inline void require_same_settings(std::string_view then, std::string_view now, const std::vector<std::string>& free,
                                  const std::string& where) {
  const auto lines_of = [&](std::string_view text) {
    std::vector<ConfigLine> lines = read_config(text);
    std::erase_if(lines, [&](const ConfigLine& l) { return std::find(free.begin(), free.end(), l.key) != free.end(); });
    return lines;
  };
  const auto value_in = [](const std::vector<ConfigLine>& lines, const std::string& key) {
    std::string value;
    for (const ConfigLine& l : lines) {
      for (std::size_t k = 0; l.key == key && k < l.values.size(); ++k) value += (k == 0 ? "" : ",") + l.values[k];
    }
    return value.empty() ? "not given" : value;
  };
  const auto before = lines_of(then), after = lines_of(now);
  for (const auto* list : {&before, &after}) {
    for (const ConfigLine& l : *list) {
      const std::string a = value_in(before, l.key), b = value_in(after, l.key);
      if (a == b) continue;
      fail(
          "--{} was {} in the run in '{}' that is to go on, but is {} now; give the same settings (--config "
          "{}/settings.toml), or another --output for a new run",
          l.key, a, where, b, where);
    }
  }
}

}  // namespace dem::rig
