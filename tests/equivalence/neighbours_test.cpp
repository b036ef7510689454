#include "world/scenes.hpp"

// Neighbour lists, re-sorting and the histories of contacts, seen through worlds.

using Catch::Approx;

namespace {

/// Grains of three sizes, poured with some wind into a box.
template <class Model>
void pour(dem::World<Model>& w) {
  w.set_contact(sand<Model>());
  SpeciesId species[3];
  for (int k = 0; k < 3; ++k) {
    const double size = 0.8e-3 + 0.4e-3 * k;
    if constexpr (std::is_same_v<typename Model::Shape, Sphere>) {
      species[k] = w.add_species(Sphere(size));
    } else {
      species[k] = w.add_species(dem::shape::cube8(size));
    }
  }
  add_open_box(w, {0.018, 0.018, 0});
  for (int k = 0; k < 3; ++k) {
    add_block(w, species[k], {2.9e-3, 2.9e-3, 2.9e-3 + 8.8e-3 * k}, 4.4e-3, 4, 4, 2, 1.0, static_cast<unsigned>(k));
  }
}

template <class A, class B>
double distance(const A& a, const B& b) {
  double worst = 0.0;
  for_each_grain(a, [&](GrainId p) { worst = std::max(worst, (a.position(p) - b.position(p)).norm()); });
  return worst;
}

template <class World>
std::size_t in_contact(const World& w) {
  std::size_t n = 0;
  for_each_grain(w, [&](GrainId p) { n += w.force(p).norm() > 0.0; });
  return n;
}

template <class S>
using Gridded = Grains<S, dem::integrator::SymplecticEuler, dem::broadphase::UniformGrid>;
template <class S>
using Paired = Grains<S, dem::integrator::SymplecticEuler, dem::broadphase::AllPairs>;

}  // namespace

TEMPLATE_TEST_CASE("a world with a grid moves like one that tries all pairs", "", Sphere, Cube8) {
  // The grid sorts grains in space, so forces add up in another order: rounding, which collisions amplify about tenfold
  // each. 1,500 steps are a handful of collisions for each grain.
  dem::World<Gridded<TestType>> grid(options({1, 0, -9.81}, 1e-5));
  dem::World<Paired<TestType>> pairs(options({1, 0, -9.81}, 1e-5));
  pour(grid);
  pour(pairs);
  std::size_t touching = 0;
  for (int k = 0; k < 15; ++k) {
    REQUIRE(grid.run(100));
    REQUIRE(pairs.run(100));
    touching += in_contact(grid);
    CHECK(in_contact(grid) == in_contact(pairs));
  }
  CHECK(touching > 50);
  CHECK(grid.state().rebuilds > 5);
  CHECK(distance(grid, pairs) < 1e-8 * 1e-3);
}

TEST_CASE("the skin does not change what happens") {
  // A thin skin makes lists anew at nearly every step, a thick one hardly ever.
  dem::World<Cubes> thin(options({1, 0, -9.81}, 1e-5, 1e-6)), thick(options({1, 0, -9.81}, 1e-5, 1e-2));
  pour(thin);
  pour(thick);
  REQUIRE(thin.run(1500));
  REQUIRE(thick.run(1500));
  CHECK(thin.state().rebuilds > 1000);
  CHECK(thick.state().rebuilds < 10);
  CHECK(distance(thin, thick) < 1e-8 * 1e-3);
}

TEST_CASE("friction remembers across new neighbour lists and re-sorting") {
  // Blocks on blocks on a slope (that does not topple them: 0.25 would), each held by its friction springs alone.
  // Beside it a grain flies up and down that makes the lists anew and changes the order of all grains again and again.
  const double mu = 0.4, slope = std::atan(0.2);
  const auto build = [&](dem::World<Cubes>& w) {
    w.set_contact({{2000.0, 0.05, 1.0}, {mu, 2000.0, 0.05, 0.975}});  // well damped, to be at rest soon
    const double h = 1.2e-3;
    const auto cube = w.add_species(dem::shape::cube8(h));
    w.add_surface(w.ground(), dem::surface::Plane{});
    for (int column = 0; column < 140; ++column) {  // more than a chunk
      for (int k = 0; k < 2; ++k) {
        dem::NewGrain n;
        n.species = cube;
        n.position = {4e-3 * (column % 10), 4e-3 * (column / 10), h * (1 + 2 * k) - 1e-8};
        w.add_grain(n);
      }
    }
    dem::NewGrain n;
    n.species = cube;
    n.position = {-0.01, 0.0, 0.02};
    n.velocity = {0, 0.9, 0};
    return w.add_grain(n);
  };
  const Vec3 gravity = 9.81 * Vec3(std::sin(slope), 0, -std::cos(slope));
  dem::World<Cubes> often(options(gravity, 1e-5, 2e-6)), seldom(options(gravity, 1e-5, 5e-3));
  build(often);
  build(seldom);
  REQUIRE(often.run(6000));
  REQUIRE(seldom.run(6000));
  const auto flier = GrainId(280);
  std::vector<Vec3> before;
  for_each_grain(often, [&](GrainId p) { before.push_back(often.position(p)); });
  REQUIRE(often.run(6000));
  REQUIRE(seldom.run(6000));
  CHECK(often.state().rebuilds > 5000);
  CHECK(seldom.state().rebuilds < 500);
  double crept = 0.0, differs = 0.0, slid = 0.0;
  for_each_grain(often, [&](GrainId p) {
    if (p == flier) return;
    crept = std::max(crept, (often.position(p) - before[p.index()]).norm());
    differs = std::max(differs, (often.position(p) - seldom.position(p)).norm());
    slid = std::max(slid, often.position(p).x() - 4e-3 * static_cast<double>((p.index() / 2) % 10));
  });
  CAPTURE(crept, differs, slid);
  // The springs' stretch is m g sin/(4 kt) = 1.3e-8 m a layer, four times that with rocking, and some asperities break
  // in the first swing. A pile that lost its springs at each of the last 6,000 lists would slide g sin t^2/2 = 3.5 mm;
  // what creeps here is the last of the stacks' rocking.
  CHECK(slid < 5e-6);
  CHECK(crept < 1e-7);
  CHECK(differs < 1e-9);
}

TEST_CASE("a contact keeps its history when its grains change places in storage") {
  // Two balls pressed together and sheared: the friction spring is loaded. Then a third grain makes the order change.
  for (const bool swapped : {false, true}) {
    dem::World<Balls> w(options({0, 0, 0}, 1e-6, 1e-5));
    w.set_contact({{2000.0, 0.0, 1.0}, {0.9, 1000.0, 0.0, 0.975}});
    const auto ball = w.add_species(Sphere(1e-3));
    // Heavy, so that they move on as they are.
    const auto heavy = w.add_species(Sphere(1e-3), {"grain", 2650e6});
    dem::NewGrain a, b;
    a.species = b.species = heavy;
    a.position = {0, 0, 0};
    b.position = {1.99e-3, 0, 0};
    b.velocity = {0, 1e-2, 0};
    const auto pa = w.add_grain(swapped ? b : a), pb = w.add_grain(swapped ? a : b);
    const auto still = swapped ? pb : pa, moving = swapped ? pa : pb;
    REQUIRE(w.run(100));  // 1e-6 m of shear
    const auto rebuilds = w.state().rebuilds;
    // kt * 1e-6 m, less the share of the normal force, 0.02 N, that points across: 1e-6 m over 1.99e-3 m.
    CHECK(w.force(still).y() == Approx(1e-3 - 1.005e-5).epsilon(1e-3));
    // Grains below and to the left of the pair get lower places along the curve that storage follows.
    for (int k = 0; k < 100; ++k) {
      dem::NewGrain n;
      n.species = ball;
      n.position = {-3e-3 * (1 + k % 10), -3e-3 * (1 + k / 10), k % 2 == 0 ? -3e-3 : 3e-3};
      w.add_grain(n);
    }
    REQUIRE(w.run(100));
    CHECK(w.state().rebuilds > rebuilds);
    CHECK(w.force(still).y() == Approx(2e-3 - 2.01e-5).epsilon(1e-3));
    CHECK(w.force(moving).y() == Approx(-2e-3 + 2.01e-5).epsilon(1e-3));
    CHECK(w.force(still).z() == Approx(0.0).margin(1e-12));
  }
}

TEST_CASE("a loaded friction spring turns with its pair") {
  // Two balls, pressed together and sheared, spin as one body about an axis across their line: the spring's force turns
  // with them, and stays across the normal.
  dem::World<Balls> w(options({0, 0, 0}, 1e-6));
  w.set_contact({{2000.0, 0.0, 1.0}, {0.9, 1000.0, 0.0, 0.975}});
  const auto heavy = w.add_species(Sphere(1e-3), {"grain", 2650e9});
  const double spin = 100.0, shear = 1e-6;
  dem::NewGrain a, b;
  a.species = b.species = heavy;
  a.position = {-0.995e-3, 0, 0};
  b.position = {0.995e-3, 0, 0};
  // First shear along z, then both together turn about z; they are so heavy that no force changes that.
  a.velocity = {0, -spin * 0.995e-3, -0.5 * shear / 1e-4};
  b.velocity = {0, spin * 0.995e-3, 0.5 * shear / 1e-4};
  a.angular_velocity = b.angular_velocity = {0, 0, spin};
  const auto pa = w.add_grain(a), pb = w.add_grain(b);
  REQUIRE(w.run(100));
  // The spring, less the share of the normal force, 0.02 N, that points along z: 1e-6 m over 1.99e-3 m.
  const double expected = 1000.0 * shear - 0.02 * shear / 1.99e-3;
  CHECK(w.force(pa).z() == Approx(expected).epsilon(2e-3));
  w.set_velocity(pa, {w.velocity(pa).x(), w.velocity(pa).y(), 0.0});
  w.set_velocity(pb, {w.velocity(pb).x(), w.velocity(pb).y(), 0.0});
  // The straight paths of free bodies part: they must be led round a circle by hand, a little at a time.
  for (int k = 0; k < 100; ++k) {
    const Vec3 along = (w.position(pb) - w.position(pa)).normalized();
    const Vec3 across = Vec3::UnitZ().cross(along);
    w.set_velocity(pa, -spin * 0.995e-3 * across);
    w.set_velocity(pb, spin * 0.995e-3 * across);
    REQUIRE(w.run(20));
  }
  // 0.2 rad of turning; the force along z has no reason to change, and the one in the plane stays along the normal.
  const Vec3 along = (w.position(pb) - w.position(pa)).normalized();
  CHECK(along.y() > 0.15);
  CHECK(w.force(pa).z() == Approx(expected).epsilon(5e-3));
}

TEST_CASE("a loaded friction spring twists with its pair") {
  // Sheared along z, and then both balls spin about the line of their centres: nothing slides, and the spring turns
  // along.
  dem::World<Balls> w(options({0, 0, 0}, 1e-6));
  w.set_contact({{2000.0, 0.0, 1.0}, {0.9, 1000.0, 0.0, 0.975}});
  const auto heavy = w.add_species(Sphere(1e-3), {"grain", 2650e9});
  const double spin = 200.0, shear = 1e-6;
  dem::NewGrain a, b;
  a.species = b.species = heavy;
  a.position = {-0.995e-3, 0, 0};
  b.position = {0.995e-3, 0, -shear};  // level when the spring is loaded, so that the spins slide nothing
  a.angular_velocity = b.angular_velocity = {spin, 0, 0};
  b.velocity = {0, 0, shear / 1e-5};
  const auto pa = w.add_grain(a), pb = w.add_grain(b);
  REQUIRE(w.run(10));  // 2e-3 rad meanwhile
  const Vec3 loaded = w.force(pa);
  CHECK(loaded.tail(2).norm() == Approx(1000.0 * shear).epsilon(0.02));
  w.set_velocity(pb, Vec3::Zero());
  REQUIRE(w.run(5000));  // 1 rad
  // First-order turning: each step lengthens the spring by (2e-4)^2/2, 1e-4 in all. While it was loaded it turned 2e-3.
  const Vec3 expected = Eigen::AngleAxisd(spin * 5e-3, Vec3::UnitX()) * Vec3(0, 0, 1000.0 * shear);
  CHECK((w.force(pa) - expected).tail(2).norm() < 0.005 * 1000.0 * shear);
}

TEST_CASE("a grain far away neither crashes nor loses the contacts of others") {
  dem::WorldOptions o = options({0, 0, -9.81}, 1e-5);
  dem::World<Cubes> plain(o), with(o);
  pour(plain);
  pour(with);
  dem::NewGrain n;
  n.species = SpeciesId(0);
  n.position = {9e-3, 9e-3, 1e6};
  n.velocity = {0, 0, 1e5};
  const auto flier = with.add_grain(n);
  REQUIRE(plain.run(1000));
  REQUIRE(with.run(1000));
  CHECK(with.state().rebuilds > 900);  // the flier is past the skin every step
  CHECK(in_contact(with) == in_contact(plain));
  CHECK(distance(plain, with) < 1e-8 * 1e-3);
  CHECK(with.position(flier).z() == Approx(1e6 + 1e5 * 0.01).margin(1e-3));
}
