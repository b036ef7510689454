#include "core/error_of.hpp"
#include "scenes.hpp"

#include <array>

using Catch::Approx;

TEST_CASE("grains of different size, shape and material share a world", "[slow]") {
  using Cluster = dem::shape::SphereCluster<8>;
  using Model = Grains<Cluster>;
  dem::World<Model> w(options({0, 0, -9.81}, 2e-6));
  w.set_contact({{2000.0, 0.1, 1.0}, {0.4, 2000.0, 0.1, 0.975}});  // well damped, to be at rest soon
  const std::array<dem::Ball, 2> dumbbell = {{{{-1e-3, 0, 0}, 1e-3}, {{1e-3, 0, 0}, 1e-3}}};
  const std::array<dem::Ball, 1> ball = {{{{0, 0, 0}, 2e-3}}};
  const std::array<SpeciesId, 3> species = {w.add_species(dem::shape::cube8(1.5e-3)),
                                            w.add_species(Cluster(dumbbell), {"grain", 1000.0}),
                                            w.add_species(Cluster(ball), {"grain", 7800.0})};
  const auto plate = w.add_surface(w.ground(), dem::surface::Plane{});
  double weight = 0.0;
  for (int k = 0; k < 9; ++k) {
    dem::NewGrain n;
    n.species = species[static_cast<std::size_t>(k % 3)];
    n.position = {6e-3 * k, 0, 2.1e-3};
    const auto p = w.add_grain(n);
    CHECK(w.species_of(p) == n.species);
    weight += 9.81 * mass_of(w, p);
  }
  CHECK(w.species(species[0]).mass == Approx(2650 * std::pow(3e-3, 3)));
  CHECK(w.species(species[1]).mass == Approx(1000 * 2 * 4.0 / 3 * M_PI * 1e-9).epsilon(1e-14));  // balls that touch
  CHECK(w.species(species[2]).mass == Approx(7800 * 4.0 / 3 * M_PI * 8e-9).epsilon(1e-14));
  REQUIRE(w.run_for(0.6));
  // Each lies at its own height, less an overlap of micrometres at the most, and all their weight is on the plate.
  const double height[] = {1.5e-3, 1e-3, 2e-3};
  for_each_grain(w, [&](GrainId p) { CHECK(w.position(p).z() == Approx(height[p.index() % 3]).margin(2e-6)); });
  CHECK(-w.surface_force(plate).z() == Approx(weight).epsilon(1e-6));
}

TEST_CASE("each pair of materials has its own friction") {
  // Grains slide on a level plate: ice on steel far, rubber not.
  dem::World<Balls> w(options({0, 0, -9.81}, 5e-6));
  const auto pair = [](double mu) {
    return dem::ContactParameters<Balls>{{2000.0, 0.015, 1.0}, {mu, 2000.0, 0.1, 1.0}};
  };
  w.set_contact("ice", "steel", pair(0.02));
  w.set_contact("rubber", "steel", pair(0.8));
  w.set_contact("ice", "ice", pair(0.1));
  w.set_contact("rubber", "rubber", pair(0.1));
  w.set_contact("rubber", "ice", pair(0.1));
  const auto ice = w.add_species(Sphere(1e-3), {"ice", 2000.0}),
             rubber = w.add_species(Sphere(1e-3), {"rubber", 2000.0});
  dem::SurfaceOptions o;
  o.material = "steel";
  w.add_surface(w.ground(), dem::surface::Plane{}, o);
  const double rest = 1e-3 - w.species(ice).mass * 9.81 / 2000.0;
  std::vector<GrainId> grains;
  for (const auto s : {ice, rubber}) {
    dem::NewGrain n;
    n.species = s;
    n.position = {0, s == ice ? 0.0 : 0.01, rest};
    n.velocity = {0.5, 0, 0};
    grains.push_back(w.add_grain(n));
  }
  REQUIRE(w.run_for(0.01));
  // Sliding: v0 - mu g t. Both still slide: rolling begins at 2 v0/(7 mu g) = 0.018 s for rubber.
  CHECK(w.velocity(grains[0]).x() == Approx(0.5 - 0.02 * 9.81 * 0.01).epsilon(1e-4));
  CHECK(w.velocity(grains[1]).x() == Approx(0.5 - 0.8 * 9.81 * 0.01).epsilon(1e-4));
}

TEST_CASE("a pair of grains of two materials answers the same whichever came first") {
  // Storage order decides who is i and who is j.
  for (const bool swapped : {false, true}) {
    dem::World<Balls> w(options({0, 0, 0}, 1e-6));
    w.set_contact("a", "b", {{1000.0, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
    w.set_contact("a", "a", {{1e5, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
    w.set_contact("b", "b", {{1e6, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
    const auto sa = w.add_species(Sphere(1e-3), {"a", 1000.0}), sb = w.add_species(Sphere(2e-3), {"b", 1000.0});
    dem::NewGrain left, right;
    left.species = swapped ? sb : sa;
    right.species = swapped ? sa : sb;
    right.position = {2.9e-3, 0, 0};
    w.add_grain(left);
    const auto p = w.add_grain(right);
    REQUIRE(w.step());
    CHECK(w.force(p).x() == Approx(1000.0 * 1e-4).epsilon(1e-9));
  }
}

TEST_CASE("many pairs of materials at once fill the same packs of contacts") {
  // Sixteen pairs of balls side by side, all with the same overlap, each pair of another stiffness.
  dem::World<Balls> w(options({0, 0, 0}, 1e-6));
  w.set_contact({{1.0, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
  std::vector<GrainId> second;
  for (int k = 0; k < 16; ++k) {
    const std::string name = fmt::format("m{}", k);
    w.set_contact(name, name, {{1000.0 + k, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
    dem::NewGrain n;
    n.species = w.add_species(Sphere(1e-3), {name, 1000.0});
    n.position = {0, 5e-3 * k, 0};
    w.add_grain(n);
    n.position.x() = 1.99e-3;
    second.push_back(w.add_grain(n));
  }
  REQUIRE(w.step());
  for (int k = 0; k < 16; ++k) {
    CHECK(w.force(second[static_cast<std::size_t>(k)]).x() == Approx((1000.0 + k) * 1e-5).epsilon(1e-9));
  }
}

TEST_CASE("a ball that is put in turned keeps the spin it was given") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Balls>());
  dem::NewGrain n;
  n.species = w.add_species(Sphere(1e-3));
  n.rotation = Random(4).rotation();
  n.angular_velocity = {1, 2, 3};
  n.velocity = {3, 2, 1};
  const auto p = w.add_grain(n);
  REQUIRE(w.run(100));
  CHECK((w.angular_velocity(p) - n.angular_velocity).norm() < 1e-13);  // 100 products of rotations
  CHECK((w.velocity(p) - n.velocity).norm() == 0.0);
}

namespace {

/// Grains that fly about, touch each other and come down on a plate, with friction.
template <class Model>
dem::World<Model> grains_on_a_plate(const typename Model::Shape& shape, double weight) {
  dem::World<Model> w(options({0, 0, -weight}, 1e-5));
  w.set_contact(sand<Model>());
  w.add_surface(w.ground(), dem::surface::Plane{});
  add_block(w, w.add_species(shape), {0, 0, 1.8e-3}, 2.6e-3, 4, 4, 3, 0.3);
  return w;
}

/// Whether the grains of two worlds are where they are, and move as they move, to the last bit.
template <class World>
bool same_bits(const World& a, const World& b) {
  bool same = a.grain_count() == b.grain_count();
  for_each_grain(a, [&](GrainId p) {
    same = same && a.position(p) == b.position(p) && a.rotation(p) == b.rotation(p) && a.velocity(p) == b.velocity(p) &&
           a.angular_velocity(p) == b.angular_velocity(p) && a.force(p) == b.force(p) && a.torque(p) == b.torque(p);
  });
  return same;
}

}  // namespace

TEST_CASE("two worlds in one program do not know of each other") {
  // Two of one model, which share the scratch memory of a thread, and one of another between them, step in turn: each
  // comes to what it comes to alone.
  const auto cube = dem::shape::cube8(1e-3);
  auto earth = grains_on_a_plate<Cubes>(cube, 9.81), earth_alone = grains_on_a_plate<Cubes>(cube, 9.81);
  auto moon = grains_on_a_plate<Cubes>(cube, 1.62), moon_alone = grains_on_a_plate<Cubes>(cube, 1.62);
  auto balls = grains_on_a_plate<Balls>(Sphere(1e-3), 9.81), balls_alone = grains_on_a_plate<Balls>(Sphere(1e-3), 9.81);
  const long steps = 4000;  // 40 ms: grains above fall 8 mm, onto those that lie on the plate already
  long touched = 0;
  for (long k = 0; k < steps; ++k) {
    REQUIRE(earth.step());
    REQUIRE(balls.step());
    REQUIRE(moon.step());
    for_each_grain(earth, [&](GrainId p) { touched += earth.torque(p).norm() > 0.0; });
  }
  REQUIRE(earth_alone.run(steps));
  REQUIRE(balls_alone.run(steps));
  REQUIRE(moon_alone.run(steps));
  CHECK(same_bits(earth, earth_alone));
  CHECK(same_bits(balls, balls_alone));
  CHECK(same_bits(moon, moon_alone));
  CHECK(!same_bits(earth, moon));
  CHECK(touched > 20 * 48);  // grains times steps, as only contacts turn a grain: twenty steps each
}

TEST_CASE("grains may be added during a run", "[slow]") {
  dem::World<Cubes> w(options({0, 0, -9.81}, 1e-5));
  w.set_contact(sand<Cubes>());
  const auto cube = w.add_species(dem::shape::cube8(1e-3));
  const auto plate = w.add_surface(w.ground(), dem::surface::Plane{});
  for (int k = 0; k < 300; ++k) {  // across the size of a chunk
    dem::NewGrain n;
    n.species = cube;
    n.position = {2.5e-3 * (k % 10), 2.5e-3 * (k / 10), 1e-3};
    CHECK(w.add_grain(n).index() == static_cast<std::size_t>(k));
    REQUIRE(w.run(3));
  }
  CHECK(w.grain_count() == 300);
  REQUIRE(w.run_for(0.1));
  for_each_grain(w, [&](GrainId p) {
    CHECK(w.position(p).x() == Approx(2.5e-3 * static_cast<double>(p.index() % 10)).margin(1e-7));
  });
  CHECK(-w.surface_force(plate).z() == Approx(total_mass(w) * 9.81).epsilon(1e-3));
}

TEST_CASE("a grain that is added leaves the others as they were, to the bit, and falls by its weight") {
  // A tower of three that slides, so that contact histories and what integrators remember count.
  enum How { alone, added_between, added_within };  // runs
  const auto run = []<class Model>(Model, How how) {
    dem::World<Model> w(options({0, 0, -g}, 1e-5, 1e-4));
    w.set_contact(sand<Model>());
    const auto ball = w.add_species(Sphere(1e-3));
    w.add_surface(w.ground(), dem::surface::Plane{});
    for (int k = 0; k < 3; ++k) w.add_grain({ball, {0.1e-3 * k, 0, 1e-3 + 1.998e-3 * k}, {0.05, 0, 0}});
    REQUIRE(w.run(501));
    if (how == added_within) {
      GrainId added;
      REQUIRE(w.run(400, [&, k = 0]() mutable {
        if (++k == 200) added = w.add_grain({ball, {0.02, 0, 0.05}});
        return true;
      }));
      CHECK(w.velocity(added).z() == Approx(-g * 200e-5).epsilon(1e-12));
    } else if (how == added_between) {
      const GrainId added = w.add_grain({ball, {0.02, 0, 0.05}});
      REQUIRE(w.run(400));
      CHECK(w.velocity(added).z() == Approx(-g * 400e-5).epsilon(1e-12));
      // The schemes differ by a step's fall, which is g dt^2 a step.
      CHECK(w.position(added).z() - 0.05 == Approx(-0.5 * g * 16e-6).epsilon(1.0 / 399));
    } else {
      REQUIRE(w.run(400));
    }
    std::vector<Vec3> motion;
    for (const GrainId p : w.grains()) motion.insert(motion.end(), {w.position(p), w.velocity(p), w.force(p)});
    motion.resize(9);
    return motion;
  };
  const auto check = [&](auto model) {
    CHECK(run(model, added_between) == run(model, alone));
    CHECK(run(model, added_within) == run(model, alone));
  };
  check(models::VerletBalls{});
  check(models::CorrectedBalls{});
  check(models::Balls{});
}
