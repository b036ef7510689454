#pragma once

#include <dem/core/aligned.hpp>
#include <dem/grain/contact_key.hpp>
#include <dem/law/state.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace dem {

/// What a contact remembers: the histories of its laws, one after the other.
template <class Model, class T>
struct ContactHistory {
  typename Model::Normal::template History<T> normal;
  typename Model::Friction::template History<T> friction;
  typename Model::Rolling::template History<T> rolling;
  typename Model::Cohesion::template History<T> cohesion;
};

template <class Model>
inline constexpr int normal_history_size = contact::field_count<typename Model::Normal::template History<double>>;
template <class Model>
inline constexpr int friction_history_size = contact::field_count<typename Model::Friction::template History<double>>;
template <class Model>
inline constexpr int rolling_history_size = contact::field_count<typename Model::Rolling::template History<double>>;
template <class Model>
inline constexpr int cohesion_history_size = contact::field_count<typename Model::Cohesion::template History<double>>;
template <class Model>
inline constexpr int history_size = normal_history_size<Model> + friction_history_size<Model> +
                                    rolling_history_size<Model> + cohesion_history_size<Model>;

/// The histories of the contacts of one chunk, one each, keys ascending: the numbers of grain::PairKey or of
/// grain::SurfaceKey.
template <int Size>
struct ContactHistories {
  int count = 0;
  std::vector<std::uint64_t> key;
  std::array<AlignedVector<double>, static_cast<std::size_t>(Size)> history;

  void reserve(std::size_t n) {
    key.resize(n);
    for (auto& column : history) column.resize(n);
  }
  /// Room for n contacts and the padding of a last pack.
  void make_room(int n) {
    const auto need = static_cast<std::size_t>(n + pack_width);
    if (key.size() < need) reserve((need + need / 4 + 15) / 16 * 16);
  }
  void copy(const ContactHistories& from) {
    make_room(count = from.count);
    std::copy_n(from.key.begin(), count, key.begin());
    for (std::size_t k = 0; k < history.size(); ++k) std::copy_n(from.history[k].begin(), count, history[k].begin());
  }
  /// Contact `at` becomes contact `other` of another list.
  void take(int at, const ContactHistories& from, int other) {
    key[static_cast<std::size_t>(at)] = from.key[static_cast<std::size_t>(other)];
    for (std::size_t k = 0; k < history.size(); ++k) {
      history[k][static_cast<std::size_t>(at)] = from.history[k][static_cast<std::size_t>(other)];
    }
  }
};

/// The histories of all contacts of one chunk with one kind of partner (grains or surfaces): those of this evaluation
/// and the last ones that were committed.
template <int HistorySize>
struct HistoriesOfSteps {
  ContactHistories<HistorySize> now, last;

  /// The histories of this evaluation become the committed ones.
  void commit() { std::swap(now, last); }
  /// The same with `now` in memory that is used again for others: of the chunk itself only `last` is touched.
  void commit_copy() { last.copy(now); }
  /// The same where only some candidates were evaluated (`renews`, by candidate): the committed histories of others
  /// stay. `spare` is used on the way.
  void commit_some(std::span<const std::uint8_t> renews, ContactHistories<HistorySize>& spare) {
    if (rewrite(renews)) return;
    // Contacts came or went: both lists become one, in the order of their keys.
    spare.make_room(now.count + last.count);
    int count = 0, l = 0;
    const auto keep_below = [&](std::uint64_t key) {
      for (; l < last.count && last.key[static_cast<std::size_t>(l)] < key; ++l) {
        if (renews[grain::PairKey{last.key[static_cast<std::size_t>(l)]}.candidate()] == 0)
          spare.take(count++, last, l);
      }
    };
    for (int k = 0; k < now.count; ++k) {
      if (renews[grain::PairKey{now.key[static_cast<std::size_t>(k)]}.candidate()] == 0) continue;
      keep_below(now.key[static_cast<std::size_t>(k)]);
      spare.take(count++, now, k);
    }
    keep_below(~std::uint64_t{0});
    spare.count = count;
    last.copy(spare);
  }
  /// How many contacts were committed: those of `last`.
  int committed() const { return last.count; }

 private:
  /// Mostly the contacts that were evaluated are those of the last time: their histories are written over. False if
  /// they are not; what was written until then is right all the same.
  bool rewrite(std::span<const std::uint8_t> renews) {
    int l = 0;
    const auto skip_below = [&](std::uint64_t key) {
      for (; l < last.count && last.key[static_cast<std::size_t>(l)] < key; ++l) {
        if (renews[grain::PairKey{last.key[static_cast<std::size_t>(l)]}.candidate()] != 0) return false;
      }
      return true;
    };
    for (int k = 0; k < now.count; ++k) {
      const std::uint64_t key = now.key[static_cast<std::size_t>(k)];
      if (renews[grain::PairKey{key}.candidate()] == 0) continue;
      if (!skip_below(key) || l == last.count || last.key[static_cast<std::size_t>(l)] != key) return false;
      last.take(l++, now, k);
    }
    return skip_below(~std::uint64_t{0});
  }
};

}  // namespace dem
