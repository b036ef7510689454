#pragma once

#include <dem/core/aligned.hpp>
#include <dem/parallel/kept.hpp>
#include <dem/parallel/threads.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dem::exec {

/// The step of GPUs on this processor: the kernels of <dem/flat/flat.hpp>, which a program includes to use it, as plain
/// loops that threads share. It is slower than Threads. It is there to test a model before it goes to a GPU.
///
/// What such an executor has besides for_each(), which runs work of the host on threads:
///   Array<T>        memory of the device: make_room(n), data(), upload(from, n), download(to, n);
///   Shared<T>       memory that both sides see: what kernels wrote there is seen after wait();
///   launch(name, n, kernel)                kernel(k) for k from 0 to n - 1;
///   reduce(name, n, kernel, result)        *result = all kernel(k), merged by their type's merge(a, b). The order is
///                                          left open, so merge() must be exact: largest numbers, counts;
///   scan(name, n, kernel, first, total)    first[k] = kernel(0) + ... + kernel(k - 1), for k from 0 to n, whole
///                                          numbers, and *total = first[n];
///   wait()                                 until all of it is done;
///   kept<T>(), holds_grains()              see Kept.
/// `name` says in a few words what is done.
class Flat : public Threads, public Kept {
 public:
  template <class T>
  class Array {
   public:
    /// Room for n. What it held is lost where it had less.
    void make_room(std::size_t n) {
      if (values_.size() < n) values_ = AlignedVector<T>(n + n / 4);
    }
    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    std::size_t bytes() const { return values_.size() * sizeof(T); }
    void upload(const T* from, std::size_t n) {
      make_room(n);
      std::copy_n(from, n, values_.begin());
    }
    /// To the place `at` on, in room that is there.
    void upload_to(std::size_t at, const T* from, std::size_t n) {
      std::copy_n(from, n, values_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    void download(T* to, std::size_t n, std::size_t at = 0) const {
      std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(at), n, to);
    }

   private:
    AlignedVector<T> values_;
  };
  template <class T>
  class Shared {
   public:
    void make_room(std::size_t n) {
      if (values_.size() < n) values_.resize(n);
    }
    T* data() { return values_.data(); }
    const T& operator[](std::size_t k) const { return values_[k]; }

   private:
    AlignedVector<T> values_;
  };

  template <class F>
  void launch(const char*, std::size_t n, const F& kernel) {
    for_each_piece(n, [&](std::size_t, std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) kernel(k);
    });
  }
  template <class F, class R>
  void reduce(const char*, std::size_t n, const F& kernel, R* result) {
    std::vector<R> partial(pieces(n));
    for_each_piece(n, [&](std::size_t piece, std::size_t first, std::size_t last) {
      R merged{};
      for (std::size_t k = first; k < last; ++k) merged = merge(merged, kernel(k));
      partial[piece] = merged;
    });
    *result = R{};
    for (const R& r : partial) *result = merge(*result, r);
  }
  template <class F>
  void scan(const char*, std::size_t n, const F& kernel, std::uint32_t* first, std::uint32_t* total) {
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      first[k] = sum;
      sum += kernel(k);
    }
    first[n] = *total = sum;
  }
  void wait() {}

 private:
  static constexpr std::size_t piece_size = 64;  // small, so that small tests have several

  static std::size_t pieces(std::size_t n) { return (n + piece_size - 1) / piece_size; }
  template <class F>
  void for_each_piece(std::size_t n, F&& f) {
    for_each(pieces(n), [&](std::size_t k) { f(k, k * piece_size, std::min((k + 1) * piece_size, n)); });
  }
};

}  // namespace dem::exec
