#pragma once

#include <dem/core/macros.hpp>
#include <dem/core/stable_time_step.hpp>
#include <dem/mbd/solver/assembly.hpp>
#include <dem/mbd/solver/close_joints.hpp>

#include <string>

namespace dem::mbd {

/// What became of a step or a run.
struct MachineReport {
  bool ok = true;
  double time = 0.0;   ///< s, reached
  BodyId body = {};    ///< the body that went wrong
  JointId joint = {};  ///< the joint that opened beyond joint_tolerance
  std::string text;    ///< what happened and which setting to change; empty if all is well
  std::string note;    ///< what the library changed of what was given, or finds odd, in words; empty if nothing
  explicit operator bool() const { return ok; }
};

/// Time steps of a machine, with all sub-steps.
struct MachineSteps {
  double newest = 0.0;    ///< s
  double designed = 0.0;  ///< s, for which was derived what was left open
};

/// Which joint opened beyond joint_tolerance (`tolerance` in m; 0: by default), and what keeps it closed.
MachineReport report_of_opening(const Parts& m, const JointOpening& worst, double tolerance, const MachineSteps& steps,
                                int substeps, double time);

/// What has newly gone wrong with the terrains, in words; empty if nothing.
std::string take_terrain_problem(Parts& m);

/// What was changed of what the user gave: velocities at the start, sub-steps (`from` 0: not); and what the terrains
/// have to say. Empty if nothing.
std::string note_of(const Parts& m, const AssemblyReport& assembly, const JointWatch& joints, int from, int to);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE MachineReport report_of_opening(const Parts& m, const JointOpening& worst, double tolerance,
                                           const MachineSteps& steps, int substeps, double time) {
  const int n = substeps_for(substeps, worst.share, 0.5, 1 << 30);  // half: what swings opens twice as far
  if (m.joints[worst.joint.index()].rigid) {
    return {false,
            time,
            {},
            worst.joint,
            dem::text("{}: no pose closes all joints; let parts that contradict each other go, or lower the time step "
                      "(now {:g} s)",
                      in_words(m, worst), steps.newest),
            {}};
  }
  const std::string text = dem::text(
      "{} (joint_tolerance, {}): the stiffness that is derived for the time step gives way under its load. A time step "
      "of {:g} s from the start, or {} substeps (now {}), keeps it; or raise joint_tolerance",
      in_words(m, worst), tolerance > 0.0 ? dem::text("{:g} m", tolerance) : "1e-4 of the machine's size",
      rounded_down(steps.designed * substeps / n), n, substeps);
  return {false, time, {}, worst.joint, text, {}};
}

DEM_INLINE std::string take_terrain_problem(Parts& m) {
  std::string text;
  for (TerrainPart& t : m.terrains) {
    if (const std::string problem = t->take_problem(); !problem.empty()) text += (text.empty() ? "" : "; ") + problem;
  }
  return text;
}

DEM_INLINE std::string note_of(const Parts& m, const AssemblyReport& assembly, const JointWatch& joints, int from,
                               int to) {
  std::string text = assembly.has_changed() ? assembly.text() : "";
  for (const TerrainPart& t : m.terrains) {
    if (const std::string note = t->note(); !note.empty()) text += (text.empty() ? "" : " ") + note;
  }
  if (from == 0) return text;
  text += dem::text("{}The machine takes {} substeps instead of {}, to keep its joints within joint_tolerance.",
                    text.empty() ? "" : " ", to, from);
  if (joints.is_exceeded()) return text + dem::text(" Before they were raised, {}.", in_words(m, joints.worst()));
  const JointId most = joints.worst().joint.valid() ? joints.worst().joint : most_loaded(m, joints).joint;
  if (most.valid()) text += dem::text(" It is {} that needs most.", detail::joint_in_words(m, most.index()));
  return text;
}

}  // namespace dem::mbd

#endif
