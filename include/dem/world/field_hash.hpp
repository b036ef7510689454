#pragma once

#include <dem/math/fingerprint.hpp>
#include <dem/mbd/load/terrain.hpp>
#include <dem/mbd/sensor/sensor.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace dem::detail {

/// Mixes numbers into a hash.
class Hash {
 public:
  std::uint64_t value() const { return value_; }
  void mix(std::uint64_t x) { dem::mix(value_, x); }
  void mix(double x) { mix(std::bit_cast<std::uint64_t>(x)); }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Which fields are hashed.
enum class Hashed {
  all,   ///< those that are set up and those that change
  state  ///< those that change, but no averages, which follow from the rest, and no terrain, whose loads tell of it
};

/// Goes through the fields of a struct as io::Fields does, and mixes them into a hash. Changes nothing.
template <Hashed hashed>
class HashOf {
  static constexpr bool has_given = hashed == Hashed::all;

 public:
  std::uint64_t value() const { return hash_.value(); }

  template <class T>
  void operator()(std::string_view, T& x, const char* = "") {
    visit(x);
  }
  template <class T>
  void given(std::string_view, const T& x, const char* = "") {
    if constexpr (has_given) {
      T copy = x;
      visit(copy);
    } else if constexpr (std::is_same_v<T, bool>) {  // whether a set point is a function, say
      hash_.mix(std::uint64_t{x});
    }
  }
  void fingerprint(std::string_view, std::uint64_t bits) {
    if (has_given) hash_.mix(bits);
  }
  /// `more` words of an item are for messages.
  template <class Items, class More = int>
  void list(std::string_view, Items& items, const char*, More&& = {}) {
    hash_.mix(std::uint64_t{items.size()});
    for (auto& item : items) visit(item);
  }
  template <class Struct>
  void reals(std::string_view, const Struct& x, const char* = "") {
    if constexpr (!std::is_empty_v<Struct>) bytes_of(x);
  }
  template <class Struct>
  void given_reals(std::string_view name, const Struct& x) {
    if constexpr (has_given) reals(name, x);
  }
  template <class T>
  void numbers(std::string_view, const std::vector<T>& rows) {
    hash_.mix(std::uint64_t{rows.size()});
    for (const T& row : rows) bytes_of(row);
  }
  template <class F>
  void about(const std::string&, F&& f) {
    f();
  }

 private:
  template <class T>
  void visit(T& x) {
    constexpr bool is_left_out = std::is_same_v<T, mbd::WindowAverage> || std::is_same_v<T, mbd::TerrainPart>;
    if constexpr (is_left_out && !has_given) return;
    else if constexpr (requires { x.fields(*this); }) x.fields(*this);
    else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) bytes_of(x);
    else if constexpr (requires { T::RowsAtCompileTime; }) {
      for (auto k = x.size() * 0; k < x.size(); ++k) hash_.mix(double(x.data()[k]));
    } else if constexpr (requires { x.has_value(); }) {
      hash_.mix(std::uint64_t{x.has_value()});
      if (x) visit(*x);
    } else if constexpr (requires { x.begin(); }) {  // texts too
      hash_.mix(std::uint64_t{x.size()});
      for (auto& item : x) visit(item);
    } else visit_more(x);
  }
  template <class A, class B>
  void visit_more(std::pair<A, B>& x) {
    visit(x.first), visit(x.second);
  }
  /// Vectors, matrices, ids and wrenches have no gaps.
  template <class T>
  void visit_more(T& x) {
    bytes_of(x);
  }
  template <class T>
  void bytes_of(const T& x) {
    static_assert(std::is_trivially_copyable_v<T>);
    Hash hash = hash_;  // in a register
    for (std::size_t k = 0; k < sizeof(T); k += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, reinterpret_cast<const char*>(&x) + k, std::min(sizeof(word), sizeof(T) - k));
      hash.mix(word);
    }
    hash_ = hash;
  }

  Hash hash_;
};

using FieldHash = HashOf<Hashed::all>;
using StateHash = HashOf<Hashed::state>;

}  // namespace dem::detail
