#pragma once

#include <dem/flat/history_store.hpp>
#include <dem/flat/pair_kernels.hpp>
#include <dem/world/state.hpp>

#include <utility>
#include <vector>

namespace dem::flat {

/// The contacts of grains with each other in the executor's memory: those of this evaluation, and those of the one
/// before, from which it starts.
template <class Model>
class PairContactStore {
 public:
  using Shape = typename Model::Shape;
  using Bits = ContactBits<Shape>;

  /// `chunk_first`: the first candidate of each chunk, and one more.
  void bring_up(WorldState<Model>& w, const std::vector<std::uint32_t>& chunk_first) {
    const std::size_t candidates = chunk_first.back();
    const std::vector<std::uint32_t> contact_first = first_contacts(w);
    const std::size_t contacts = contact_first.back();
    std::vector<Bits> bits(candidates);
    std::vector<std::uint32_t> first(candidates + 1);
    first.back() = static_cast<std::uint32_t>(contacts);
    std::vector<std::vector<double>> columns(size, std::vector<double>(contacts));
    w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
      const auto& of_chunk = w.chunks[c].pair_contacts.last;
      int at = 0;
      for (std::size_t k = chunk_first[c]; k < chunk_first[c + 1]; ++k) {
        first[k] = contact_first[c] + static_cast<std::uint32_t>(at);
        std::uint64_t word = 0;
        for (int bit = 0; at < of_chunk.count; ++at) {
          const grain::PairKey key{of_chunk.key[static_cast<std::size_t>(at)]};
          if (key.candidate() != k - chunk_first[c]) break;
          while (Shape::feature_of(bit) != key.feature()) ++bit;
          word |= std::uint64_t{1} << bit;
        }
        bits[k] = static_cast<Bits>(word);
      }
      DEM_ASSERT(at == of_chunk.count, "each contact has a candidate");
      for (std::size_t h = 0; h < size; ++h) {
        std::copy_n(of_chunk.history[h].begin(), of_chunk.count,
                    columns[h].begin() + static_cast<std::ptrdiff_t>(contact_first[c]));
      }
    });
    for (Step* step : {&now_, &last_}) step->bits.make_room(candidates), step->first.make_room(candidates + 1);
    last_.histories.make_room(contacts);
    last_.bits.upload_to(0, bits.data(), candidates);
    last_.first.upload_to(0, first.data(), candidates + 1);
    last_.histories.upload(columns);
  }
  /// Hands the contacts of the last evaluation to the chunks.
  void bring_down(WorldState<Model>& w, const std::vector<std::uint32_t>& chunk_first) {
    const std::size_t candidates = chunk_first.back();
    std::vector<Bits> bits(candidates);
    std::vector<std::uint32_t> first(candidates + 1);
    const auto columns = last_.histories.download();
    last_.bits.download(bits.data(), candidates);
    last_.first.download(first.data(), candidates + 1);
    w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
      auto& of_chunk = w.chunks[c].pair_contacts.last;
      const std::uint32_t begin = first[chunk_first[c]];
      of_chunk.count = static_cast<int>(first[chunk_first[c + 1]] - begin);
      of_chunk.make_room(of_chunk.count);
      std::size_t at = 0;
      for (std::size_t k = chunk_first[c]; k < chunk_first[c + 1]; ++k) {
        for (std::uint64_t left = bits[k]; left != 0; left &= left - 1) {
          of_chunk.key[at++] = grain::PairKey::make(k - chunk_first[c], Shape::feature_of(lowest_bit(left))).value;
        }
      }
      for (std::size_t h = 0; h < size; ++h) {
        std::copy_n(columns[h].begin() + static_cast<std::ptrdiff_t>(begin), of_chunk.count,
                    of_chunk.history[h].begin());
      }
    });
  }

  /// Room for the contacts of this step.
  void make_room(std::size_t contacts) {
    now_.histories.make_room(contacts);
    candidate_.make_room(contacts);
    bit_.make_room(contacts);
    results_.make_room(contacts);
  }
  /// The contacts of this evaluation become those that the next one starts from.
  void commit() { std::swap(now_, last_); }

  /// Of the evaluation before.
  std::size_t contacts() const { return last_.histories.contacts(); }
  PairContactsView<Model> now() { return view(now_); }
  PairContactsView<Model> last() { return view(last_); }
  PairContactPlaces places() { return {candidate_.data(), bit_.data()}; }
  ContactResult* results() { return results_.data(); }
  std::size_t bytes() const {
    std::size_t sum = candidate_.bytes() + bit_.bytes() + results_.bytes();
    for (const Step* s : {&now_, &last_}) sum += s->bits.bytes() + s->first.bytes() + s->histories.bytes();
    return sum;
  }

 private:
  template <class T>
  using Array = typename Model::Executor::template Array<T>;
  static constexpr auto size = HistoryStore<Model>::size;

  struct Step {
    Array<Bits> bits;
    Array<std::uint32_t> first;
    HistoryStore<Model> histories;
  };
  static PairContactsView<Model> view(Step& s) { return {s.bits.data(), s.first.data(), s.histories.view()}; }
  /// The first contact of each chunk, and one more.
  static std::vector<std::uint32_t> first_contacts(const WorldState<Model>& w) {
    std::vector<std::uint32_t> first = {0};
    for (const auto& chunk : w.chunks) {
      first.push_back(first.back() + static_cast<std::uint32_t>(chunk.pair_contacts.last.count));
    }
    return first;
  }

  Step now_, last_;
  Array<std::uint32_t> candidate_;
  Array<std::uint8_t> bit_;
  Array<ContactResult> results_;
};

}  // namespace dem::flat
