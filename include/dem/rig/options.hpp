#pragma once
// What of a rig can be chosen from outside: names, texts and places of values. command_line.hpp reads them from a
// command line, config_text.hpp from a file; neither is needed to fill in a struct of settings by hand.

#include <dem/core/error.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace dem::rig {

/// Where the value of an option is kept.
using OptionValue = std::variant<bool*, int*, std::uint64_t*, double*, std::string*, std::vector<double>*>;

/// One option, and what of it was given.
struct Option {
  std::string name;  ///< with its dashes: "--travel"
  std::string text;  ///< for --help, with the unit
  OptionValue value;
  std::string group = {};
  std::string no = {};                    ///< of a flag: the name that switches it off, "--no-vtk"
  bool is_flag = false;                   ///< may stand without a value
  std::vector<std::string> choices = {};  ///< that a text must be one of; empty: any text
  std::vector<std::string> given = {};    ///< texts of its value, as given; empty if nobody gave it
  std::string default_text = {};          ///< of the value before anything was read
  bool in_file = false;                   ///< the settings file gives it
  bool is_setting = true;                 ///< false: how this run is gone about; not in the file that repeats it
  bool changes_results = true;            ///< false: a run may go on with another value
  [[nodiscard]] std::string key() const { return name.substr(2); }  ///< in a settings file
};

/// The options of a program, in the order in which --help shows them.
///
///     options.group("Blade");
///     options.add("--depth", depth, "of the blade in the bed [m]");
///     options.add("--shape", shape, "of the grains").one_of({"sphere", "cube"});
///     options.flag("--vtk", vtk, "files for ParaView").off("--no-vtk");
///
/// The values are the caller's and must outlive it. They hold the defaults when they are added.
class Options {
 public:
  /// Refines the option that was added last.
  class Added {
   public:
    explicit Added(Option& option) : option_(option) {}
    /// The texts that are allowed.
    Added& one_of(std::vector<std::string> choices) {
      option_.choices = std::move(choices);
      return *this;
    }
    /// The name that switches a flag off.
    Added& off(std::string name) {
      option_.no = std::move(name);
      return *this;
    }

    /// What is found does not depend on it: a run that was stopped may go on with another value.
    Added& changes_no_result() {
      option_.changes_results = false;
      return *this;
    }
    /// It says how this run is gone about, and is not in the file that repeats it.
    Added& of_this_run() {
      option_.is_setting = false;
      return *this;
    }

   private:
    Option& option_;
  };

  /// The heading that the options after it stand under.
  void group(std::string name) { group_ = std::move(name); }

  /// An option with a value. Throws Error for a name without "--", or one that there is already.
  Added add(std::string name, OptionValue value, std::string text) {
    return Added(insert({.name = std::move(name), .text = std::move(text), .value = value}));
  }
  template <class T>
  requires std::constructible_from<OptionValue, T*> Added add(std::string name, T& value, std::string text) {
    return add(std::move(name), OptionValue(&value), std::move(text));
  }
  /// An option that may be given without a value: it is true then.
  Added flag(std::string name, bool& value, std::string text) {
    return Added(insert({.name = std::move(name), .text = std::move(text), .value = &value, .is_flag = true}));
  }

  [[nodiscard]] std::span<Option> all() { return options_; }
  [[nodiscard]] std::span<const Option> all() const { return options_; }
  /// The option of that name, by which a flag may also be switched off; none if there is none.
  [[nodiscard]] const Option* find(std::string_view name) const {
    for (const Option& o : options_) {
      if (o.name == name || (!o.no.empty() && o.no == name)) return &o;
    }
    return nullptr;
  }

 private:
  Option& insert(Option option) {
    if (option.name.size() < 3 || !option.name.starts_with("--")) {
      fail("an option is called '{}', but must begin with two dashes; call it '--{}'", option.name, option.name);
    }
    if (find(option.name) != nullptr) fail("two options are called '{}'; rename one", option.name);
    option.group = group_;
    options_.push_back(std::move(option));
    return options_.back();
  }

  std::vector<Option> options_;
  std::string group_;
};

/// An option that changes nothing in a run, because of another option.
struct IdleOption {
  std::string name;
  std::string when_it_counts;  ///< "counts only ..."
};

/// Those that change nothing with these settings. They are refused when given, for who gives one expects that it does
/// something, and are left out of the file that repeats the run.
class IdleOptions {
 public:
  /// Says that options count only `when`, and whether they do.
  void unless(bool they_count, const char* when, std::initializer_list<const char*> names) {
    if (they_count) return;
    for (const char* name : names) idle_.push_back({name, when});
  }
  [[nodiscard]] const std::vector<IdleOption>& all() const { return idle_; }
  [[nodiscard]] bool contains(std::string_view name) const {
    for (const IdleOption& o : idle_) {
      if (o.name == name) return true;
    }
    return false;
  }

 private:
  std::vector<IdleOption> idle_;
};

}  // namespace dem::rig
