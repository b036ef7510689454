#include "scenes.hpp"

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using Problem = dem::StepReport::Problem;

namespace {

template <class Model = Balls>
dem::World<Model> make(dem::WorldOptions o, const dem::ContactParameters<Model>& p = sand<Model>()) {
  dem::World<Model> w(o);
  w.set_contact(p);
  if constexpr (std::is_same_v<typename Model::Shape, Sphere>) w.add_species(Sphere(1e-3));
  else w.add_species(dem::shape::cube8(1e-3));
  return w;
}
template <class World>
GrainId add(World& w, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  dem::NewGrain n;
  n.species = SpeciesId(0);
  n.position = position;
  n.velocity = velocity;
  return w.add_grain(n);
}

}  // namespace

TEST_CASE("a good run says that all is well") {
  auto w = make(options({0, 0, -9.81}, 1e-5));
  add(w, {0, 0, 0});
  const dem::StepReport report = w.run(10);
  CHECK(report);
  CHECK(report.problem == Problem::none);
  CHECK(report.step == 10);
  CHECK(report.time == Approx(1e-4));
  CHECK(w.steps() == 10);
  CHECK(w.time() == Approx(1e-4));
}

TEST_CASE("a grain that leaves the domain is named") {
  dem::WorldOptions o = options({0, 0, 0}, 2e-5);
  o.domain = dem::surface::Aabb{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  for (const Vec3& way :
       {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    auto w = make(o);
    for (int k = 0; k < 80; ++k) add(w, {-0.9 + 0.02 * k, 0, -0.7});
    const auto flier = add(w, {5e-3, 0.5, 0}, 100.0 * way);
    add(w, {0, -0.5, 0.3});
    const dem::StepReport report = w.run(1000);
    REQUIRE(!report);
    CHECK(report.problem == Problem::lost);
    CHECK(report.grain == flier);
    CHECK(report.step == w.steps());
    CHECK(report.time == Approx(w.time()));
    // It has 0.5 to 1.5 m to go at 100 m/s.
    CHECK(report.time > 0.004);
    CHECK(report.time < 0.016);
    CHECK_THAT(report.text, ContainsSubstring(fmt::format("grain {} left the domain", flier.value)));
    CHECK_THAT(report.text, ContainsSubstring(fmt::format("t = {:.6g} s", report.time)));
    CHECK_THAT(report.text, ContainsSubstring("time_step"));
    CHECK_THAT(report.text, ContainsSubstring("domain"));
  }
}

TEST_CASE("a grain that takes the place of a removed one is named by its own number") {
  dem::WorldOptions o = options({0, 0, 0}, 2e-5);
  o.domain = dem::surface::Aabb{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  auto w = make(o);
  const auto first = add(w, {0, 0, 0});
  add(w, {0.1, 0, 0});
  w.remove_grain(first);
  REQUIRE(w.run(2));
  const auto flier = add(w, {0, 0.5, 0}, {0, 100, 0});
  REQUIRE(flier.value == 2);
  const dem::StepReport report = w.run(1000);
  REQUIRE(!report);
  CHECK(report.grain == flier);
  CHECK_THAT(report.text, ContainsSubstring("grain 2 left the domain"));
}

TEST_CASE("a lost grain does not stop a run that goes on, nor the contacts of others") {
  dem::WorldOptions o = options({0, 0, -9.81}, 1e-5);
  o.domain = dem::surface::Aabb{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  auto w = make<Cubes>(o);
  const auto plate = w.add_surface(w.ground(), dem::surface::Plane{});
  add(w, {0, 0, 1e-3});
  add(w, {0, 0.5, 0.9}, {1e4, 0, 1e4});
  REQUIRE(w.run(100).problem == Problem::lost);
  REQUIRE(w.run(30000));  // said once is enough
  CHECK(-w.surface_force(plate).z() == Approx(w.species(SpeciesId(0)).mass * 9.81).epsilon(1e-6));
}

TEST_CASE("a grain that is pressed too deep is named") {
  dem::WorldOptions o = options({0, 0, 0}, 1e-6);
  o.overlap_limit = 0.1;
  auto w = make(o);
  for (int k = 0; k < 5; ++k) add(w, {0.01 * k, 0, 0});
  const auto deep = add(w, {0.02, 1.75e-3, 0});  // 0.25 mm of an effective diameter of 1 mm
  const dem::StepReport report = w.run(10);
  REQUIRE(!report);
  CHECK(report.problem == Problem::overlap);
  CHECK((report.grain == deep || report.grain == GrainId(2)));
  CHECK(report.step == 1);
  CHECK_THAT(report.text, ContainsSubstring("overlaps grain"));
  CHECK_THAT(report.text, ContainsSubstring("0.25"));
  CHECK_THAT(report.text, ContainsSubstring("overlap_limit 0.1"));
  CHECK_THAT(report.text, ContainsSubstring(" m overlaps") && ContainsSubstring("as they were placed"));
  // With the limit above it all is well, but it is said once that they are thrown out.
  o.overlap_limit = 0.3;
  auto v = make(o);
  add(v, {0, 0, 0});
  add(v, {0, 1.75e-3, 0});
  const dem::StepReport told = v.run(10);
  CHECK(told);
  CHECK_THAT(told.note, ContainsSubstring("by 0.25 of their effective diameter as it was placed, and is thrown out"));
  CHECK(v.run(10).note.empty());
  // A grain that is moved far away makes no others new.
  add(v, {0.1, 0, 0});
  v.set_position(GrainId(2), {0.2, 0, 0});
  CHECK(v.run(10).note.empty());
}

TEST_CASE("a density that looks like one in other units is noted, and runs as it is") {
  for (const auto& [density, is_noted] : {std::pair(2.65, true), {2650.0, false}, {20.0, false}, {2.65e6, true}}) {
    dem::World<Balls> w(options({0, 0, 0}));
    w.set_contact(sand<Balls>());
    w.add_species(Sphere(1e-3), {.density = 2650});
    w.add_grain({w.add_species(Sphere(1e-3), {.density = density}), {0, 0, 0}});
    const dem::StepReport report = w.run(1);
    CHECK(report);
    CHECK((report.note.find("Species 1 has a density of") != std::string::npos) == is_noted);
  }
}

TEST_CASE("an overlap on the way is said to be one of stiffness, speed or load, not of where grains were placed") {
  dem::WorldOptions o = options({0, 0, 0}, 1e-6);
  o.overlap_limit = 0.1;
  auto w = make(o);
  const auto fast = add(w, {0, 0, 0});
  add(w, {2.05e-3, 0, 0});
  w.set_velocity(fast, {20, 0, 0});  // 20 um a step
  dem::StepReport report;
  for (int k = 0; k < 100 && report; ++k) {  // what else is changed by hand between steps does not matter
    w.set_gravity({0, 0, -1e-3 * k});
    add(w, {0.1 + 0.01 * k, 0, 0});
    report = w.run(1);
  }
  REQUIRE(!report);
  CHECK(report.step > 1);
  CHECK_THAT(report.text, ContainsSubstring("raise the normal stiffness, lower time_step (now 1e-06 s)"));
}

TEST_CASE("the report names the two that overlap, not a grain that is pushed harder") {
  dem::WorldOptions o = options({0, 0, 0}, 1e-6);
  o.overlap_limit = 0.1;
  dem::World<Balls> w(o);
  w.set_contact({{1e3, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
  w.set_contact("hard", "wall", {{1e6, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
  w.add_species(Sphere(1e-3), {"soft"});
  w.add_species(Sphere(1e-3), {"hard"});
  w.add_surface(w.ground(), dem::surface::Plane{});
  // Squeezed from both sides by 0.2 mm, so that hardly any force is left; and a hard grain 0.01 mm in the floor, 10 N.
  const double x = 1.8e-3;
  add(w, {0, 0, 0.5});
  const auto middle = add(w, {x, 0, 0.5});
  add(w, {2 * x, 0, 0.5});
  dem::NewGrain hard;
  hard.species = SpeciesId(1);
  hard.position = {0.1, 0, 0.99e-3};
  w.add_grain(hard);
  const dem::StepReport report = w.run(1);
  CHECK(report.problem == Problem::overlap);
  CHECK((report.grain == GrainId(0) || report.grain == middle));
  CHECK_THAT(report.text, ContainsSubstring("grain 1"));
  CHECK_THAT(report.text, ContainsSubstring("grain 0") || ContainsSubstring("grain 2"));
}

TEST_CASE("an overlap with a surface is reported too") {
  dem::WorldOptions o = options({0, 0, 0}, 1e-6);
  o.overlap_limit = 0.1;
  auto w = make(o);
  w.add_surface(w.ground(), dem::surface::Plane{});
  const auto deep = add(w, {0, 0, 0.7e-3});  // 0.3 mm of 2 mm, the diameter: an effective one beside a flat wall
  const dem::StepReport report = w.run(10);
  REQUIRE(!report);
  CHECK(report.problem == Problem::overlap);
  CHECK(report.grain == deep);
  CHECK_THAT(report.text, ContainsSubstring("0.15"));
  CHECK_THAT(report.text, ContainsSubstring("overlaps surface 0 of body 'ground'"));
}

TEST_CASE("a surface that is switched on does not make others ones that were just placed") {
  dem::WorldOptions o = options({0, 0, 0}, 1e-6);
  o.overlap_limit = 0.01;
  auto w = make(o);
  const auto far = w.add_surface(w.ground(), dem::surface::Plane{}, {.position = {0, 0, -1}});
  w.add_surface(w.ground(), dem::surface::Plane{}, {.name = "floor"});
  add(w, {0, 0, 0.95e-3});
  REQUIRE_FALSE(w.run(1));
  w.set_active(far, false);
  w.set_active(far, true);
  const dem::StepReport report = w.run(1);
  REQUIRE(!report);
  CHECK_THAT(report.text,
             ContainsSubstring("overlaps surface 'floor'") && ContainsSubstring("raise the normal stiffness"));
}

TEMPLATE_TEST_CASE("a part that jumps past grains within a step is reported, one that touches nothing is not", "",
                   Balls, models::VerletBalls, models::CorrectedBalls) {
  dem::World<TestType> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<TestType>());
  w.add_species(Sphere(1e-3));
  const auto grain = add(w, {0, 0, 0});
  w.add_grain({w.add_species(Sphere(1e-3), {.held = true}), Vec3(-0.01, 0, 0)});  // held grains meet no surface
  auto& m = w.machine();
  const auto plate = m.add_body(dem::mbd::fixed_body("plate", {-0.02, 0, 0}));
  const auto paddle = w.add_surface(plate, dem::surface::Box({2e-4, 0.02, 0.02}), {.name = "paddle"});
  double to = 0.0;
  const auto go = m.add_motion(dem::mbd::prescribed_position("go", plate, Vec3::UnitX(),
                                                             dem::mbd::Signal::function([&](double) { return to; })));
  REQUIRE(w.run(10));
  to = 0.018;  // to 2 mm before the grain, whose radius is 1 mm
  REQUIRE(w.run(10));
  to = 0.022;  // to 2 mm behind it
  const dem::StepReport report = w.run(10);
  REQUIRE(!report);
  CHECK(report.problem == Problem::machine);
  CHECK(report.grain == grain);
  CHECK(report.step == 21);
  CHECK_THAT(report.text, ContainsSubstring("'paddle' went 0.004 m") && ContainsSubstring("grain 0"));
  CHECK(w.run(10));

  w.set_active(paddle, false);
  to = 0.0;
  CHECK(w.run(1));
  w.set_active(paddle, true);
  CHECK(w.run(1));
  // Nor is one that is put elsewhere by hand.
  m.switch_on(go, false);
  m.body(plate).motion.position.x = 0.002;
  CHECK(w.run(10));
}

TEST_CASE("a run that blows up is stopped and says where, when and what to change") {
  dem::WorldOptions o = options({0, 0, 0}, 1e10);
  o.allow_unstable_time_step = true;
  o.overlap_limit = 1e300;
  auto w = make(o, {{1e300, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}});
  for (int k = 0; k < 70; ++k) add(w, {0.1 * k, 0, 0});
  const auto first = add(w, {0, 5, 0}), second = add(w, {1e-3, 5, 0});
  const dem::StepReport report = w.run(100);
  REQUIRE(!report);
  CHECK(report.problem == Problem::not_finite);
  CHECK((report.grain == first || report.grain == second));
  CHECK_THAT(report.text, ContainsSubstring("not a number"));
  CHECK_THAT(report.text, ContainsSubstring(fmt::format("grain {}", report.grain.value)));
  CHECK_THAT(report.text, ContainsSubstring("time_step (now 1e+10 s)"));
  CHECK_THAT(report.text, ContainsSubstring(fmt::format("step {}", report.step)));
}

TEST_CASE("a velocity that becomes no number is found in the next step") {
  auto w = make(options({0, 0, 0}, 1e-5));
  for (int k = 0; k < 100; ++k) add(w, {0.01 * k, 0, 0});
  REQUIRE(w.step());
  auto& grains = w.state().grains;
  grains.velocity.set(grains.row_of[57], {0, std::nan(""), 0});
  const dem::StepReport report = w.step();
  CHECK(report.problem == Problem::not_finite);
  CHECK(report.grain == GrainId(57));
  CHECK(report.step == 2);
}
