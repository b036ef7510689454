// Spheres, or cubes of eight spheres, settle in a long box, shared by as many processes as mpirun starts. Prints what
// sharing costs, and a hash of the state, which is the same for any number of processes and threads.
//
//   mpirun -np 4 settle_ranks --shape cubes --grains 20000 --settle 3000 --steps 300 --threads 1 --output out
//
// Writes settled.csv: positions and speeds of the grains, once, whatever the number of processes. With --bed bed.h5 the
// settled bed is kept in that file (needs HDF5). If it is there the bed is taken from it and does not settle, with as
// many processes as you like. All must see the file. --settle-gravity 98.1 (m/s^2) makes grains settle in fewer steps.

#include "arguments.hpp"

#include <dem/dem.hpp>
#include <dem/domain/ranks.hpp>
#include <dem/io/checkpoint/world_columns.hpp>
#include <dem/io/csv.hpp>

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
void settle(const typename Model::Shape& grain, Arguments& arguments) {
  const int grains = static_cast<int>(arguments.number("--grains", 20000, "how many"));
  const int settle = static_cast<int>(arguments.number("--settle", 3000, "steps to settle"));
  const int steps = static_cast<int>(arguments.number("--steps", 300, "steps that are timed"));
  const int threads = static_cast<int>(arguments.number("--threads", 0, "of each process; 0: all"));
  const double settle_gravity = arguments.number("--settle-gravity", 9.81, "while grains settle [m/s^2]");
  const std::filesystem::path bed = arguments.take("--bed", "", "file that the settled bed is taken from, or kept in");
  const std::filesystem::path folder = arguments.take("--output", "settle_ranks_output", "folder for settled.csv");
  arguments.check();

  const double pitch = 2.2 * grain.bounding_radius();  // m
  World<Model> world({.threads = threads});
  world.set_contact({.normal = contact::LinearSpringDashpot::with_restitution(1000, 0.5), .friction = {0.4, 700, 0.1}});
  // Ten times as long as wide, some 20 grains deep.
  const int across = std::max(3, static_cast<int>(std::sqrt(grains / 200.0))), along = 10 * across;
  const double width = across * pitch, length = along * pitch;
  const auto wall = [&](const Vec3& middle, const Vec3& edges) {
    world.add_surface(world.ground(), surface::Box(edges), {.position = middle});
  };
  const double t = 0.01, h = 0.2;
  wall({length / 2, width / 2, -t / 2}, {length + 2 * t, width + 2 * t, t});
  for (const double side : {0.0, 1.0}) {
    wall({side * length + (side - 0.5) * t, width / 2, h / 2}, {t, width + 2 * t, h});
    wall({length / 2, side * width + (side - 0.5) * t, h / 2}, {length + 2 * t, t, h});
  }
  const SpeciesId species = world.add_species(grain, {.density = 2500});
  for (int k = 0; k < grains; ++k) {
    const int i = k % along, j = k / along % across, level = k / (along * across);
    const double shake = 0.04 * std::sin(12.9898 * k);
    world.add_grain({.species = species,
                     .position = pitch * Vec3(i + 0.5 + shake, j + 0.5 - shake, level + 0.5),
                     .rotation = Quaternion(1, 20 * shake, 0.3, -10 * shake).normalized().toRotationMatrix()});
  }

  const auto run = [&](int n) {
    const StepReport report = world.run(static_cast<std::uint64_t>(n));
    if (!report) fail("{}", report.text);
  };
  // More than the Earth's gravity saves steps; a fifth of them are done under that.
  const auto come_to_rest = [&] {
    world.set_gravity({0, 0, -settle_gravity});
    run(settle - settle / 5);
    world.set_gravity({0, 0, -9.81});
    run(settle / 5);
  };
#ifdef DEM_WITH_HDF5
  if (processes.of_first(!bed.empty() && exists(bed))) {
    load(world, bed);
    if (world.grain_count() != static_cast<std::size_t>(grains)) {
      fail("--bed {} has {} grains, but --grains is {}; give --grains {}", bed.string(), world.grain_count(), grains,
           world.grain_count());
    }
  } else {
    come_to_rest();
    if (!bed.empty()) save(world, bed);
  }
#else
  if (!bed.empty()) fail("--bed: this program was built without HDF5, which it needs to keep a bed");
  come_to_rest();
#endif
  const domain::Traffic before = world.state().domain.traffic();
  const std::uint64_t lists_before = world.state().rebuilds;
  const auto start = std::chrono::steady_clock::now();
  run(steps);
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
