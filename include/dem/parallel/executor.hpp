#pragma once

#include <dem/core/function_like.hpp>

#include <concepts>
#include <cstddef>

namespace dem::exec {

/// An executor runs f(0) ... f(n-1), in any order and on any number of threads. Every phase of the step is written such
/// that the result does not depend on either. An f of two arguments is told which thread calls it, from 0 to
/// threads() - 1, as scratch memory of that thread is chosen by. An exception of f leaves for_each, on the thread that
/// called it. Where lists of neighbours are dearer than on a processor, beside the work of a step, an executor says by
/// how many times: `static constexpr double list_weight`; skins are wider then.
template <class E>
concept Executor = requires(E& executor) {
  executor.for_each(std::size_t{1}, FunctionLike<void(std::size_t)>{});
  executor.for_each(std::size_t{1}, FunctionLike<void(std::size_t, int)>{});
  { executor.threads() } -> std::convertible_to<int>;
  executor.set_threads(1);
};

/// An executor with memory of its own, in which a world keeps its grains while it runs: a GPU (exec::Cuda), or this
/// processor by the same code (exec::Flat, which says what such an executor has).
template <class E>
concept FlatExecutor = Executor<E> && requires {
  typename E::template Array<double>;
};

template <class E>
constexpr void check_executor() {
  static_assert(
      !requires { E::needs_nvcc; }, "exec::Cuda: compile this source with nvcc, the compiler of CUDA");
  static_assert(Executor<E>,
                "Executor: needs for_each(n, f) for f(piece) and f(piece, thread), threads() and set_threads(n)");
}

/// One piece of the work of an executor.
template <class F>
void call_piece(F& f, std::size_t piece, int thread) {
  if constexpr (requires { f(piece, thread); }) {
    f(piece, thread);
  } else {
    f(piece);
  }
}

}  // namespace dem::exec
