#include "catch.hpp"
#include "worlds.hpp"

#include <random>
#include <utility>
#include <vector>

namespace {

using models::Balls;
using Pairs = std::vector<std::pair<std::size_t, std::uint32_t>>;

/// Balls at random places of a cube, twelve to one of 2 mm; the species take turns. `skin` in m; 0: chosen.
dem::World<Balls> balls(std::size_t n, const std::vector<dem::SpeciesOptions>& kinds, const std::vector<double>& radii,
                        double skin = 0.0) {
  dem::World<Balls> world({.skin = skin, .threads = 2});
  world.set_contact({.normal = {2000, 0.05, 1.0}, .friction = {0.4, 2000, 0.015, 0.975}});
  for (std::size_t k = 0; k < kinds.size(); ++k) world.add_species(dem::shape::Sphere(radii[k]), kinds[k]);
  std::mt19937 engine(static_cast<unsigned>(n));
  const double edge = 2e-3 * std::cbrt(static_cast<double>(n) / 12.0);
  std::uniform_real_distribution<double> place(-edge / 2, edge / 2);
  for (std::size_t k = 0; k < n; ++k) {
    world.add_grain({.species = dem::SpeciesId(static_cast<std::uint32_t>(k % kinds.size())),
                     .position = {place(engine), place(engine), place(engine)}});
  }
  world.prepare();
  return world;
}

/// The candidates as they are listed: row of the grain, row of the partner.
Pairs listed(const dem::World<Balls>& world) {
  Pairs pairs;
  const auto& w = world.state();
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    for (std::size_t k = 0; k < dem::chunk_size; ++k) {
      for (std::uint32_t m = w.chunks[c].candidate_first[k]; m < w.chunks[c].candidate_first[k + 1]; ++m) {
        pairs.emplace_back(c * dem::chunk_size + k, w.chunks[c].candidate[m]);
      }
    }
  }
  return pairs;
}
/// The same by trying all pairs.
Pairs expected(const dem::World<Balls>& world) {
  Pairs pairs;
  const auto& w = world.state();
  const auto& p = w.grains;
  for (std::size_t i = 0; i < p.count; ++i) {
    for (std::size_t j = i + 1; j < p.count; ++j) {
      const auto &a = w.species[p.species[i]], &b = w.species[p.species[j]];
      const double reach = a.shape.bounding_radius() + b.shape.bounding_radius() + w.materials.range() + w.list_skin;
      const dem::Vector3<double> d = p.position[j] - p.position[i];
      if (dot(d, d) < reach * reach && !(a.is_held() && b.is_held()))
        pairs.emplace_back(i, static_cast<std::uint32_t>(j));
    }
  }
  return pairs;
}

}  // namespace

// Numbers of grains about those of a pack and of a chunk: candidates are tried a pack at a time, and rows behind the
// last grain are none.
TEST_CASE("candidates are those within reach, in the order of rows") {
  for (const std::size_t n : {1, 2, 7, 8, 9, 15, 16, 17, 255, 256, 257, 600}) {
    CAPTURE(n);
    const auto one = balls(n, {{}}, {0.5e-3});
    CHECK(listed(one) == expected(one));
    const auto held = balls(n, {{.held = true}}, {0.5e-3});
    CHECK(listed(held).empty());
    const auto mixed = balls(n, {{}, {}, {.held = true}}, {0.5e-3, 0.3e-3, 0.4e-3});
    CHECK(listed(mixed) == expected(mixed));
    if (n == 600) CHECK(listed(one).size() > 1000);
    if (n == 600) CHECK(listed(mixed).size() > 300);
  }
  // More in a chunk than there was room for.
  const auto far = balls(600, {{}}, {0.5e-3}, 3e-3);
  CHECK(listed(far).size() > 10 * 4096);
  CHECK(listed(far) == expected(far));
}
