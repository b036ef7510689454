#include <dem/io/checkpoint.hpp>
#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/machine_columns.hpp>

#include <array>
#include <filesystem>

#include "catch.hpp"
#include "worlds.hpp"

using namespace dem;
namespace ground = dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

ground::ColumnsSpec sledge_bed() {
  return {.low_x = 0,
          .low_y = -0.2,
          .length_x = 1.6,
          .length_y = 0.4,
          .spacing = 0.02,
          .soil = ground::melanz_sand,
          .damping = 2e4,
          .bulldozing = 0.5};
}

/// A sledge of two runners that a spring draws over soil, and a ball that falls on it.
template <class Mechanism>
BodyId add_sledge(Mechanism& machine, ground::MachineColumns& soil) {
  const BodyId body = machine.add_body(mbd::box_body("sledge", {0.2, 0.2, 0.1}, 1500.0).at({0.2, 0, 0.051}));
  const auto runner = std::make_shared<ground::ColumnBox>(Vector3<double>{0.2, 0.05, 0.01});
  soil.add(body, runner, {0.2, -0.07, 0.006});
  soil.add(body, runner, {0.2, 0.07, 0.006});
  machine.add_spring(mbd::spring("rope", machine.ground(), {1.2, 0, 0.05}, body, {0.3, 0, 0.05}, 300.0, 0.0, 0.3));
  return body;
}

template <class Model>
struct SledgeWorld {
  World<Model> world{{.time_step = 2e-4}};
  ground::MachineColumns soil;
  BodyId sledge;

  explicit SledgeWorld(int substeps = 1, const ground::ColumnsSpec& spec = sledge_bed())
      : soil(world.add_soil_columns(spec)), sledge(add_sledge(world.machine(), soil)) {
    world.machine().substeps = substeps;
    world.machine().most_substeps = substeps;
    const SpeciesId ball = world.add_species(shape::Sphere(0.01), {.density = 2500});
    world.set_contact({.normal = {1e4, 1.0, 1.0}, .friction = {}});
    world.add_surface(sledge, surface::Box({0.2, 0.2, 0.1}));
    world.add_grain({.species = ball, .position = Vec3(0.25, 0.01, 0.13)});
  }
};

}  // namespace

TEST_CASE("a machine in a world feels soil columns as one alone does, with sub-steps and either kind of integrator") {
  mbd::Machine<integrator::VelocityVerlet> alone;
  ground::MachineColumns alone_soil(alone, sledge_bed());
  const BodyId there = add_sledge(alone, alone_soil);
  REQUIRE(alone.run(0.4, 2e-4));
  const double way = alone.body(there).position().x() - 0.2;
  CHECK(way > 0.05);
  const auto check = [&]<class Model>(Model, int substeps) {
    SledgeWorld<Model> w(substeps);
    REQUIRE(w.world.run_for(0.4));
    // The ball weighs a thousandth of the sledge, and soil that is first touched answers with a jump: first order.
    CHECK(w.world.machine().body(w.sledge).position().x() - 0.2 == Approx(way).epsilon(0.02));
    CHECK(w.soil.soil().steps() == 2000u * static_cast<unsigned>(substeps));  // a trial is not kept
    CHECK(w.soil.report().ok);
  };
  check(models::VerletBalls{}, 1);
  check(models::VerletBalls{}, 2);
  check(models::CorrectedBalls{}, 1);
  check(models::CorrectedBalls{}, 2);
}

TEST_CASE("soil columns are part of a world's saved state, to the bit, on any number of threads") {
  const auto run = []<class Model>(Model, int substeps) {
    SledgeWorld<Model> whole(substeps);
    whole.soil.soil().set_threads(1);
    REQUIRE(whole.world.run(1000));
    const auto path = std::filesystem::temp_directory_path() / "dem_soil_columns.h5";
    save(whole.world, path);
    REQUIRE(whole.world.run(700));
    SledgeWorld<Model> again(substeps);
    again.soil.soil().set_threads(3);
    load(again.world, path);
    std::filesystem::remove(path);
    REQUIRE(again.world.run(700));
    auto ours = io::columns_of(whole.world), theirs = io::columns_of(again.world);
    CHECK(io::differences(ours, theirs).empty());
    CHECK(again.soil.soil().field().sunk == whole.soil.soil().field().sunk);
    CHECK(again.soil.soil().field().heap == whole.soil.soil().field().heap);
  };
  run(models::VerletBalls{}, 1);
  run(models::CorrectedBalls{}, 2);
}

TEST_CASE("a copied world has columns of its own, and its handle is that of the copy") {
  SledgeWorld<models::VerletBalls> first;
  REQUIRE(first.world.run(200));
  auto copy = first.world;
  ground::MachineColumns soil = first.soil.of(copy.machine());
  const double before = first.soil.soil().field().sunk[first.soil.soil().field().grid.row(10, 6)];
  REQUIRE(copy.run(1500));
  CHECK(soil.soil().steps() == 1700);
  CHECK(first.soil.soil().steps() == 200);
  CHECK(first.soil.soil().field().sunk[first.soil.soil().field().grid.row(10, 6)] == before);
  REQUIRE(first.world.run(1500));
  CHECK(first.soil.soil().field().sunk == soil.soil().field().sunk);
  mbd::Mechanism bare;
  CHECK_THROWS_WITH(first.soil.of(bare), ContainsSubstring("terrain 0 is asked for"));
}

TEST_CASE("a state of other soil columns is refused in words, and a part that leaves them is told of") {
  SledgeWorld<models::VerletBalls> world;
  REQUIRE(world.world.run(10));
  auto state = io::columns_of(world.world);
  auto other_spec = sledge_bed();
  other_spec.soil.shear.cohesion = 200.0;
  SledgeWorld<models::VerletBalls> other(1, other_spec);
  CHECK_THROWS_WITH(io::restore(other.world, state), ContainsSubstring("terrain 'terrain 0'") &&
                                                         ContainsSubstring("cohesion 139.28") &&
                                                         ContainsSubstring("cohesion 200"));
  auto short_bed = sledge_bed();
  short_bed.length_x = 0.31;  // the runners end at 0.3
  SledgeWorld<models::VerletBalls> leaving(1, short_bed);
  REQUIRE(leaving.world.run(1).note.empty());
  const StepReport left = leaving.world.run_for(0.3);
  CHECK(left.problem == StepReport::Problem::machine);
  CHECK_THAT(left.text, ContainsSubstring("body 'sledge' leaves the soil") && !ContainsSubstring("; body"));
  SledgeWorld<models::VerletBalls> again(1, short_bed);
  state = io::columns_of(leaving.world);
  io::restore(again.world, state);
  const StepReport report = leaving.world.run_for(0.1);
  CHECK(report);  // it goes on, without soil
  CHECK_THAT(report.note, ContainsSubstring("leaves the soil"));
  CHECK_FALSE(leaving.soil.report().ok);
  CHECK(again.world.run_for(0.1));  // what was told is part of the state
  auto ours = io::columns_of(leaving.world), theirs = io::columns_of(again.world);
  CHECK(io::differences(ours, theirs).empty());
}
