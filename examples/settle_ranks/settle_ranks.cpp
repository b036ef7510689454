// Spheres, or cubes of eight spheres, settle in a long box, shared by as many processes as mpirun starts. Prints what
// sharing costs, and a hash of the state, which is the same for any number of processes and threads.
//
//   mpirun -np 4 settle_ranks --shape cubes --grains 20000 --settle 3000 --steps 300 --threads 1 --output out
//
// Writes settled.csv: positions and speeds of the grains, once, whatever the number of processes. With --bed bed.h5 the
// settled bed is kept in that file (needs HDF5). If it is there the bed is taken from it and does not settle, with as
// many processes as you like. All must see the file. --settle-gravity 98.1 (m/s^2) makes grains settle in fewer steps.
// --tiles 10: a tenth of the bed settles, repeating itself, and is laid ten times, so that a large bed is at rest soon.
// A bed of tiles that was kept wants the same --tiles.

#include "arguments.hpp"

#include <dem/dem.hpp>
#include <dem/domain/periodic_ranks.hpp>
#include <dem/domain/ranks.hpp>
#include <dem/io/checkpoint/world_columns.hpp>
#include <dem/io/csv.hpp>
#include <dem/soil/lay_tiles.hpp>

#ifdef DEM_WITH_HDF5
#include <dem/io/checkpoint.hpp>
#endif

#include <chrono>
#include <cmath>
#include <filesystem>

using namespace dem;

struct Beads : Model {
  using Normal = contact::LinearSpringDashpot;
  using Friction = friction::CundallStrack;
  using Integrator = integrator::VelocityVerlet;
  using Domain = domain::Ranks;
};

struct Dice : Beads {
  using Shape = shape::SphereCluster<8>;
};

template <class Model>
struct Repeated : Model {
  using Domain = domain::PeriodicRanks;
};

template <class Model>
void settle(const typename Model::Shape& grain, Arguments& arguments) {
  const int grains = static_cast<int>(arguments.number("--grains", 20000, "how many"));
  const int settle = static_cast<int>(arguments.number("--settle", 3000, "steps to settle"));
  const int steps = static_cast<int>(arguments.number("--steps", 300, "steps that are timed"));
  const int threads = static_cast<int>(arguments.number("--threads", 0, "of each process; 0: all"));
  const double settle_gravity = arguments.number("--settle-gravity", 9.81, "while grains settle [m/s^2]");
  const int tiles =
      static_cast<int>(arguments.number("--tiles", 0, "0, or how many tiles the bed is laid of, of which one settles"));
  const std::filesystem::path bed = arguments.take("--bed", "", "file that the settled bed is taken from, or kept in");
  const std::filesystem::path folder = arguments.take("--output", "settle_ranks_output", "folder for settled.csv");
  arguments.check();

  const double pitch = 2.2 * grain.bounding_radius();  // m
  // Ten times as long as wide, some 20 grains deep.
  const int across = std::max(3, static_cast<int>(std::sqrt(grains / 200.0))), along = 10 * across;
  const double width = across * pitch, length = along * pitch;
  if (tiles < 0 || (tiles > 0 && (along % tiles != 0 || grains % tiles != 0 || along / tiles < 3))) {
    fail("--tiles {} must divide the bed's length, {} grains, into tiles of 3 at least, and --grains, {}", tiles, along,
         grains);
  }

  // Floor and walls; those at the ends only where the bed has no tiles, which hold themselves there.
  const auto set_up = [&](auto& world) {
    world.set_contact(
        {.normal = contact::LinearSpringDashpot::with_restitution(1000, 0.5), .friction = {0.4, 700, 0.1}});
    const auto wall = [&](const char* name, const Vec3& at, const Vec3& normal) {
      const Mat3 rotation = Quaternion::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
      world.add_surface(world.ground(), surface::Plane{}, {.name = name, .position = at, .rotation = rotation});
    };
    wall("floor", Vec3::Zero(), Vec3::UnitZ());
    wall("right", Vec3::Zero(), Vec3::UnitY());
    wall("left", {0, width, 0}, -Vec3::UnitY());
    if (tiles == 0) {
      wall("back", Vec3::Zero(), Vec3::UnitX());
      wall("front", {length, 0, 0}, -Vec3::UnitX());
    }
    world.add_species(grain, {.density = 2500});
  };
  // n grains in layers of `row` times across.
  const auto pour = [&](auto& world, int n, int row) {
    for (int k = 0; k < n; ++k) {
      const int i = k % row, j = k / row % across, level = k / (row * across);
      const double shake = 0.04 * std::sin(12.9898 * k);
      world.add_grain({.species = SpeciesId(0),
                       .position = pitch * Vec3(i + 0.5 + shake, j + 0.5 - shake, level + 0.5),
                       .rotation = Quaternion(1, 20 * shake, 0.3, -10 * shake).normalized().toRotationMatrix()});
    }
  };
  const auto run = [](auto& world, int n) {
    const StepReport report = world.run(static_cast<std::uint64_t>(n));
    if (!report) fail("{}", report.text);
  };
  // More than the Earth's gravity saves steps; a fifth of them are done under that.
  const auto come_to_rest = [&](auto& world) {
    world.set_gravity({0, 0, -settle_gravity});
    run(world, settle - settle / 5);
    world.set_gravity({0, 0, -9.81});
    run(world, settle / 5);
  };
  World<Model> world({.threads = threads});
  set_up(world);
  if (tiles > 0) held_twin(world, SpeciesId(0));  // of grains at both ends
  const auto fill = [&] {
    if (tiles == 0) {
      pour(world, grains, along);
      return come_to_rest(world);
    }
    World<Repeated<Model>> cell(
        {.domain = {{{0, 0, -1}, {length / tiles, width, 1}}}, .periodic = {.x = true}, .threads = threads});
    set_up(cell);
    pour(cell, grains / tiles, along / tiles);
    come_to_rest(cell);
    soil::lay_tiles(world, soil::take_tile(cell), {.along_x = tiles, .rim = 2.0 * pitch});
    run(world, 1);  // finds the first forces
  };
#ifdef DEM_WITH_HDF5
  if (processes.of_first(!bed.empty() && exists(bed))) {
    load(world, bed);
    if (world.grain_count() != static_cast<std::size_t>(grains)) {
      fail("--bed {} has {} grains, but --grains is {}; give --grains {}", bed.string(), world.grain_count(), grains,
           world.grain_count());
    }
  } else {
    fill();
    if (!bed.empty()) save(world, bed);
  }
#else
  if (!bed.empty()) fail("--bed: this program was built without HDF5, which it needs to keep a bed");
  fill();
#endif
  const domain::Traffic before = world.state().domain.traffic();
  const std::uint64_t lists_before = world.state().rebuilds;
  const auto start = std::chrono::steady_clock::now();
  run(world, steps);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const domain::Traffic after = world.state().domain.traffic();
  const auto& d = world.state().domain;
  const double most_bytes = d.largest(static_cast<double>(after.step_bytes - before.step_bytes));
  const double most_for_lists = d.largest(static_cast<double>(after.list_bytes - before.list_bytes));
  const auto lists = static_cast<double>(world.state().rebuilds - lists_before);
  const double wait = after.step_seconds - before.step_seconds;
  const double most_wait = d.largest(wait), least_wait = -d.largest(-wait), mean_wait = d.total(wait) / d.ranks();
  double contacts = 0.0;
  for (std::size_t c = d.own().first; c < d.own().second; ++c) {
    const auto& chunk = world.state().chunks[c];
    contacts += chunk.pair_contacts.committed() + chunk.surface_contacts.committed();
  }
  contacts = d.total(contacts);
  fmt::print(
      "{} grains, {} ranks of {} threads, {} steps in {:.2f} s: {:.3g} grain steps a second, {:.2f} contacts a grain\n",
      grains, d.ranks(), world.threads(), steps, seconds, grains * double(steps) / seconds, contacts / grains);
  fmt::print(
      "exchange: {:.0f} bytes a step and rank at the most, {:.1f} % of the time in steps (mean of the ranks {:.1f}, "
      "least "
      "{:.1f}), {:.1f} % for lists\n",
      most_bytes / steps, 100 * most_wait / seconds, 100 * mean_wait / seconds, 100 * least_wait / seconds,
      100 * (after.list_seconds - before.list_seconds) / seconds);
  fmt::print("{:.0f} lists, {:.0f} bytes a list and rank at the most, the end of the run included\n", lists,
             most_for_lists / std::max(1.0, lists));
  fmt::print("counted work of the busiest rank: {:.3f} of the mean\n", after.imbalance);
  fmt::print("state {:016x}\n", io::hash_of(io::columns_of(world)));

  io::CsvWriter csv(folder / "settled.csv", {"x_m", "y_m", "z_m", "speed_m_per_s"});
  for (const GrainId p : world.grains()) {
    const Vec3 x = world.position(p);
    csv.row(x.x(), x.y(), x.z(), world.velocity(p).norm());
  }
  csv.flush();
}

void simulate(Arguments& arguments) {
  const std::string kind = arguments.take("--shape", "spheres", "spheres or cubes");
  if (kind == "spheres") settle<Beads>(shape::Sphere(1e-3), arguments);
  else if (kind == "cubes") settle<Dice>(shape::cube8(0.6e-3), arguments);
  else fail("--shape is '{}', but must be spheres or cubes", kind);
}

int main(int argc, char** argv) {
  const domain::Session mpi(argc, argv);
  return run_example(argc, argv, "Grains settle in a long box, shared by as many processes as mpirun starts", simulate);
}
