#pragma once
// Stages of a run: what they tell while they run, and how a world is run within them.

#include <dem/core/error.hpp>
#include <dem/core/output.hpp>
#include <dem/report/interrupt.hpp>
#include <dem/rig/part.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace dem::rig {

/// Thrown within a stage after Ctrl-C or SIGTERM.
struct Interrupted {};

/// Thrown when the simulation reports a problem, or a stage does not come to its end.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

namespace detail {

/// Stages that this thread is in and that are saved when Ctrl-C comes: they end at their next update(), where they can
/// be gone on with, and not after the step that is under way.
inline thread_local int kept_stages = 0;

}  // namespace detail

/// A stage that was entered, until this goes: whether it is to be run.
class EnteredStage {
 public:
  EnteredStage(Part* part, Part::Entry entry)
      : part_(part), entry_(entry), is_kept_(part != nullptr && *this && part->is_kept()) {
    if (is_kept_) ++detail::kept_stages;
  }
  EnteredStage(const EnteredStage&) = delete;
  EnteredStage& operator=(const EnteredStage&) = delete;
  ~EnteredStage() {
    if (is_kept_) --detail::kept_stages;
    if (part_ != nullptr && entry_ != Part::Entry::skip) part_->leave();
  }
  /// False: it was done before the run was stopped that is gone on with.
  explicit operator bool() const { return entry_ != Part::Entry::skip; }
  /// Whether it begins; else it goes on where it was saved.
  [[nodiscard]] bool begins() const { return entry_ == Part::Entry::begin; }

 private:
  Part* part_;
  Part::Entry entry_;
  bool is_kept_;
};

/// Something that is kept with a part, until this goes.
class KeptWhile {
 public:
  explicit KeptWhile(Part* part) : part_(part) {}
  KeptWhile(const KeptWhile&) = delete;
  KeptWhile& operator=(const KeptWhile&) = delete;
  ~KeptWhile() {
    if (part_ != nullptr) part_->drop();
  }

 private:
  Part* part_;
};

/// Numbers of a stage that has none.
struct NoNumbers {
  template <class V>
  void fields(V&) {}
};

/// What the stages of a run tell. Session shows it; this one keeps quiet.
///
/// A run that was stopped goes on by running again, from its start, all but what was done: stages that are entered. So
/// what a stage does belongs between enter() and its end, and what it needs of the world is set up by enter().
///
///     Pushing n = {.start = world.time()};
///     stages.begin("push", travel);
///     if (const auto stage = stages.enter(world, n, [&] { m.set_target(drive, push_from(n.start)); })) {
///       while (world.time() < n.start + time) {
///         run(world, 1e-3);
///         stages.update(world.time() - n.start);   // here it may be saved
///       }
///     }
class Stages {
 public:
  /// Total of a stage whose end is not known beforehand.
  static constexpr double unknown = 0.0;

  virtual ~Stages() = default;
  /// A stage begins, and the one before it is done. `total` is its amount of work in any unit.
  virtual void begin([[maybe_unused]] std::string_view name, [[maybe_unused]] double total = unknown) {}
  /// So much of the total is done; `status` is one line on how things stand. Throws Interrupted after Ctrl-C in a stage
  /// of a part, which is saved first if it is kept.
  virtual void update([[maybe_unused]] double done, [[maybe_unused]] std::string_view status = {}) {}
  /// What the next update() tells was done by an earlier run: the stage goes on where it was saved.
  virtual void go_on() {}
  /// The stage is done; `result` is one line on what came out.
  virtual void finish([[maybe_unused]] std::string_view result = {}) {}
  /// Calls `f` while no run beside this one calls anything so: for what only one may do at a time.
  virtual void alone(const std::function<void()>& f) { f(); }
  /// Threads that a world of this stage may use now; 0: those that it has. More, where runs beside this one have ended.
  [[nodiscard]] virtual int threads() const { return 0; }
  /// Something to know besides, as a warning.
  virtual void message([[maybe_unused]] std::string_view text) {}

  /// Enters a stage of a world, after begin(). It may be saved at each update() from here on until the result goes: so
  /// world and `numbers`, a struct with fields (see io::Fields), are then all that the rest of the stage depends on.
  /// `set_up()` adds what the stage needs in the world (parts, functions, friction). It is called whether the stage is
  /// run or not, as later stages stand on it; where the stage goes on, with the numbers from the file and before the
  /// world takes its state. Throws Error if the state does not fit the world.
  template <class World, class Numbers, std::invocable SetUp>
  [[nodiscard]] EnteredStage enter(World& world, Numbers& numbers, SetUp&& set_up) {
    auto entry = Part::Entry::begin;
    if (part_ != nullptr) {
      entry = part_->enter(std::make_unique<detail::KeptAs<Numbers>>(numbers), &world, &detail::mark_of<World>);
    }
    set_up();
    if (entry == Part::Entry::go_on) part_->restore_world(), go_on();
    return {part_, entry};
  }
  template <class World, class Numbers>
  [[nodiscard]] EnteredStage enter(World& world, Numbers& numbers) {
    return enter(world, numbers, [] {});
  }
  /// Keeps something with fields besides, under a name, as long as the result lives: what was found so far.
  template <class T>
  [[nodiscard]] KeptWhile keep(std::string_view name, T& it) {
    if (part_ != nullptr) part_->keep(name, std::make_unique<detail::KeptAs<T>>(it));
    return KeptWhile(part_);
  }
  /// The same of something that may not be there: null.
  template <class T>
  [[nodiscard]] KeptWhile keep(std::string_view name, T* it) {
    if (it == nullptr) return KeptWhile(nullptr);
    return keep(name, *it);
  }
  /// The stages of the part are done. Later parts start from this world: it is saved, or where the part was done before
  /// takes its state from the file.
  template <class World>
  void complete(World& world) {
    if (part_ != nullptr) warn(part_->complete(&world, &detail::mark_of<World>));
  }
  /// The same where no world is handed on.
  void complete() {
    if (part_ != nullptr) warn(part_->complete(nullptr, nullptr));
  }
  /// The part that the stages belong to from now on; null: they are not kept.
  void set_part(Part* part) { part_ = part; }
  [[nodiscard]] Part* part() const { return part_; }

 protected:
  /// To be called by update(). After Ctrl-C in a stage of a part it throws Interrupted; where the part is kept it is
  /// saved first, whether it is due or not.
  void save_if_due() {
    if (part_ == nullptr) return;
    const bool ends = processes.any(io::interrupted()) && part_->is_in_stage();
    warn(ends && part_->is_kept() ? part_->save_now() : part_->save_if_due());
    if (ends) throw Interrupted{};
  }

 private:
  void warn(const std::string& problem) {
    if (!problem.empty()) message("warning: the run could not be saved to go on from here: " + problem);
  }

  Part* part_ = nullptr;
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
/// came, if a guard watches for it and the stage is not one that is saved at its next update().
template <class World, class BeforeStep>
void run(World& world, double duration, BeforeStep&& before_step) {
  world.prepare();
  const double steps = std::max(1.0, std::round(duration / world.time_step()));
  require_within(steps, 1.0, 0x1.0p53, "number of steps of a stage");
  const auto ends_at_once = [] { return io::interrupted() && detail::kept_stages == 0; };
  before_step();
  const auto report = world.run(static_cast<std::uint64_t>(steps), [&, left = steps]() mutable {
    if (ends_at_once()) return false;
    if (--left > 0.0) before_step();
    return true;
  });
  if (!report) throw Stopped(report.text);
  if (processes.any(ends_at_once())) throw Interrupted{};
}
/// The same without anything between the steps.
template <class World>
void run(World& world, double duration) {
  run(world, duration, [] {});
}

/// Gives a world the threads that its run may use now.
template <class World>
void use_free_threads(World& world, const Stages& stages) {
  if (const int threads = stages.threads(); threads > 0 && threads != world.threads()) world.set_threads(threads);
}

}  // namespace dem::rig
