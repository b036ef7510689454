#pragma once

#include <dem/domain/session.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace dem::domain {

/// What a rank has sent so far, how long it took, and how evenly work is cut now.
struct Traffic {
  std::uint64_t step_bytes = 0;  ///< handed over within steps: motion and loads of borders, sums
  std::uint64_t list_bytes = 0;  ///< handed over when neighbours were listed or a run ended; rows to count energy
  double step_seconds = 0.0;     ///< s, within steps: packing, sending, and waiting for others
  double list_seconds = 0.0;     ///< s, the same
  double imbalance = 1.0;        ///< of the last cut: most counted work of a rank, over the mean of all
};

/// What ranks tell each other. No sum depends on how many they are. The main thread alone calls these.
class Messages {
 public:
  /// Throws Error where there is no Session.
  Messages() {
    int is_running = 0;
    MPI_Initialized(&is_running);
    if (!is_running) {
      fail(
          "a world whose Domain is domain::Ranks, PeriodicRanks or ShearedRanks needs a domain::Session: make one at "
          "the start of main()");
    }
    rank_ = detail::rank_of_process();
    ranks_ = detail::count_of_ranks();
  }

  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  bool is_shared() const { return ranks_ > 1; }
  const Traffic& traffic() const { return traffic_; }

  /// While it lives, time counts as exchange.
  class Watch {
   public:
    explicit Watch(double& seconds) : seconds_(seconds), start_(MPI_Wtime()) {}
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    ~Watch() { seconds_ += MPI_Wtime() - start_; }

   private:
    double& seconds_;
    double start_;
  };
  Watch watch_step() const { return Watch(traffic_.step_seconds); }

  // ---- what all ranks say together; every rank calls them ----

  double largest(double x) const { return reduced(x, MPI_DOUBLE, MPI_MAX); }
  /// Of each number.
  template <std::size_t N>
  std::array<double, N> largest(std::array<double, N> x) const {
    if (!is_shared()) return x;
    const Watch watch(traffic_.step_seconds);
    MPI_Allreduce(MPI_IN_PLACE, x.data(), static_cast<int>(N), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    traffic_.step_bytes += N * sizeof(double);
    return x;
  }
  /// Exact for whole numbers, whatever the order.
  double total(double x) const { return reduced(x, MPI_DOUBLE, MPI_SUM); }
  int smallest(int x) const { return reduced(x, MPI_INT, MPI_MIN); }
  bool all(bool yes) const { return smallest(yes ? 1 : 0) != 0; }
  /// Every call that ranks make together begins with it, and with no other message. Throws Error, on every rank, unless
  /// all are in this one. Returns the first part of which ranks have different hashes; hashes.size() where there is
  /// none.
  std::size_t compare(Call call, const CallHashes& hashes) const {
    if (!is_shared()) return hashes.size();
    const Watch watch(traffic_.step_seconds);
    const CallNumbers numbers = detail::compare_calls(call, hashes);
    traffic_.step_bytes += numbers.size() * sizeof(std::uint64_t);
    if (const std::string difference = numbers.difference(); !difference.empty()) throw Error(difference);
    return numbers.differing_part();
  }
  /// Sums of numbers that only one rank has, and that are zero on all others, or of whole numbers: exact.
  void share_sums(std::vector<double>& numbers) const {
    if (!is_shared()) return;
    const Watch watch(traffic_.step_seconds);
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), number(numbers.size()), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    traffic_.step_bytes += numbers.size() * sizeof(double);
  }
  /// A text of one rank.
  std::string text_of(int rank, std::string text) const {
    std::uint64_t size = text.size();
    MPI_Bcast(&size, 1, MPI_UINT64_T, rank, MPI_COMM_WORLD);
    text.resize(size);
    MPI_Bcast(text.data(), number(size), MPI_CHAR, rank, MPI_COMM_WORLD);
    return text;
  }
  void wait_for_all() const { MPI_Barrier(MPI_COMM_WORLD); }

  /// The lists of all ranks, one after the other.
  template <class T>
  std::vector<T> gathered(const std::vector<T>& mine, bool in_step = true) const {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!is_shared()) return mine;
    const Watch watch(in_step ? traffic_.step_seconds : traffic_.list_seconds);
    const int size = number(mine.size());
    std::vector<int> sizes(static_cast<std::size_t>(ranks_));
    MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
    const std::vector<int> first = starts(sizes);
    std::vector<T> all(static_cast<std::size_t>(first.back() + sizes.back()));
    if (all.empty()) return all;
    const Type type(sizeof(T));
    MPI_Allgatherv(mine.data(), size, type.mpi, all.data(), sizes.data(), first.data(), type.mpi, MPI_COMM_WORLD);
    (in_step ? traffic_.step_bytes : traffic_.list_bytes) += mine.size() * sizeof(T);
    return all;
  }
  /// The same of lists that hardly grow from step to step, in one message: with room for a quarter more items than the
  /// longest list had. `room`: how many that is now; the same number on all ranks, and zero at first.
  template <class T>
  std::vector<T> gathered(const std::vector<T>& mine, std::size_t& room) const {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!is_shared()) return mine;
    const std::uint64_t size = mine.size();
    const std::size_t block = sizeof size + room * sizeof(T), ranks = static_cast<std::size_t>(ranks_);
    block_out_.resize(block), blocks_in_.resize(block * ranks);
    std::memcpy(block_out_.data(), &size, sizeof size);
    const std::size_t told = std::min(mine.size(), room);
    if (told > 0) std::memcpy(block_out_.data() + sizeof size, mine.data(), told * sizeof(T));
    {
      const Watch watch(traffic_.step_seconds);
      MPI_Allgather(block_out_.data(), number(block), MPI_BYTE, blocks_in_.data(), number(block), MPI_BYTE,
                    MPI_COMM_WORLD);
      traffic_.step_bytes += block;
    }
    std::vector<std::size_t> sizes(ranks);
    std::size_t all = 0, longest = 0;
    for (std::size_t r = 0; r < ranks; ++r) {
      std::uint64_t there = 0;
      std::memcpy(&there, blocks_in_.data() + r * block, sizeof there);
      sizes[r] = there;
      all += there, longest = std::max(longest, sizes[r]);
    }
    if (longest > room) {
      room = longest + longest / 4 + 1;
      return gathered(mine);
    }
    std::vector<T> result(all);
    T* to = result.data();
    for (std::size_t r = 0; r < ranks; to += sizes[r++]) {
      if (sizes[r] > 0) std::memcpy(to, blocks_in_.data() + r * block + sizeof size, sizes[r] * sizeof(T));
    }
    return result;
  }
  /// Of a column whose parts have so many pieces each, of `width` numbers a piece, every rank's own part goes to all.
  template <class T>
  void gather_column(T* column, const std::vector<int>& sizes, std::size_t width) const {
    if (!is_shared()) return;
    const Watch watch(traffic_.list_seconds);
    const std::vector<int> first = starts(sizes);
    const Type type(sizeof(T) * width);
    MPI_Allgatherv(MPI_IN_PLACE, 0, type.mpi, column, sizes.data(), first.data(), type.mpi, MPI_COMM_WORLD);
    traffic_.list_bytes += static_cast<std::size_t>(sizes[static_cast<std::size_t>(rank_)]) * width * sizeof(T);
  }
  /// The list for each rank goes to it; returns those that came, one after the other, and where each begins.
  template <class T>
  std::pair<std::vector<T>, std::vector<int>> exchanged(const std::vector<std::vector<T>>& to) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const Watch watch(traffic_.list_seconds);
    std::vector<int> out, in(to.size());
    std::vector<T> all_out;
    for (const auto& list : to) {
      out.push_back(number(list.size()));
      all_out.insert(all_out.end(), list.begin(), list.end());
    }
    MPI_Alltoall(out.data(), 1, MPI_INT, in.data(), 1, MPI_INT, MPI_COMM_WORLD);
    const std::vector<int> first_out = starts(out);
    std::vector<int> first_in = starts(in);
    first_in.push_back(first_in.back() + in.back());
    std::vector<T> came(static_cast<std::size_t>(first_in.back()));
    const Type type(sizeof(T));
    MPI_Alltoallv(all_out.data(), out.data(), first_out.data(), type.mpi, came.data(), in.data(), first_in.data(),
                  type.mpi, MPI_COMM_WORLD);
    traffic_.list_bytes += all_out.size() * sizeof(T);
    return {std::move(came), std::move(first_in)};
  }

  // ---- between two ranks ----

  enum class Tag : int { motion = 1, loads = 2 };

  void send(int to, Tag tag, const void* data, std::size_t bytes) const {
    sent_.emplace_back();
    MPI_Isend(data, number(bytes), MPI_BYTE, to, static_cast<int>(tag), MPI_COMM_WORLD, &sent_.back());
    traffic_.step_bytes += bytes;
  }
  /// What was sent is used up: its memory may be written to again.
  void wait_for_sent() const {
    MPI_Waitall(number(sent_.size()), sent_.data(), MPI_STATUSES_IGNORE);
    sent_.clear();
  }
  /// What comes from there goes to this memory, whenever it comes.
  void expect(int from, Tag tag, void* data, std::size_t bytes) const {
    expected_.emplace_back();
    MPI_Irecv(data, number(bytes), MPI_BYTE, from, static_cast<int>(tag), MPI_COMM_WORLD, &expected_.back());
  }
  /// All that was expected is there.
  void wait_for_expected() const {
    MPI_Waitall(number(expected_.size()), expected_.data(), MPI_STATUSES_IGNORE);
    expected_.clear();
  }
  /// Whether it is, without waiting.
  bool all_expected_came() const {
    int came = 0;
    MPI_Testall(number(expected_.size()), expected_.data(), &came, MPI_STATUSES_IGNORE);
    return came != 0;
  }
  /// Lets MPI hand over what other ranks wait for: without threads of its own it does so within its calls only.
  void attend() const {
    int gone = 0;
    MPI_Testall(number(sent_.size()), sent_.data(), &gone, MPI_STATUSES_IGNORE);
  }
  /// A message of unknown length.
  void receive(int from, Tag tag, std::vector<std::byte>& message) const {
    MPI_Message which;
    MPI_Status status;
    int size = 0;
    MPI_Mprobe(from, static_cast<int>(tag), MPI_COMM_WORLD, &which, &status);
    MPI_Get_count(&status, MPI_BYTE, &size);
    message.resize(static_cast<std::size_t>(size));
    MPI_Mrecv(message.data(), size, MPI_BYTE, &which, MPI_STATUS_IGNORE);
  }

 protected:
  /// MPI counts in int.
  static int number(std::size_t n) {
    if (n > 0x7fffffff) fail("{} items are too many for one message between ranks, at most 2147483647", n);
    return static_cast<int>(n);
  }
  static std::vector<int> starts(const std::vector<int>& sizes) {
    std::vector<int> first;
    std::size_t all = 0;
    for (const int n : sizes) {
      first.push_back(number(all));
      all += static_cast<std::size_t>(n);
    }
    number(all);
    return first;
  }
  /// So many bytes, as one item.
  struct Type {
    explicit Type(std::size_t bytes) {
      MPI_Type_contiguous(number(bytes), MPI_BYTE, &mpi);
      MPI_Type_commit(&mpi);
    }
    Type(const Type&) = delete;
    Type& operator=(const Type&) = delete;
    ~Type() { MPI_Type_free(&mpi); }
    MPI_Datatype mpi;
  };
  template <class T>
  T reduced(T x, MPI_Datatype type, MPI_Op how) const {
    if (!is_shared()) return x;
    const Watch watch(traffic_.step_seconds);
    T result{};
    MPI_Allreduce(&x, &result, 1, type, how, MPI_COMM_WORLD);
    traffic_.step_bytes += sizeof(T);
    return result;
  }

  int rank_ = 0, ranks_ = 1;
  mutable Traffic traffic_;
  mutable std::vector<MPI_Request> sent_, expected_;
  mutable std::vector<std::byte> block_out_, blocks_in_;
};

}  // namespace dem::domain
