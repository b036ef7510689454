#pragma once
// Stages of a run: what they tell while they run, and how a world is run within them.

#include <dem/core/error.hpp>
#include <dem/report/interrupt.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>

namespace dem::rig {

/// Thrown within a stage after Ctrl-C or SIGTERM.
struct Interrupted {};

/// Thrown when the simulation reports a problem, or a stage does not come to its end.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What the stages of a run tell. Session shows it; this one keeps quiet.
class Stages {
 public:
  /// Total of a stage whose end is not known beforehand.
  static constexpr double unknown = 0.0;

  virtual ~Stages() = default;
  /// A stage begins, and the one before it is done. `total` is its amount of work in any unit.
  virtual void begin([[maybe_unused]] std::string_view name, [[maybe_unused]] double total = unknown) {}
  /// So much of the total is done; `status` is one line on how things stand.
  virtual void update([[maybe_unused]] double done, [[maybe_unused]] std::string_view status = {}) {}
  /// The stage is done; `result` is one line on what came out.
  virtual void finish([[maybe_unused]] std::string_view result = {}) {}
  /// Something to know besides, as a warning.
  virtual void message([[maybe_unused]] std::string_view text) {}
};

/// Calls work(), and then save(), also when the work is stopped: each run of a campaign keeps what it has found.
template <class Work, class Save>
void work_and_save(Work&& work, Save&& save) {
  try {
    work();
  } catch (...) {
    save();
    throw;
  }
  save();
}

/// Runs a world for a time (s), rounded to whole steps, at least one, calling `before_step()` before each. Throws
/// Stopped with the report of a step that shows a problem, and Interrupted after the step in which Ctrl-C or SIGTERM
/// came, if a guard watches for it.
template <class World, class BeforeStep>
void run(World& world, double duration, BeforeStep&& before_step) {
  world.prepare();
  const double steps = std::max(1.0, std::round(duration / world.time_step()));
  require_within(steps, 1.0, 0x1.0p53, "number of steps of a stage");
  before_step();
  const auto report = world.run(static_cast<std::uint64_t>(steps), [&, left = steps]() mutable {
    if (io::interrupted()) return false;
    if (--left > 0.0) before_step();
    return true;
  });
  if (!report) throw Stopped(report.text);
  if (io::interrupted()) throw Interrupted{};
}
/// The same without anything between the steps.
template <class World>
void run(World& world, double duration) {
  run(world, duration, [] {});
}

}  // namespace dem::rig
