#pragma once
// Reads zlib streams as RFC 1950 and 1951 describe them, bit by bit: a second opinion on what dem writes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

class Inflate {
 public:
  /// The bytes that a stream holds. Throws std::runtime_error or std::out_of_range for what is no such stream, and for
  /// bytes behind its end.
  static std::string all(std::string_view stream) {
    const auto head = static_cast<std::size_t>(byte_of(stream, 0) * 256 + byte_of(stream, 1));
    if (head % 31 != 0 || head / 256 != 0x78) throw std::runtime_error("no zlib stream");
    Inflate i(stream.substr(2));
    bool last = false;
    while (!last) {
      last = i.bits(1) != 0;
      i.block(i.bits(2));
    }
    std::uint32_t a = 1, b = 0;
    for (const char c : i.out_) {
      a = (a + static_cast<unsigned char>(c)) % 65521;
      b = (b + a) % 65521;
    }
    const std::size_t end = (i.at_ + 7) / 8;
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum = sum << 8U | byte_of(i.in_, end + k);
    if (sum != (b << 16U | a)) throw std::runtime_error("wrong checksum");
    if (i.in_.size() != end + 4) throw std::runtime_error("bytes behind the end");
    return i.out_;
  }

 private:
  /// Symbols by the length and the bits of their codes.
  using Code = std::map<std::pair<int, std::uint32_t>, std::uint32_t>;

  explicit Inflate(std::string_view in) : in_(in) {}

  static std::uint32_t byte_of(std::string_view text, std::size_t k) {
    return static_cast<unsigned char>(std::string(text.substr(k, 1)).at(0));
  }
  std::uint32_t bits(int count) {
    std::uint32_t value = 0;
    for (int k = 0; k < count; ++k, ++at_) {
      value |= (byte_of(in_, at_ / 8) >> at_ % 8 & 1U) << static_cast<unsigned>(k);
    }
    return value;
  }

  static Code code_of(const std::vector<int>& lengths) {
    Code code;
    std::uint32_t next = 0;
    for (int length = 1; length < 16; ++length, next <<= 1U) {
      for (std::size_t s = 0; s < lengths.size(); ++s) {
        if (lengths[s] != length) continue;
        if (next >> static_cast<unsigned>(length) != 0) throw std::runtime_error("more codes than there are");
        code[{length, next++}] = static_cast<std::uint32_t>(s);
      }
    }
    return code;
  }
  std::uint32_t symbol(const Code& code) {
    std::uint32_t read = 0;
    for (int length = 1; length < 16; ++length) {
      read = read << 1U | bits(1);
      if (const auto found = code.find({length, read}); found != code.end()) return found->second;
    }
    throw std::runtime_error("no such code");
  }

  void block(std::uint32_t kind) {
    std::vector<int> literals, distances;
    if (kind == 0) {  // bytes as they are
      at_ = (at_ + 7) / 8 * 8;
      const std::uint32_t count = bits(16);
      if ((bits(16) ^ count) != 0xFFFFU) throw std::runtime_error("a wrong number of bytes");
      for (std::uint32_t k = 0; k < count; ++k) out_ += static_cast<char>(bits(8));
      return;
    }
    if (kind == 1) {
      for (int s = 0; s < 288; ++s) literals.push_back(s < 144 ? 8 : s < 256 ? 9 : s < 280 ? 7 : 8);
      distances.assign(30, 5);
    } else if (kind == 2) {
      read_lengths(literals, distances);
    } else {
      throw std::runtime_error("a kind of block that is not expected");
    }
    const Code literal = code_of(literals), distance = code_of(distances);
    for (std::uint32_t s = symbol(literal); s != 256; s = symbol(literal)) {
      if (s < 256) {
        out_ += static_cast<char>(s);
        continue;
      }
      static constexpr std::array<std::uint32_t, 29> base = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                                             15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                                             67, 83, 99, 115, 131, 163, 195, 227, 258};
      const int extra = s < 265 || s == 285 ? 0 : static_cast<int>(s - 261) / 4;
      const std::uint32_t length = base.at(s - 257) + bits(extra);
      const std::uint32_t d = symbol(distance);
      const int more = d < 4 ? 0 : static_cast<int>(d - 2) / 2;
      const std::uint32_t far = (d < 4 ? d : (2 + d % 2) << static_cast<unsigned>(more)) + 1 + bits(more);
      if (far > out_.size()) throw std::runtime_error("a distance before the start");
      for (std::uint32_t k = 0; k < length; ++k) out_ += out_[out_.size() - far];
    }
  }

  void read_lengths(std::vector<int>& literals, std::vector<int>& distances) {
    const std::size_t many_literals = bits(5) + 257, many_distances = bits(5) + 1, many_lengths = bits(4) + 4;
    static constexpr std::array<std::size_t, 19> order = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                          11, 4,  12, 3, 13, 2, 14, 1, 15};
    std::vector<int> of_lengths(19, 0);
    for (std::size_t k = 0; k < many_lengths; ++k) of_lengths[order.at(k)] = static_cast<int>(bits(3));
    const Code code = code_of(of_lengths);
    std::vector<int> lengths;
    while (lengths.size() < many_literals + many_distances) {
      const std::uint32_t s = symbol(code);
      if (s < 16) lengths.push_back(static_cast<int>(s));
      if (s == 16) lengths.insert(lengths.end(), bits(2) + 3, lengths.at(lengths.size() - 1));
      if (s == 17) lengths.insert(lengths.end(), bits(3) + 3, 0);
      if (s == 18) lengths.insert(lengths.end(), bits(7) + 11, 0);
    }
    const auto border = lengths.begin() + static_cast<std::ptrdiff_t>(many_literals);
    literals.assign(lengths.begin(), border);
    distances.assign(border, lengths.end());
  }

  std::string_view in_;
  std::size_t at_ = 0;  // in bits
  std::string out_;
};
