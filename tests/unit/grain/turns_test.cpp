#include "catch.hpp"

#include <dem/domain/cut.hpp>
#include <dem/grain/turns.hpp>
#include <dem/world/model.hpp>

namespace {

using Chunks = std::vector<dem::Chunk<dem::Model>>;
using Indices = std::vector<std::uint32_t>;

/// Chunks that reach others, as listed.
Chunks chunks_that_reach(const std::vector<Indices>& reached) {
  Chunks chunks(reached.size());
  for (std::size_t c = 0; c < chunks.size(); ++c) chunks[c].reached = reached[c];
  return chunks;
}

}  // namespace

TEST_CASE("a chunk is moved when its contacts and those of all chunks that reach it are found, once") {
  const Chunks chunks = chunks_that_reach({{1, 2}, {2}, {}});
  dem::grain::Turns turns;
  Indices moved;
  const auto move = [&](std::size_t c) { moved.push_back(static_cast<std::uint32_t>(c)); };
  for (int repeat = 0; repeat < 2; ++repeat) {
    moved.clear();
    turns.begin({0, 1, 2}, chunks);
    turns.found(2, chunks, move);
    CHECK(moved.empty());
    turns.found(0, chunks, move);
    CHECK(moved == Indices{0});
    turns.found(1, chunks, move);
    CHECK(moved == Indices{0, 1, 2});
  }
}

TEST_CASE("a chunk that does not work holds nobody up and is not moved") {
  const Chunks chunks = chunks_that_reach({{1}, {2}, {}});
  dem::grain::Turns turns;
  Indices moved;
  const auto move = [&](std::size_t c) { moved.push_back(static_cast<std::uint32_t>(c)); };
  turns.begin({0, 2}, chunks);
  turns.found(0, chunks, move);
  turns.found(2, chunks, move);
  CHECK(moved == Indices{0, 2});
}

TEST_CASE("a chunk waits for those of other ranks that reach it, which are not moved here") {
  const Chunks chunks = chunks_that_reach({{1}, {}});
  dem::grain::Turns turns;
  Indices moved;
  const auto move = [&](std::size_t c) { moved.push_back(static_cast<std::uint32_t>(c)); };
  turns.begin({1}, chunks);
  turns.expect({0}, chunks);
  turns.found(1, chunks, move);
  CHECK(moved.empty());
  turns.found_elsewhere(0, chunks, move);
  CHECK(moved == Indices{1});
}

TEST_CASE("chunks are cut where the work is halved, and a part may be empty") {
  CHECK(dem::domain::cut_by_work({1, 1, 1, 1}, 2) == Indices{0, 2, 4});
  CHECK(dem::domain::cut_by_work({1, 1, 1, 3}, 2) == Indices{0, 3, 4});
  CHECK(dem::domain::cut_by_work({1}, 2).size() == 3);
  CHECK(dem::domain::cut_by_work({1}, 2).back() == 1);
  CHECK(dem::domain::imbalance_of({1, 1, 1, 3}, {0, 3, 4}) == 1.0);
  CHECK(dem::domain::imbalance_of({1, 1, 1, 1}, {0, 3, 4}) == 1.5);
  CHECK(dem::domain::imbalance_of({1}, {0, 0, 1}) == 2.0);
  CHECK(dem::domain::imbalance_of({}, {0, 0, 0}) == 1.0);
}
