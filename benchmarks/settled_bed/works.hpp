#pragma once

// The works that are timed: cubes and spheres in open boxes, and the laws that they share.

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/world/world.hpp>

#include <algorithm>
#include <chrono>
#include <random>
#include <string>
#include <vector>

namespace bench {

using Seconds = std::chrono::duration<double>;

struct Cubes : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Integrator = dem::integrator::SymplecticEuler;
  static Shape grain() { return dem::shape::cube8(1.2e-3); }
  static constexpr double width = 0.045, pitch = 0.0045, stiffness = 2000.0;
  static constexpr int grains = 4000, per_row = 10;
};
struct Spheres : dem::Model {
  using Integrator = dem::integrator::SymplecticEuler;
  static Shape grain() { return dem::shape::Sphere(1e-3); }
  static constexpr double width = 0.040, pitch = 0.0025, stiffness = 2000.0;
  static constexpr int grains = 20000, per_row = 16;
};

struct Settings {
  std::string work = "both", shape = "cube8";
  int steps = 5000, settle = 60000, repeats = 3, threads = 0, least_threads = 1;
  double skin = 0.0;
  bool flow = false;                                                ///< beds of `sizes` flow
  std::vector<std::size_t> sizes = {4000, 40000, 300000, 2000000};  ///< of beds made of boxes (sizes.cpp)
};

/// Constants of a contact with restitution 0.3 for an effective mass (kg): C = 2 zeta sqrt(K m), zeta = 0.3579.
template <class Model>
dem::ContactParameters<Model> contact(double effective_mass) {
  const double stiffness = Model::stiffness, damping = 2.0 * 0.3579 * std::sqrt(stiffness * effective_mass);
  return {{stiffness, damping, 1.0}, {0.4, 2.0 / 7.0 * stiffness, 0.5 * damping, 1.0}};
}

/// A world without walls and grains: its first species is the work's grain.
template <class Model>
dem::World<Model> empty_world(const Settings& settings) {
  // The step, like all else, is that of the same works in other programs: half to two thirds of the stable one.
  dem::World<Model> world({.time_step = 1e-5, .skin = settings.skin});
  const double mass = world.species(world.add_species(Model::grain())).mass;
  world.set_contact("grain", "grain", contact<Model>(0.5 * mass));
  world.set_contact("grain", "wall", contact<Model>(mass));
  return world;
}

/// A loose lattice of so many grains with random orientations and velocities, `n` a row, in an open box of width w (m).
template <class Model>
dem::World<Model> loose_bed(const Settings& settings, int grains = Model::grains, int n = Model::per_row,
                            double w = Model::width) {
  dem::World<Model> world = empty_world<Model>(settings);
  const dem::SpeciesId grain(0);
  const double thick = 0.02, high = 0.3;
  const auto wall = [&](const dem::Vec3& middle, const dem::Vec3& edges) {
    world.add_surface(world.ground(), dem::surface::Box(edges), {.position = middle});
  };
  wall({w / 2, w / 2, -thick / 2}, {w + 2 * thick, w + 2 * thick, thick});
  for (const double side : {-thick / 2, w + thick / 2}) {
    wall({side, w / 2, high / 2}, {thick, w + 2 * thick, high});
    wall({w / 2, side, high / 2}, {w + 2 * thick, thick, high});
  }
  std::mt19937 random(20240501);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  for (int k = 0; k < grains; ++k) {
    const dem::Vec3 cell(k % n + 0.5, k / n % n + 0.5, k / (n * n) + 0.5);
    const dem::Vec3 jitter = 0.05e-3 * dem::Vec3(uniform(random), uniform(random), uniform(random));
    const dem::Quaternion turn = dem::Quaternion(normal(random), normal(random), normal(random), normal(random));
    world.add_grain({.species = grain,
                     .position = Model::pitch * cell + jitter,
                     .velocity = 0.2 * dem::Vec3(uniform(random), uniform(random), uniform(random)),
                     .rotation = turn.normalized().toRotationMatrix()});
  }
  return world;
}

template <class World>
void run_or_fail(World& world, int steps) {
  if (const auto report = world.run(static_cast<std::uint64_t>(steps)); !report) dem::fail("{}", report.text);
}

/// The fewest, twice as many, and so on, and the most itself.
inline std::vector<int> thread_counts(int fewest, int most) {
  std::vector<int> counts;
  for (int n = fewest; n < most; n *= 2) counts.push_back(n);
  counts.push_back(most);
  return counts;
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Contacts of grains with each other and with walls, a grain.
template <class World>
double contacts_a_grain(const World& world) {
  std::size_t contacts = 0;
  for (const auto& chunk : world.state().chunks) {
    contacts += static_cast<std::size_t>(chunk.pair_contacts.committed() + chunk.surface_contacts.committed());
  }
  return static_cast<double>(contacts) / static_cast<double>(world.grain_count());
}

/// Times beds of growing size (sizes.cpp).
void time_sizes(const Settings& settings);

}  // namespace bench
