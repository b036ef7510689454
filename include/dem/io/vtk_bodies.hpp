#pragma once
// Rigid bodies for ParaView (.vtp): meshes, each at the pose of its body.

#include <dem/core/error.hpp>
#include <dem/io/surface_mesh.hpp>
#include <dem/io/vtk_data.hpp>
#include <dem/io/vtk_file.hpp>
#include <dem/math/vector.hpp>

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <variant>
#include <vector>

namespace dem::io {

/// One body to draw. The mesh stays the caller's and may serve several bodies. A mesh in the axes of a machine's
/// drawing is at machine.reference_position(body) and reference_rotation(body); Body::position and rotation are those
/// of the centre of mass and the principal axes, which are others for most meshes.
struct BodyMesh {
  const SurfaceMesh* mesh = nullptr;
  Vec3 position = Vec3::Zero();      ///< of the mesh's origin, in the world [m]
  Mat3 rotation = Mat3::Identity();  ///< from the mesh's frame to the world
};

namespace detail {

/// Vertices, faces and per-face body indices of all bodies in one mesh in the world's frame.
struct WorldMesh {
  std::vector<double> points;
  std::vector<std::int32_t> connectivity, offsets, body;

  void add(const BodyMesh& placed, std::int32_t index) {
    const auto base = static_cast<std::int32_t>(points.size() / 3);
    for (const auto& v : placed.mesh->vertices) {
      const Vec3 world = placed.rotation * v + placed.position;
      points.insert(points.end(), world.data(), world.data() + 3);
    }
    const auto add_faces = [&](const auto& faces) {
      for (const auto& face : faces) {
        for (const std::int32_t vertex : face) connectivity.push_back(base + vertex);
        offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
        body.push_back(index);
      }
    };
    add_faces(placed.mesh->triangles);
    add_faces(placed.mesh->quads);
    add_faces(placed.mesh->polygons);
  }
};

inline void check_mesh(const std::filesystem::path& path, const BodyMesh& placed, std::size_t index) {
  if (placed.mesh == nullptr) fail("vtk file '{}': body {} has no mesh; set BodyMesh::mesh", path.string(), index);
  const std::size_t vertices = placed.mesh->vertices.size();
  const auto check_faces = [&](const auto& faces) {
    for (const auto& face : faces) {
      for (const std::int32_t vertex : face) {
        if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices) {
          fail("vtk file '{}': body {}: a face uses vertex {}, but the mesh has {} vertices (0 to {})", path.string(),
               index, vertex, vertices, static_cast<std::ptrdiff_t>(vertices) - 1);
        }
      }
    }
  };
  check_faces(placed.mesh->triangles);
  check_faces(placed.mesh->quads);
  check_faces(placed.mesh->polygons);
}

/// `values` with the tuple of each face's body.
template <class T>
[[nodiscard]] std::vector<T> per_face(std::span<const T> values, int components, std::span<const std::int32_t> body) {
  const auto width = static_cast<std::size_t>(components);
  std::vector<T> faces;
  faces.reserve(body.size() * width);
  for (const std::int32_t b : body) {
    const auto tuple = values.subspan(static_cast<std::size_t>(b) * width, width);
    faces.insert(faces.end(), tuple.begin(), tuple.end());
  }
  return faces;
}

}  // namespace detail

/// Writes the bodies' meshes at their poses as PolyData. Every face carries the cell array "body" (index into
/// `bodies`) and, for each array of `data` (one tuple a body, e.g. velocity or load), the value of its body.
///
/// The file appears complete or not at all. Throws dem::Error when it cannot be written, when a body has no mesh or a
/// face a vertex that is not there, and when an array has not one tuple a body, or an empty or repeated name.
inline void write_vtk_bodies(const std::filesystem::path& path, const std::vector<BodyMesh>& bodies,
                             const std::vector<BodyData>& data = {}, const VtkOptions& options = {}) {
  detail::check_arrays(path, data, bodies.size(), "bodies");
  for (const BodyData& array : data) {
    if (array.name == "body") fail("vtk file '{}': the array name 'body' is taken; rename yours", path.string());
  }
  detail::WorldMesh world;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    detail::check_mesh(path, bodies[i], i);
    std::size_t more = 4 * bodies[i].mesh->quads.size() + 3 * bodies[i].mesh->triangles.size();
    for (const auto& polygon : bodies[i].mesh->polygons) more += polygon.size();
    detail::check_index_count(path, world.connectivity.size() + more + bodies[i].mesh->vertices.size());
    world.add(bodies[i], static_cast<std::int32_t>(i));
  }
  const std::span<const std::int32_t> body(world.body);

  detail::VtkFile file("PolyData", options);
  file.xml(
      fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                  "NumberOfPolys=\"{}\">\n<CellData>\n",
                  world.points.size() / 3, body.size()));
  file.array("body", 1, body);
  for (const BodyData& array : data) {
    std::visit(
        [&](auto values) {
          file.array(array.name, array.components, detail::per_face(values, array.components, body));
        },
        array.values);
  }
  file.xml("</CellData>\n<Points>\n");
  file.array("Points", 3, std::span<const double>(world.points));
  file.xml("</Points>\n<Polys>\n");
  file.array("connectivity", 1, std::span<const std::int32_t>(world.connectivity));
  file.array("offsets", 1, std::span<const std::int32_t>(world.offsets));
  file.xml("</Polys>\n</Piece>\n");
  file.save(path);
}

}  // namespace dem::io
