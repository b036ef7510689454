#pragma once

#include <dem/parallel/executor.hpp>

#include <concepts>
#include <cstddef>
#include <memory>

namespace dem::exec {

/// Stands for an executor of any type, for functions that are compiled once for all: lists that are made now and then,
/// where a call through a pointer for each piece costs nothing. It refers to the executor, which must outlive it.
class AnyExecutor {
 public:
  template <class E>
  requires(!std::same_as<E, AnyExecutor> && !std::same_as<E, const AnyExecutor> &&
           requires(E & e) {
             e.for_each(std::size_t{1}, FunctionLike<void(std::size_t, int)>{});
             { e.threads() } -> std::convertible_to<int>;
           }) AnyExecutor(E& executor)
      : executor_(std::addressof(executor)), threads_(&threads_of<E>), run_(&run<E>) {}

  int threads() const { return threads_(executor_); }
  /// As the executor's; it calls f(piece), or f(piece, thread) where f takes that.
  template <class F>
  void for_each(std::size_t n, F&& f) const {
    auto* const piece = std::addressof(f);
    const auto call = [](const void* work, std::size_t k, int thread) {
      call_piece(**static_cast<decltype(piece)*>(work), k, thread);
    };
    run_(executor_, n, call, &piece);
  }

 private:
  using Call = void (*)(const void* work, std::size_t piece, int thread);

  template <class E>
  static int threads_of(const void* executor) {
    return static_cast<E*>(const_cast<void*>(executor))->threads();
  }
  template <class E>
  static void run(const void* executor, std::size_t n, Call call, const void* work) {
    static_cast<E*>(const_cast<void*>(executor))->for_each(n, [=](std::size_t k, int thread) {
      call(work, k, thread);
    });
  }

  const void* executor_;
  int (*threads_)(const void*);
  void (*run_)(const void*, std::size_t, Call, const void*);
};

}  // namespace dem::exec
