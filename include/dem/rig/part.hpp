#pragma once
// A part of a run that is kept in a file, so that the run can go on from there after it was stopped or killed.

#include <dem/core/error.hpp>
#include <dem/io/checkpoint/fields.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::rig {

/// Something with fields (see io::Fields) that is kept as long as this lives.
class Kept {
 public:
  virtual ~Kept() = default;
  virtual void fields(io::Fields& v) = 0;
};

namespace detail {

template <class T>
class KeptAs final : public Kept {
 public:
  explicit KeptAs(T& it) : it_(it) {}
  void fields(io::Fields& v) override { v("", it_); }

 private:
  T& it_;
};

/// Its address stands for a type.
template <class T>
inline constexpr char mark_of = 0;

}  // namespace detail

/// Where the parts of a run are kept, and what of the run they carry. Session has one.
class PartStore {
 public:
  virtual ~PartStore() = default;
  /// Whether parts are kept at all.
  [[nodiscard]] virtual bool is_on() const = 0;
  /// Whether they are written as the run goes.
  [[nodiscard]] virtual bool writes() const = 0;
  /// Whether so much time has gone by since `last` (s, of a clock of its own) that a part is to be saved. `last` is
  /// then set to now.
  virtual bool is_due(double& last) = 0;
  /// The columns of a part as it was saved last; none if it was not, or if the run begins anew. Throws Error.
  virtual io::StateColumns read(const std::string& part) = 0;
  /// Saves them, and with them what the store has to say of the run. Returns why that did not work; empty if it did. It
  /// is no reason to end the run.
  virtual std::string write(const std::string& part, io::StateColumns& columns) = 0;
};

/// One part: stages that one world goes through, or one world after the other, and what the rig has found of them. A
/// file of a part says which stage it was in, the numbers of that stage, what is kept besides, and the state of the
/// world; of one that is done, only what was kept, and its world if it is handed on.
class Part {
 public:
  /// Reads the file of the part, if there is one. Throws Error.
  Part(PartStore& store, std::string name) : store_(store), name_(std::move(name)) {
    if (!store_.is_on()) return;
    io::StateColumns all = store_.read(name_);
    while (!all.empty()) {
      auto column = all.extract(all.begin());
      (column.key().starts_with("rig/") ? own_ : world_columns_).insert(std::move(column));
    }
    is_passing_ = !own_.empty();
    if (is_passing_) restore("rig/part", [&](io::Fields& v) { v("stage", saved_stage_), v("done", was_done_); });
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;
  virtual ~Part() = default;

  /// Whether the run that is gone on with had done all of this part.
  [[nodiscard]] bool is_done() const { return was_done_; }

  /// What a stage does that is entered.
  enum class Entry { skip, begin, go_on };

  /// The next stage. `numbers` are those of the stage; they take their values from the file where the stage goes on.
  Entry enter(std::unique_ptr<Kept> numbers, void* world, const void* type) {
    const std::uint64_t stage = next_stage_++;
    const bool goes_on = is_passing_ && !was_done_ && stage == saved_stage_;
    if (is_passing_ && !goes_on) return Entry::skip;
    if (goes_on) restore("rig/numbers", [&](io::Fields& v) { numbers->fields(v); });
    numbers_ = std::move(numbers);
    world_ = world;
    type_ = type;
    return goes_on ? Entry::go_on : Entry::begin;
  }
  /// The rest of entering one that goes on: the world, as far as it is set up, takes its state from the file.
  void restore_world() {
    restore_world_of(world_, type_);
    is_passing_ = false;
  }
  void leave() {
    numbers_.reset();
    world_ = nullptr;
  }

  /// From now on something is kept with every stage, until drop(). It takes its values from the file if they are there.
  void keep(std::string_view name, std::unique_ptr<Kept> it) {
    const std::string group = "rig/kept/" + std::string(name);
    const auto first = own_.lower_bound(group + "/");
    const bool is_there = first != own_.end() && first->first.starts_with(group + "/");
    if (is_passing_ && is_there) restore(group, [&](io::Fields& v) { it->fields(v); });
    kept_.emplace_back(name, std::move(it));
  }
  void drop() { kept_.pop_back(); }

  /// Whether it is in a stage.
  [[nodiscard]] bool is_in_stage() const { return numbers_ != nullptr; }
  /// Whether it is in a stage that is saved.
  [[nodiscard]] bool is_kept() const { return is_in_stage() && store_.writes(); }
  /// Saves the part, which is kept. Returns why that did not work.
  std::string save_now() { return save(world_, type_); }
  /// Saves the part, if it is in a stage and it is time to. Returns why that did not work.
  std::string save_if_due() { return numbers_ && store_.is_on() && store_.is_due(last_) ? save(world_, type_) : ""; }
  /// The part is done. Its world, if another part starts from it, is saved; or restored, if the part was done before.
  std::string complete(void* world, const void* type) {
    if (is_passing_ && !was_done_) {
      fail("the part '{}' of the run was saved in its stage {}, but has {} stages only", name_, saved_stage_,
           next_stage_);
    }
    if (!was_done_) {
      is_done_ = true;
      return store_.is_on() ? save(world, type) : "";
    }
    if (world != nullptr) restore_world_of(world, type);
    is_passing_ = false;
    return "";
  }

 protected:
  /// The state of a world of this type, and back.
  virtual void collect(void* world, const void* type, io::StateColumns& columns) const = 0;
  virtual void restore_state(void* world, const void* type, io::StateColumns& columns) const = 0;

 private:
  template <class F>
  void restore(const std::string& group, F&& f) {
    for (auto& [name, column] : own_) {
      if (name.starts_with(group + "/")) column.at = 0;  // something may be kept again, under the same name
    }
    io::Fields v(io::Fields::Task::restore, own_);
    v.group(group, [&] { f(v); });
  }

  std::string save(void* world, const void* type) {
    io::StateColumns columns, own;
    io::Fields v(io::Fields::Task::collect, own);
    std::uint64_t stage = next_stage_ - (next_stage_ > 0 ? 1 : 0);
    v.group("rig/part", [&] { v("stage", stage), v("done", is_done_); });
    for (const auto& [name, kept] : kept_) v.group("rig/kept/" + name, [&, &it = kept] { it->fields(v); });
    if (numbers_) v.group("rig/numbers", [&] { numbers_->fields(v); });
    if (world != nullptr) collect(world, type, columns);
    columns.merge(own);
    return store_.write(name_, columns);
  }

  void restore_world_of(void* world, const void* type) {
    if (world_columns_.empty()) return;
    try {
      restore_state(world, type, world_columns_);
    } catch (const Error& problem) {
      fail("cannot go on with the part '{}' of the run: {}", name_, problem.what());
    }
    world_columns_.clear();
  }

  PartStore& store_;
  std::string name_;
  io::StateColumns own_, world_columns_;  ///< of the file, until they are restored
  bool is_passing_ = false;               ///< stages are passed over, on the way to where the run goes on
  bool was_done_ = false, is_done_ = false;
  std::uint64_t saved_stage_ = 0, next_stage_ = 0;
  double last_ = -1.0;
  std::vector<std::pair<std::string, std::unique_ptr<Kept>>> kept_;
  std::unique_ptr<Kept> numbers_;  ///< of the stage that is entered
  void* world_ = nullptr;
  const void* type_ = nullptr;
};

}  // namespace dem::rig
