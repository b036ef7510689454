#pragma once

// What the tests of whole worlds share: settings, and sums over all grains.

#include "catch.hpp"
#include "random.hpp"
#include "worlds.hpp"

#include <dem/math/rotation.hpp>

#include <vector>

using dem::GrainId;
using dem::Mat3;
using dem::SpeciesId;
using dem::SurfaceId;
using dem::Vec3;

inline constexpr double g = 9.81;  // m/s^2

using models::Balls;
using models::Cube8;
using models::Cubes;
using models::Grains;
using models::Sphere;

inline dem::WorldOptions options(const Vec3& gravity, double time_step = 0.0, double skin = 0.0) {
  dem::WorldOptions o;
  o.gravity = gravity;
  o.time_step = time_step;
  o.skin = skin;
  o.threads = 1;  // tests share the machine; those that are about threads say so
  return o;
}

/// The thesis's contact constants with a friction coefficient of choice.
template <class Model>
dem::ContactParameters<Model> sand(double mu = 0.4, double breaking_factor = 0.975) {
  return {{2000.0, 0.015, 0.05}, {mu, 2000.0, 0.015, breaking_factor}};
}

/// Five walls that never move, open at the top: 0 <= x <= edges.x and so on.
template <class World>
std::vector<SurfaceId> add_open_box(World& world, const Vec3& edges) {
  std::vector<SurfaceId> walls;
  const auto wall = [&](const Vec3& position, const Vec3& normal) {
    dem::SurfaceOptions o;
    o.position = position;
    o.rotation = dem::rotation_between(Vec3::UnitZ(), normal);
    walls.push_back(world.add_surface(world.ground(), dem::surface::Plane{}, o));
  };
  wall({0, 0, 0}, {0, 0, 1});
  wall({0, 0, 0}, {1, 0, 0});
  wall({edges.x(), 0, 0}, {-1, 0, 0});
  wall({0, 0, 0}, {0, 1, 0});
  wall({0, edges.y(), 0}, {0, -1, 0});
  return walls;
}

/// A block of nx x ny x nz grains, `distance` apart, at random orientations and with random velocities up to `speed`.
template <class World>
void add_block(World& world, SpeciesId species, const Vec3& corner, double distance, int nx, int ny, int nz,
               double speed, unsigned seed = 1) {
  Random random(seed);
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        dem::NewGrain p;
        p.species = species;
        p.position = corner + distance * Vec3(i, j, k);
        p.rotation = random.rotation();
        p.velocity = random.vector(speed);
        world.add_grain(p);
      }
    }
  }
}

template <class World>
double mass_of(const World& w, GrainId p) {
  return w.species(w.species_of(p)).mass;
}
template <class World, class F>
void for_each_grain(const World& w, F&& f) {
  for (std::size_t k = 0; k < w.grain_count(); ++k) f(GrainId(k));
}
template <class World>
double total_mass(const World& w) {
  double m = 0.0;
  for_each_grain(w, [&](GrainId p) { m += mass_of(w, p); });
  return m;
}
template <class World>
Vec3 momentum(const World& w) {
  Vec3 sum = Vec3::Zero();
  for_each_grain(w, [&](GrainId p) { sum += mass_of(w, p) * w.velocity(p); });
  return sum;
}
/// About the origin.
template <class World>
Vec3 angular_momentum(const World& w) {
  Vec3 sum = Vec3::Zero();
  for_each_grain(w, [&](GrainId p) {
    const Mat3 r = w.rotation(p);
    const Vec3 spin = r.transpose() * w.angular_velocity(p);
    sum +=
        mass_of(w, p) * w.position(p).cross(w.velocity(p)) + r * w.species(w.species_of(p)).inertia.cwiseProduct(spin);
  });
  return sum;
}
template <class World>
double kinetic_energy(const World& w) {
  double sum = 0.0;
  for_each_grain(w, [&](GrainId p) {
    const Vec3 spin = w.rotation(p).transpose() * w.angular_velocity(p);
    sum += 0.5 * mass_of(w, p) * w.velocity(p).squaredNorm() +
           0.5 * spin.dot(w.species(w.species_of(p)).inertia.cwiseProduct(spin));
  });
  return sum;
}
/// Calls f(geometry) for every contact of two grains, which it finds by asking all pairs.
template <class Model, class F>
void for_each_pair_contact(const dem::World<Model>& w, F&& f) {
  const auto& p = w.state().grains;
  for (std::size_t i = 0; i < p.count; ++i) {
    const auto& a = w.state().species[p.species[i]].shape;
    for (std::size_t j = i + 1; j < p.count; ++j) {
      const auto& b = w.state().species[p.species[j]].shape;
      const dem::Vector3<double> separation = p.position[j] - p.position[i];
      if (norm(separation) > a.bounding_radius() + b.bounding_radius()) continue;
      Model::Shape::collide(a, p.pose_of(i), b, p.pose_of(j), separation,
                            [&](std::uint32_t, const auto& point) { f(point.geometry()); });
    }
  }
}

/// The most energy (J) that the springs of a contact hold. The normal one: half its slope times the overlap squared,
/// as no law is softer deeper in. Those of friction and rolling resistance, which mu F = mu K d limits, hold mu^2 K/kt
/// of that, in all of these tests less than half.
template <class Model>
double spring_energy(const dem::World<Model>& w, const dem::contact::Geometry<double>& g) {
  const auto& p = w.state().materials.table()[0];
  const double d = std::max(0.0, g.overlap);
  return 1.5 * 0.5 * g.weight * Model::Normal::stiffness(p.normal, {d, 0.0, g.effective_radius, 1.0, 0.0}) * d * d;
}

/// Watches that a world in which nothing but dampers and friction acts besides springs never gains energy, at any time
/// of the run: it may not move with more than it moved with, and had in springs, at any moment before. Springs of
/// friction may also be stretched by what dampers press, c v with c = 2 b sqrt(K m): mu^2 c^2 v^2/(2 kt), for b < 0.25
/// less than two hundredths of m v^2/2.
class EnergyWatch {
 public:
  /// `held`: J, the most that springs hold now; `fallen`: J, what an attraction may have given since the grains were
  /// apart.
  void look(double kinetic, double held, double fallen = 0.0) {
    if (kinetic > most_ * (1 + 1e-9) + fallen) ++gains_;
    most_ = std::min(most_, 1.02 * kinetic + held);
  }
  int gains() const { return gains_; }

 private:
  double most_ = 1e300;
  int gains_ = 0;
};

/// Largest deviation of a matrix from a rotation.
inline double not_a_rotation(const Mat3& r) { return (r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff(); }
