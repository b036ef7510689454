#pragma once

// The command line of a small example: `--name value`, in any order; and its main().

#include <dem/core/error.hpp>
#include <dem/rig/fail_with.hpp>
#include <dem/rig/launcher.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

class Arguments {
 public:
  /// What check() throws where options are only to be told: their list.
  struct Help {
    std::string options;
  };

  /// Throws dem::Error for what is no pair of a name and a value.
  Arguments(int argc, char** argv) {
    for (int k = 1; k < argc; k += 2) {
      const std::string name = argv[k];
      if (name == "--help" || name == "-h") {
        helps_ = true;
        return;
      }
      if (name.rfind("--", 0) != 0 || k + 1 == argc)
        dem::fail("'{}' is no option with a value, as --output folder; --help lists the options", name);
      given_[name] = argv[k + 1];
    }
  }
  /// `about` is for --help.
  double number(const std::string& name, double otherwise, const std::string& about) {
    const std::string text = given(name, fmt::format("{:g}", otherwise), about);
    return text.empty() ? otherwise : number_in(text, name);
  }
  /// Numbers with commas between them, at least one.
  std::vector<double> numbers(const std::string& name, std::vector<double> otherwise, const std::string& about) {
    const std::string text = given(name, fmt::format("{:g}", fmt::join(otherwise, ",")), about);
    if (text.empty()) return otherwise;
    std::vector<double> values;
    for (std::size_t from = 0; from <= text.size();) {
      const std::size_t to = std::min(text.find(',', from), text.size());
      values.push_back(number_in(text.substr(from, to - from), name));
      from = to + 1;
    }
    return values;
  }
  std::string take(const std::string& name, const std::string& otherwise, const std::string& about) {
    const std::string text = given(name, otherwise, about);
    return text.empty() ? otherwise : text;
  }
  /// To be called when all options were taken. Throws dem::Error for one that nobody asked for, and Help for --help.
  void check() const {
    if (helps_) throw Help{options_};
    if (!given_.empty()) dem::fail("{} is no option of this program; --help lists them", given_.begin()->first);
  }

 private:
  std::string given(const std::string& name, const std::string& otherwise, const std::string& about) {
    options_ += fmt::format("  {:<28} {}\n", name + " " + otherwise, about);
    const auto found = given_.find(name);
    if (found == given_.end()) return {};
    const std::string text = found->second;
    given_.erase(found);
    return text;
  }
  static double number_in(const std::string& text, const std::string& name) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') dem::fail("{} is '{}', but must be a number", name, text);
    return value;
  }

  std::map<std::string, std::string> given_;
  std::string options_;  // that were taken, a line each
  bool helps_ = false;
};

/// What main() returns after `program(arguments)`: what that returns, 0 where it returns nothing, and 1 after an
/// exception, of which it tells in words. `about` is for --help.
template <class Program>
int run_example(int argc, char** argv, const std::string& about, Program&& program) {
  const std::string path = argc > 0 ? argv[0] : "example", name = path.substr(path.rfind('/') + 1);
  if (!dem::rig::may_run(name, path)) return 1;
  try {
    Arguments arguments(argc, argv);
    if constexpr (std::is_void_v<std::invoke_result_t<Program, Arguments&>>) program(arguments);
    else return program(arguments);
  } catch (const Arguments::Help& help) {
    fmt::print("{}\n\nOptions, and what they are unless given:\n{}", about, help.options);
  } catch (const std::exception& error) {
    return dem::rig::fail_with(1, name + ": " + error.what());
  }
  return 0;
}
