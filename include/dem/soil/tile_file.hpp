#pragma once

// Tiles in files (HDF5), so that a bed is settled once. Needs HDF5: link dem::hdf5.

#include <dem/io/checkpoint/fields.hpp>
#include <dem/io/checkpoint/hdf5_file.hpp>
#include <dem/soil/tile.hpp>

namespace dem::soil {

/// Saves a tile with its contact histories, complete or not at all; what is read back is the same in every bit. Throws
/// Error if the file cannot be written.
inline void save_tile(const Tile& tile, const std::filesystem::path& path) {
  io::StateColumns columns;
  io::Fields v(io::Fields::Task::collect, columns);
  const_cast<Tile&>(tile).fields(v);  // collecting changes nothing
  io::write_columns(path, columns);
}

/// Reads a tile. Throws Error, in words, for a file that is none, is cut short or damaged.
inline Tile load_tile(const std::filesystem::path& path) {
  io::StateColumns columns = io::read_columns(path);
  Tile tile;
  try {
    io::Fields v(io::Fields::Task::restore, columns);
    tile.fields(v);
    v.check_all_read();
    tile.check();
  } catch (const Error& problem) {
    fail("cannot load the tile '{}': {}", path.string(), problem.what());
  }
  return tile;
}

}  // namespace dem::soil
