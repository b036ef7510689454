#include "world/scenes.hpp"

#include <dem/grain/broadphase/hierarchical_grid.hpp>
#include <dem/world/contacts.hpp>

#include <algorithm>
#include <set>

// Grains of 1 : 20 with a hierarchical grid: the contacts are those of brute force, and the bits are the same on any
// number of threads.

namespace {

using LevelledBalls = Grains<Sphere, dem::integrator::SymplecticEuler, dem::broadphase::HierarchicalGrid>;

/// Two balls of 10 mm fall into 600 of 0.5 mm and some of 2 mm.
template <class M>
dem::World<M> mixed_balls(int threads, double skin = 0.0) {
  dem::WorldOptions o = options({1, 0, -g}, 5e-6, skin);
  o.threads = threads;
  dem::World<M> w(o);
  w.set_contact(sand<M>());
  const auto small = w.add_species(Sphere(0.5e-3)), middle = w.add_species(Sphere(2e-3)),
             large = w.add_species(Sphere(10e-3));
  add_open_box(w, {0.025, 0.025, 0});
  add_block(w, small, {0.8e-3, 0.8e-3, 0.6e-3}, 1.06e-3, 20, 20, 3, 0.5, 1);
  add_block(w, middle, {3e-3, 3e-3, 6e-3}, 5e-3, 4, 4, 1, 0.5, 2);
  add_block(w, small, {0.8e-3, 0.8e-3, 9e-3}, 1.1e-3, 10, 10, 1, 0.5, 3);
  for (const double x : {0.0105, 0.0145}) {
    w.add_grain({large, Vec3(x, 0.0125, x < 0.012 ? 0.02 : 0.041), Vec3(0, 0, -0.5)});
  }
  return w;
}

using PairsInContact = std::set<std::pair<GrainId, GrainId>>;

/// Pairs of grains in contact, each with the lower id first: all are tried.
template <class World>
PairsInContact pairs_by_brute_force(const World& w) {
  PairsInContact pairs;
  const auto grains = w.grains();
  std::vector<double> radius;
  std::vector<Vec3> x;
  for (const GrainId p : grains) {
    radius.push_back(w.species(w.species_of(p)).shape.bounding_radius());
    x.push_back(w.position(p));
  }
  for (std::size_t a = 0; a < grains.size(); ++a) {
    for (std::size_t b = a + 1; b < grains.size(); ++b) {
      if ((x[a] - x[b]).norm() < radius[a] + radius[b]) pairs.insert({grains[a], grains[b]});
    }
  }
  return pairs;
}
template <class Model>
PairsInContact pairs_in_lists(const dem::World<Model>& w) {
  PairsInContact pairs;
  for (const auto& c : contacts_of(w)) {
    if (c.kind != dem::ContactKind::grains) continue;
    CHECK(pairs.insert(std::minmax(c.grain, c.other_grain)).second);
  }
  return pairs;
}

}  // namespace

TEST_CASE("the contacts of a mixture of 1 : 20 are those that brute force finds") {
  auto w = mixed_balls<LevelledBalls>(1);
  std::size_t most = 0, with_large = 0;
  for (int k = 0; k < 20; ++k) {
    REQUIRE(w.run(100));
    const PairsInContact expected = pairs_by_brute_force(w);
    CHECK(pairs_in_lists(w) == expected);
    most = std::max(most, expected.size());
    for (const auto& pair : expected) with_large += w.species_of(pair.second) == SpeciesId(2);
    CHECK(w.state().broad_phase.levels() >= 3);
  }
  CHECK(w.state().rebuilds > 10);
  CHECK(most > 100);
  CHECK(with_large > 20);
}

TEST_CASE("a mixture of 1 : 20 has the same bits on any number of threads") {
  auto one = mixed_balls<LevelledBalls>(1);
  REQUIRE(one.run(1000));
  for (const int threads : {2, 3}) {
    auto more = mixed_balls<LevelledBalls>(threads);
    REQUIRE(more.run(1000));
    CHECK(one.state().rebuilds == more.state().rebuilds);
    for_each_grain(one, [&](GrainId p) {
      REQUIRE(one.position(p) == more.position(p));
      REQUIRE(one.velocity(p) == more.velocity(p));
    });
  }
}

TEST_CASE("a few large grains do not widen the lists of the small ones") {
  // The skin is reckoned in mean radii. A tenth of the largest radius, 1 mm, would be twice a small radius: lists would
  // hold ((2 + 2)/(2 + 0.2))^3, six times the candidates.
  auto w = mixed_balls<LevelledBalls>(1);
  w.prepare();
  const double mean = (1300 * 0.5e-3 + 16 * 2e-3 + 2 * 10e-3) / 1318;
  CHECK(w.state().list_skin < 0.11 * mean);
  std::size_t candidates = 0;
  for (const auto& chunk : w.state().chunks) candidates += chunk.candidate.size();
  CHECK(static_cast<double>(candidates) < 6.0 * 1318);
}
