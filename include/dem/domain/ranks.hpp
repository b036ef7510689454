#pragma once

// Grains that several processes share (MPI: link dem::mpi).

#include <dem/domain/cut.hpp>
#include <dem/domain/messages.hpp>
#include <dem/domain/sorted_rows.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace dem::domain {

/// Space without borders whose grains several processes share. Every rank owns a range of whole chunks of the one order
/// of grains. Its contacts have the same partners in the same order as on one rank, so the results are the same bits
/// for any number of ranks and threads.
///
///     struct Sand : dem::Model { using Domain = dem::domain::Ranks; };
///     int main(int argc, char** argv) {
///       dem::domain::Session mpi(argc, argv);
///       dem::World<Sand> world;                              // the same set-up on every rank
///       ...
///       const dem::StepReport report = world.run_for(1.0);   // shared; afterwards every rank knows all grains
///       return report ? 0 : 1;                               // the same on every rank
///     }
///
/// Calls that change or run a world are made on every rank, with the same arguments: prepare, step, run, run_for,
/// find_rest, assemble, lay_tiles, MovingPatch::follow, load and io::restore too. So are those that look at contacts or
/// take the state: contacts_of, count_energy, energy_of, take_tile, averages of soil, files of contacts
/// (write_vtk_contacts), replays with forces, save and io::columns_of. Ranks that make different ones of these calls,
/// end the program, or have set up different worlds before the first step are all told so in words. What is steered
/// later, set points and switches say, must be alike and is not compared. Queries of single grains work on any rank by
/// itself, but only between runs.
///
/// At the end of step(), run() and run_for() every rank is told of all grains, which costs as much as a step or more.
/// So give run() many steps.
///
/// Chunks are cut anew among the ranks, by the work that was counted, at each neighbour list and only there. Rows move
/// then anyway. A list that was made earlier, because the work is uneven, would depend on the number of ranks, and so
/// would the bits.
///
/// Within a run a rank works on its own chunks alone, unless energy is counted. When neighbours are listed it sorts its
/// own grains, sends those that have another owner now, and hears of the grains of chunks that its own may touch. Where
/// machine parts hold grains or inlets put some in, in periodic cells, and with a broad phase other than UniformGrid,
/// all ranks tell each other all positions instead. Between runs every rank has the rows of all grains, some 400 bytes
/// each: that bounds how many grains they can share.
class Ranks : public Messages {
 public:
  static constexpr bool has_images = false, has_ranks = true;
  using SortKey = domain::SortKey;

  /// Throws Error where there is no Session.
  Ranks() { first_.assign(static_cast<std::size_t>(ranks_) + 1, 0); }

  /// As many threads as the ranks of one machine leave to each.
  static int threads_of_a_rank() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / processes.here);
  }

  // ---- which chunks are whose ----

  /// The chunks from first to second are this rank's.
  std::pair<std::size_t, std::size_t> own() const { return chunks_of(rank_); }
  std::pair<std::size_t, std::size_t> chunks_of(int rank) const {
    return {first_[static_cast<std::size_t>(rank)], first_[static_cast<std::size_t>(rank) + 1]};
  }
  bool owns(std::size_t chunk) const { return chunk >= own().first && chunk < own().second; }
  int owner(std::size_t chunk) const {
    return static_cast<int>(std::upper_bound(first_.begin() + 1, first_.end() - 1, chunk) - first_.begin()) - 1;
  }
  /// Sorts the grains of all ranks, by one key each: see domain::sort_rows.
  SortedRows sort_rows(const std::vector<SortKey>& keys, std::size_t all, std::size_t rows_of_a_chunk) const {
    return domain::sort_rows(*this, keys, all, rows_of_a_chunk);
  }
  /// Cuts the chunks, with the work that each of them is, into ranges of nearly the same work.
  void cut(const std::vector<double>& of_chunks) {
    first_ = cut_by_work(of_chunks, ranks_);
    traffic_.imbalance = imbalance_of(of_chunks, first_);
  }

  /// What goes over between this rank and another one in a step.
  struct Border {
    std::vector<std::uint32_t> rows_out, rows_in;  ///< grains whose motion is sent, or comes
    std::vector<std::uint32_t> chunks_out;         ///< own chunks with partners there
    std::vector<std::uint32_t> first_out;          ///< of each of these in candidates_out, and one entry more
    std::vector<std::uint32_t> candidates_out;     ///< their candidates that are grains of the other rank
    std::vector<std::uint32_t> chunks_in;          ///< chunks of the other rank with partners here
    std::vector<double> motion_out, motion_in;
    std::vector<std::byte> loads_out;
  };
  std::vector<Border> borders;             ///< of each rank
  std::vector<std::uint8_t> is_at_border;  ///< of each chunk: it has candidates of other ranks
  std::vector<float> work;                 ///< of each grain (id), counted in its last list
  bool is_whole = true;                    ///< this rank's rows of all grains are up to date
  bool has_names = true;                   ///< it knows which grain each row holds, also of those that are not near
  std::uint64_t lists_of_parts = 0;        ///< neighbour lists for which no rank looked at all grains
  bool is_complete = false;                ///< so are the contacts of all chunks
  std::size_t room_for_loads = 0;          ///< on surfaces, of a rank in a step: see gathered()
  std::optional<double> moved2_of_all;     ///< m^2, as of the end of the last step, until grains move again

  /// Of a column with `width` numbers a chunk, every rank's own chunks go to all.
  template <class T>
  void gather_chunks(T* column, std::size_t width) const {
    std::vector<int> sizes;
    for (int r = 0; r < ranks_; ++r) sizes.push_back(number(chunks_of(r).second - chunks_of(r).first));
    gather_column(column, sizes, width);
  }

  /// f(), whose exceptions end all ranks if there are several: the others would wait for this one. `where` it was, in
  /// words.
  template <class F>
  auto guarded(const char* where, F&& f) const {
    try {
      return f();
    } catch (...) {
      if (is_shared()) {
        detail::print_exception(where);
        MPI_Abort(MPI_COMM_WORLD, 1);
      }
      throw;
    }
  }

 private:
  std::vector<std::uint32_t> first_;  // chunk of each rank, and one entry more
};

}  // namespace dem::domain
