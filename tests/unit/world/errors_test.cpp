#include "core/error_of.hpp"
#include "scenes.hpp"

#include <limits>

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class F>
dem::WorldOptions with(F&& change) {
  dem::WorldOptions o = options({0, 0, -9.81});
  change(o);
  return o;
}
template <class F>
std::string options_refused(F&& change) {
  return message_of([&] { dem::World<Balls> w(with(change)); });
}
void check_says(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) CHECK_THAT(text, Catch::Matchers::ContainsSubstring(word));
}

}  // namespace

TEST_CASE("options out of range are refused") {
  check_says(options_refused([](auto& o) { o.time_step = -1e-5; }), {"time step is -1e-05 s", "not negative"});
  check_says(options_refused([](auto& o) { o.time_step = not_a_number; }), {"time step is nan"});
  check_says(options_refused([](auto& o) { o.time_step_safety = 1.5; }), {"time step safety is 1.5", "and 1"});
  check_says(options_refused([](auto& o) { o.time_step_safety = 0.0; }), {"time step safety is 0"});
  check_says(options_refused([](auto& o) { o.skin = -1e-4; }), {"skin is -0.0001 m", "not negative"});
  check_says(options_refused([](auto& o) { o.overlap_limit = 0.0; }), {"overlap limit is 0", "greater than zero"});
  check_says(options_refused([](auto& o) { o.gravity.y() = not_a_number; }), {"gravity is (0, nan", "must be finite"});
  check_says(options_refused([](auto& o) { o.threads = -1; }), {"threads is -1", "at least 1"});
  CHECK_NOTHROW(dem::World<Balls>());
  CHECK_NOTHROW([] { dem::World<Balls> w({}); }());  // options that all keep their defaults
}

TEST_CASE("a serial world runs on one thread only") {
  using Serial = Grains<Sphere, dem::integrator::SymplecticEuler, dem::broadphase::UniformGrid, dem::exec::Serial>;
  check_refused([] { dem::World<Serial> w(with([](auto& o) { o.threads = 2; })); }, "1 thread, not 2", "Threads");
  dem::World<Balls> w;
  check_refused([&] { w.set_threads(0); }, "threads is 0");
}

TEST_CASE("a species needs a density and a shape") {
  dem::World<Balls> w;
  check_refused([&] { w.add_species(Sphere(1e-3), {"grain", 0.0}); }, "density of a species is 0 kg/m^3");
  check_refused([&] { w.add_species(Sphere(1e-3), {"grain", -2650.0}); }, "density of a species is -2650 kg/m^3");
  check_refused([&] { w.add_species(Sphere(1e-3), {"grain", not_a_number}); }, "density", "nan");
  check_refused([&] { w.add_species(Sphere(-1e-3)); }, "radius of a sphere is -0.001 m");
}

TEST_CASE("a grain that cannot be is refused") {
  dem::World<Balls> w;
  const auto ball = w.add_species(Sphere(1e-3));
  dem::NewGrain good;
  good.species = ball;
  const auto refused = [&](auto&& change) {
    dem::NewGrain n = good;
    change(n);
    return message_of([&] { w.add_grain(n); });
  };
  w.add_grain(good);
  check_says(refused([](auto& n) { n.species = SpeciesId(3); }), {"species 3", "the world has 1", "add_species"});
  check_says(refused([](auto& n) { n.species = SpeciesId(); }), {"species", "add_species"});
  check_says(refused([](auto& n) { n.position.x() = not_a_number; }), {"grain 1", "position", "not finite"});
  check_says(refused([](auto& n) { n.velocity.y() = 1.0 / 0.0; }), {"grain 1", "velocity", "not finite"});
  check_says(refused([](auto& n) { n.angular_velocity.z() = not_a_number; }), {"grain 1", "not finite"});
  check_says(refused([](auto& n) { n.rotation *= 1.01; }), {"grain 1", "rotation", "normalise"});
  check_says(refused([](auto& n) { n.rotation.col(0) *= -1.0; }), {"grain 1", "rotation"});
  check_says(refused([](auto& n) { n.rotation(0, 0) = not_a_number; }), {"grain 1", "rotation"});
  CHECK(w.grain_count() == 1);  // those that were refused left nothing behind
}

TEST_CASE("a surface needs its body") {
  dem::World<Balls> w;
  check_refused(
      [&] {
        dem::SurfaceOptions o;
        o.name = "lid";
        w.add_surface(dem::BodyId(4), dem::surface::Plane{}, o);
      },
      "surface 'lid'", "body 4", "the machine has 0");
  check_refused([&] { w.add_surface({}, dem::surface::Plane{}); }, "names a body that was never added");
  check_refused([&] { w.add_surface(w.ground(), dem::surface::Box({1, -1, 1})); }, "edge length of a box is -1 m");
}

TEST_CASE("surfaces that are there twice are noted, as both push") {
  using dem::surface::Box, dem::surface::Plane;
  const auto note = [](auto&& add) {
    dem::World<Balls> w(options({0, 0, 0}, 1e-5));
    w.set_contact(sand<Balls>());
    const auto table = w.machine().add_fixed_body("table", {0, 0, 0});
    w.add_surface(w.ground(), Box({1, 1, 1}), {.name = "block"});
    const auto floor = w.add_surface(table, Plane{}, {.name = "floor"});
    add(w, table, floor);
    return w.run(1).note;
  };
  CHECK(note([](auto& w, auto table, auto) { w.add_surface(table, Plane{}, {.name = "floor"}); }) ==
        "Surfaces 1 and 2 of body 'table' have one shape and one place: both push on what touches them.");
  // Another place, another body, another size, or switched off.
  CHECK(note([](auto& w, auto table, auto) {
          w.add_surface(table, Plane{}, {.name = "floor", .position = {0, 0, 1e-9}});
        }).empty());
  CHECK(note([](auto& w, auto, auto) { w.add_surface(w.ground(), Plane{}, {.name = "floor"}); }).empty());
  CHECK(note([](auto& w, auto, auto) { w.add_surface(w.ground(), Box({1, 1, 2}), {.name = "block"}); }).empty());
  CHECK(note([](auto& w, auto table, auto floor) {
          w.set_active(floor, false);
          w.add_surface(table, Plane{}, {.name = "floor"});
        }).empty());
}

TEST_CASE("missing contact constants are named before the first step") {
  dem::World<Balls> w(options({0, 0, -9.81}));
  w.add_species(Sphere(1e-3), {"gravel", 2650.0});
  dem::SurfaceOptions steel;
  steel.material = "steel";
  w.add_surface(w.ground(), dem::surface::Plane{}, steel);
  check_refused([&] { (void)w.step(); }, "no contact constants", "'gravel'", "set_contact");
  w.set_contact("gravel", "gravel", sand<Balls>());
  check_refused([&] { (void)w.step(); }, "no contact constants", "'gravel'", "'steel'");
  w.set_contact("steel", "gravel", sand<Balls>());
  CHECK(w.step());
  // And again when something new comes.
  w.add_species(Sphere(1e-3), {"clay", 2000.0});
  check_refused([&] { (void)w.step(); }, "no contact constants", "'clay'");
}

TEST_CASE("a time step above the stable one is refused with the numbers") {
  const auto make = [](double dt, bool anyway) {
    dem::World<Balls> w(with([&](auto& o) {
      o.time_step = dt;
      o.allow_unstable_time_step = anyway;
    }));
    w.set_contact(sand<Balls>());
    w.add_species(Sphere(1e-3), {"gravel", 2650.0});
    return w;
  };
  const double limit = make(0.0, false).stable_time_step().dt;
  const std::string text = message_of([&] { make(1.5 * limit, false).prepare(); });
  check_says(text, {"time step", "largest stable", "gravel", "2000 N/m", "allow_unstable_time_step", "stiffness"});
  // The limit is rounded down, so that the number that is named is accepted.
  const double unit = std::pow(10.0, std::floor(std::log10(limit)) - 3.0);
  check_says(
      text, {fmt::format("{:g}", 1.5 * limit).c_str(), fmt::format("{:.4g}", unit * std::floor(limit / unit)).c_str()});
  auto insisted = make(1.5 * limit, true);
  CHECK_NOTHROW(insisted.prepare());
  CHECK(insisted.time_step() == 1.5 * limit);
  CHECK_NOTHROW(make(0.99 * limit, false).prepare());
  auto chosen = make(0.0, false);
  chosen.prepare();
  CHECK(chosen.time_step() == Catch::Approx(0.5 * limit));
}

TEST_CASE("a world that nothing limits asks for a time step") {
  dem::World<Balls> w;
  check_refused([&] { (void)w.step(); }, "nothing", "time step", "set time_step");
}

TEST_CASE("a negative time to run is refused") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-3));
  check_refused([&] { (void)w.run_for(-1.0); }, "time to run is -1 s");
}

TEST_CASE("a chosen time step keeps its safety when contacts become stiffer") {
  dem::World<Balls> w(options({0, 0, 0}));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(1e-3));
  w.prepare();
  const double before = w.time_step();
  auto stiff = sand<Balls>();
  stiff.normal.stiffness *= 3.9;  // the old step would just be stable still
  w.set_contact(stiff);
  w.prepare();
  CHECK(w.time_step() < 0.6 * before);
  CHECK(w.time_step() == Catch::Approx(0.5 * w.stable_time_step().dt));
  // What does not make contacts stiffer leaves the step alone.
  const double now = w.time_step();
  stiff.friction.coefficient = 0.1;
  w.set_contact(stiff);
  w.prepare();
  CHECK(w.time_step() == now);
}

TEST_CASE("time spans that are no whole steps are run in the long run") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-3));
  for (int k = 0; k < 100; ++k) CHECK(w.run_for(0.4e-3));
  CHECK(w.steps() == 40);
  // A span that was broken off owes nothing.
  CHECK(w.run_for(10.4e-3, [] { return false; }));
  CHECK(w.run_for(1.2e-3));
  CHECK(w.steps() == 42);
}

TEST_CASE("a material that nothing is made of is refused, with those that are there") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-6));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(1e-3), {"gravel", 2650.0});
  w.set_contact("gravle", "wall", sand<Balls>());
  check_refused([&] { (void)w.step(); }, "'gravle'", "there are: 'gravel'", "correct the name");
}

TEST_CASE("domains, gravity and velocities that make no sense are refused") {
  check_refused(
      [] {
        dem::World<Balls> w(with([](auto& o) { o.domain = dem::surface::Aabb{{0, 0, 0}, {1, NAN, 1}}; }));
      },
      "domain's lower corner");
  dem::World<Balls> w(options({0, 0, 0}, 1e-3));
  check_refused([&] { w.set_gravity({0, NAN, 0}); }, "gravity is (0, nan, 0)");
  w.add_species(Sphere(1e-3));
  w.set_contact(sand<Balls>());
  const auto grain = w.add_grain({SpeciesId(0)});
  check_refused([&] { w.set_velocity(grain, {INFINITY, 0, 0}); }, "velocity of a grain is (inf, 0, 0)");
}

TEST_CASE("ids that are not there are refused") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-3));
  check_refused([&] { (void)w.position(GrainId(0)); }, "grain 0 is asked for", "added so far: 0");
  check_refused([&] { (void)w.surface_force(SurfaceId()); },
                "the surface that is asked for has an id that was never set");
  check_refused([&] { w.set_active(SurfaceId(2), false); }, "surface 2");
  check_refused([&] { (void)w.species(SpeciesId(1)); }, "species 1");
}

TEST_CASE("a world of sources that were compiled for different processors is refused") {
  dem::detail::PackWidths& widths = dem::detail::pack_widths;
  CHECK(widths.first == dem::pack_width);
  REQUIRE(widths.other == 0);
  widths.add(dem::pack_width);
  CHECK_NOTHROW(dem::World<Balls>(options({0, 0, 0})));
  widths.add(dem::pack_width + 1);
  check_refused([] { dem::World<Balls> w(options({0, 0, 0})); }, "compiled for different processors", "dem::native");
  widths.other = 0;
}
