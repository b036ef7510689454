#pragma once

#include <dem/core/error.hpp>
#include <dem/math/fingerprint.hpp>

#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dem::io {

/// What the numbers of a column are.
enum class ColumnKind : std::uint8_t { real, integer, natural, natural32, byte, text };

/// Bytes of one number; 1 for the characters of a text.
constexpr std::size_t size_of(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::real:
    case ColumnKind::integer:
    case ColumnKind::natural: return 8;
    case ColumnKind::natural32: return 4;
    case ColumnKind::byte:
    case ColumnKind::text: break;
  }
  return 1;
}

/// Rows of `width` numbers each, or of one text each.
struct Column {
  ColumnKind kind = ColumnKind::real;
  std::size_t width = 1;
  std::string unit = {};                     ///< SI; empty where there is none
  std::vector<std::byte> own = {};           ///< the numbers, unless they are borrowed
  std::span<const std::byte> borrowed = {};  ///< numbers that stay where they are while the column is in use
  std::vector<std::string> texts = {};       ///< of kind text
  std::size_t at = 0;                        ///< the next row to be read

  std::span<const std::byte> bytes() const { return borrowed.empty() ? std::span<const std::byte>(own) : borrowed; }
  std::size_t row_bytes() const { return width * size_of(kind); }
  std::size_t rows() const { return kind == ColumnKind::text ? texts.size() : bytes().size() / row_bytes(); }
};

/// All columns of a state, by their names: parts of a name are set apart by slashes.
using StateColumns = std::map<std::string, Column, std::less<>>;

namespace detail {

using dem::mix;
inline void mix(std::uint64_t& hash, const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  std::size_t k = 0;
  for (; k + 8 <= bytes; k += 8) {
    std::uint64_t word;
    std::memcpy(&word, from + k, 8);
    mix(hash, word);
  }
  std::uint64_t rest = 0;
  if (k < bytes) std::memcpy(&rest, from + k, bytes - k);  // of nothing there may be no address
  mix(hash, rest);
  mix(hash, bytes);
}

}  // namespace detail

/// Mixes the bits of a column: its name, what it holds, and its unit.
inline std::uint64_t hash_of(std::string_view name, const Column& column) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  detail::mix(hash, name.data(), name.size());
  detail::mix(hash, column.unit.data(), column.unit.size());
  detail::mix(hash, static_cast<std::uint64_t>(column.kind) << 32 | column.width);
  if (column.kind == ColumnKind::text) {
    for (const std::string& text : column.texts) detail::mix(hash, text.data(), text.size());
  } else {
    detail::mix(hash, column.bytes().data(), column.bytes().size());
  }
  return hash;
}

/// Mixes the bits of all columns: two states that differ in one bit differ in it.
inline std::uint64_t hash_of(const StateColumns& columns) {
  std::uint64_t hash = 0;
  for (const auto& [name, column] : columns) detail::mix(hash, hash_of(name, column));
  return hash;
}

/// The names of the columns that two states do not share in every bit.
inline std::vector<std::string> differences(const StateColumns& a, const StateColumns& b) {
  std::vector<std::string> names;
  for (const auto& [name, column] : a) {
    const auto other = b.find(name);
    if (other == b.end() || hash_of(name, column) != hash_of(name, other->second)) names.push_back(name);
  }
  for (const auto& [name, column] : b) {
    if (!a.contains(name)) names.push_back(name);
  }
  return names;
}

}  // namespace dem::io
