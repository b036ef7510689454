#pragma once
// Meshes of a replay: checked, triangulated, and as fine as the number of grains allows.

#include <dem/core/error.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/report/replay_data.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

namespace dem::report::detail {

/// Throws dem::Error when a mesh has no faces, a face a vertex that is not there, or a vertex no finite place.
inline void check_replay_mesh(const io::SurfaceMesh& mesh, std::string_view of_what) {
  std::size_t faces = 0;
  const auto check_faces = [&](const auto& list) {
    faces += list.size();
    for (const auto& face : list) {
      for (const std::int32_t vertex : face) {
        if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.vertices.size()) {
          fail("replay: a face of {} uses vertex {}, but its mesh has {} (from 0 on); correct the index", of_what,
               vertex, mesh.vertices.size());
        }
      }
    }
  };
  check_faces(mesh.triangles);
  check_faces(mesh.quads);
  check_faces(mesh.polygons);
  if (faces == 0) fail("replay: the mesh of {} has no faces; give it some", of_what);
  for (const Vec3& v : mesh.vertices) {
    if (!v.allFinite()) fail("replay: the mesh of {} has a vertex that is not finite; correct or remove it", of_what);
  }
}

/// Vertices and triangles, and the angle (rad) up to which edges between triangles are shaded round.
struct ReplayMesh {
  std::vector<Vec3> vertices = {};
  std::vector<std::uint32_t> triangles = {};  ///< three indices of vertices each
  double smooth_angle = 0.0;
};

/// Faces become fans of triangles about their first corner, which suits convex ones.
[[nodiscard]] inline ReplayMesh triangulated(const io::SurfaceMesh& mesh, double smooth_angle) {
  ReplayMesh result{.vertices = mesh.vertices, .triangles = {}, .smooth_angle = smooth_angle};
  const auto add = [&](const auto& faces) {
    for (const auto& face : faces) {
      for (std::size_t k = 2; k < face.size(); ++k) {
        for (const std::size_t corner : {std::size_t{0}, k - 1, k}) {
          result.triangles.push_back(static_cast<std::uint32_t>(face[corner]));
        }
      }
    }
  };
  add(mesh.triangles);
  add(mesh.quads);
  add(mesh.polygons);
  return result;
}

/// How often an icosahedron is refined to show each of so many balls, 3 times (1,280 triangles) to never (20): at most
/// 2.6 million triangles up to 128,000 balls, which a notebook's graphics turn smoothly. 10,000 cubes of eight balls
/// are 1.6 million.
[[nodiscard]] inline int ball_refinements(std::size_t balls) {
  return balls <= 500 ? 3 : balls <= 8'000 ? 2 : balls <= 32'000 ? 1 : 0;
}

/// Balls of the volumes that they should have, without triangles that lie within another ball of the grain.
[[nodiscard]] inline ReplayMesh ball_mesh(const std::vector<ReplayBall>& balls, int refinements) {
  const IndexedMesh unit = mesh::sphere(1.0, refinements);
  double volume = 0.0;
  for (std::size_t t = 0; t < unit.triangles.size(); ++t) volume += unit.corner(t, 0).dot(unit.area_vector(t)) / 6.0;
  const double swell = std::cbrt(4.0 / 3.0 * std::numbers::pi / volume);
  ReplayMesh result{.vertices = {}, .triangles = {}, .smooth_angle = std::numbers::pi};
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const auto base = static_cast<std::uint32_t>(result.vertices.size());
    std::vector<bool> hidden;
    for (const Vec3& v : unit.vertices) {
      const Vec3 x = balls[b].centre + swell * balls[b].radius * v;
      bool inside = false;
      for (std::size_t other = 0; other < balls.size(); ++other) {
        inside = inside || (other != b && (x - balls[other].centre).norm() < 0.98 * balls[other].radius);
      }
      hidden.push_back(inside);
      result.vertices.push_back(x);
    }
    for (const auto& t : unit.triangles) {
      if (hidden[t[0]] && hidden[t[1]] && hidden[t[2]]) continue;
      for (const std::uint32_t corner : t) result.triangles.push_back(base + corner);
    }
  }
  return result;
}

/// The mesh of a shape of which `grains` are drawn.
[[nodiscard]] inline ReplayMesh shape_mesh(const ReplayShape& shape, std::size_t grains) {
  if (shape.balls.empty()) return triangulated(shape.mesh, shape.smooth_angle);
  return ball_mesh(shape.balls, ball_refinements(grains * shape.balls.size()));
}

}  // namespace dem::report::detail
