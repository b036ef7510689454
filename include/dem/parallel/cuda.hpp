#pragma once

#if defined(__CUDACC__)
#include <dem/parallel/cuda_memory.hpp>
#include <dem/parallel/cuda_profile.hpp>
#include <dem/parallel/kept.hpp>
#include <dem/parallel/threads.hpp>

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <cub/device/device_scan.cuh>
#endif

#include <cstddef>
#include <cstdint>

namespace dem::exec {

#if defined(__CUDACC__)

namespace cuda_detail {

inline constexpr unsigned threads_of_a_block = 128;

template <class F>
__global__ void __launch_bounds__(threads_of_a_block) run(std::size_t n, const F kernel) {
  const std::size_t k = std::size_t{blockIdx.x} * threads_of_a_block + threadIdx.x;
  if (k < n) kernel(k);
}

/// The merged values of a block's threads, in its first thread.
template <class R, unsigned Threads>
__device__ R merge_block(R mine) {
  __shared__ alignas(R) unsigned char memory[Threads * sizeof(R)];  // an array of R would have to be constructed
  R* const values = reinterpret_cast<R*>(memory);
  values[threadIdx.x] = mine;
  for (unsigned half = Threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) values[threadIdx.x] = merge(values[threadIdx.x], values[threadIdx.x + half]);
  }
  return values[0];
}

template <class F, class R>
__global__ void __launch_bounds__(threads_of_a_block) reduce_blocks(std::size_t n, const F kernel, R* of_blocks) {
  const std::size_t k = std::size_t{blockIdx.x} * threads_of_a_block + threadIdx.x;
  const R merged = merge_block<R, threads_of_a_block>(k < n ? kernel(k) : R{});
  if (threadIdx.x == 0) of_blocks[blockIdx.x] = merged;
}

inline constexpr unsigned threads_of_the_last_block = 256;

template <class R>
__global__ void __launch_bounds__(threads_of_the_last_block) reduce_last(std::size_t n, const R* of_blocks, R* result) {
  R mine{};
  for (std::size_t k = threadIdx.x; k < n; k += threads_of_the_last_block) mine = merge(mine, of_blocks[k]);
  mine = merge_block<R, threads_of_the_last_block>(mine);
  if (threadIdx.x == 0) *result = mine;
}

/// A kernel that counts, with 0 behind its last number, as a sum over all before it needs one place more.
template <class F>
struct CountsThenNone {
  F kernel;
  std::size_t n;
  __host__ __device__ std::uint32_t operator()(std::size_t k) const { return k < n ? kernel(k) : 0u; }
};

template <class T>
__global__ void copy_one(const T* from, T* to) {
  *to = *from;
}

}  // namespace cuda_detail

/// One GPU: that which is current when a world first runs. The grains' part of a step runs there, the machine's and the
/// making of neighbour lists here, on threads. A program includes <dem/flat/cuda.hpp>, and nvcc compiles it. No sum
/// depends on the order in which threads come, so a run gives the same bits twice. See exec::Flat for what it has.
class Cuda : public Threads, public Kept {
 public:
  /// On an H100 with 300,000 grains a list took as long as looks at 4,700 candidates a grain (cubes) or 8,500
  /// (spheres), which the choice of skins counts as 150 and 130.
  static constexpr double list_weight = 40.0;
  template <class T>
  using Array = cuda::Array<T>;
  template <class T>
  using Shared = cuda::Shared<T>;

  /// How many GPUs there are; 0 without a driver, too.
  static int devices() {
    int count = 0;
    if (cudaGetDeviceCount(&count) == cudaSuccess) return count;
    static_cast<void>(cudaGetLastError());
    return 0;
  }

  template <class F>
  void launch(const char* name, std::size_t n, const F& kernel) {
    if (n == 0) return;
    const auto timed = profile_.time(name);
    cuda_detail::run<<<blocks(n), cuda_detail::threads_of_a_block>>>(n, kernel);
    cuda::check(cudaGetLastError(), name);
  }
  template <class F, class R>
  void reduce(const char* name, std::size_t n, const F& kernel, R* result) {
    const auto timed = profile_.time(name);
    const unsigned count = n == 0 ? 0 : blocks(n);
    of_blocks_.make_room(count * sizeof(R));
    R* const of_blocks = reinterpret_cast<R*>(of_blocks_.data());
    if (count > 0) {
      cuda_detail::reduce_blocks<<<count, cuda_detail::threads_of_a_block>>>(n, kernel, of_blocks);
      cuda::check(cudaGetLastError(), name);
    }
    cuda_detail::reduce_last<<<1, cuda_detail::threads_of_the_last_block>>>(std::size_t{count}, of_blocks, result);
    cuda::check(cudaGetLastError(), name);
  }
  template <class F>
  void scan(const char* name, std::size_t n, const F& kernel, std::uint32_t* first, std::uint32_t* total) {
    const auto timed = profile_.time(name);
    const auto counts = thrust::make_transform_iterator(thrust::make_counting_iterator(std::size_t{0}),
                                                        cuda_detail::CountsThenNone<F>{kernel, n});
    std::size_t bytes = 0;
    cuda::check(cub::DeviceScan::ExclusiveSum(nullptr, bytes, counts, first, n + 1), name);
    of_scan_.make_room(bytes);
    cuda::check(cub::DeviceScan::ExclusiveSum(of_scan_.data(), bytes, counts, first, n + 1), name);
    cuda_detail::copy_one<<<1, 1>>>(first + n, total);
    cuda::check(cudaGetLastError(), name);
  }
  void wait() {
    cuda::check(cudaStreamSynchronize(nullptr), "a step");
    profile_.collect();
  }

  /// Where the time on the GPU goes, once it is switched on.
  cuda::Profile& profile() { return profile_; }

 private:
  static unsigned blocks(std::size_t n) {
    return static_cast<unsigned>((n + cuda_detail::threads_of_a_block - 1) / cuda_detail::threads_of_a_block);
  }

  Array<std::byte> of_blocks_, of_scan_;
  cuda::Profile profile_;
};

#else

/// One GPU: <dem/flat/cuda.hpp>, for sources that nvcc compiles.
struct Cuda {
  static constexpr bool needs_nvcc = true;
};

#endif

}  // namespace dem::exec
