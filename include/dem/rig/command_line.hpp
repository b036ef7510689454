#pragma once
// Options from a command line and from a settings file, by CLI11. Only what includes this header needs it.

#include <dem/io/file.hpp>
#include <dem/rig/settings_file.hpp>
#include <dem/rig/tell.hpp>

#include <CLI/CLI.hpp>

#include <istream>
#include <iterator>
#include <memory>

namespace dem::rig {

namespace detail {

/// Reads settings files for CLI11, which alone passes over tables, over names that are no option, and over what is
/// given a second time.
class StrictConfig : public CLI::ConfigBase {
 public:
  explicit StrictConfig(Options& options) : options_(options) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& in) const override {
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    std::vector<CLI::ConfigItem> found;
    for (ConfigLine& line : read_settings_file(text, options_)) {
      for (Option& o : options_.all()) o.in_file |= &o == options_.find("--" + line.key);
      found.push_back({.parents = {}, .name = std::move(line.key), .inputs = std::move(line.values)});
    }
    return found;
  }

 private:
  Options& options_;
};

inline const char* kind_of(const OptionValue& value) {
  static constexpr const char* kinds[] = {"BOOLEAN", "INT", "UINT", "FLOAT", "TEXT", "FLOAT"};
  return kinds[value.index()];
}

inline CLI::Option* add_to(CLI::App& app, const Option& option) {
  const auto read = [&option](const CLI::results_t& texts) { return read_value(option, texts); };
  CLI::Option* added = nullptr;
  if (option.is_flag) {
    const std::string off = option.no.empty() ? "" : ",!" + option.no;
    added = app.add_flag(option.name + off, *std::get<bool*>(option.value), option.text);
  } else {
    added = app.add_option(option.name, read, option.text);
    added->type_name(kind_of(option.value))->type_size(1);
    const bool is_list = std::holds_alternative<std::vector<double>*>(option.value);
    if (is_list) added->expected(CLI::detail::expected_max_vector_size)->delimiter(',');
    else added->expected(1);
    if (!option.choices.empty()) added->check(CLI::IsMember(option.choices));
  }
  return added->group(option.group.empty() ? "Options" : option.group)->default_str(option.default_text);
}

}  // namespace detail

/// What a program says of itself, besides its options.
struct ProgramText {
  std::string name = {};    ///< of the program, which its messages begin with
  std::string title = {};   ///< of its report
  std::string about = {};   ///< one line for --help
  std::string footer = {};  ///< of --help, below the options
};

/// Reads the command line and, with --config, a settings file, whose every name must be an option; what the command
/// line gives comes first. Afterwards the values and Option::given are set. Returns false when only help was asked
/// for, which is then printed. Throws Error when something cannot be understood.
inline bool read_command_line(const ProgramText& program, int argc, const char* const* argv, Options& options) {
  CLI::App app{program.about};
  app.set_config("--config", "", "TOML file with any of these options");
  app.config_formatter(std::make_shared<detail::StrictConfig>(options));
  app.footer(program.footer);
  std::vector<CLI::Option*> added;
  for (Option& option : options.all()) {
    option.default_text = text_of(option);
    added.push_back(detail::add_to(app, option));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    tell(stdout, "{}", app.help());
    return false;
  } catch (const CLI::ParseError& e) {
    fail("{} (--help lists the options)", e.what());
  }
  for (std::size_t k = 0; k < added.size(); ++k) {
    if (added[k]->count() > 0) options.all()[k].given = added[k]->reduced_results();
  }
  return true;
}

}  // namespace dem::rig
