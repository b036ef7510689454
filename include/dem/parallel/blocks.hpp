#pragma once

#include <algorithm>
#include <cstddef>

namespace dem::exec {

/// How many items threads take at once where an item is little work.
inline constexpr std::size_t block_size = 4096;

/// Calls f(first, last) for the blocks of 0 to n - 1, which an executor's threads share.
template <class Executor, class F>
void for_each_block(Executor& executor, std::size_t n, F&& f) {
  executor.for_each((n + block_size - 1) / block_size,
                    [&](std::size_t b) { f(b * block_size, std::min((b + 1) * block_size, n)); });
}

}  // namespace dem::exec
