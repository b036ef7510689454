#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/joint_watch.hpp>
#include <dem/mbd/solver/step_watch.hpp>

#include <cmath>
#include <string>

namespace dem::mbd {

/// The first function of a user that gave no number in the newest step, in words; empty if all did.
std::string not_a_number(const Parts& parts);

/// Why a machine blew up at steps of dt (s, with all `substeps`), in words: a number that is none, a step that was too
/// large from the start or became so in another pose, a joint that folded or that no pose closes, or none of these.
template <class I>
std::string cause_of_blow_up(const Parts& parts, const StableTimeStep& at_start, const StepWatch<I>& later,
                             const JointWatch& joints, double dt, int substeps) {
  if (const std::string cause = not_a_number(parts); !cause.empty()) {
    return cause + " is not a number: check the function that gives it.";
  }
  constexpr const char* remedy = "take a smaller time step, or a lower stiffness there.";
  if (at_start.dt < dt) {
    return dem::text("The time step is {:g} s, but the stable one is {:g} s, limited by {}: {}", dt, at_start.dt,
                     at_start.limited_by, remedy);
  }
  if (later.seen()) {
    return dem::text(
        "The time step, {:g} s, was stable at the start of the run, but in the pose at t = {:g} s the stable one was "
        "{:g} s, limited by {}: {}",
        dt, later.time(), later.limit().dt * substeps, later.limit().limited_by, remedy);
  }
  if (const JointOpening& folded = joints.folded(); folded.joint.valid()) {
    return dem::text(
        "Before, {} had folded: at t = {:g} s its axes stood {:.0f} deg apart, where its springs no longer pull them "
        "back. It was loaded beyond what it holds at a time step of {:g} s: take a smaller one from the start or more "
        "substeps (now {}), lower the load, or give the joint more room to bend.",
        detail::joint_in_words(parts, folded.joint.index()), folded.time, folded.violation.rotation * 57.29577951308232,
        dt, substeps);
  }
  if (joints.is_exceeded() && parts.joints[joints.worst().joint.index()].rigid) {
    return dem::text("Before, {}: no pose closes all joints. Let parts that contradict each other go.",
                     in_words(parts, joints.worst()));
  }
  return dem::text(
      "The time step, {:g} s, was stable at the start of the run{}: check the applied forces, set points and contacts, "
      "or take a smaller one.",
      dt, at_start.limited_by.empty() ? "" : dem::text(" (up to {:g} s, by {})", at_start.dt, at_start.limited_by));
}

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE std::string not_a_number(const Parts& parts) {
  for (const detail::PartKind* kind : parts.kinds) {
    if (!kind->not_a_number) continue;
    if (std::string text = kind->not_a_number(parts); !text.empty()) return text;
  }
  return {};
}

}  // namespace dem::mbd

#endif
