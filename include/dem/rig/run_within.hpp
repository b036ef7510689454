#pragma once
// Runs of rigs as stages of the run of another one: a campaign of several apparatus.

#include <dem/rig/report.hpp>
#include <dem/rig/rig.hpp>

#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig {

/// A part of a run that has no world. It is done as soon as it is completed: a run all of whose parts are runs of their
/// own keeps one, as a run without any has nothing to go on with.
class PartWithoutWorld final : public Part {
 public:
  using Part::Part;

 private:
  void collect(void*, const void*, io::StateColumns&) const override { fail("a part without a world was given one"); }
  void restore_state(void*, const void*, io::StateColumns&) const override {
    fail("a part without a world was given one");
  }
};

/// Keeps such a part of a run that has begun, under a name: from now on there is something to go on with.
inline void keep_begun(Session& session, const std::string& name) {
  PartWithoutWorld begun(session.parts(), name);
  session.set_part(&begun);
  session.complete();
  session.set_part(nullptr);
}

/// The options by which a run within another one is kept: as that one is. It goes on where it was stopped, if it had
/// kept something; else it begins anew. `free_settings` are its own.
inline CheckpointOptions checkpoints_within(CheckpointOptions other, const std::string& program,
                                            const std::filesystem::path& output, const std::string& settings,
                                            std::vector<std::string> free_settings = {}) {
  other.free_settings = std::move(free_settings);
  other.resume = other.resume && !CheckpointFolder(program, output, settings, other).parts().empty();
  return other;
}

/// The text of a settings file that repeats a rig's run with the values that it has now.
inline std::string settings_as_they_are(Rig& rig) {
  Options options;
  rig.declare(options);
  for (Option& option : options.all()) option.default_text = text_of(option);
  IdleOptions idle;
  rig.find_idle(idle);
  return settings_text(options, idle);
}

/// Whether a path lies in a folder, however both are written.
inline bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto home = (folder.empty() ? std::filesystem::path(".") : folder).lexically_normal();
  const auto from = path.lexically_normal().lexically_relative(home);
  return !from.empty() && *from.begin() != "..";
}

/// Runs a rig, whose settings are resolved, in its own output folder as a stage of another run, and makes its report
/// there. `session` has begun that stage with the total 1. What ends the run early is thrown here, after the report.
/// Parts of the report and files for ParaView that are missing are noted in the outcome of `session`. The run is kept
/// and gone on with as the other one is; the files that it goes on from stay until forget_run_within(). `words` are
/// what the rig calls otherwise than the other run.
inline void run_within(Session& session, Rig& rig, const char* program, const char* title,
                       std::span<const OwnWord> words = {}) {
  std::vector<std::string> free_settings;
  Options options;
  rig.declare(options);
  for (const Option& option : options.all()) {
    // What lies in the folder of the other run, as its soil and its beds do, is where that folder is now.
    const auto* const place = std::get_if<std::string*>(&option.value);
    const bool goes_along = place != nullptr && !(*place)->empty() && lies_in(**place, session.folder());
    if (!option.changes_results || goes_along) free_settings.push_back(option.key());
  }
  const std::string config = settings_as_they_are(rig);
  CheckpointOptions checkpoints =
      checkpoints_within(session.checkpoints(), program, rig.output(), config, std::move(free_settings));
  std::vector<OwnWord> all_words(words.begin(), words.end());
  for (const OwnWord& word : rig.words()) all_words.push_back(word);
  Session own({program, rig.output(), config, rig.results(), std::move(all_words), std::move(checkpoints),
               static_cast<Stages*>(&session)});
  std::exception_ptr thrown;
  std::string problem;
  try {
    rig.run(own);
    if (!own.has_begun()) fail("the rig of {} has run no stage: run() did not call begin_run()", program);
  } catch (const Interrupted&) {
    thrown = std::current_exception();
    own.outcome.interrupted = true;
  } catch (const std::exception& error) {
    thrown = std::current_exception();
    problem = error.what();
  }
  if (!own.has_begun()) std::rethrow_exception(thrown);
  const bool all_ended = problem.empty() || processes.all_come();
  own.end(problem);
  if (process_writes_files) {
    Report report(own, title);
    bool has_frames = false;
    report.part("the report", [&] { has_frames = rig.report(report); });
    report.finish(has_frames);
    if (!own.outcome.frames_problem.empty()) session.outcome.frames_problem = own.outcome.frames_problem;
    if (!report.has_all_parts()) {
      std::string& problem_of_all = session.outcome.report_problem;
      problem_of_all +=
          text("{}Parts of the report in '{}' are missing", problem_of_all.empty() ? "" : ". ", rig.output());
    }
  }
  if (all_ended) processes.of_first(0);  // the others wait for the report
  if (thrown) std::rethrow_exception(thrown);
}

/// Removes what a run within another one was to go on from: that other one is done.
inline void forget_run_within(const std::filesystem::path& output) { CheckpointFolder("", output, "", {}).clear(); }

}  // namespace dem::rig
