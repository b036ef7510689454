#pragma once

// Scenes that ranks share, and the same ones on one process: the states must be the same in every bit.

#include "scene_list.hpp"

#include <dem/dem.hpp>
#include <dem/domain/ranks.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/io/checkpoint/world_columns.hpp>
#include <dem/world/contacts.hpp>
#include <dem/world/energy.hpp>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace scenes {

inline constexpr double dt = 1e-5;  // s

/// Numbers from 0 to 1.
struct Numbers {
  std::uint64_t state = 7;
  double operator()() {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) * 0x1p-53;
  }
};

/// Each rank has its own number, and one process one: it changes no bit.
template <class Model>
int threads_of() {
  return Model::Domain::has_ranks ? 1 + dem::processes.rank % 3 : 1;
}

template <class World>
void add_box(World& world, double width, double depth, double height) {
  const auto wall = [&](const dem::Vec3& middle, const dem::Vec3& edges) {
    world.add_surface(world.ground(), dem::surface::Box(edges), {.material = "wall", .position = middle});
  };
  const double t = 0.01;
  wall({width / 2, depth / 2, -t / 2}, {width + 2 * t, depth + 2 * t, t});
  for (const double side : {0.0, 1.0}) {
    wall({side * width + (side - 0.5) * t, depth / 2, height / 2}, {t, depth + 2 * t, height});
    wall({width / 2, side * depth + (side - 0.5) * t, height / 2}, {width + 2 * t, t, height});
  }
}

/// n grains on a lattice of this pitch, a little shaken, in columns of nx times ny, from `height` (m) upwards.
template <class World>
void pour(World& world, dem::SpeciesId grain, int n, int nx, int ny, double pitch, double speed, double height = 0.0) {
  Numbers number;
  for (int k = 0; k < n; ++k) {
    const double cell[] = {k % nx + 0.5, k / nx % ny + 0.5, k / (nx * ny) + 0.5};
    dem::Vec3 x;
    for (int i = 0; i < 3; ++i) x[i] = pitch * (cell[i] + 0.05 * (number() - 0.5));
    x.z() += height;
    const dem::Mat3 r = dem::Quaternion(1, number(), number(), number()).normalized().toRotationMatrix();
    const double u = number(), v = number();
    world.add_grain({.species = grain, .position = x, .velocity = {u * speed, v * speed, -speed}, .rotation = r});
  }
}

/// A load of the user's own on each grain.
inline dem::GrainLoad drag_of_air(const dem::GrainNow& now) {
  return {.force = -1e-6 * now.velocity, .torque = -1e-12 * now.angular_velocity};
}

/// Ends the program, on all ranks, where something went wrong.
inline void require(bool is_well, const std::string& what) {
  if (!is_well) dem::fail("{}", what);
}
/// In runs of one step and of fifty, as programs have them that look at the grains in between: at the end of each all
/// ranks know all grains, and new lists are made in the first step of a run and in later ones.
template <class World>
void run(World& world, std::uint64_t steps) {
  for (std::uint64_t done = 0; done < steps;) {
    const std::uint64_t next = std::min<std::uint64_t>(done / 100 % 2 == 0 ? 1 : 50, steps - done);
    const dem::StepReport report = world.run(next);
    require(bool(report), report.text);
    done += next;
  }
}

/// How many candidates are images of grains that other ranks own.
template <class Model>
double images_elsewhere(const dem::WorldState<Model>& w) {
  double n = 0.0;
  const auto [begin, end] = w.domain.own();
  for (std::size_t c = begin; c < end; ++c) {
    for (const std::uint32_t j : w.chunks[c].candidate) {
      n += j >= w.images.first && !w.domain.owns(w.images.grain_of(j) / dem::chunk_size) ? 1.0 : 0.0;
    }
  }
  return w.domain.total(n);
}

/// Runs a scene as ranks share it, on all of them, and as one process has it, on rank 0; says whether every bit is the
/// same. The scene is a function template of the model, which calls world.run() itself.
template <class Shared, class Alone, class Scene>
bool same_bits(const char* name, const Scene& scene) {
  const dem::World<Shared> shared = scene.template operator()<Shared>();
  const dem::io::StateColumns columns = dem::io::columns_of(shared);
  const auto& d = shared.state().domain;
  if constexpr (Shared::Domain::has_images) {
    require(!d.is_shared() || !shared.state().list_valid || images_elsewhere(shared.state()) > 0.0,
            "no candidate is an image of another rank's grain");
  }
  if constexpr (!Shared::Domain::has_images) {
    require(!d.is_shared() || d.lists_of_parts > 0 || !shared.state().held.empty(),
            "each rank looked at all grains for each list");
  }
  // Otherwise nothing was shared. A rank may be without work where most of the grains sleep.
  const double at_work = d.total(d.own().second > d.own().first ? 1.0 : 0.0);
  require(at_work > 1.0 || !d.is_shared(), "one rank has all chunks");
  const std::uint64_t mine = dem::io::hash_of(columns);
  for (const std::uint64_t other : d.gathered(std::vector{mine})) require(other == mine, "ranks have other states");
  if (d.rank() != 0) return true;
  const dem::World<Alone> alone = scene.template operator()<Alone>();
  const dem::io::StateColumns expected = dem::io::columns_of(alone);
  const auto differences = dem::io::differences(expected, columns);
  std::printf("%-10s %d ranks: %s, hash %016llx, %zu grains, %llu lists, %.0f bytes a step\n", name, d.ranks(),
              differences.empty() ? "same bits" : "OTHER BITS",
              static_cast<unsigned long long>(dem::io::hash_of(columns)), shared.grain_count(),
              static_cast<unsigned long long>(shared.state().rebuilds),
              double(d.traffic().step_bytes) / double(shared.steps()));
  for (const std::string& column : differences) std::printf("  %s\n", column.c_str());
  return differences.empty();
}

inline bool equal(const char* what, const dem::io::StateColumns& a, const dem::io::StateColumns& b) {
  const auto differences = dem::io::differences(a, b);
  for (const std::string& column : differences) std::printf("  %s: %s\n", what, column.c_str());
  return differences.empty();
}

/// Goes on from the states of ranks as one process, and the other way round; all run on to the same state. `make` is a
/// function template of the model, called with the number of grains.
template <class Shared, class Alone, class Make>
bool goes_on(const char* name, const Make& make) {
  auto shared = make.template operator()<Shared>(1500);
  run(shared, 150);
  auto first = dem::io::columns_of(shared);
  const auto& d = shared.state().domain;

  auto alone = make.template operator()<Alone>(1500);
  run(alone, 150);
  bool same = equal("before", dem::io::columns_of(alone), first);
  auto alone_again = make.template operator()<Alone>(10);
  dem::io::restore(alone_again, first);
  auto saved = dem::io::columns_of(alone);
  auto shared_again = make.template operator()<Shared>(10);
  dem::io::restore(shared_again, saved);
  // One that lies at the bottom goes: who sleeps beside it wakes, on every rank.
  alone_again.remove_grain(dem::GrainId(5)), shared_again.remove_grain(dem::GrainId(5));
  shared.remove_grain(dem::GrainId(5));
  run(alone_again, 200), run(shared_again, 200), run(shared, 200);
  const auto last = dem::io::columns_of(shared), a = dem::io::columns_of(alone_again),
             b = dem::io::columns_of(shared_again);
  same = equal("as one process", a, last) && same;
  same = equal("as ranks again", b, last) && same;
  // What contacts feel is known to every rank, in the same order.
  const auto contacts = contacts_of(shared);
  const auto as_alone = contacts_of(alone_again);
  same = same && contacts.size() == as_alone.size() && contacts.size() > 30;
  for (std::size_t k = 0; same && k < contacts.size(); ++k) {
    const auto &one = contacts[k], &other = as_alone[k];
    same = one.kind == other.kind && one.grain == other.grain && one.other_grain == other.other_grain &&
           one.surface == other.surface && one.force == other.force && one.point == other.point;
  }
  std::printf("%-10s %d ranks: %s, %zu contacts\n", name, d.ranks(), same ? "same bits" : "OTHER BITS",
              contacts.size());
  return d.all(same);
}

}  // namespace scenes
