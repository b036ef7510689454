#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>

namespace dem {

/// When grains fall asleep, and what wakes them (WorldOptions::sleep).
///
/// A grain bears its weight or the sum of the magnitudes of its contact forces, whichever is larger. It is at rest when
/// in a window of steps
/// - it moves by less than `motion` of its radius and turns by less than `motion` (rad),
/// - what it bears changes by less than `change` of itself,
/// - what is left of all forces on it and of all torques is less than `balance` of it.
///
/// A grain that is at rest for two windows sleeps. One that nothing touches does so only if it does not move at all. A
/// sleeper is not moved, and what contacts between sleepers bear counts on without being evaluated. Contacts with
/// grains that are awake are evaluated on, and near anything that moves those with surfaces, too. A sleeper wakes when
/// the sum of the forces or torques on it differs from that when it fell asleep by more than `change` of what it bore
/// then, in a running mean over `mean` steps; or at once by more than `jolt`. When nothing that moves acts on it any
/// more, `change` counts at once.
///
/// So `balance` says how exact forces are when grains fall asleep, and `change` how late a grain passes on a load that
/// grows; a sleeping grain is out of balance by their sum at the most, in the mean. Each layer of a bed adds to that:
/// the floor under nine layers has been seen to be 5 % behind, and 23 % with a `change` of 0.05. Waves of less than
/// `jolt` end at grains that sleep: so half as many are awake around a blade.
///
/// All grains wake when gravity or these options get another value, at any call of set_contact, evaluate_anew,
/// find_rest or assemble, and when a surface is switched on or off. A function that is called each step should not do
/// that: nothing would ever sleep.
struct SleepOptions {
  double balance = 0.01;  ///< of what a grain bears
  double change = 0.01;   ///< of what a grain bears
  double jolt = 0.1;      ///< of what a grain bears
  double motion = 1e-4;   ///< of a grain's bounding radius; rad
  int window = 100;       ///< steps
  int mean = 100;         ///< steps

  bool operator==(const SleepOptions&) const = default;
};

/// Throws Error for options that make no sense.
void check_sleep(const SleepOptions& s);

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE void check_sleep(const SleepOptions& s) {
  require_within(s.balance, 1e-9, 1.0, "share of what a grain bears that may be out of balance when it falls asleep");
  require_within(s.change, 1e-9, 1.0, "share of what a grain bears that may change without waking it");
  require_within(s.jolt, s.change, 10.0, "share of what a grain bears that wakes it at once (at least `change`)");
  require_positive(s.motion, "motion in a window that leaves a grain asleep", "radii");
  if (s.window < 1) fail("the window after which grains may sleep is {} steps, but must be at least 1", s.window);
  if (s.mean < 1)
    fail("the mean of the forces on a grain that sleeps is over {} steps, but must be over at least 1", s.mean);
}

}  // namespace dem

#endif
