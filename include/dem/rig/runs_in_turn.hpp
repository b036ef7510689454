#pragma once

#include <dem/rig/stages.hpp>

#include <cstddef>
#include <exception>
#include <string_view>

namespace dem::rig {

/// Several runs, one after the other: one whose simulation is Stopped is told of, and the others go on. With one run,
/// or where several processes share each, of which the others may not have seen it, that ends all.
///
///     RunsInTurn runs(session, all.size());
///     for (const Variant& v : all) runs.run(v.text, [&] { ... });
///     runs.end();
class RunsInTurn {
 public:
  RunsInTurn(Stages& stages, std::size_t count) : stages_(stages), goes_on_(count > 1 && processes.count == 1) {}

  /// `name` is what the run is called; empty: the run itself.
  template <class F>
  void run(std::string_view name, F&& f) {
    try {
      f();
    } catch (const Stopped& stopped) {
      if (!goes_on_) throw;
      stages_.message(text("{} stopped; the others go on: {}", name.empty() ? "the run itself" : name, stopped.what()));
      if (!first_) first_ = std::current_exception();
    }
  }
  /// Throws what stopped the first of those that were stopped.
  void end() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  Stages& stages_;
  bool goes_on_;
  std::exception_ptr first_;
};

}  // namespace dem::rig
