#pragma once

#include "idle_options.hpp"

#include <dem/core/error.hpp>

#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <istream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// The --config file, read and written.

namespace direct_shear {

/// TOML that must be understood as a whole: CLI11 alone passes over tables, over names that are no option, and over
/// what is given a second time.
class StrictToml : public CLI::ConfigBase {
 public:
  explicit StrictToml(const CLI::App& app) : app_(app) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& in) const override {
    auto lines = ConfigBase::from_config(in);
    for (const auto& item : lines) {
      if (!item.parents.empty()) {
        dem::fail("the --config file has a table [{}], but must have none; give its options without that header",
                  fmt::join(item.parents, "."));
      }
      if (app_.get_option_no_throw("--" + item.name) == nullptr) {
        dem::fail("the --config file gives '{}', but there is no such option; --help lists them", item.name);
      }
      if (!given_.insert("--" + item.name).second) {
        dem::fail("the --config file gives '{}' twice; leave one out", item.name);
      }
    }
    return lines;
  }

  /// Whether someone asked for this option's value: on the command line, or by a file that does not just list defaults,
  /// as settings.toml does.
  bool is_wish(const CLI::Option& option) const {
    if (option.count() == 0) return false;
    const bool default_value = option.results() == std::vector<std::string>{option.get_default_str()};
    return !(default_value && given_.contains(option.get_name()));
  }

 private:
  const CLI::App& app_;
  mutable std::set<std::string> given_;  // reading is const in CLI11
};

/// Throws Error for an option that was asked for, on the command line or by the --config file, but changes nothing.
inline void refuse_idle(const std::vector<IdleOption>& idle, const CLI::App& app, const StrictToml& toml) {
  for (const IdleOption& o : idle) {
    const CLI::Option& option = *app.get_option(o.name);
    if (!toml.is_wish(option)) continue;
    dem::fail("{} is {}, but counts only {}; leave it out, or change the other option", o.name,
              fmt::join(option.results(), ","), o.when_it_counts);
  }
}

/// The text of settings.toml: every option that counts. CLI11 writes empty texts and lists in a form that it does not
/// read; they are defaults, so they may go.
inline std::string all_that_counts(const CLI::App& app, const std::vector<IdleOption>& idle) {
  std::istringstream in(app.config_to_str(true, false));
  std::string kept;
  for (std::string line; std::getline(in, line);) {
    const bool empty = line.ends_with("=\"\"") || line.ends_with("=\"[]\"") || line.ends_with("=[]");
    const std::string name = "--" + line.substr(0, line.find('='));
    const bool counts = std::none_of(idle.begin(), idle.end(), [&](const IdleOption& o) { return o.name == name; });
    if (!empty && counts) kept += line + '\n';
  }
  return kept;
}

}  // namespace direct_shear
