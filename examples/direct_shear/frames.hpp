#pragma once

#include "settings.hpp"

#include <dem/io/polyhedron_mesh.hpp>
#include <dem/io/vtk.hpp>
#include <dem/io/vtk_grains.hpp>
#include <dem/soil/coordination.hpp>
#include <dem/surface/box.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace direct_shear {

/// The ParaView series of one load: grains and boxes every so many metres of travel.
class Frames {
 public:
  Frames(const Settings& s, const std::string& name)
      : spheres_(s.vtk_spheres), interval_(s.vtk_interval), series_(s.output / (name + ".pvd")) {}

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
    written_ = displacement;
    write_grains(world);
    write_boxes(world);
    if constexpr (std::is_same_v<typename World::Shape, dem::shape::Superquadric>) {
      const auto path = series_.next_path("superquadrics");
      dem::io::write_vtk_grains(path, world, 4, {.single_precision = true, .time_s = world.time()});
      series_.add(world.time(), path, "superquadrics");
    } else if constexpr (std::is_same_v<typename World::Shape, dem::shape::Polyhedron>) {
      write_polyhedra(world);
    } else if (spheres_) {
      write_spheres(world);
    }
  }

  template <class World>
  void write_grains(const World& world) {
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
    const auto path = series_.next_path("grains");
    dem::io::write_vtk_points(path, dem::io::flat(position),
                              {{"radius_m", 1, radius},
                               {"velocity_m_s", 3, dem::io::flat(velocity)},
                               {"angular_velocity_rad_s", 3, dem::io::flat(spin)},
                               {"quaternion_wxyz", 4, quaternion},
                               {"net_contact_force_N", 3, dem::io::flat(force)},
                               {"contact_points", 1, contacts.contacts},
                               {"coordination", 1, contacts.neighbours}},
                              {.single_precision = true, .time_s = world.time()});
    series_.add(world.time(), path, "grains");
  }

  /// Every grain as its spheres: Point Gaussian, scaled by radius_m, shows the true shape.
  template <class World>
  void write_spheres(const World& world) {
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
    const auto path = series_.next_path("spheres");
    dem::io::write_vtk_points(
        path, dem::io::flat(centre),
        {{"radius_m", 1, radius}, {"velocity_m_s", 3, dem::io::flat(velocity)}, {"grain", 1, grain}},
        {.single_precision = true, .time_s = world.time()});
    series_.add(world.time(), path, "spheres");
  }

  /// Every grain as what it is.
  template <class World>
  void write_polyhedra(const World& world) {
    const auto mesh = dem::io::polyhedron_mesh(world.species(dem::SpeciesId(0)).shape);
    std::vector<dem::io::BodyMesh> grains;
    std::vector<dem::Vec3> velocity, force;
    for (const dem::ParticleId p : world.particles()) {
      grains.push_back({&mesh, world.position(p), world.rotation(p)});
      velocity.push_back(world.velocity(p));
      force.push_back(world.force(p));
    }
    const auto path = series_.next_path("polyhedra");
    dem::io::write_vtk_bodies(
        path, grains, {{"velocity_m_s", 3, dem::io::flat(velocity)}, {"net_contact_force_N", 3, dem::io::flat(force)}},
        {.single_precision = true, .time_s = world.time()});
    series_.add(world.time(), path, "polyhedra");
  }

  template <class World>
  void write_boxes(const World& world) {
    const auto& surfaces = world.state().surfaces;
    std::vector<dem::io::SurfaceMesh> meshes;
    std::vector<dem::io::BodyMesh> bodies;
    std::vector<dem::Vec3> velocity, force;
    std::vector<std::int32_t> body;
    for (const auto& s : surfaces) {
      meshes.push_back(dem::io::box_mesh(std::get<dem::surface::Box>(s.geometry).edges()));
      velocity.push_back(world.machine().body(s.body).velocity());
      force.push_back(dem::to_eigen(s.force));
      body.push_back(static_cast<std::int32_t>(s.body.value));
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const auto& b = world.machine().body(surfaces[i].body);
      bodies.push_back({&meshes[i], b.point(surfaces[i].position), b.rotation() * surfaces[i].rotation});
    }
    const auto path = series_.next_path("boxes");
    dem::io::write_vtk_bodies(path, bodies,
                              {{"machine_part", 1, body},
                               {"velocity_m_s", 3, dem::io::flat(velocity)},
                               {"force_of_grains_N", 3, dem::io::flat(force)}},
                              {.single_precision = true, .time_s = world.time()});
    series_.add(world.time(), path, "boxes");
  }

  bool spheres_;
  double interval_, next_ = 0.0, written_ = -1.0;  // m
  dem::io::VtkSeries series_;
};

}  // namespace direct_shear
