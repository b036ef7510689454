#pragma once
// A rig: a world, its stages, its samples, its report. run_program() makes a program of it.

#include <dem/rig/options.hpp>
#include <dem/rig/report.hpp>
#include <dem/rig/session.hpp>
#include <dem/rig/sizes.hpp>

#include <string>
#include <vector>

namespace dem::rig {

/// An experiment as a program sees it. The functions are called in the order in which they stand here. The settings
/// and what was found are members of the rig.
class Rig {
 public:
  virtual ~Rig() = default;

  /// Names the options and the places of their values, which hold the defaults.
  virtual void declare(Options& options) = 0;
  /// Says which options change nothing with the settings that were read.
  virtual void find_idle(IdleOptions&) const {}
  /// Fills in what depends on other settings, as on the size. Throws Error for what makes no sense.
  virtual void resolve() {}
  /// The output folder, which an option may have set, and what the rig's files in it are called.
  [[nodiscard]] virtual std::string output() const = 0;
  [[nodiscard]] virtual ResultNames results() const = 0;
  /// Whether its stages are entered (see Stages), in parts (see PartOf): then it can go on after it was stopped.
  [[nodiscard]] virtual bool can_resume() const { return false; }
  /// What to do in place of --resume with a run that has ended; empty: begin it anew.
  [[nodiscard]] virtual std::string when_ended() const { return ""; }
  /// For what the library calls otherwise than the program does.
  [[nodiscard]] virtual std::vector<OwnWord> words() const { return {}; }
  /// Builds the world, which throws Error for what cannot work; calls session.begin_run(stages); runs the stages and
  /// keeps their samples. What is thrown from there on ends the run early, and is reported.
  virtual void run(Session& session) = 0;
  /// Shows what was found, also when the run ended early. Returns whether there are files for ParaView.
  virtual bool report(Report& report) const = 0;
};

/// Thrown when the program was asked for what another one has.
struct InAnotherProgram : Error {
  using Error::Error;
};

}  // namespace dem::rig
