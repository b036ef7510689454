#include "scenes.hpp"

#include <dem/world/memory.hpp>

#include <memory>
#include <utility>

#if __has_include(<malloc.h>)
#include <malloc.h>
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

TEST_CASE("a settled cube of eight spheres takes less than 2000 bytes") {
  const auto w = settled_bed(10);
  std::size_t contacts = 0;
  for (const auto& chunk : w->state().chunks) contacts += static_cast<std::size_t>(chunk.pair_contacts.committed());
  CHECK(contacts > 3 * w->particle_count());
  const std::size_t bytes = dem::memory_bytes(w->state()) / w->particle_count();
  CAPTURE(bytes);
  CHECK(bytes < 2000);
}

#if defined(__GLIBC__) && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 33)
TEST_CASE("the memory that is told is what a world takes from the heap") {
  const auto heap = [] {
    const auto info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
  };
  if (heap() == 0.0) return;  // another allocator, as under sanitizers
  // What is freed with a world was the world's: scratch memory of the threads stays.
  const auto taken = [&](int n) {
    auto w = settled_bed(n);
    const double with = heap();
    const auto told = static_cast<double>(dem::memory_bytes(w->state()));
    w.reset();
    return std::pair(with - heap(), told);
  };
  const auto [machine, nothing] = taken(0);
  const auto [all, told] = taken(10);
  CHECK(nothing == 0.0);
  // The allocator's own book-keeping, up to 64 bytes for each of some 200 aligned blocks, is up to 1 %; partner
  // records, candidates, memories and state are several per cent each.
  const double of_grains = all - machine;
  CAPTURE(machine, of_grains, told);
  CHECK(told > 0.99 * of_grains);
  CHECK(told < of_grains);
}
#endif
#endif
