#pragma once
// Compression that every browser undoes by itself, without a library.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::report {

namespace detail {

/// Bits into bytes, the lowest first.
class BitWriter {
 public:
  void put(std::uint32_t value, int count) {
    pending_ |= std::uint64_t{value} << filled_;
    for (filled_ += count; filled_ >= 8; filled_ -= 8, pending_ >>= 8U) bytes += static_cast<char>(pending_ & 0xFFU);
  }
  void fill_byte() {
    if (filled_ > 0) put(0, 8 - filled_);
  }

  std::string bytes;

 private:
  std::uint64_t pending_ = 0;
  int filled_ = 0;
};

/// A Huffman code for symbols that occur so often, none longer than `longest` bits.
struct HuffmanCode {
  std::vector<int> length;          ///< bits of each symbol, 0 where it never occurs
  std::vector<std::uint32_t> code;  ///< with its first bit lowest

  HuffmanCode(std::vector<std::uint32_t> counts, int longest) : length(counts.size(), 0), code(counts.size(), 0) {
    for (;;) {
      find_lengths(counts);
      if (*std::max_element(length.begin(), length.end()) <= longest) break;
      for (std::uint32_t& n : counts) n = (n + 1) / 2;  // flatter counts make a flatter tree
    }
    // Codes of one length follow each other in the order of the symbols (RFC 1951, 3.2.2).
    std::uint32_t next = 0;
    for (int bits = 1; bits <= longest; ++bits, next <<= 1U) {
      for (std::size_t s = 0; s < length.size(); ++s) {
        if (length[s] == bits) code[s] = reversed(next++, bits);
      }
    }
  }

  void put(BitWriter& out, std::size_t symbol) const { out.put(code[symbol], length[symbol]); }

 private:
  static std::uint32_t reversed(std::uint32_t value, int bits) {
    std::uint32_t result = 0;
    for (int k = 0; k < bits; ++k)
      result |= (value >> static_cast<unsigned>(k) & 1U) << static_cast<unsigned>(bits - 1 - k);
    return result;
  }

  void find_lengths(const std::vector<std::uint32_t>& counts) {
    std::fill(length.begin(), length.end(), 0);
    struct Node {
      std::uint64_t count;
      std::size_t number;  // of the symbol, or of the inner node behind the symbols
    };
    std::vector<Node> leaves;
    for (std::size_t s = 0; s < counts.size(); ++s) {
      if (counts[s] > 0) leaves.push_back({counts[s], s});
    }
    std::stable_sort(leaves.begin(), leaves.end(), [](const Node& a, const Node& b) { return a.count < b.count; });
    if (leaves.size() == 1) length[leaves[0].number] = 1;
    if (leaves.size() < 2) return;
    // Two queues, each sorted: the leaves, and the inner nodes in the order in which they are made.
    const std::size_t symbols = counts.size();
    std::vector<std::size_t> parent(symbols + leaves.size(), 0);
    std::vector<Node> inner;
    std::size_t leaf = 0, made = 0;
    const auto take = [&] {
      const bool from_leaves =
          leaf < leaves.size() && (made == inner.size() || leaves[leaf].count <= inner[made].count);
      return from_leaves ? leaves[leaf++] : inner[made++];
    };
    while (inner.size() + 1 < leaves.size()) {
      const Node a = take(), b = take();
      const std::size_t node = symbols + inner.size();
      parent[a.number] = parent[b.number] = node;
      inner.push_back({a.count + b.count, node});
    }
    std::vector<int> depth(symbols + inner.size(), 0);
    for (std::size_t k = inner.size() - 1; k-- > 0;) depth[inner[k].number] = depth[parent[inner[k].number]] + 1;
    for (const Node& l : leaves) length[l.number] = depth[parent[l.number]] + 1;
  }
};

/// The symbol of a run's length (3 to 258), and the extra bits behind it (RFC 1951, 3.2.5).
struct RunSymbol {
  std::size_t symbol;
  std::uint32_t extra;
  int extra_bits;
};
[[nodiscard]] inline RunSymbol run_symbol(std::uint32_t length) {
  if (length == 258) return {285, 0, 0};
  const std::uint32_t l = length - 3;
  int bits = 0;
  while (l >> static_cast<unsigned>(bits) >= 8) ++bits;  // four lengths to each number of extra bits, from 8 on
  const std::uint32_t step = l >> static_cast<unsigned>(bits);
  return {257 + static_cast<std::size_t>(4 * bits) + step, l - (step << static_cast<unsigned>(bits)), bits};
}

}  // namespace detail

/// Makes a zlib stream (RFC 1950), "deflate" to a browser's DecompressionStream, by Huffman codes and runs of one byte.
/// It looks for no other repetition: numbers that are stored as differences, low and high bytes apart, have none. On
/// those of a replay it gives 1 % less than zlib at its best level.
class Deflate {
 public:
  Deflate() { out_.bytes = "\x78\x9c"; }

  /// Appends bytes of one kind; they get codes of their own, made anew every 32 KiB.
  void add(std::string_view bytes) {
    for (const char c : bytes) {
      low_ = (low_ + static_cast<unsigned char>(c)) % 65521;
      high_ = (high_ + low_) % 65521;
    }
    for (; !bytes.empty(); bytes.remove_prefix(std::min<std::size_t>(bytes.size(), 32768))) {
      add_block(bytes.substr(0, 32768));
    }
  }

  /// The whole stream; nothing may be added after it.
  [[nodiscard]] std::string finish() {
    out_.put(0b011, 10);  // a last block, of fixed codes, that only ends
    out_.fill_byte();
    for (const std::uint32_t sum : {high_, low_}) {
      out_.bytes += static_cast<char>(sum >> 8U);
      out_.bytes += static_cast<char>(sum & 0xFFU);
    }
    return std::move(out_.bytes);
  }

 private:
  static constexpr std::size_t kEnd = 256;
  static constexpr std::size_t kShortest = 8;  // run: shorter ones gain less than they cost the codes of the bytes

  /// Bytes as symbols; a run is 1000 + its length.
  static std::vector<std::uint32_t> symbols_of(std::string_view bytes) {
    std::vector<std::uint32_t> symbols;
    for (std::size_t i = 0; i < bytes.size();) {
      std::size_t run = 0;
      while (i > 0 && i + run < bytes.size() && run < 258 && bytes[i + run] == bytes[i - 1]) ++run;
      symbols.push_back(run >= kShortest ? static_cast<std::uint32_t>(1000 + run)
                                         : static_cast<unsigned char>(bytes[i]));
      i += run >= kShortest ? run : 1;
    }
    return symbols;
  }

  void add_block(std::string_view bytes) {
    const std::vector<std::uint32_t> symbols = symbols_of(bytes);
    std::vector<std::uint32_t> counts(286, 0);
    for (const std::uint32_t s : symbols) ++counts[s < 1000 ? s : detail::run_symbol(s - 1000).symbol];
    counts[kEnd] = 1;
    const detail::HuffmanCode code(counts, 15);
    put_code(code);
    for (const std::uint32_t s : symbols) {
      if (s < 1000) {
        code.put(out_, s);
        continue;
      }
      const detail::RunSymbol run = detail::run_symbol(s - 1000);
      code.put(out_, run.symbol);
      out_.put(run.extra, run.extra_bits);
      out_.put(0, 1);  // the only distance: 1
    }
    code.put(out_, kEnd);
  }

  /// The head of a block: the lengths of its codes (RFC 1951, 3.2.7), zeros by their number.
  void put_code(const detail::HuffmanCode& code) {
    std::vector<int> lengths = code.length;
    lengths.push_back(1);  // distance 1
    struct Item {
      std::uint32_t symbol, extra;
      int extra_bits;
    };
    std::vector<Item> items;
    for (std::size_t i = 0; i < lengths.size();) {
      std::uint32_t zeros = 0;
      while (i + zeros < lengths.size() && zeros < 138 && lengths[i + zeros] == 0) ++zeros;
      if (zeros >= 11) {
        items.push_back({18, zeros - 11, 7});
      } else if (zeros >= 3) {
        items.push_back({17, zeros - 3, 3});
      } else {
        items.push_back({static_cast<std::uint32_t>(lengths[i]), 0, 0});
        zeros = 1;
      }
      i += zeros;
    }
    std::vector<std::uint32_t> counts(19, 0);
    for (const Item& item : items) ++counts[item.symbol];
    const detail::HuffmanCode of_lengths(counts, 7);
    out_.put(0b100, 3);  // not the last block, of codes of its own
    out_.put(286 - 257, 5);
    out_.put(1 - 1, 5);
    out_.put(19 - 4, 4);
    for (const std::size_t symbol : {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15}) {
      out_.put(static_cast<std::uint32_t>(of_lengths.length[symbol]), 3);
    }
    for (const Item& item : items) {
      of_lengths.put(out_, item.symbol);
      out_.put(item.extra, item.extra_bits);
    }
  }

  detail::BitWriter out_;
  std::uint32_t low_ = 1, high_ = 0;  // Adler-32
};

}  // namespace dem::report
