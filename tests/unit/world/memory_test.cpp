#include "scenes.hpp"

#include <dem/world/memory.hpp>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

// The address sanitizer has its own allocation functions, beside which there can be no others.
#ifndef __SANITIZE_ADDRESS__

// Bytes that this program has asked for and not given back, as asked for: the allocator's own book-keeping left out.
static std::atomic<long> bytes_asked_for = 0;

static void* take(std::size_t size, std::size_t alignment) {
  const std::size_t room = std::max<std::size_t>(alignment, 16);  // before the block, for its size
  void* start = std::aligned_alloc(room, room + (size + room - 1) / room * room);
  if (start == nullptr) throw std::bad_alloc();
  *static_cast<std::size_t*>(start) = size;
  bytes_asked_for += static_cast<long>(size);
  return static_cast<char*>(start) + room;
}
static void give(void* block, std::size_t alignment) noexcept {
  if (block == nullptr) return;
  void* start = static_cast<char*>(block) - std::max<std::size_t>(alignment, 16);
  bytes_asked_for -= static_cast<long>(*static_cast<std::size_t*>(start));
  std::free(start);
}
void* operator new(std::size_t size) { return take(size, 16); }
void* operator new(std::size_t size, std::align_val_t a) { return take(size, static_cast<std::size_t>(a)); }
void operator delete(void* p) noexcept { give(p, 16); }
void operator delete(void* p, std::size_t) noexcept { give(p, 16); }
void operator delete(void* p, std::align_val_t a) noexcept { give(p, static_cast<std::size_t>(a)); }
void operator delete(void* p, std::size_t, std::align_val_t a) noexcept { give(p, static_cast<std::size_t>(a)); }

#endif

namespace {

/// An open box with grains in it, at rest: n each way. Soft, so that steps are long: there are as many contacts and
/// neighbours as in a stiffer bed.
std::unique_ptr<dem::World<Cubes>> settled_bed(int n) {
  const double half_edge = 1.2e-3, pitch = 3.4e-3;
  auto w = std::make_unique<dem::World<Cubes>>(options({0, 0, -g}));
  w->set_contact({{200.0, 0.02, 1.0}, {0.4, 200.0, 0.01, 0.975}});
  const auto cube = w->add_species(dem::shape::cube8(half_edge));
  add_open_box(*w, {10.2 * pitch, 10.2 * pitch, 0});
  add_block(*w, cube, Vec3::Constant(0.6 * pitch), pitch, n, n, n, 0.1);
  REQUIRE(w->run_for(0.25));
  CHECK(kinetic_energy(*w) <= 1e-5 * total_mass(*w) * g * half_edge);  // it is settled
  return w;
}

}  // namespace

TEST_CASE("a settled cube of eight spheres takes less than 2000 bytes", "[slow]") {
  const auto w = settled_bed(10);
  std::size_t contacts = 0;
  for (const auto& chunk : w->state().chunks) contacts += static_cast<std::size_t>(chunk.pair_contacts.committed());
  CHECK(contacts > 3 * w->grain_count());
  const std::size_t bytes = dem::memory_bytes(w->state()) / w->grain_count();
  CAPTURE(bytes);
  CHECK(bytes < 2000);
}

#ifndef __SANITIZE_ADDRESS__
TEST_CASE("the memory that is told is what grains take, to the byte") {
  // What is freed with a world was the world's, what its threads write down included.
  const auto taken = [&](int n) {
    auto w = settled_bed(n);
    const long with = bytes_asked_for;
    const auto told = static_cast<long>(dem::memory_bytes(w->state()));
    w.reset();
    return std::pair(with - bytes_asked_for, told);
  };
  const auto [machine, nothing] = taken(0);
  const auto [all, told] = taken(10);
  CHECK(told - nothing == all - machine);  // an empty world has its threads' empty lists
}
#endif
