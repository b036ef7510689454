#pragma once

namespace dem {

/// Whether this process writes files. False on all but one of the processes that run one program together
/// (domain::Session): what they write goes nowhere, so that every file comes once.
inline bool process_writes_files = true;

}  // namespace dem
