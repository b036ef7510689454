#pragma once

#include "settings.hpp"

#include <dem/io/polyhedron_mesh.hpp>
#include <dem/io/vtk.hpp>
#include <dem/io/vtk_machine.hpp>
#include <dem/soil/coordination.hpp>

#include <cmath>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace direct_shear {

/// The ParaView series of one load, if there is to be one: grains and boxes every so many metres of travel. One that
/// cannot be written goes no further and says why, for it is not worth the test.
class Frames {
 public:
  using Failed = std::function<void(const std::string& why)>;

  Frames(const Settings& s, const std::string& name, Failed failed)
      : spheres_(s.vtk_spheres), interval_(s.vtk_interval), failed_(std::move(failed)) {
    if (s.vtk) attempt([&] { series_.emplace(s.output / (name + ".pvd")); });
  }

  /// Writes a frame if one is due at this displacement (m).
  template <class World>
  void show(const World& world, double displacement) {
    if (displacement < next_) return;
    // From a multiple of the interval to the next: what a frame comes late must not add up.
    next_ = interval_ * (std::floor(displacement / interval_) + 1.0);
    write(world, displacement);
  }

  /// Writes the last frame, unless there is one of this displacement (m) already.
  template <class World>
  void finish(const World& world, double displacement) {
    if (displacement > written_) write(world, displacement);
  }

 private:
  template <class World>
  void write(const World& world, double displacement) {
    if (!series_) return;
    written_ = displacement;
    attempt([&] { write_parts(world); });
  }

  template <class Write>
  void attempt(Write&& write) {
    try {
      write();
    } catch (const std::exception& error) {
      series_.reset();
      failed_(error.what());
    }
  }

  template <class World>
  void write_parts(const World& world) {
    using Shape = typename World::Shape;
    const dem::io::VtkOptions options{.single_precision = true, .time_s = world.time()};
    add(world, "grains", [&](const auto& path) { write_grains(path, world, options); });
    add(world, "boxes", [&](const auto& path) { dem::io::write_vtk_surfaces(path, world, options); });
    const auto add_meshes = [&](const char* part) {
      add(world, part, [&](const auto& path) { dem::io::write_vtk_grains(path, world, 4, options); });
    };
    if constexpr (std::is_same_v<Shape, dem::shape::Superquadric>) add_meshes("superquadrics");
    else if constexpr (std::is_same_v<Shape, dem::shape::Polyhedron>) add_meshes("polyhedra");
    else if (spheres_) add(world, "spheres", [&](const auto& path) { write_spheres(path, world, options); });
  }

  template <class World, class Write>
  void add(const World& world, const char* part, Write&& write) {
    const auto path = series_->next_path(part);
    write(path);
    series_->add(world.time(), path, part);
  }

  /// Every grain as a point that knows how it moves and touches others.
  template <class World>
  static void write_grains(const std::filesystem::path& path, const World& world, const dem::io::VtkOptions& options) {
    const std::size_t n = world.particle_count();
    std::vector<dem::Vec3> position(n), velocity(n), spin(n), force(n);
    std::vector<double> quaternion, radius(n);
    const auto grains = world.particles();
    for (std::size_t i = 0; i < n; ++i) {
      const dem::ParticleId p = grains[i];
      const dem::Quaternion q(world.rotation(p));
      position[i] = world.position(p);
      velocity[i] = world.velocity(p);
      spin[i] = world.angular_velocity(p);
      force[i] = world.force(p);
      radius[i] = world.species(world.species_of(p)).shape.bounding_radius();
      quaternion.insert(quaternion.end(), {q.w(), q.x(), q.y(), q.z()});
    }
    const auto contacts = dem::soil::coordination(world);
    dem::io::write_vtk_points(path, dem::io::flat(position),
                              {{"radius_m", 1, radius},
                               {"velocity_m_s", 3, dem::io::flat(velocity)},
                               {"angular_velocity_rad_s", 3, dem::io::flat(spin)},
                               {"quaternion_wxyz", 4, quaternion},
                               {"net_contact_force_N", 3, dem::io::flat(force)},
                               {"contact_points", 1, contacts.contacts},
                               {"coordination", 1, contacts.neighbours}},
                              options);
  }

  /// Every grain as its spheres: Point Gaussian, scaled by radius_m, shows the true shape.
  template <class World>
  static void write_spheres(const std::filesystem::path& path, const World& world, const dem::io::VtkOptions& options) {
    std::vector<dem::Vec3> centre, velocity;
    std::vector<double> radius;
    std::vector<std::int32_t> grain;
    for (const dem::ParticleId p : world.particles()) {
      const auto& shape = world.species(world.species_of(p)).shape;
      for (int k = 0; k < shape.count(); ++k) {
        const dem::Vec3 arm = world.rotation(p) * shape.ball(k).centre;
        centre.push_back(world.position(p) + arm);
        velocity.push_back(world.velocity(p) + world.angular_velocity(p).cross(arm));
        radius.push_back(shape.ball(k).radius);
        grain.push_back(static_cast<std::int32_t>(p.value));
      }
    }
    dem::io::write_vtk_points(
        path, dem::io::flat(centre),
        {{"radius_m", 1, radius}, {"velocity_m_s", 3, dem::io::flat(velocity)}, {"grain", 1, grain}}, options);
  }

  bool spheres_;
  double interval_, next_ = 0.0, written_ = -1.0;  // m
  Failed failed_;
  std::optional<dem::io::VtkSeries> series_;  // none: nothing is written, or no more
};

}  // namespace direct_shear
