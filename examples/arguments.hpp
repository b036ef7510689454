#pragma once

// The command line of a small example: `--name value`, in any order.

#include <dem/core/error.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

class Arguments {
 public:
  /// Throws dem::Error for what is no pair of a name and a value.
  Arguments(int argc, char** argv) {
    for (int k = 1; k < argc; k += 2) {
      const std::string name = argv[k];
      if (name.rfind("--", 0) != 0 || k + 1 == argc)
        dem::fail("'{}' is no option with a value, as --output folder", name);
      given_[name] = argv[k + 1];
    }
  }
  double number(const std::string& name, double otherwise) {
    const std::string text = take(name, "");
    return text.empty() ? otherwise : number_in(text, name);
  }
  /// Numbers with commas between them, at least one.
  std::vector<double> numbers(const std::string& name, std::vector<double> otherwise) {
    const std::string text = take(name, "");
    if (text.empty()) return otherwise;
    std::vector<double> values;
    for (std::size_t from = 0; from <= text.size();) {
      const std::size_t to = std::min(text.find(',', from), text.size());
      values.push_back(number_in(text.substr(from, to - from), name));
      from = to + 1;
    }
    return values;
  }
  std::string take(const std::string& name, const std::string& otherwise) {
    const auto found = given_.find(name);
    if (found == given_.end()) return otherwise;
    const std::string text = found->second;
    given_.erase(found);
    return text;
  }
  /// To be called when all options were taken. Throws dem::Error for one that nobody asked for.
  void check() const {
    if (!given_.empty()) dem::fail("{} is no option of this program", given_.begin()->first);
  }

 private:
  static double number_in(const std::string& text, const std::string& name) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') dem::fail("{} is '{}', but must be a number", name, text);
    return value;
  }

  std::map<std::string, std::string> given_;
};
