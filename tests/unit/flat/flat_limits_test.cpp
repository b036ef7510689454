#include "core/error_of.hpp"
#include "flat_scenes.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/world/contacts.hpp>
#include <dem/world/energy.hpp>

#include <stdexcept>

namespace flat_limits {

using Catch::Matchers::ContainsSubstring;
using World = dem::World<flat_scenes::Balls>;

World falling(const dem::WorldOptions& o = options({0, 0, -9.81}, 1e-5)) {
  World w(o);
  w.set_contact(flat_scenes::Balls::contact());
  w.add_surface(w.ground(), dem::surface::Plane{});
  const auto kind = w.add_species(Sphere(1e-3));
  for (int k = 0; k < 3; ++k) w.add_grain({.species = kind, .position = {3e-3 * k, 0, 2e-3}});
  return w;
}

TEST_CASE("what the flat path cannot do is refused in words") {
  World w = falling();
  REQUIRE(w.run(2));
  const auto refused = [&] { return message_of([&] { (void)w.run(2); }); };
  SECTION("sleep") {
    w.set_sleep(dem::SleepOptions{});
    CHECK_THAT(refused(), ContainsSubstring("grains cannot sleep"));
  }
  SECTION("loads on grains") {
    w.set_grain_load([](const dem::GrainNow&) { return dem::GrainLoad{}; });
    CHECK_THAT(refused(), ContainsSubstring("no load law"));
  }
  SECTION("attached grains") {
    const auto held = w.add_species(Sphere(1e-3), {.held = true});
    w.attach(w.add_grain({.species = held, .position = {0, 0, 9e-3}}), w.ground());
    CHECK_THAT(refused(), ContainsSubstring("attached to machine parts"));
  }
  SECTION("inlets") {
    const auto inlet =
        w.add_inlet(dem::InletRegion::disc({0, 0, 0.3}, {0, 0, -1}, 0.02), {.grains = SpeciesId(0), .mass_flow = 0.1});
    w.set_open(inlet, false);
    CHECK(w.run(2));  // a bed that was rained keeps its inlet
    w.set_open(inlet, true);
    CHECK_THAT(refused(), ContainsSubstring("no inlet can be open"));
  }
  SECTION("outlets") {
    w.add_outlet({{-1, -1, -2}, {1, 1, -1}});
    CHECK_THAT(refused(), ContainsSubstring("no outlets"));
  }
  SECTION("energy") {
    dem::count_energy(w);
    CHECK_THAT(refused(), ContainsSubstring("energy cannot be counted"));
  }
  SECTION("meshes") {
    w.add_surface(w.ground(), dem::surface::TriangleMesh(dem::mesh::box({1, 1, 1}, 1)),
                  {.name = "sieve", .position = {0, 0, -2}});
    CHECK_THAT(refused(), ContainsSubstring("surface 'sieve' is of a kind"));
  }
  CHECK_THAT(refused(), ContainsSubstring("exec::Threads"));
}

TEST_CASE("a domain that removes what leaves it is refused on the flat path") {
  dem::WorldOptions o = options({0, 0, -9.81}, 1e-5);
  o.domain = dem::surface::Aabb{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  o.beyond_domain = dem::BeyondDomain::remove;
  World w = falling(o);
  CHECK_THAT(message_of([&] { (void)w.run(2); }), ContainsSubstring("cannot be removed"));
}

TEST_CASE("within a run on the flat path nobody looks at old grains") {
  World w = falling();
  const auto within = [&](auto&& f) {
    std::string said;
    REQUIRE(w.run(5, [&] {
      said = message_of([&] { f(); });
      return false;
    }));
    CHECK(w.state().executor.holds_grains() == false);
    return said;
  };
  CHECK_THAT(within([&] { (void)w.position(GrainId(0)); }), ContainsSubstring("end the run first"));
  CHECK_THAT(within([&] { w.add_grain({.species = SpeciesId(0)}); }), ContainsSubstring("end the run first"));
  CHECK_THAT(within([&] { w.set_contact(flat_scenes::Balls::contact()); }), ContainsSubstring("end the run first"));
  CHECK_THAT(within([&] { w.add_outlet({{-1, -1, -2}, {1, 1, -1}}); }), ContainsSubstring("end the run first"));
  CHECK_THAT(within([&] { (void)dem::contacts_of(w); }), ContainsSubstring("end the run first"));
  CHECK_THAT(within([&] { World copy = w; }), ContainsSubstring("copied within its run"));
  // Between runs all of it works, and grains that are added run on.
  w.add_grain({.species = SpeciesId(0), .position = {0, 0, 8e-3}});
  REQUIRE(w.run(5));
  CHECK(w.grain_count() == 4);
  CHECK(w.velocity(GrainId(3)).z() == Approx(-9.81 * 5e-5));
}

TEST_CASE("an exception of a function of the user leaves the grains at home") {
  World w = falling();
  CHECK_THROWS_AS(w.run(9, [&]() -> bool { throw std::runtime_error("enough"); }), std::runtime_error);
  CHECK(w.position(GrainId(0)).z() < 2e-3);
  CHECK(w.steps() == 1);
}

TEST_CASE("grains that are held stand still on the flat path, and others feel them") {
  World w = falling();
  const auto held = w.add_species(Sphere(1e-3), {.held = true});
  const GrainId base = w.add_grain({.species = held, .position = {0, 0, 1e-4}});
  const GrainId top = w.add_grain({.species = SpeciesId(0), .position = {0, 0, 8e-3}});
  REQUIRE(w.run(4000));
  CHECK(w.position(base) == Vec3(0, 0, 1e-4));
  CHECK(w.position(top).z() > 3.9e-3);
}

TEST_CASE("a world without grains runs on the flat path") {
  World w(options({0, 0, -9.81}, 1e-5));
  w.set_contact(flat_scenes::Balls::contact());
  w.add_surface(w.ground(), dem::surface::Plane{});
  REQUIRE(w.run(5));
  CHECK(w.steps() == 5);
}

}  // namespace flat_limits
