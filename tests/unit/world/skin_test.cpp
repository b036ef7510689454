#include "scenes.hpp"

#include <dem/grain/skin.hpp>

using Catch::Approx;
using dem::grain::SkinChoice;

namespace {

/// A list of a dense bed of balls of 1 mm: 3.6 candidates a grain with a tenth of a radius.
SkinChoice list_of_dense_bed(double skin = 1e-4) {
  SkinChoice choice;
  choice.radius = 1e-3;
  choice.skin = skin;
  choice.diameter = 2e-3;
  const double ratio = (2e-3 + skin) / 2.1e-3;
  choice.candidates = 3.6 * ratio * ratio * ratio;
  return choice;
}

/// Balls that fall at 1 m/s, and a floor.
dem::World<Balls> falling_bed(double skin, int threads, int n = 9) {
  dem::WorldOptions o = options({0, 0, -g}, 1e-5, skin);
  o.threads = threads;
  dem::World<Balls> w(o);
  w.set_contact(sand<Balls>());
  const auto ball = w.add_species(Sphere(1e-3));
  add_open_box(w, {2.1e-3 * n, 2.1e-3 * n, 0});
  add_block(w, ball, Vec3(1.05e-3, 1.05e-3, 0.02), 2.1e-3, n, n, n, 0.1);
  for (const GrainId p : w.grains()) w.set_velocity(p, w.velocity(p) - Vec3(0, 0, 1.0));
  return w;
}

}  // namespace

TEST_CASE("faster grains are given wider skins, and more candidates narrower ones") {
  const SkinChoice choice = list_of_dense_bed();
  double last = 0.0;
  for (const double speed : {0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4}) {
    const double skin = choice.best(speed, 1.0, 0.0);
    CHECK(skin >= last);
    CHECK(choice.best(speed, 2.0, 0.0) <= skin);
    // The choice is the least of what the ladder offers.
    const auto cost = [&](double s) { return choice.candidates_at(s) + choice.list_cost(s) * speed / s; };
    for (const double share : SkinChoice::ladder) CHECK(cost(skin) <= cost(share * 1e-3));
    last = skin;
  }
  CHECK(choice.best(0.0, 1.0, 0.0) == 1e-4);
  CHECK(last >= 1e-3);
}

TEST_CASE("lists that are made anew for other reasons need no skin that outlasts them") {
  SkinChoice choice = list_of_dense_bed();
  choice.made = 100;
  // Motion at 1e-5 m a step would ask for a wide skin, but a list is made every second step anyway.
  CHECK(choice.best(2e-5, 1.0, 0.0) > 3e-4);
  choice.moved = 2e-5;
  CHECK(choice.choose(102, 1.0) == 1e-4);
  // Where the list was given up by hand, nothing is known of the motion.
  choice.skin = 4e-4;
  CHECK(choice.choose(104, 1.0) == 4e-4);
}

TEST_CASE("a list that has lasted is narrowed when its needless candidates have cost a new one") {
  SkinChoice choice = list_of_dense_bed(1e-3);
  choice.made_list(0.0, choice.candidates, 500, 1.0);
  CHECK(choice.look_at > 510);
  CHECK(choice.look_at < 700);
  SkinChoice resting = choice, moving = choice;
  const std::uint64_t then = choice.look_at, steps = then - 500;
  CHECK(resting.is_too_wide(0.0, then, 1.0));
  resting.moved = 0.0;
  CHECK(resting.choose(then, 1.0) == 1e-4);
  // Still moving as fast as the skin was made for: looked at again after as many steps.
  const double farthest = 0.45e-3;
  CHECK(moving.is_too_wide(farthest, then, 1.0) ==
        (moving.best(2 * farthest / static_cast<double>(steps), 1.0, 0.0) < 1e-3));
  CHECK(moving.look_at == then + steps);
  // The narrowest is never looked at.
  SkinChoice narrow = list_of_dense_bed();
  narrow.made_list(0.0, 3.6, 500, 1.0);
  CHECK(narrow.look_at == SkinChoice::never);
}

TEST_CASE("a falling bed makes fewer lists, and a bed at rest goes back to the narrow skin", "[slow]") {
  auto fixed = falling_bed(1e-4, 1), chosen = falling_bed(0.0, 1);
  REQUIRE(fixed.run(1500));
  REQUIRE(chosen.run(1500));
  CHECK(chosen.state().list_skin > 2e-4);
  CHECK(chosen.state().rebuilds < fixed.state().rebuilds / 3);
  // The same grains, but for the order of sums.
  for (const GrainId p : chosen.grains()) {
    CHECK((chosen.position(p) - fixed.position(p)).norm() < 1e-9);
  }
  CHECK(fixed.state().list_skin == 1e-4);

  dem::World<Balls> bed(options({0, 0, -g}, 1e-5));
  bed.set_contact({{2000.0, 0.05, 1.0}, {0.4, 2000.0, 0.05, 1.0}});
  const auto ball = bed.add_species(Sphere(1e-3));
  add_open_box(bed, {12.6e-3, 12.6e-3, 0});
  add_block(bed, ball, Vec3::Constant(1.05e-3), 2.1e-3, 6, 6, 4, 0.5);
  double widest = 0.0;
  REQUIRE(bed.run(30000, [&] {
    widest = std::max(widest, bed.state().list_skin);
    return true;
  }));
  CHECK(widest > 1.3e-4);
  CHECK(bed.state().list_skin == 1e-4);
}

TEST_CASE("a chosen skin is the same for any number of threads", "[slow]") {
  const auto run = [](int threads) {
    auto w = falling_bed(0.0, threads);
    REQUIRE(w.run(3000));  // it meets the floor
    std::vector<double> all = {w.state().list_skin, static_cast<double>(w.state().rebuilds)};
    for (const GrainId p : w.grains()) {
      const Vec3 x = w.position(p), v = w.velocity(p);
      all.insert(all.end(), {x.x(), x.y(), x.z(), v.x(), v.y(), v.z()});
    }
    return all;
  };
  const auto one = run(1);
  CHECK(run(2) == one);
  CHECK(run(3) == one);
}
