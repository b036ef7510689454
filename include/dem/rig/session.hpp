#pragma once
// One run of a rig's program, from its checked start to what is known at its end.

#include <dem/io/duration.hpp>
#include <dem/io/file.hpp>
#include <dem/report/interrupt.hpp>
#include <dem/report/progress.hpp>
#include <dem/rig/checkpoint_folder.hpp>
#include <dem/rig/folder_lock.hpp>
#include <dem/rig/old_results.hpp>
#include <dem/rig/own_words.hpp>
#include <dem/rig/stages.hpp>
#include <dem/rig/tell.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig {

/// How a run ended.
struct Outcome {
  bool interrupted = false;
  std::string problem = {};         ///< why it ended early; empty if it did not
  std::string frames_problem = {};  ///< why files for ParaView are missing, also of runs within; empty if none are
  std::string report_problem = {};  ///< which runs within this one have reports without parts; empty if none do
  double wall_time = 0.0;           ///< s
};

/// A run with its output folder. What it starts from is checked first; then begin_run() makes the folder the run's own
/// and shows the progress of the stages.
class Session final : public Stages {
 public:
  /// What stays the same from the start to the end of a run.
  struct Set {
    std::string program = {};         ///< its name, which messages begin with
    std::string output = {};          ///< folder
    std::string config = {};          ///< text of settings.toml
    ResultNames results = {};         ///< of this rig
    std::vector<OwnWord> words = {};  ///< for what the library calls otherwise than the program
    CheckpointOptions checkpoints = {};
    /// Of a run that is a stage of another one: that one's stages, whose stage has the total 1. They are told how far
    /// this run is, and whoever runs that one watches for Ctrl-C. Null: a run of its own.
    Stages* within = nullptr;
  };

  explicit Session(Set set) : set_(std::move(set)), parts_(set_.program, set_.output, set_.config, set_.checkpoints) {}

  [[nodiscard]] std::filesystem::path folder() const { return set_.output; }
  [[nodiscard]] const std::string& program() const { return set_.program; }
  [[nodiscard]] const std::string& config() const { return set_.config; }
  [[nodiscard]] const CheckpointOptions& checkpoints() const { return set_.checkpoints; }
  [[nodiscard]] std::string in_own_words(std::string_view text) const { return rig::in_own_words(text, set_.words); }

  /// Throws Error unless a file can be written there, and is none of the run's own; an older one stays as it is.
  /// `option` is what sets the path.
  void require_writable(const std::filesystem::path& file, const char* option) {
    lock();
    if (std::filesystem::is_directory(file)) {
      fail("'{}' is a folder, but a file is to be written there; give another path", file.string());
    }
    if (is_own_file(file, folder(), set_.results)) {
      fail("{} is '{}', but the run writes a result of its own there; give another path", option, file.string());
    }
    io::AtomicFile{file};  // is gone again, for it is not committed
  }

  /// Something to be said as soon as the run begins: nothing of a run that is refused.
  void say_when_begun(std::string words) { notes_.push_back(std::move(words)); }

  /// The check of the start is over: `stages` will follow. Results of an earlier run in the folder go, and it is said
  /// which; `also` is what else will be replaced later. A run that goes on leaves them. The settings file is written.
  /// From here on Ctrl-C and SIGTERM end the run after the present step, or at the next update() of a stage that is
  /// kept. Throws Error, and leaves earlier results as they are, if the folder cannot be written to, another process
  /// runs in it, or the run in it cannot go on.
  void begin_run(int stages, const std::string& also = {}) {
    lock();
    processes.any(false);  // all have read what they start from
    if (parts_.resumes()) {
      parts_.check();
      io::write_file(folder() / "settings.toml", set_.config);
    } else {
      make_room(also);
    }
    processes.of_first(0);  // whoever writes has made room
    parts_.start();
    stages_ = stages;
    if (set_.within == nullptr) {
      guard_ = std::make_unique<io::InterruptGuard>();
      io::ProgressOptions options;
      options.stages = stages;
      if (!process_writes_files) options.out = nullptr;
      progress_.emplace(options);
    }
    for (const std::string& note : notes_) message(note);
    if (!parts_.resumes()) return;
    const auto files = parts_.parts();
    message(files.empty() ? "The run had kept nothing to go on from: it begins anew."
                          : text("Going on where {} part{} of the run {} kept last.", files.size(),
                                 files.size() > 1 ? "s" : "", files.size() > 1 ? "were" : "was"));
  }
  [[nodiscard]] bool has_begun() const { return stages_ >= 0; }

  /// Where the parts of the run are kept.
  [[nodiscard]] CheckpointFolder& parts() { return parts_; }

  void begin(std::string_view name, double total = unknown) override {
    if (progress_) return progress_->begin(name, total);
    ++stage_;
    name_ = name;
    total_ = total;
    tell_within(0.0, {});
  }
  void update(double done, std::string_view status = {}) override {
    if (progress_) progress_->update(done, status);
    else tell_within(done, status);
    save_if_due();
  }
  void go_on() override { progress_ ? progress_->go_on() : set_.within->go_on(); }
  void finish(std::string_view result = {}) override {
    if (progress_) progress_->finish(result);
  }
  void message(std::string_view text) override {
    const std::string words = in_own_words(text);
    if (progress_) progress_->message(words);
    else set_.within->message(words);
  }

  /// Files for ParaView of `what` cannot be written: it is said, and noted for the report.
  void give_up_frames(const std::string& why, const char* what) {
    outcome.frames_problem = why;
    message(text("warning: no more files for ParaView of {}: {}", what, why));
  }

  /// Notes the end of a run that has begun; `problem` is empty if there is none.
  void end(const std::string& problem = {}) {
    outcome.problem = in_own_words(problem);
    if (progress_) progress_->stop(outcome.problem);
    outcome.wall_time = parts_.wall_time();
    guard_.reset();
  }

  Outcome outcome;

 private:
  void lock() {
    if (lock_) return;
    if (parts_.resumes()) parts_.require_begun();  // before there is a folder
    if (!process_writes_files) return;
    io::make_folder_of(folder() / "settings.toml");
    lock_.emplace(set_.output, set_.program);
  }

  /// Removes what an earlier run has left, and writes the settings of this one.
  void tell_or_message(const std::string& words) {
    if (set_.within == nullptr) tell(stderr, "{}\n", words);
    else set_.within->message(words);
  }
  void make_room(const std::string& also) {
    if (!process_writes_files) return;
    const auto settings = folder() / "settings.toml";
    io::AtomicFile{settings};  // is gone again: the folder can be written to
    auto old = find_old_results(folder(), set_.results);
    const auto parts = parts_.parts();
    old.insert(old.end(), parts.begin(), parts.end());
    if (old.empty() && !also.empty()) tell_or_message(text("Replacing {}.", also));
    if (!old.empty()) {
      const bool same = std::filesystem::exists(settings) && io::read_file(settings) == set_.config;
      std::string names;
      for (const auto& path : old) {
        names += (names.empty() ? "" : ", ") + path.lexically_proximate(folder()).generic_string();
      }
      const std::string replacing =
          text("Replacing what an earlier run with {} settings left in '{}': {}{}. Another --output keeps it.",
               same ? "the same" : "other", set_.output, names, also.empty() ? "" : ", and " + also);
      tell_or_message(replacing);
    }
    parts_.clear();  // first: they are those of the settings that were there
    io::write_file(settings, set_.config);
    remove_old_results(folder(), set_.results);
  }

  /// What another run is told: the share of all stages that is done.
  void tell_within(double done, std::string_view status) {
    const double share = total_ > 0.0 ? std::clamp(done / total_, 0.0, 1.0) : 0.0;
    const double all = std::max({stages_, stage_, 1});
    set_.within->update(std::min(1.0, (stage_ - 1 + share) / all),
                        name_ + (status.empty() ? "" : ": ") + std::string(status));
  }

  Set set_;
  int stages_ = -1, stage_ = 0;  // of the run, once it has begun; of a run within another one, the stage that it is in
  std::string name_;
  double total_ = unknown;
  std::vector<std::string> notes_;
  CheckpointFolder parts_;
  std::optional<FolderLock> lock_;
  std::unique_ptr<io::InterruptGuard> guard_;
  std::optional<io::Progress> progress_;
};

}  // namespace dem::rig
