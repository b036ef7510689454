#include "catch.hpp"
#include "inflate.hpp"

#include <dem/report/deflate.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

using Catch::Approx;
using dem::report::Deflate;

namespace {

std::string packed(const std::vector<std::string>& pieces) {
  Deflate out;
  for (const std::string& piece : pieces) out.add(piece);
  return out.finish();
}

/// Each byte as often as the counts say, in any order.
std::string shuffled(const std::vector<int>& counts, std::mt19937& random) {
  std::string text;
  for (std::size_t k = 0; k < counts.size(); ++k)
    text.append(static_cast<std::size_t>(counts[k]), static_cast<char>(k));
  std::shuffle(text.begin(), text.end(), random);
  return text;
}

}  // namespace

TEST_CASE("what deflate has packed comes out again") {
  std::mt19937 random(1);
  std::vector<int> fibonacci = {1, 1};  // whose Huffman code would be longer than the 15 bits that are allowed
  while (fibonacci.size() < 21) fibonacci.push_back(fibonacci.end()[-1] + fibonacci.end()[-2]);
  std::vector<int> even(256, 20), few(2, 3000);
  std::string runs;
  for (int length = 1; length < 600; ++length)
    runs.append(static_cast<std::size_t>(length), static_cast<char>(length % 2));
  const std::vector<std::string> pieces = {"",
                                           "a",
                                           "ab",
                                           std::string(100'000, '\0'),
                                           runs,
                                           shuffled(fibonacci, random),
                                           shuffled(even, random),
                                           shuffled(few, random),
                                           std::string(258, '\xff'),
                                           "the end"};
  std::string all;
  for (const std::string& piece : pieces) {
    CHECK(Inflate::all(packed({piece})) == piece);
    all += piece;
  }
  CHECK(Inflate::all(packed(pieces)) == all);
  CHECK(Inflate::all(packed({})).empty());
}

TEST_CASE("deflate comes near the entropy of bytes, and runs cost next to nothing") {
  std::mt19937 random(2);
  // Numbers that are half as frequent from each to the next: a Huffman code reaches their 2 bits a byte.
  std::vector<int> halves;
  for (int n = 1 << 14; n > 0; n /= 2) halves.push_back(n);
  const std::string text = shuffled(halves, random);
  const double entropy = 2.0 / 8.0 * static_cast<double>(text.size());
  // The head of a block names 286 codes: some 40 bytes.
  CHECK(static_cast<double>(packed({text}).size()) < entropy + 100.0);
  CHECK(static_cast<double>(packed({text}).size()) > 0.95 * entropy);
  // 31 blocks of 32 KiB, in each 127 runs of 1 or 2 bits with 1 for the distance, and a head of some 20 bytes.
  CHECK(packed({std::string(1'000'000, '\0')}).size() < 31 * (127 * 3 / 8 + 25));
}
