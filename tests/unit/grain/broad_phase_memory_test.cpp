#include "catch.hpp"

#include <dem/grain/broadphase/uniform_grid.hpp>

#include <malloc.h>

#include <cstdlib>
#include <new>
#include <random>

// The sanitizers have allocators of their own, which must not be mixed with these.
#if !defined(DEM_SANITIZED)

// Counts what this program holds on the heap.
namespace {
std::size_t held = 0, most = 0;

void* take(std::size_t size, std::size_t alignment) {
  void* p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (p == nullptr) throw std::bad_alloc();
  held += malloc_usable_size(p);
  most = std::max(most, held);
  return p;
}
void release(void* p) {
  if (p != nullptr) held -= malloc_usable_size(p);
  std::free(p);
}
}  // namespace

void* operator new(std::size_t size) { return take(size, 16); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return take(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete(void* p, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { release(p); }

namespace {

/// The most bytes that building a grid of n grains over a cube of this size takes.
std::size_t bytes_to_build(std::size_t n, double half) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> d(-half, half);
  std::vector<double> x(n), y(n), z(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = d(engine), y[i] = d(engine), z[i] = d(engine);
  const std::size_t before = held;
  most = held;
  dem::broadphase::UniformGrid grid;
  grid.build({x.data(), y.data(), z.data(), n}, 1.0);
  return most - before;
}

}  // namespace

TEST_CASE("the grid's memory follows the number of grains, not the size of the domain") {
  const std::size_t n = 1000;
  const std::size_t dense = bytes_to_build(n, 5.0), sparse = bytes_to_build(n, 1e6), vast = bytes_to_build(n, 1e12);
  REQUIRE(dense > n * sizeof(std::uint32_t));
  // Grains that are alone in their cell need a cell each: some tens of bytes more. A grid over 1e18 cells would not
  // fit.
  CHECK(sparse < 300 * n);
  CHECK(vast < 300 * n);
  CHECK(dense < 300 * n);
  // Ten times the grains, ten times the memory (vectors and tables grow by powers of two).
  CHECK(bytes_to_build(10 * n, 1e6) < 25 * sparse);
}

#endif
