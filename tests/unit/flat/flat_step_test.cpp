#include "flat_scenes.hpp"
#include "state_hash.hpp"

#include <dem/world/contacts.hpp>

namespace flat_step {

using flat_scenes::scene;

/// One step of the ordinary kind.
template <class Model>
void step_here(dem::World<Model>& w) {
  dem::advance(w.state());
}

/// Contacts, their histories and forces are those of another world, as far as rounding goes.
template <class Model>
void check_same_contacts(const dem::World<Model>& a, const dem::World<Model>& b) {
  REQUIRE(a.state().chunks.size() == b.state().chunks.size());
  double most = 0.0;  // of the numbers that are remembered
  std::size_t differ = 0;
  double difference = 0.0;
  const auto compare = [&](const auto& x, const auto& y) {
    REQUIRE(x.count == y.count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(x.count); ++k) {
      differ += x.key[k] != y.key[k] ? 1 : 0;
      for (std::size_t h = 0; h < x.history.size(); ++h) {
        most = std::max(most, std::abs(x.history[h][k]));
        const double d = std::abs(x.history[h][k] - y.history[h][k]);
        REQUIRE(std::isfinite(d));
        difference = std::max(difference, d);
      }
    }
  };
  for (std::size_t c = 0; c < a.state().chunks.size(); ++c) {
    const auto &x = a.state().chunks[c], &y = b.state().chunks[c];
    compare(x.pair_contacts.last, y.pair_contacts.last);
    compare(x.surface_contacts.last, y.surface_contacts.last);
    CHECK(x.deepest.overlap == Approx(y.deepest.overlap).epsilon(1e-12));
    CHECK(x.deepest.i == y.deepest.i);
    CHECK(x.deepest.partner == y.deepest.partner);
    CHECK(x.deepest.with_surface == y.deepest.with_surface);
    CHECK(x.moved2 == Approx(y.moved2).epsilon(1e-12));
  }
  CHECK(differ == 0);
  CHECK(most > 0.0);
  CHECK(difference <= 1e-12 * most);
}

// With wide packs, rows of two spheres are longer than two: the bits of a pair's contacts are not the lowest ones.
TEST_CASE("the bits of all contacts of a pair fit") {
  const auto fit = []<int N>(dem::shape::SphereCluster<N>*) {
    using Cluster = dem::shape::SphereCluster<N>;
    const std::size_t last = (N - 1) * Cluster::stride + N - 1;
    CHECK(last < 8 * sizeof(dem::flat::ContactBits<Cluster>));
  };
  fit(static_cast<dem::shape::SphereCluster<2>*>(nullptr));
  fit(static_cast<dem::shape::SphereCluster<3>*>(nullptr));
  fit(static_cast<dem::shape::SphereCluster<8>*>(nullptr));
}

TEMPLATE_TEST_CASE("a step on the flat path is the ordinary step", "", flat_scenes::Balls, flat_scenes::Cubes,
                   flat_scenes::WetBalls) {
  auto flat = scene<TestType>();
  std::size_t contacts = 0;
  for (int k = 0; k < 12; ++k) {
    REQUIRE(flat.run(k == 0 ? 4000 : 100));
    auto here = flat;
    REQUIRE(flat.step());
    step_here(here);
    double force = 0.0, torque = 0.0;  // the largest
    for_each_grain(here, [&](GrainId p) {
      force = std::max(force, here.force(p).norm());
      torque = std::max(torque, here.torque(p).norm());
    });
    for_each_grain(here, [&](GrainId p) {
      REQUIRE((flat.force(p) - here.force(p)).norm() <= 1e-12 * force);
      REQUIRE((flat.torque(p) - here.torque(p)).norm() <= 1e-12 * torque);
      REQUIRE((flat.position(p) - here.position(p)).norm() <= 1e-16);
      REQUIRE((flat.velocity(p) - here.velocity(p)).norm() <= 1e-13);
      REQUIRE((flat.rotation(p) - here.rotation(p)).norm() <= 1e-13);
    });
    for (std::size_t s = 0; s < here.state().surfaces.size(); ++s) {
      const SurfaceId id(s);
      REQUIRE((flat.surface_force(id) - here.surface_force(id)).norm() <= 1e-12 * force);
      REQUIRE((flat.surface_torque(id) - here.surface_torque(id)).norm() <= 1e-12 * force);
    }
    check_same_contacts(flat, here);
    contacts = dem::contacts_of(flat).size();
  }
  CHECK(contacts > flat.grain_count());
  CHECK(flat.state().rebuilds > 3);
  CHECK(flat.steps() == 4000 + 11 * 100 + 12);
  CHECK(flat.time() == Approx(8e-6 * 5112));
}

TEMPLATE_TEST_CASE("contacts go on when neighbours are listed anew on the flat path", "", flat_scenes::Balls,
                   flat_scenes::Cubes) {
  auto flat = scene<TestType>(2e-4);  // a narrow skin, which asks for many lists
  REQUIRE(flat.run(2000));
  auto here = flat;
  const std::uint64_t lists = flat.state().rebuilds;
  REQUIRE(flat.run(100));
  for (int k = 0; k < 100; ++k) step_here(here);
  CHECK(flat.state().rebuilds > lists + 1);
  CHECK(flat.state().rebuilds == here.state().rebuilds);
  for_each_grain(here, [&](GrainId p) {
    REQUIRE((flat.position(p) - here.position(p)).norm() <= 1e-9 * 1e-3);
    REQUIRE((flat.velocity(p) - here.velocity(p)).norm() <= 1e-8);
  });
}

TEMPLATE_TEST_CASE("a run on the flat path has the same bits twice, on any number of threads", "", flat_scenes::Balls,
                   flat_scenes::Cubes) {
  auto once = scene<TestType>(), again = scene<TestType>(), on_two = scene<TestType>(0.0, 2);
  REQUIRE(once.run(700));
  REQUIRE(again.run(700));
  REQUIRE(on_two.run(700));
  CHECK(hash_of(once) == hash_of(again));
  CHECK(hash_of(once) == hash_of(on_two));
}

TEST_CASE("a bed that settles on the flat path is as high as another, and weighs what it weighs") {
  auto flat = scene<flat_scenes::Balls>(), here = flat;
  REQUIRE(flat.run(10000));
  here.prepare();
  for (int k = 0; k < 10000; ++k) step_here(here);
  const auto mean_height = [](const auto& w) {
    double sum = 0.0;
    for_each_grain(w, [&](GrainId p) { sum += w.position(p).z(); });
    return sum / static_cast<double>(w.grain_count());
  };
  CHECK(mean_height(flat) == Approx(mean_height(here)).epsilon(0.03));
  Vec3 force = Vec3::Zero();  // mean of the grains on what stands
  constexpr int samples = 200;
  for (int k = 0; k < samples; ++k) {
    REQUIRE(flat.run(10));
    for (std::size_t s = 0; s < 7; ++s) force += flat.surface_force(SurfaceId(s)) / samples;
  }
  const Vec3 weight = (total_mass(flat) + 5e-3) * flat.state().options.gravity;
  CHECK((force - weight).norm() < 0.05 * weight.norm());
}

TEST_CASE("problems are reported on the flat path as they are else") {
  using Problem = dem::StepReport::Problem;
  dem::WorldOptions o = options({0, 0, 0}, 2e-5);
  o.domain = dem::surface::Aabb{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  const auto make = [&](const Vec3& velocity) {
    dem::World<flat_scenes::Balls> w(o);
    w.set_contact(flat_scenes::Balls::contact());
    const auto kind = w.add_species(Sphere(1e-3));
    for (int k = 0; k < 300; ++k) w.add_grain({.species = kind, .position = {-0.9 + 0.005 * k, 0, -0.7}});
    const GrainId flier = w.add_grain({.species = kind, .position = {0, 0.5, 0}, .velocity = velocity});
    return std::pair(std::move(w), flier);
  };
  SECTION("a grain that leaves the domain is told of once") {
    auto [w, flier] = make({0, 100, 0});
    const auto report = w.run(1000);
    CHECK(report.problem == Problem::lost);
    CHECK(report.grain == flier);
    CHECK(report.time == Approx(0.005).epsilon(0.01));
    CHECK(report.step == w.steps());
    REQUIRE(w.run(50));
    CHECK(w.steps() == report.step + 50);
    w.set_velocity(GrainId(7), {0, 0, -200});
    CHECK(w.run(1000).grain == GrainId(7));
  }
  SECTION("a grain that is pressed too deep into another is named") {
    auto [w, flier] = make({0, 0, 0});
    w.add_grain({.species = SpeciesId(0), .position = {0, 0.5 + 1.9e-3, 0}, .velocity = {0, -60, 0}});
    const auto report = w.run(1000);
    CHECK(report.problem == Problem::overlap);
    CHECK((report.grain == flier || report.grain == GrainId(301)));
    CHECK_THAT(report.text, Catch::Matchers::ContainsSubstring("overlap_limit"));
  }
  SECTION("a grain that is pressed too deep into a surface is named") {
    auto [w, flier] = make({0, 60, 0});
    w.add_surface(w.ground(), dem::surface::Box({0.01, 0.01, 0.01}), {.name = "block", .position = {0, 0.51, 0}});
    const auto report = w.run(1000);
    CHECK(report.problem == Problem::overlap);
    CHECK(report.grain == flier);
    CHECK_THAT(report.text, Catch::Matchers::ContainsSubstring("'block'"));
  }
  SECTION("numbers that are none are found") {
    auto [w, flier] = make({0, 0, 0});
    REQUIRE(w.run(3));
    w.state().grains.velocity.y[w.state().grains.row_of[flier.value]] = std::nan("");
    const auto report = w.run(10);
    CHECK(report.problem == Problem::not_finite);
    CHECK(report.grain == flier);
  }
}

}  // namespace flat_step
