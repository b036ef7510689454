// No number is given to two grains, and the tables of a world are used again when grains are gone.

#include "core/error_of.hpp"
#include "scenes.hpp"

#include <dem/world/energy.hpp>

#include <algorithm>
#include <set>

using Catch::Approx;

TEST_CASE("the tables of a stream hold as many grains as there are at a time") {
  dem::World<Balls> w(options({0, 0, 0}, 2e-5));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(1e-3));
  // 2,000 a second that fly for some 25 ms: 50 at a time. Those that wait for a list, 16 steps, are one more.
  const auto in = w.add_inlet(dem::InletRegion::box({0, 0, 0.05}, {0.02, 0.02, 0.06}),
                              {.grains = SpeciesId(0), .grain_flow = 2000, .velocity = {0, 0, -2}});
  const auto out = w.add_outlet({{-1, -1, -HUGE_VAL}, {1, 1, 0}});
  REQUIRE(w.run_for(0.01));
  count_energy(w);
  const double balance = energy_of(w).balance();
  const GrainId early = w.grains().front();
  std::set<GrainId> seen;
  for (int k = 0; k < 20; ++k) {
    REQUIRE(w.run_for(0.01));
    const auto now = w.grains();
    CHECK(now.size() == w.grain_count());
    CHECK(now.size() == w.inlet(in).grains() - w.outlet(out).grains());
    seen.insert(now.begin(), now.end());
    for (const GrainId p : now) {
      REQUIRE(w.position(p).z() > 0.0);
      REQUIRE(w.position(GrainId(p.index())) == w.position(p));  // an id that is made from a number
    }
    CHECK(std::is_sorted(now.begin(), now.end()));
  }
  CHECK(w.outlet(out).grains() > 350);
  CHECK(seen.size() > 380);                     // every grain has a name of its own,
  CHECK(w.state().grains.row_of.size() < 100);  // in tables that do not grow
  check_refused([&] { w.velocity(early); }, "was removed");
  check_refused([&] { w.velocity(GrainId(early.index())); }, "was removed");
  check_refused([&] { w.velocity(GrainId(w.inlet(in).grains())); }, "but is not known (added so far: ");
  CHECK(w.grains().size() == w.grain_count());
  // Grains come and go with their energies: 0.02 mJ each, 400 of them. Without weight no integrator errs, and the rest
  // is rounding: none is left out or counted as another's.
  const auto e = energy_of(w);
  CHECK(std::abs(e.balance() - balance) < 1e-13);
}

TEST_CASE("a part does not carry the grain that has the place of one that was attached to it") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Balls>());
  const auto held = w.add_species(Sphere(1e-3), {.held = true}), moving = w.add_species(Sphere(1e-3));
  const auto body = w.machine().add_body(
      dem::mbd::box_body("block", Vec3::Constant(5e-3), 2000).at(Vec3(0, 0, 0.1)).moving(Vec3(1, 0, 0)));
  const auto glued = w.add_grain({held, Vec3(0, 0, 0)});
  w.attach(glued, body);
  REQUIRE(w.run(10));
  CHECK(w.position(glued).x() > 5e-5);
  w.remove_grain(glued);
  REQUIRE(w.run(10));
  const auto other = w.add_grain({moving, Vec3(0.05, 0, 0)});
  REQUIRE(other.slot == glued.slot);
  CHECK(other != glued);
  CHECK(other.index() == 1);
  REQUIRE(w.run(100));
  CHECK(w.position(other).x() == 0.05);
  check_refused([&] { w.position(glued); }, "was removed");
}

TEST_CASE("a grain in the place of one that was lost is reported when it is lost") {
  dem::WorldOptions o = options(Vec3(0, 0, 0), 1e-5);
  o.domain = {{Vec3(-1, -1, -1), Vec3(1, 1, 1)}};
  dem::World<Balls> w(o);
  w.set_contact(sand<Balls>());
  const auto ball = w.add_species(Sphere(1e-3));
  std::set<GrainId> lost;
  for (int k = 0; k < 3; ++k) {
    const auto p = w.add_grain({ball, Vec3(0.9999, 0, 0), Vec3(10, 0, 0)});
    CHECK(p.slot == 0);
    CHECK(p.index() == static_cast<std::size_t>(k));
    const auto report = w.run(100);
    REQUIRE(report.problem == dem::StepReport::Problem::lost);
    CHECK(report.grain == p);
    lost.insert(report.grain);
    w.remove_grain(p);
    REQUIRE(w.run(1));
  }
  CHECK(lost.size() == 3);
}

TEST_CASE("the place of a grain is used again only after a step") {
  // Until then the energies that are counted, the parts and the sleepers still know the grain that had it.
  dem::World<Balls> w(options(Vec3::Zero(), 1e-5));
  w.set_contact(sand<Balls>());
  const auto ball = w.add_species(Sphere(1e-3));
  const auto a = w.add_grain({ball, Vec3(0, 0, 0)});
  w.add_grain({ball, Vec3(0.1, 0, 0)});
  count_energy(w);
  w.remove_grain(a);
  w.prepare();  // lists neighbours anew
  CHECK(w.add_grain({ball, Vec3(0.2, 0, 0)}).slot == 2);
  REQUIRE(w.run(1));
  const auto again = w.add_grain({ball, Vec3(0.3, 0, 0), Vec3(1, 0, 0)});
  CHECK(again.slot == a.slot);
  CHECK(again.index() == 3);
  REQUIRE(w.run(10));
  const auto e = energy_of(w);
  CHECK(e.came == Approx(e.translation).epsilon(1e-12));
}
