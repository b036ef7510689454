#pragma once

// Memory of a GPU, and memory that it shares with the host. Seen by nvcc alone.

#if defined(__CUDACC__)

#include <dem/core/error.hpp>

#include <cuda_runtime.h>

#include <cstddef>
#include <utility>

namespace dem::cuda {

/// Throws Error unless all is well; `what`: what was done, in a few words.
inline void check(cudaError_t error, const char* what) {
  if (error == cudaSuccess) return;
  static_cast<void>(cudaGetLastError());  // it is told now, and not by the next call as well
  if (error == cudaErrorNoDevice || error == cudaErrorInsufficientDriver) {
    fail("exec::Cuda found no GPU that it could use ({}); choose exec::Threads in the model, or run where one is",
         cudaGetErrorString(error));
  }
  if (error == cudaErrorMemoryAllocation) {
    fail("the memory of the GPU does not suffice ({}); take fewer grains or a smaller skin", what);
  }
  fail("the GPU reports '{}' ({})", cudaGetErrorString(error), what);
}

/// Memory of the GPU. A copy holds nothing.
template <class T>
class Array {
 public:
  Array() = default;
  Array(const Array&) {}
  Array& operator=(const Array&) { return *this; }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Array() { cudaFree(values_); }

  /// Room for n. What it held is lost where it had less.
  void make_room(std::size_t n) {
    if (n <= room_) return;
    check(cudaFree(values_), "memory is freed");
    values_ = nullptr;
    room_ = 0;
    const std::size_t more = n + n / 4;
    check(cudaMalloc(&values_, more * sizeof(T)), "memory is taken");
    room_ = more;
  }
  T* data() { return values_; }
  const T* data() const { return values_; }
  std::size_t bytes() const { return room_ * sizeof(T); }
  void upload(const T* from, std::size_t n) {
    make_room(n);
    upload_to(0, from, n);
  }
  /// To the place `at` on, in room that is there. `from` may be changed when it returns.
  void upload_to(std::size_t at, const T* from, std::size_t n) {
    if (n > 0) check(cudaMemcpy(values_ + at, from, n * sizeof(T), cudaMemcpyHostToDevice), "copied to the GPU");
  }
  void download(T* to, std::size_t n, std::size_t at = 0) const {
    if (n > 0) check(cudaMemcpy(to, values_ + at, n * sizeof(T), cudaMemcpyDeviceToHost), "copied from the GPU");
  }

 private:
  void swap(Array& other) noexcept {
    std::swap(values_, other.values_);
    std::swap(room_, other.room_);
  }

  T* values_ = nullptr;
  std::size_t room_ = 0;
};

/// Memory of the host that the GPU writes to: for the few numbers that each step tells. A copy holds nothing.
template <class T>
class Shared {
 public:
  Shared() = default;
  Shared(const Shared&) {}
  Shared& operator=(const Shared&) { return *this; }
  Shared(Shared&& other) noexcept { swap(other); }
  Shared& operator=(Shared&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Shared() { cudaFreeHost(values_); }

  void make_room(std::size_t n) {
    if (n <= room_) return;
    check(cudaFreeHost(values_), "memory is freed");
    values_ = nullptr;
    room_ = 0;
    check(cudaHostAlloc(&values_, n * sizeof(T), cudaHostAllocMapped), "memory is shared");
    room_ = n;
  }
  /// As both sides know it.
  T* data() { return values_; }
  const T& operator[](std::size_t k) const { return values_[k]; }

 private:
  void swap(Shared& other) noexcept {
    std::swap(values_, other.values_);
    std::swap(room_, other.room_);
  }

  T* values_ = nullptr;
  std::size_t room_ = 0;
};

}  // namespace dem::cuda

#endif
