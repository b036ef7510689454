#pragma once

#include <dem/flat/history_store.hpp>
#include <dem/flat/surface_kernels.hpp>
#include <dem/world/state.hpp>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace dem::flat {

/// The contacts of grains with surfaces in the executor's memory, as those of pairs.
template <class Model>
class SurfaceContactStore {
 public:
  void bring_up(WorldState<Model>& w) {
    const std::size_t grains = w.grains.count;
    std::vector<std::uint32_t> first(grains + 1, 0);
    for (std::size_t c = 0; c < w.chunks.size(); ++c) {
      const auto& of_chunk = w.chunks[c].surface_contacts.last;
      for (int k = 0; k < of_chunk.count; ++k) ++first[row_of(c, of_chunk.key[static_cast<std::size_t>(k)]) + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    const std::size_t contacts = first.back();
    std::vector<std::uint64_t> key(contacts);
    std::vector<std::vector<double>> columns(size, std::vector<double>(contacts));
    std::vector<std::uint32_t> next = first;
    for (std::size_t c = 0; c < w.chunks.size(); ++c) {  // keys ascend in a chunk, so they do for each of its grains
      const auto& of_chunk = w.chunks[c].surface_contacts.last;
      for (std::size_t k = 0; k < static_cast<std::size_t>(of_chunk.count); ++k) {
        const std::uint32_t to = next[row_of(c, of_chunk.key[k])]++;
        key[to] = grain::SurfaceKey{of_chunk.key[k]}.with_local(0).value;
        for (std::size_t h = 0; h < size; ++h) columns[h][to] = of_chunk.history[h][k];
      }
    }
    grains_ = grains;
    count_.make_room(grains);
    for (Step* step : {&now_, &last_}) step->first.make_room(grains + 1);
    make_room(last_, contacts);
    last_.first.upload_to(0, first.data(), grains + 1);
    last_.key.upload_to(0, key.data(), contacts);
    last_.histories.upload(columns);
  }
  /// Hands the contacts of the last evaluation to the chunks.
  void bring_down(WorldState<Model>& w) {
    std::vector<std::uint32_t> first(grains_ + 1);
    std::vector<std::uint64_t> key(contacts());
    const auto columns = last_.histories.download();
    last_.first.download(first.data(), grains_ + 1);
    last_.key.download(key.data(), contacts());
    w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
      const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, grains_);
      std::vector<std::pair<std::uint64_t, std::uint32_t>> found;  // key in the chunk, and contact
      for (std::size_t i = begin; i < end; ++i) {
        for (std::uint32_t k = first[i]; k < first[i + 1]; ++k) {
          found.emplace_back(grain::SurfaceKey{key[k]}.with_local(i - begin).value, k);
        }
      }
      std::sort(found.begin(), found.end());
      auto& of_chunk = w.chunks[c].surface_contacts.last;
      of_chunk.count = static_cast<int>(found.size());
      of_chunk.make_room(of_chunk.count);
      for (std::size_t k = 0; k < found.size(); ++k) {
        of_chunk.key[k] = found[k].first;
        for (std::size_t h = 0; h < size; ++h) of_chunk.history[h][k] = columns[h][found[k].second];
      }
    });
  }

  /// Room for the contacts of this step.
  void make_room(std::size_t contacts) {
    make_room(now_, contacts);
    grain_.make_room(contacts);
    results_.make_room(contacts);
  }
  void commit() { std::swap(now_, last_); }

  /// Of the evaluation before.
  std::size_t contacts() const { return last_.histories.contacts(); }
  /// How many each grain has, and whose each is, in this step.
  std::uint32_t* count() { return count_.data(); }
  std::uint32_t* grain_of() { return grain_.data(); }
  SurfaceContactsView<Model> now() { return view(now_); }
  SurfaceContactsView<Model> last() { return view(last_); }
  ContactResult* results() { return results_.data(); }
  std::size_t bytes() const {
    std::size_t sum = count_.bytes() + grain_.bytes() + results_.bytes();
    for (const Step* s : {&now_, &last_}) sum += s->first.bytes() + s->key.bytes() + s->histories.bytes();
    return sum;
  }

 private:
  template <class T>
  using Array = typename Model::Executor::template Array<T>;
  static constexpr auto size = HistoryStore<Model>::size;

  struct Step {
    Array<std::uint32_t> first;
    Array<std::uint64_t> key;
    HistoryStore<Model> histories;
  };
  static void make_room(Step& s, std::size_t contacts) {
    s.histories.make_room(contacts);
    s.key.make_room(s.histories.room());
  }
  static SurfaceContactsView<Model> view(Step& s) { return {s.first.data(), s.key.data(), s.histories.view()}; }
  static std::size_t row_of(std::size_t chunk, std::uint64_t key) {
    return chunk * chunk_size + grain::SurfaceKey{key}.local();
  }

  std::size_t grains_ = 0;
  Step now_, last_;
  Array<std::uint32_t> count_, grain_;
  Array<ContactResult> results_;
};

}  // namespace dem::flat
