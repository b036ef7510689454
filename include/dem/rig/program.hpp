#pragma once
// The program of a rig. Needs CLI11. Programs that link dem::hdf5 can go on after they were stopped.

#include <dem/rig/command_line.hpp>
#include <dem/rig/fail_with.hpp>
#include <dem/rig/launcher.hpp>
#include <dem/rig/rig.hpp>
#if defined(DEM_WITH_HDF5)
#include <dem/rig/hdf5_checkpoints.hpp>
#endif

#include <csignal>
#include <exception>
#include <new>
#include <string>

#include <fcntl.h>

namespace dem::rig {

/// What run_program() returns, for --help.
inline constexpr const char* exit_codes =
    "Ends with 0 when all was done, 1 when the run ended early or a part of the report could not be made, 2 when the "
    "settings make no sense (results of an earlier run are then still there), 130 after Ctrl-C. What was found by then "
    "is saved and reported.";

namespace detail {

/// Opens the standard streams that this process was started without (2>&-): the next file that it opens would take
/// their numbers, and get what is printed.
inline void open_standard_streams() {
  for (int number = 0; number <= 2; ++number) {
    if (::fcntl(number, F_GETFD) != -1) continue;
    if (::open("/dev/null", O_RDWR) != number) return;
  }
}

inline const char* const no_memory = "there is not enough memory for so many grains; take fewer";

/// Adds the options of a rig that can go on after it was stopped.
inline void add_checkpoint_options(Options& options, CheckpointOptions& o) {
  options.group("Stop and go on");
  options
      .add("--checkpoint-every", o.every,
           "keep what the run can go on from, in the output folder, each time that so much wall time has gone by [s], "
           "and at Ctrl-C; 0: never; with --resume 900, unless it is given")
      .of_this_run();
  options
      .flag("--resume", o.resume,
            "go on with the run in the output folder that was stopped or killed, where it was kept last; with the same "
            "settings it ends with the same results to the last digit")
      .of_this_run();
}

/// Completes them once they were read. Throws Error where this program can keep nothing.
inline void resolve(CheckpointOptions& o, const Options& options) {
  require_non_negative(o.every, "--checkpoint-every", "s (0: never)");
#if defined(DEM_WITH_HDF5)
  o.files = hdf5_checkpoints();
#else
  if (o.every > 0.0 || o.resume) {
    fail(
        "{} needs HDF5, which this program was built without; install it (on Debian and Ubuntu: apt install "
        "libhdf5-dev), configure with cmake anew and build",
        o.resume ? "--resume" : "--checkpoint-every");
  }
#endif
  for (const Option& option : options.all()) {
    if (!option.changes_results) o.free_settings.push_back(option.key());
    if (option.key() == "checkpoint-every" && option.given.empty() && o.resume) o.every = 900.0;
  }
}

/// Runs the rig until its end or to where it is stopped. Returns false where a problem is of this process alone, for
/// which others wait in a step. Throws what it throws before the run has begun.
inline bool run_to_end(Rig& rig, Session& session) {
  std::string problem;
  try {
    rig.run(session);
    if (!session.has_begun()) fail("the rig has run no stage: run() did not call begin_run()");
    session.finish();
  } catch (const Interrupted&) {
    session.outcome.interrupted = true;
  } catch (const InAnotherProgram&) {
    throw;
  } catch (const std::bad_alloc&) {
    problem = no_memory;
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (!session.has_begun()) throw Error(session.in_own_words(problem));
  const bool all_ended = problem.empty() || processes.all_come();
  session.end(problem);
  return all_ended;
}

/// Makes the report of a run that has ended, and returns what main() returns.
inline int report_run(const ProgramText& program, const Rig& rig, Session& session) {
  Report report(session, program.title);
  bool has_frames = false;
  report.part("the report", [&] { has_frames = rig.report(report); });
  const bool is_complete = report.finish(has_frames);
  const Outcome& outcome = session.outcome;
  if (!outcome.problem.empty()) tell(stderr, "{}: {}\n", program.name, outcome.problem);
  if (outcome.interrupted) {
    if (!session.parts().parts().empty()) tell(stderr, "{}: --resume goes on with the run\n", program.name);
    return 130;
  }
  if (!report.has_all_parts() || !outcome.problem.empty()) return 1;
  session.parts().clear();  // frames that could not be written are not made anew by going on
  return is_complete ? 0 : 1;
}

}  // namespace detail

/// Reads the settings of a rig, checks them, runs it and makes its report. Returns what main() returns: see
/// exit_codes; 3 when the settings ask for what another program has (InAnotherProgram).
inline int run_program(const ProgramText& program, Rig& rig, int argc, const char* const* argv) {
  detail::open_standard_streams();
  std::signal(SIGPIPE, SIG_IGN);  // whoever read the messages is gone: no reason to lose the results
  if (!may_run(program.name, argc > 0 ? argv[0] : program.name)) return 2;
  try {
    Options options;
    rig.declare(options);
    CheckpointOptions checkpoints;
    if (rig.can_resume()) detail::add_checkpoint_options(options, checkpoints);
    if (!read_command_line(program, argc, argv, options)) return 0;
    IdleOptions idle;
    rig.find_idle(idle);
    refuse_idle(options, idle);
    const std::string config = settings_text(options, idle);
    rig.resolve();
    detail::resolve(checkpoints, options);
    if (const std::string instead = rig.when_ended(); !instead.empty()) checkpoints.when_ended = instead;
    Session session({program.name, rig.output(), config, rig.results(), rig.words(), std::move(checkpoints)});
    if (!detail::run_to_end(rig, session)) {
      tell(stderr, "rank {} of {}: {}\n", processes.rank, processes.count, session.outcome.problem);
      if (process_writes_files) detail::report_run(program, rig, session);
      processes.end(1);
    }
    // One process writes. The others have nothing to add.
    return processes.of_first(process_writes_files ? detail::report_run(program, rig, session) : 0);
  } catch (const InAnotherProgram& error) {
    return fail_with(3, text("{}: {}", program.name, error.what()));
  } catch (const std::bad_alloc&) {
    return fail_with(2, text("{}: {}", program.name, detail::no_memory));
  } catch (const std::exception& error) {
    return fail_with(2, text("{}: {}", program.name, error.what()));
  }
}

}  // namespace dem::rig
