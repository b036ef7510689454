#include "core/error_of.hpp"
#include "scenes.hpp"
#include "state_hash.hpp"

#include <functional>

// What is changed from within a run, by the function that is asked after each step, acts as what is changed between
// runs.

using Catch::Approx;
using dem::BodyId;
using dem::mbd::box_body;

namespace on_the_way {

/// Balls in a row on a floor, and a body high above them.
template <class Model>
struct Row {
  dem::World<Model> world;
  SpeciesId ball;
  BodyId block;

  explicit Row(double time_step = 0.0) : world(options({0, 0, -g}, time_step)) {
    world.set_contact(sand<Model>());
    ball = world.add_species(models::Sphere(2e-3));
    world.add_surface(world.ground(), dem::surface::Plane{});
    for (int k = 0; k < 20; ++k) world.add_grain({ball, Vec3(3.99e-3 * k, 0, 2e-3)});
    block = world.machine().add_body(box_body("block", {0.02, 0.02, 0.02}, 1000).at({0, 0, 1}));
  }
};
template <class Model>
using Change = std::function<void(Row<Model>&)>;

template <class Model>
std::string changed_between_runs(const Change<Model>& change) {
  Row<Model> row;
  REQUIRE(row.world.run(100));
  change(row);
  REQUIRE(row.world.run(200));
  return hash_of(row.world);
}
template <class Model>
std::string changed_within_a_run(const Change<Model>& change, bool prepares) {
  Row<Model> row;
  int n = 0;
  REQUIRE(row.world.run(300, [&] {
    if (++n != 100) return true;
    change(row);
    if (prepares) row.world.prepare();
    return true;
  }));
  return hash_of(row.world);
}

template <class Model>
std::vector<Change<Model>> changes() {
  return {
      [](Row<Model>& row) {
        row.world.machine().add_body(box_body("another", {0.02, 0.02, 0.02}, 1000).at({0, 1, 1}));
      },
      [](Row<Model>& row) {
        auto& m = row.world.machine();
        m.add_joint(dem::mbd::revolute("hinge", m.ground(), row.block, {0.1, 0, 1}, {0, 1, 0}));
      },
      [](Row<Model>& row) {
        row.world.set_contact({{2e5, 0.015, 0.05}, {0.4, 2e5, 0.015, 0.975}});
      },
      [](Row<Model>& row) {
        const SpeciesId dust = row.world.add_species(models::Sphere(2e-4));
        row.world.add_grain({dust, Vec3(0, 0, 0.02)});
      },
      [](Row<Model>& row) {
        row.world.add_surface(row.block, dem::surface::Box({0.02, 0.02, 0.02}));
      },
  };
}

template <class Model>
void stiffen(Row<Model>& row) {
  row.world.set_contact({{2e5, 0.015, 0.05}, {0.4, 2e5, 0.015, 0.975}});
}

/// The speed of a block that has fallen on balls, in sub-steps, while a ball far away is pushed after each step.
enum class Push { never, within_a_run, between_runs };
template <class Model>
double speed_of_block(Push push) {
  dem::World<Model> w(options({0, 0, -g}, 1e-5));
  w.set_contact({{2e4, 0.0, 1.0}, {0.0, 2e4, 0.0, 1.0}});
  const SpeciesId ball = w.add_species(models::Sphere(2e-3));
  w.add_surface(w.ground(), dem::surface::Plane{});
  for (const double x : {-5e-3, 5e-3})
    for (const double y : {-5e-3, 5e-3}) w.add_grain({ball, Vec3(x, y, 2e-3)});
  const GrainId lone = w.add_grain({ball, Vec3(0.5, 0, 0.5)});
  auto& m = w.machine();
  const BodyId block = m.add_body(box_body("block", {0.02, 0.02, 0.02}, 1000).at({0, 0, 0.015}));
  m.add_joint(dem::mbd::prismatic("guide", m.ground(), block, {0, 0, 0}, {0, 0, 1}));
  m.substeps = 10;
  w.add_surface(block, dem::surface::Box({0.02, 0.02, 0.02}));
  const auto steer = [&] {
    if (push != Push::never) w.set_velocity(lone, {0.1, 0, 0});
    return true;
  };
  if (push == Push::between_runs) {
    for (int k = 0; k < 2000; ++k) {
      REQUIRE(w.run(1));
      steer();
    }
  } else {
    REQUIRE(w.run(2000, steer));
  }
  CHECK(m.substeps == 10);
  return m.body(block).velocity().z();
}

}  // namespace on_the_way

using namespace on_the_way;

TEMPLATE_TEST_CASE("what is changed within a run acts as what is changed between runs, to the bit", "", Balls,
                   models::VerletBalls, models::CorrectedBalls) {
  for (const auto& change : changes<TestType>()) {
    const std::string between = changed_between_runs<TestType>(change);
    CHECK(changed_within_a_run<TestType>(change, false) == between);
    CHECK(changed_within_a_run<TestType>(change, true) == between);
  }
}

TEMPLATE_TEST_CASE("a grain that is steered far away leaves a machine with sub-steps as it is", "", Balls,
                   models::VerletBalls) {
  const double untouched = speed_of_block<TestType>(Push::never);
  CHECK(std::abs(untouched) > 1e-3);
  CHECK(speed_of_block<TestType>(Push::within_a_run) == Approx(untouched).epsilon(1e-9));
  CHECK(speed_of_block<TestType>(Push::between_runs) == Approx(untouched).epsilon(1e-9));
}

TEST_CASE("a joint that is added within a run holds") {
  Row<Balls> row;
  auto& m = row.world.machine();
  dem::JointId hinge;
  REQUIRE(row.world.run_for(0.1, [&] {
    if (!hinge.valid()) {
      hinge = m.add_joint(dem::mbd::revolute("hinge", m.ground(), row.block, {0.1, 0, 1}, {0, 1, 0}));
    }
    return true;
  }));
  CHECK(m.violation(hinge).displacement < 1e-4);
}

TEST_CASE("a time span is as long as it was asked for when its steps become shorter on the way") {
  for (const bool prepares : {false, true}) {
    Row<Balls> row;
    row.world.prepare();
    const double first = row.world.time_step();
    bool changed = false;
    REQUIRE(row.world.run_for(0.02, [&] {
      if (changed || row.world.time() < 0.01) return true;
      stiffen(row);
      if (prepares) row.world.prepare();
      return changed = true;
    }));
    // As the square root of the stiffness, a hundred times of it; dampers, which are as they were, take less of it
    // then.
    CHECK(row.world.time_step() == Approx(0.1 * first).epsilon(0.1));
    CHECK(row.world.time() == Approx(0.02).margin(row.world.time_step()));
  }
}

TEST_CASE("a motion that would jump is refused when it is given within a run") {
  Row<Balls> row;
  auto& m = row.world.machine();
  const auto hinge = m.add_joint(dem::mbd::revolute("hinge", m.ground(), row.block, {0, 0, 1}, {0, 1, 0}));
  const auto drive = m.add_motion(dem::mbd::prescribed_joint("drive", hinge, dem::mbd::Signal::ramp(0, 1)));
  check_refused(
      [&] {
        (void)row.world.run(10, [&] {
          m.set_motion(drive, 2.0);
          return true;
        });
      },
      "'drive'");
}

TEST_CASE("a change within a run that makes no sense is refused, and the world goes on without it") {
  Row<Balls> row(2e-5);
  bool changed = false;
  check_refused(
      [&] {
        (void)row.world.run(10, [&] {
          if (!changed) stiffen(row);
          return changed = true;
        });
      },
      "time step 2e-05 s is above the largest stable one");
  CHECK(row.world.steps() == 1);
  row.world.set_contact(sand<Balls>());
  CHECK(row.world.run(10));
  CHECK(row.world.steps() == 11);
}

TEST_CASE("a machine that makes the time step small is named") {
  Row<Balls> row;
  auto& m = row.world.machine();
  const auto hinge = m.add_joint(dem::mbd::revolute("hinge", m.ground(), row.block, {0, 0, 1}, {0, 1, 0}));
  const auto quiet = row.world.run(1);
  CHECK(quiet.note.empty());
  m.add_actuator(dem::mbd::joint_actuator("motor", hinge, 0.0, 10.0, dem::mbd::Signal::ramp(0, 1)));
  const auto report = row.world.run(1);
  CHECK_THAT(report.note, Catch::Matchers::ContainsSubstring("of what the contacts allow, because of"));
  CHECK_THAT(report.note, Catch::Matchers::ContainsSubstring("'motor'"));
}
