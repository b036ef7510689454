// n steps, a file, and n more steps are 2n steps: every column of the state is the same in every bit.

#include "scenes_to_save.hpp"

#include <dem/world/contacts.hpp>
#include <dem/world/energy.hpp>

#include <algorithm>

namespace exact_test {

namespace {

using namespace models;

template <class Model>
dem::ContactParameters<Model> constants() {
  if constexpr (std::is_same_v<Model, LinearModel>) {
    return {.normal = Linear::with_restitution(2000.0, 0.6), .friction = {0.4, 1500.0, 0.1}};
  } else if constexpr (std::is_same_v<Model, HertzModel>) {
    const auto pair = dem::contact::elastic_pair({.young = 2e6, .poisson = 0.25});
    return {.normal = dem::contact::Hertz::with_restitution(pair, 0.6),
            .friction = dem::friction::Mindlin::with_restitution(pair, 0.4, 0.6)};
  } else {
    return sand<Model>();
  }
}
template <class Model>
std::vector<typename Model::Shape> shapes() {
  if constexpr (std::is_same_v<typename Model::Shape, Sphere>) return {Sphere(1.2e-3), Sphere(1e-3)};
  else return {dem::shape::cube8(1e-3), dem::shape::cube8(0.8e-3)};
}
template <class Model>
Scene<Model> scene(const SceneOptions& o, bool has_grains = true) {
  return Scene<Model>(o, constants<Model>(), shapes<Model>(), has_grains);
}

/// What a program keeps beside its world.
struct Progress {
  std::uint64_t rows = 0;
  std::vector<double> samples;
  std::string stage;
  template <class V>
  void fields(V& v) {
    v("rows", rows), v("samples", samples, "N"), v("stage", stage);
  }
};

}  // namespace

TEMPLATE_TEST_CASE("n steps, a file and n steps on other threads are 2n steps in every bit", "", CorrectedBalls, Balls,
                   VerletBalls, Cubes, VerletCubes, LinearModel, HertzModel, HeldBalls) {
  const Folder folder;
  const int substeps = GENERATE(1, 3);
  CAPTURE(substeps);
  constexpr std::uint64_t n = 800;
  auto whole = scene<TestType>({.threads = 1, .substeps = substeps});
  auto first = scene<TestType>({.threads = 2, .substeps = substeps});
  whole.run(2 * n);
  first.run(n);
  if constexpr (std::is_same_v<TestType, VerletBalls>) {  // some contacts stick, and some slip
    int slipping = 0, all = 0;
    for (const auto& contact : dem::contacts_of(first.world)) {
      slipping += contact.tangential_force().norm() > 0.999 * 0.4 * contact.normal_force() ? 1 : 0;
      ++all;
    }
    CHECK(slipping > 3);
    CHECK(all - slipping > 3);
  }
  dem::save(first.world, folder / "state.h5");
  auto second = scene<TestType>({.threads = 3, .substeps = substeps}, false);
  dem::load(second.world, folder / "state.h5");
  CHECK(difference(first.world, second.world) == "");
  second.run(n);
  CHECK(difference(whole.world, second.world) == "");
  // There is something that could be forgotten: contacts that remember, lists that were made anew, parts that push.
  const auto columns = dem::io::columns_of(whole.world);
  CHECK(columns.at("contacts/pairs/key").rows() > 20);
  CHECK(columns.at("contacts/surfaces/key").rows() > 5);
  CHECK(whole.contacts_of_bodies > 0);
  CHECK(whole.world.state().rebuilds > 3);
  const auto& parts = whole.world.machine().parts();
  CHECK(parts.friction[0].force.x * parts.friction[0].force.x +
            parts.friction[0].torque.y * parts.friction[0].torque.y >
        0);
  CHECK(parts.couplings[0].multiplier != 0.0);
  CHECK(parts.springs[0].force != 0.0);
}

TEST_CASE("a state may be saved between any two steps, and in the middle of what is done by hand") {
  const Folder folder;
  auto whole = scene<Cubes>({}), pieces = scene<Cubes>({});
  const auto go_through_file = [&] {
    dem::save(pieces.world, folder / "state.h5");
    auto next = scene<Cubes>({}, false);
    dem::load(next.world, folder / "state.h5");
    pieces.world = std::move(next.world);
  };
  go_through_file();  // before the first step
  for (int k = 0; k < 40; ++k) {
    for (auto* s : {&whole, &pieces}) REQUIRE(s->world.run(7 + static_cast<std::uint64_t>(k % 3)));
    go_through_file();
  }
  CHECK(difference(whole.world, pieces.world) == "");

  // Grains that came, went and were moved since the lists were made; a body that was fixed, a target that was set, and
  // a part of a step that is owed.
  for (auto* s : {&whole, &pieces}) {
    auto& w = s->world;
    w.remove_grain(GrainId(5));
    w.set_position(GrainId(9), {0.012, 0.010, 0.060});
    w.add_grain({.species = SpeciesId(0), .position = {0.014, 0.010, 0.065}});
    w.set_velocity(GrainId(3), {0, 0, 0.1});
    w.machine().set_fixed(w.machine().body_named("left disc"));
    w.machine().set_throttle(dem::ActuatorId(0), -0.2);
    w.machine().switch_on(dem::LoadId(0), false);
  }
  go_through_file();
  for (auto* s : {&whole, &pieces}) REQUIRE(s->world.run_for(100.3 * s->world.time_step()));
  go_through_file();
  for (auto* s : {&whole, &pieces}) REQUIRE(s->world.run_for(50.4 * s->world.time_step()));
  CHECK(whole.world.steps() == pieces.world.steps());
  CHECK(difference(whole.world, pieces.world) == "");
  CHECK(whole.world.grain_count() == pieces.world.grain_count());
  CHECK(error_of([&] { (void)pieces.world.position(GrainId(5)); }).find("was removed") != std::string::npos);
}

TEST_CASE("a bed in which some grains sleep goes on where it was saved, and the same with its energy counted") {
  // 64 towers of 9 cubes in three chunks, onto whose corner one more falls.
  const Folder folder;
  const dem::SleepOptions lax{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.01, .window = 40};
  const auto set_up = [&](dem::World<VerletCubes>& w) {
    w.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
    const SpeciesId cube = w.add_species(dem::shape::cube8(1e-3));
    w.add_surface(w.ground(), dem::surface::Plane{});
    return cube;
  };
  const auto with_sleep = [&](int threads) {
    dem::WorldOptions o = options({0.3, 0.1, -9.81});
    o.sleep = lax;
    o.threads = threads;
    return o;
  };
  dem::World<VerletCubes> whole(with_sleep(1)), pieces(with_sleep(2)), counted(with_sleep(1));
  for (auto* w : {&whole, &pieces, &counted}) {
    const SpeciesId cube = set_up(*w);
    for (int k = 0; k < 576; ++k) {
      w->add_grain({cube, Vec3(2.2e-3 * (k / 9 % 8), 2.2e-3 * (k / 72), 1e-3 + 2e-3 * (k % 9))});
    }
    REQUIRE(w->run(1500));
    w->add_grain({cube, Vec3(1e-4, 0, 0.0192), {0.05, 0, -0.3}});
  }
  const auto go_through_file = [&] {
    dem::save(pieces, folder / "state.h5");
    dem::World<VerletCubes> next(with_sleep(1));
    set_up(next);
    dem::load(next, folder / "state.h5");
    pieces = std::move(next);
  };
  int mixed = 0;
  for (int k = 0; k < 60; ++k) {
    if (k == 20) dem::count_energy(counted);
    for (auto* w : {&whole, &pieces, &counted}) {
      if (k == 30) w->set_velocity(GrainId(8), {0.05, 0, 0.1}), w->prepare();
      if (k == 40) w->remove_grain(GrainId(300));
    }
    if (k % 2 == 0) go_through_file();
    for (auto* w : {&whole, &pieces, &counted}) REQUIRE(w->run(13 + k % 5));
    mixed += whole.asleep_count() > 0 && whole.asleep_count() + 1 < whole.grain_count() ? 1 : 0;
    REQUIRE(pieces.asleep_count() == whole.asleep_count());
    CHECK(difference(whole, pieces) == "");
  }
  CHECK(mixed > 20);
  for (const GrainId p : whole.grains()) CHECK(counted.position(p) == whole.position(p));

  // Contacts of chunks that sleep are not evaluated any more, but still counted.
  REQUIRE(counted.run(3000));
  const auto& chunks = counted.state().chunks;
  REQUIRE(std::any_of(chunks.begin(), chunks.end(), [](const auto& c) { return c.asleep; }));
  dem::save(counted, folder / "counted.h5");
  dem::World<VerletCubes> again(with_sleep(1));
  set_up(again);
  dem::count_energy(again);
  dem::load(again, folder / "counted.h5");
  for (auto* w : {&counted, &again}) REQUIRE(w->run(1));
  CHECK(difference(counted, again) == "");
}

TEST_CASE("energy that is counted goes on where it was saved") {
  const Folder folder;
  auto whole = scene<HertzModel>({}), first = scene<HertzModel>({});
  for (auto* s : {&whole, &first}) dem::count_energy(s->world);
  whole.run(600);
  first.run(300);
  dem::save(first.world, folder / "state.h5");
  auto second = scene<HertzModel>({}, false);
  dem::count_energy(second.world);
  dem::load(second.world, folder / "state.h5");
  second.run(300);
  CHECK(difference(whole.world, second.world) == "");
  CHECK(dem::energy_of(whole.world).dissipated() > 0.0);
  CHECK(dem::energy_of(second.world).balance() == dem::energy_of(whole.world).balance());
  // A program that does not count is told so.
  auto third = scene<HertzModel>({}, false);
  CHECK(error_of([&] { dem::load(third.world, folder / "state.h5"); }).find("energy") != std::string::npos);
}

TEST_CASE("a state of a model with something more is refused, and leaves the world as it is") {
  auto held = scene<HeldBalls>({});
  held.run(10);
  auto columns = dem::io::columns_of(held.world);
  auto penalty = scene<VerletBalls>({}, false);
  const auto before = dem::io::hash_of(dem::io::columns_of(penalty.world));
  CHECK(error_of([&] {
          dem::io::restore(penalty.world, columns);
        }).find("the model that was saved has joints = mbd::Projected, and this program's has the default") !=
        std::string::npos);
  CHECK(dem::io::hash_of(dem::io::columns_of(penalty.world)) == before);
}

TEST_CASE("what else a program keeps is saved with its world") {
  const Folder folder;
  auto one = scene<Balls>({});
  one.run(10);
  dem::save(one.world, folder / "state.h5", Progress{7, {1.5, -0.0}, "shear"});
  auto other = scene<Balls>({}, false);
  Progress progress;
  dem::load(other.world, folder / "state.h5", progress);
  CHECK(progress.rows == 7);
  CHECK(progress.samples == std::vector<double>{1.5, 0.0});
  CHECK(std::signbit(progress.samples[1]));
  CHECK(progress.stage == "shear");
  // A program that does not know of it is told so.
  auto third = scene<Balls>({}, false);
  const auto before = dem::io::hash_of(dem::io::columns_of(third.world));
  CHECK(error_of([&] {
          dem::load(third.world, folder / "state.h5");
        }).find("1 things were saved besides the world, but this program gives load 0") != std::string::npos);
  Progress another;
  CHECK(error_of([&] {
          dem::load(third.world, folder / "state.h5", progress, another);
        }).find("1 things were saved besides the world, but this program gives load 2") != std::string::npos);
  CHECK(dem::io::hash_of(dem::io::columns_of(third.world)) == before);  // it is left as it is
}

}  // namespace exact_test
