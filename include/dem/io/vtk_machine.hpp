#pragma once
// Machines for ParaView (.vtp): bodies as meshes, all surfaces of a world, and frames of grains and machine together.

#include <dem/io/drawn_body.hpp>
#include <dem/io/drawn_surface.hpp>
#include <dem/io/vtk_contacts.hpp>
#include <dem/io/vtk_grain_points.hpp>
#include <dem/io/vtk_grains.hpp>
#include <dem/io/vtk_series.hpp>
#include <dem/mbd/solver/mechanism.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace dem::io {

namespace detail {

/// What ParaView shows of the body that a mesh belongs to.
struct MachineArrays {
  std::vector<std::int32_t> part;
  std::vector<Vec3> velocity, spin, force;

  void add(BodyId id, const Body& b, const Vec3& f) {
    part.push_back(static_cast<std::int32_t>(id.value));
    velocity.push_back(b.velocity());
    spin.push_back(b.angular_velocity());
    force.push_back(f);
  }
  [[nodiscard]] std::vector<BodyData> arrays(const char* name_of_force) const {
    return {{"machine_part", 1, std::span<const std::int32_t>(part)},
            {"velocity_m_s", 3, flat(velocity)},
            {"angular_velocity_rad_s", 3, flat(spin)},
            {name_of_force, 3, flat(force)}};
  }
};

}  // namespace detail

/// Writes bodies of a machine, with or without a world, as meshes where they are now. Cell arrays: "body" (index into
/// `bodies`), "machine_part" (number of the body), "velocity_m_s" (of the centre of mass), "angular_velocity_rad_s" and
/// "contact_force_N" (on the body from grains and from other bodies' surfaces; 0 without a world). Throws dem::Error as
/// write_vtk_bodies does, and for a body that the machine does not have.
inline void write_vtk_machine(const std::filesystem::path& path, const mbd::Mechanism& machine,
                              const std::vector<DrawnBody>& bodies, const VtkOptions& options = {}) {
  std::vector<BodyMesh> meshes;
  detail::MachineArrays data;
  const auto& contacts = machine.parts().outside;
  for (const DrawnBody& d : bodies) {
    meshes.push_back(
        {d.mesh, machine.reference_point(d.body, d.position), machine.reference_rotation(d.body) * d.rotation});
    data.add(d.body, machine.body(d.body),
             d.body.index() < contacts.size() ? to_eigen(contacts[d.body.index()].force) : Vec3(Vec3::Zero()));
  }
  write_vtk_bodies(path, meshes, data.arrays("contact_force_N"), options);
}

/// Writes all active surfaces of a world where their bodies are now, with the cell arrays "body" (index of the drawn
/// surface), "surface" (its number, which stays when others are not active), "machine_part", "velocity_m_s" and
/// "angular_velocity_rad_s" as above, and "force_of_grains_N" (on the surface). A plane has no end: a square of edge
/// `plane_size` (m) is drawn. Throws dem::Error as write_vtk_bodies does.
template <class World>
void write_vtk_surfaces(const std::filesystem::path& path, const World& world, const VtkOptions& options = {},
                        double plane_size = 1.0) {
  std::vector<SurfaceMesh> meshes;
  std::vector<BodyMesh> surfaces;
  std::vector<std::int32_t> numbers;
  detail::MachineArrays data;
  const auto& all = world.state().surfaces;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& s = all[k];
    if (!s.active) continue;
    numbers.push_back(static_cast<std::int32_t>(k));
    const Body& b = world.machine().body(s.body);
    meshes.push_back(drawn(s.geometry, plane_size));
    surfaces.push_back({nullptr, b.point(s.position), b.rotation() * s.rotation});
    data.add(s.body, b, to_eigen(s.force));
  }
  for (std::size_t k = 0; k < meshes.size(); ++k) surfaces[k].mesh = &meshes[k];
  auto arrays = data.arrays("force_of_grains_N");
  arrays.insert(arrays.begin(), {"surface", 1, std::span<const std::int32_t>(numbers)});
  write_vtk_bodies(path, surfaces, arrays, options);
}

/// How a frame of a world is drawn, and what of it.
struct FrameOptions {
  int divisions = 4;        ///< of grains, see write_vtk_grains
  double plane_size = 1.0;  ///< m, edge of the square that shows a plane
  bool grains = true;       ///< as meshes, the part "grains": write_vtk_grains
  bool points = false;      ///< grains as points, the part "points": write_vtk_grain_points
  bool contacts = false;    ///< force chains, the part "contacts": write_vtk_contacts
};

/// Adds a world as it is now to a time series: its grains as "grains", its surfaces as "surfaces", and what else is
/// asked for. Each frame has each part, also where there is nothing to show: files of one number are of one frame.
/// Bodies without surfaces are added to the same series by the other add_vtk_frame, with world.time() and
/// world.machine().
template <class World>
void add_vtk_frame(VtkSeries& series, const World& world, const FrameOptions& frame = {}) {
  const VtkOptions options{.single_precision = true, .time_s = world.time()};
  const auto add = [&](const char* part, auto&& write) {
    const auto path = series.next_path(part);
    write(path);
    series.add(world.time(), path, part);
  };
  if (frame.grains) add("grains", [&](const auto& path) { write_vtk_grains(path, world, frame.divisions, options); });
  if (frame.points) add("points", [&](const auto& path) { write_vtk_grain_points(path, world, options); });
  add("surfaces", [&](const auto& path) { write_vtk_surfaces(path, world, options, frame.plane_size); });
  if (frame.contacts) add_vtk_contacts(series, world);
}

/// Adds bodies of a machine, with or without a world, as `part`.
inline void add_vtk_frame(VtkSeries& series, double time, const mbd::Mechanism& machine,
                          const std::vector<DrawnBody>& bodies, std::string_view part = "machine") {
  const auto path = series.next_path(part);
  write_vtk_machine(path, machine, bodies, {.single_precision = true, .time_s = time});
  series.add(time, path, part);
}

}  // namespace dem::io
