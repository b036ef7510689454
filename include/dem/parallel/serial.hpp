#pragma once

#include <dem/core/error.hpp>
#include <dem/parallel/executor.hpp>

namespace dem::exec {

/// One thread, plain loops.
class Serial {
 public:
  int threads() const { return 1; }
  void set_threads(int n) {
    if (n != 1) fail("exec::Serial runs 1 thread, not {}; choose exec::Threads in the model for more", n);
  }

  template <class F>
  void for_each(std::size_t n, F&& f) const {
    for (std::size_t k = 0; k < n; ++k) call_piece(f, k, 0);
  }
};

}  // namespace dem::exec
