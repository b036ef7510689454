#include "scenes.hpp"

#include <dem/world/memory.hpp>

TEST_CASE("a settled cube of eight spheres takes less than 2000 bytes") {
  // Soft, so that steps are long: the bed has as many contacts and neighbours as a stiffer one.
  const double half_edge = 1.2e-3, pitch = 3.4e-3;
  dem::World<Cubes> w(options({0, 0, -g}));
  w.set_contact({{200.0, 0.02, 1.0}, {0.4, 200.0, 0.01, 0.975}});
  const auto cube = w.add_species(dem::shape::cube8(half_edge));
  add_open_box(w, {10.2 * pitch, 10.2 * pitch, 0});
  add_block(w, cube, Vec3::Constant(0.6 * pitch), pitch, 10, 10, 10, 0.1);
  REQUIRE(w.run_for(0.25));
  CHECK(kinetic_energy(w) < 1e-5 * total_mass(w) * g * half_edge);  // it is settled
  std::size_t contacts = 0;
  for (const auto& chunk : w.state().chunks) contacts += static_cast<std::size_t>(chunk.pair_contacts.committed());
  CHECK(contacts > 3 * w.particle_count());
  const std::size_t bytes = dem::memory_bytes(w.state()) / w.particle_count();
  CAPTURE(bytes);
  CHECK(bytes < 2000);
  CHECK(bytes > 408);  // the 51 numbers of pose, motion and forces, and nothing else
}
