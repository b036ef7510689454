// How the chunks of a bed are best shared among ranks: the cut of dem's own order, which domain::Ranks makes, beside
// recursive coordinate bisection (RCB) and Hilbert's curve (HSFC) of Zoltan. A wheel rolls along a long bed of spheres;
// for each cut the imbalance of counted work and the bytes that ranks send each other in a step are printed; what all
// say together is not counted. Runs on one process.
//
//   partition --grains 60000 --settle 10000 --roll 4000 --sleep 1
//
// Zoltan: Devine et al., Computing in Science and Engineering 4(2), 2002. Debian: libtrilinos-zoltan-dev.

#include <dem/dem.hpp>
#include <dem/domain/cut.hpp>
#include <dem/report/ascii_table.hpp>
#include <dem/world/border.hpp>
#include <dem/world/gather.hpp>

#include <mpi.h>
#include <zoltan.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using dem::Vec3;

struct Beads : dem::Model {
  using Normal = dem::contact::LinearSpringDashpot;
  using Friction = dem::friction::CundallStrack;
  using Integrator = dem::integrator::VelocityVerlet;
};
using World = dem::World<Beads>;

struct Settings {
  std::size_t grains = 60'000;
  int settle = 10'000, roll = 4'000, sleep = 1;
};

constexpr double d = 4e-3, width = 0.12, radius = 0.08;  // m: of a sphere, of the bed, of the wheel

void run(World& world, int steps) {
  if (const auto report = world.run(static_cast<std::uint64_t>(steps)); !report) dem::fail("{}", report.text);
}

/// A bed ten times as long as wide, at rest but for where a wheel rolls through the middle of it.
World wheel_in_a_long_bed(const Settings& s) {
  World world({.time_step_safety = 0.8, .sleep = s.sleep ? std::optional(dem::SleepOptions{}) : std::nullopt});
  world.set_contact({.normal = dem::contact::LinearSpringDashpot::with_restitution(1000, 0.3),
                     .friction = {0.5, 2.0 / 7 * 1000, 0.1}});
  const auto across = static_cast<std::size_t>(width / (1.1 * d)), along = 10 * across;
  const double length = 10 * width, t = 0.02, h = 0.4;
  const auto wall = [&](const Vec3& middle, const Vec3& edges) {
    world.add_surface(world.ground(), dem::surface::Box(edges), {.position = middle});
  };
  wall({length / 2, width / 2, -t / 2}, {length + 2 * t, width + 2 * t, t});
  for (const double side : {0.0, 1.0}) {
    wall({side * length + (side - 0.5) * t, width / 2, h / 2}, {t, width + 2 * t, h});
    wall({length / 2, side * width + (side - 0.5) * t, h / 2}, {length + 2 * t, t, h});
  }
  const auto bead = world.add_species(dem::shape::Sphere(d / 2), {.density = 2500});
  dem::RandomStream random(1);
  for (std::size_t k = 0; k < s.grains; ++k) {
    const Vec3 cell(double(k % along) + 0.5, double(k / along % across) + 0.5, double(k / (along * across)) + 0.5);
    world.add_grain({bead, 1.1 * d * cell, random.in_ball(0.1)});
  }
  run(world, s.settle);

  double top = 0.0;
  for (const auto p : world.grains()) top = std::max(top, world.position(p).z() + d / 2);
  const Vec3 at(0.5 * length, 0.5 * width, top + radius), way = Vec3(3, 0, -1).normalized();  // it sinks as it goes
  dem::Mat3 about_y;  // the wheel's axis, z of its own frame, along y
  about_y << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  namespace mbd = dem::mbd;
  auto& m = world.machine();
  const auto carriage = m.add_body(mbd::box_body("carriage", Vec3::Constant(0.1), 8000).at(at));
  const auto wheel = m.add_body(mbd::cylinder_body("wheel", radius, 0.5 * width, 2000).at(at, about_y));
  const auto rail = m.add_joint(mbd::prismatic("rail", m.ground(), carriage, at, way));
  const auto axle = m.add_joint(mbd::revolute("axle", carriage, wheel, at, Vec3::UnitY()));
  constexpr double speed = 0.3, slip = 0.3;  // m/s
  const double start = world.time();
  m.add_motion(mbd::prescribed_joint("way", rail, mbd::Signal::ramp(0.0, speed, start)));
  m.add_motion(mbd::prescribed_joint("turns", axle, mbd::Signal::ramp(0.0, speed / (1.0 - slip) / radius, start)));
  world.add_surface(wheel, dem::surface::Cylinder(radius, 0.5 * width), {.name = "wheel"});
  run(world, s.roll);
  return world;
}

// ---- what a cut costs ----

struct Cost {
  double imbalance;                         ///< work of the busiest rank over the mean
  double mean_bytes, most_bytes;            ///< sent in a step, of a rank
  double mean_neighbours, most_neighbours;  ///< ranks that a rank sends to
};

/// The work and the messages of a step (world/border_step.hpp) if the ranks have these chunks.
Cost cost_of(const World& world, const std::vector<double>& work, const std::vector<int>& owner, int ranks) {
  const auto& w = world.state();
  const auto n = static_cast<std::size_t>(ranks);
  std::vector<double> done(n, 0.0), bytes(n, 0.0);
  std::vector<std::set<int>> sends_to(n);
  std::vector<std::set<std::uint32_t>> wanted(n);  // rows of others, by who wants them
  double all = 0.0;
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    const auto& chunk = w.chunks[c];
    const int mine = owner[c];
    const auto me = static_cast<std::size_t>(mine);
    done[me] += work[c], all += work[c];
    const bool works = std::binary_search(w.sleepers.working.begin(), w.sleepers.working.end(), c);
    std::set<int> told;
    for (std::size_t k = 0; k < chunk.candidate.size(); ++k) {
      const std::uint32_t j = chunk.candidate[k];
      const int other = owner[j / dem::chunk_size];
      if (other == mine) continue;
      wanted[me].insert(j);
      sends_to[me].insert(other);
      if (!works) continue;
      if (told.insert(other).second) bytes[me] += sizeof(std::uint32_t);
      const auto loads = chunk.partner_load_first[k + 1] - chunk.partner_load_first[k];
      bytes[me] += double(sizeof(std::uint16_t)) + double(loads * sizeof(dem::PartnerLoad));
    }
  }
  for (std::size_t r = 0; r < n; ++r) {
    for (const std::uint32_t j : wanted[r]) {
      const auto from = static_cast<std::size_t>(owner[j / dem::chunk_size]);
      bytes[from] += dem::motion_width<Beads> * sizeof(double);
      sends_to[from].insert(static_cast<int>(r));
    }
  }
  Cost cost{*std::max_element(done.begin(), done.end()) / (all / ranks), 0, 0, 0, 0};
  for (std::size_t r = 0; r < n; ++r) {
    const auto neighbours = static_cast<double>(sends_to[r].size());
    cost.mean_bytes += bytes[r] / ranks, cost.mean_neighbours += neighbours / ranks;
    cost.most_bytes = std::max(cost.most_bytes, bytes[r]);
    cost.most_neighbours = std::max(cost.most_neighbours, neighbours);
  }
  return cost;
}

// ---- Zoltan ----

struct Pieces {
  std::vector<Vec3> middles;  ///< m, of chunks
  std::vector<double> work;
};

void zoltan_check(int code, const char* call) {
  if (code != ZOLTAN_OK && code != ZOLTAN_WARN) dem::fail("{} of Zoltan failed with code {}", call, code);
}

/// Whose each chunk is by a method of Zoltan.
std::vector<int> by_zoltan(const char* method, const Pieces& pieces, int ranks) {
  Zoltan_Struct* z = Zoltan_Create(MPI_COMM_WORLD);
  if (z == nullptr) dem::fail("Zoltan_Create failed");
  for (const auto& [name, value] : std::map<std::string, std::string>{{"LB_METHOD", method},
                                                                      {"NUM_GLOBAL_PARTS", std::to_string(ranks)},
                                                                      {"OBJ_WEIGHT_DIM", "1"},
                                                                      {"IMBALANCE_TOL", "1.01"},
                                                                      {"REDUCE_DIMENSIONS", "1"},  // a bed is flat
                                                                      {"RETURN_LISTS", "PARTS"},
                                                                      {"DEBUG_LEVEL", "0"}}) {
    zoltan_check(Zoltan_Set_Param(z, name.c_str(), value.c_str()), "Zoltan_Set_Param");
  }
  void* data = const_cast<Pieces*>(&pieces);
  Zoltan_Set_Num_Obj_Fn(
      z, [](void* p, int*) { return int(static_cast<Pieces*>(p)->work.size()); }, data);
  Zoltan_Set_Obj_List_Fn(
      z,
      [](void* p, int, int, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR, int, float* weights, int*) {
        const auto& of = *static_cast<Pieces*>(p);
        for (std::size_t k = 0; k < of.work.size(); ++k) {
          global[k] = static_cast<ZOLTAN_ID_TYPE>(k);
          weights[k] = static_cast<float>(of.work[k]);
        }
      },
      data);
  Zoltan_Set_Num_Geom_Fn(
      z, [](void*, int*) { return 3; }, data);
  Zoltan_Set_Geom_Multi_Fn(
      z,
      [](void* p, int, int, int count, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR, int, double* at, int*) {
        for (int k = 0; k < count; ++k) {
          const Vec3& x = static_cast<Pieces*>(p)->middles[global[k]];
          for (int axis = 0; axis < 3; ++axis) at[3 * k + axis] = x[axis];
        }
      },
      data);
  int changes = 0, globals = 0, locals = 0, in = 0, out = 0;
  ZOLTAN_ID_PTR in_global = nullptr, in_local = nullptr, out_global = nullptr, out_local = nullptr;
  int *in_procs = nullptr, *in_parts = nullptr, *out_procs = nullptr, *out_parts = nullptr;
  zoltan_check(Zoltan_LB_Partition(z, &changes, &globals, &locals, &in, &in_global, &in_local, &in_procs, &in_parts,
                                   &out, &out_global, &out_local, &out_procs, &out_parts),
               "Zoltan_LB_Partition");
  std::vector<int> owner(pieces.work.size(), 0);
  for (int k = 0; k < out; ++k) owner[out_global[k]] = out_parts[k];
  Zoltan_LB_Free_Part(&in_global, &in_local, &in_procs, &in_parts);
  Zoltan_LB_Free_Part(&out_global, &out_local, &out_procs, &out_parts);
  Zoltan_Destroy(&z);
  return owner;
}

/// Whose each chunk is by the cut of the one order.
std::vector<int> by_order(const Pieces& pieces, int ranks) {
  const std::vector<std::uint32_t> first = dem::domain::cut_by_work(pieces.work, ranks);
  std::vector<int> owner(pieces.work.size());
  for (int r = 0; r < ranks; ++r) {
    const auto k = static_cast<std::size_t>(r);
    std::fill(owner.begin() + first[k], owner.begin() + first[k + 1], r);
  }
  return owner;
}

void compare(const Settings& s) {
  const World world = wheel_in_a_long_bed(s);
  const auto& w = world.state();
  Pieces pieces;
  double largest = 0.0, sum = 0.0;
  std::size_t asleep = 0;
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    std::vector<float> work;
    dem::append_work(w, c, work);
    double of_chunk = 0.0;
    for (const float x : work) of_chunk += x;
    Vec3 middle = Vec3::Zero();
    for (std::size_t k = 0; k < work.size(); ++k) {
      middle += dem::to_eigen(w.grains.position[c * dem::chunk_size + k]) / double(work.size());
    }
    pieces.middles.push_back(middle);
    pieces.work.push_back(of_chunk);
    largest = std::max(largest, of_chunk), sum += of_chunk;
    asleep += w.chunks[c].asleep;
  }
  fmt::print("{} spheres in {} chunks, {} of them asleep; the busiest chunk has {:.2g} of all work\n", s.grains,
             w.chunks.size(), asleep, largest / sum);
  dem::io::Table table{.header = {"ranks", "cut", "imbalance", "kB a step, mean rank", "busiest rank",
                                  "ranks it sends to, mean", "most"},
                       .digits = 3};
  for (const int ranks : {2, 4, 8, 16, 32, 64}) {
    if (static_cast<std::size_t>(2 * ranks) > w.chunks.size()) break;
    const auto row = [&](const char* name, const std::vector<int>& owner) {
      const Cost c = cost_of(world, pieces.work, owner, ranks);
      table.row(ranks, name, c.imbalance, 1e-3 * c.mean_bytes, 1e-3 * c.most_bytes, c.mean_neighbours,
                c.most_neighbours);
    };
    row("dem's order", by_order(pieces, ranks));
    row("Zoltan RCB", by_zoltan("RCB", pieces, ranks));
    row("Zoltan HSFC", by_zoltan("HSFC", pieces, ranks));
  }
  print(table);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Cuts of a bed among ranks: balance and exchange");
  app.add_option("--grains", settings.grains, "spheres")->check(CLI::Range(1000, 10'000'000));
  app.add_option("--settle", settings.settle, "steps before the wheel comes")->check(CLI::PositiveNumber);
  app.add_option("--roll", settings.roll, "steps of the wheel")->check(CLI::PositiveNumber);
  app.add_option("--sleep", settings.sleep, "1: grains at rest may sleep, so that the work is where the wheel is")
      ->check(CLI::Range(0, 1));
  CLI11_PARSE(app, argc, argv);
  MPI_Init(&argc, &argv);
  float version = 0.0f;
  int rc = 0;
  try {
    int processes = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &processes);
    if (processes > 1) dem::fail("{} processes were started, but one makes all cuts; run it without mpirun", processes);
    zoltan_check(Zoltan_Initialize(argc, argv, &version), "Zoltan_Initialize");
    compare(settings);
  } catch (const std::exception& e) {
    fmt::print(stderr, "partition: {}\n", e.what());
    rc = 1;
  }
  MPI_Finalize();
  return rc;
}
