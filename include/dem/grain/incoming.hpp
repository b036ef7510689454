#pragma once
// Whose partners the grains of a chunk are: candidate lists the other way round.

#include <dem/core/sorted.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/grain/images.hpp>
#include <dem/grain/move.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace dem::grain {

/// The candidates of a chunk that are grains of other chunks, or images, by the chunks of these grains.
struct Outgoing {
  std::vector<std::uint32_t> to;         ///< chunks, ascending; itself too, if it has images of its own grains
  std::vector<std::uint32_t> first;      ///< of each of them in `candidate`, and one entry more
  std::vector<std::uint32_t> candidate;  ///< ascending for each chunk
};

template <class Model>
Outgoing find_outgoing(std::size_t c, const Chunk<Model>& chunk, const Images<typename Model::Domain>& images) {
  Outgoing out;
  const auto for_each = [&](auto&& f) {
    for (std::uint32_t k = 0; k < chunk.candidate.size(); ++k) {
      const std::uint32_t j = chunk.candidate[k];
      if (j / chunk_size != c) f(k, static_cast<std::uint32_t>(images.grain_of(j) / chunk_size));
    }
  };
  for_each([&](std::uint32_t, std::uint32_t other) {
    if (out.to.empty() || out.to.back() != other) out.to.push_back(other);
  });
  sort_and_drop_doubles(out.to);

  std::size_t last = 0;  // neighbours in a list mostly go to the same chunk
  const auto place_of = [&](std::uint32_t other) {
    if (out.to[last] != other) {
      last = static_cast<std::size_t>(std::lower_bound(out.to.begin(), out.to.end(), other) - out.to.begin());
    }
    return last;
  };
  out.first.assign(out.to.size() + 1, 0);
  for_each([&](std::uint32_t, std::uint32_t other) { ++out.first[place_of(other) + 1]; });
  for (std::size_t k = 0; k < out.to.size(); ++k) out.first[k + 1] += out.first[k];
  out.candidate.resize(out.first.back());
  std::vector<std::uint32_t> next = out.first;
  for_each([&](std::uint32_t k, std::uint32_t other) { out.candidate[next[place_of(other)]++] = k; });
  return out;
}

/// Lists which other chunks a chunk reaches.
template <class Model>
void list_reached(std::size_t c, Chunk<Model>& chunk, const Outgoing& outgoing) {
  chunk.reached = outgoing.to;
  std::erase(chunk.reached, c);
}

/// The reverse of the candidate lists: for each grain, where it is a partner in another chunk; owners ascending. Lists
/// which chunks each chunk reaches, too.
template <class Model, class Executor>
void list_incoming(Executor& executor, std::span<Chunk<Model>> chunks, std::size_t grains,
                   const Images<typename Model::Domain>& images, std::vector<std::uint32_t>& first,
                   std::vector<Incoming>& incoming) {
  std::vector<Outgoing> outgoing(chunks.size());
  executor.for_each(chunks.size(), [&](std::size_t c) {
    outgoing[c] = find_outgoing<Model>(c, chunks[c], images);
    list_reached(c, chunks[c], outgoing[c]);
  });

  struct Sender {
    std::uint32_t chunk, place;  // of the chunk that it is about in outgoing[chunk].to
  };
  std::vector<std::vector<Sender>> senders(chunks.size());
  std::vector<std::uint32_t> start(chunks.size() + 1, 0);
  for (std::uint32_t c = 0; c < chunks.size(); ++c) {
    for (std::uint32_t k = 0; k < outgoing[c].to.size(); ++k) {
      const std::uint32_t to = outgoing[c].to[k];
      senders[to].push_back({c, k});
      start[to + 1] += outgoing[c].first[k + 1] - outgoing[c].first[k];
    }
  }
  for (std::size_t c = 0; c < chunks.size(); ++c) start[c + 1] += start[c];

  first.resize(grains + 1);
  std::fill(first.begin() + static_cast<std::ptrdiff_t>(std::min(chunks.size() * chunk_size, grains)), first.end(),
            start.back());
  incoming.resize(start.back());
  executor.for_each(chunks.size(), [&](std::size_t c) {
    const auto for_each = [&](auto&& f) {
      for (const Sender& s : senders[c]) {
        const Outgoing& out = outgoing[s.chunk];
        for (std::uint32_t m = out.first[s.place]; m < out.first[s.place + 1]; ++m) {
          const std::uint32_t k = out.candidate[m];
          f(images.grain_of(chunks[s.chunk].candidate[k]) % chunk_size, Incoming{s.chunk, k});
        }
      }
    };
    std::array<std::uint32_t, chunk_size> next = {};
    for_each([&](std::size_t i, const Incoming&) { ++next[i]; });
    std::uint32_t at = start[c];
    for (std::uint32_t& n : next) at += std::exchange(n, at);
    for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, grains); ++i)
      first[i] = next[i % chunk_size];
    for_each([&](std::size_t i, const Incoming& entry) { incoming[next[i]++] = entry; });
  });
}

}  // namespace dem::grain
