#pragma once

// Stop and go on, bit for bit. Needs HDF5: link dem::hdf5. These are free functions, and dem.hpp does not include them,
// so that programs which save nothing need neither the library nor the seconds that its headers take to compile. What
// the columns of a file mean, for other programs: checkpoint/README.md.
//
// A program that has HDF5 files of its own closes them before it ends: where save or load is the first to use HDF5, it
// does not close them at the exit, and one that is left open cannot be read. Or the program calls H5open() first.

#include <dem/io/checkpoint/hdf5_file.hpp>
#include <dem/io/checkpoint/world_columns.hpp>

namespace dem {

/// Saves the state of a world: n steps, a file, and n more steps are 2n steps in every bit, on any number of threads.
/// The file (HDF5) is compressed and checksummed; it is written beside `path`, synchronised with the disk and renamed,
/// so a kill at any moment leaves the last good one. Throws Error if it cannot be written, and after a step that an
/// exception broke off.
///
/// Where ranks share the grains, all ranks call it at once and rank 0 writes. The file does not tell how many ranks
/// there were: any number of ranks goes on from it, and so does a world whose Domain is Open (Periodic after
/// PeriodicRanks, Sheared after ShearedRanks).
///
/// `others` are what else the program needs to go on: structs with a member function `fields` (see io::Fields).
///
///     struct Progress {
///       std::uint64_t rows = 0;
///       template <class V>
///       void fields(V& v) { v("rows", rows); }
///     };
///     dem::save(world, "bed.h5", progress);
///
/// Tables that the program writes beside it: flush() them before saving, and go on with CsvOptions::goes_on_after.
template <class Model, class... Others>
void save(const World<Model>& world, const std::filesystem::path& path, const Others&... others) {
  const io::StateColumns columns = io::columns_of(world, others...);
  if constexpr (Model::Domain::has_ranks) {
    world.state().domain.guarded("as a state was saved", [&] {
      if (process_writes_files) io::write_columns(path, columns);
      world.state().domain.wait_for_all();
    });
  } else {
    io::write_columns(path, columns);
  }
}

/// Puts a world into a state that was saved. The program has to set it up first, as it did before it saved: options,
/// materials, species, surfaces and machine, with the functions (signals, loads) that it gave. Grains come from the
/// file; those that were added already are dropped.
///
/// Compared with the file, bit for bit:
/// - the model's policies; time step, skin, overlap limit and domain of the options;
/// - materials with all contact constants, species with their shapes, inlets and outlets;
/// - surfaces with their shapes and their places on bodies; masses and moments of bodies, but not where they stand;
/// - of joints the points and axes at assembly, stiffness, limits, friction and tables; of springs, actuators and loads
///   the points and the constants; of couplings and clutches the joints and what was given.
/// A shape or a surface of your own is compared by its fingerprint(), or else by its sample points or its bounds. What
/// only functions know is not compared.
///
/// Restored, whatever the program set: the state, and what was steered while it ran. These are targets, sizes of loads
/// (applied_force) that are numbers, throttles, switches, brakes' capacities, largest forces of actuators, preloads of
/// friction, ratios of gears, set_fixed, gravity, sub-steps, and whether grains may sleep. So what is to be another one
/// from now on is set after loading: set_load for another pressure, set_sleep for a bed that was saved awake.
///
/// To be set before loading, because the file has it to compare only or not at all:
/// - contact constants that set_contact changed during the run, as they were when it was saved;
/// - a time step that set_time_step gave;
/// - a function that has taken the place of a number since the set-up;
/// - parts, species, materials and surfaces that were added during the run. A joint, spring or actuator has to be given
///   the same points again, so add it where it is assembled, and switch it on when it is needed.
///
/// Where ranks share the grains, all ranks call it at once, and each reads the file.
///
/// Throws Error, and leaves the world as it is, if the file cannot be read, is cut short or damaged, has another
/// schema, or if the set-up differs; the text names what differs: which option, material, species, body, joint. A file
/// that is whole and yet lacks a field of this world is refused while it is being read, and leaves a world that is good
/// for nothing.
template <class Model, class... Others>
void load(World<Model>& world, const std::filesystem::path& path, Others&... others) {
  io::StateColumns columns = io::read_columns(path);
  try {
    io::restore(world, columns, others...);
  } catch (const Error& problem) {
    fail("cannot load '{}': {}", path.string(), problem.what());
  }
}

}  // namespace dem
