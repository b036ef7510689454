#pragma once

namespace dem {

/// Whether this process writes files. False on all but one of the processes that run one program together
/// (domain::Session): what they write goes nowhere, so that every file comes once.
inline bool process_writes_files = true;

/// The processes that run one program together, and what they agree on. domain::Session sets it; without one a process
/// agrees with itself. `any` and `of_first` are called by all of them, in the same order, on their main threads;
/// `all_come` and `end` by one that cannot go on.
struct Processes {
  int rank = 0, count = 1;
  int here = 1;                                                  ///< of them on this machine
  bool (*any)(bool yes) = [](bool yes) { return yes; };          ///< whether one of them says yes
  int (*of_first)(int value) = [](int value) { return value; };  ///< what rank 0 says
  /// Whether all of them come here within some seconds. One that cannot go on asks, as others may be waiting for it
  /// elsewhere.
  bool (*all_come)() = [] { return true; };
  void (*end)(int code) = [](int) {};  ///< ends all of them, wherever they are; one alone goes on
};
inline Processes processes;

}  // namespace dem
