#pragma once
// Files of the parts of a run. Needs HDF5: link dem::hdf5.

#include <dem/io/checkpoint/hdf5_file.hpp>
#include <dem/rig/checkpoint_folder.hpp>

namespace dem::rig {

/// Each is written beside its place, synchronised and renamed: a kill at any moment leaves the last good one.
inline CheckpointFiles hdf5_checkpoints() { return {io::write_columns, io::read_columns, io::detail::check_seal}; }

}  // namespace dem::rig
