#pragma once
// Grains of any shape as meshes to look at.

#include <dem/geometry/mixed.hpp>
#include <dem/io/polyhedron_mesh.hpp>
#include <dem/io/surface_mesh.hpp>

#include <cstdint>
#include <variant>

namespace dem::io {

/// The boundary of a superquadric with `divisions` cells along each edge of the cube that it is drawn from [m].
[[nodiscard]] inline SurfaceMesh grain_mesh(const shape::SuperquadricSolid& solid, int divisions = 8) {
  const shape::SuperquadricBoundary boundary = shape::superquadric_boundary(solid, divisions);
  SurfaceMesh mesh;
  for (const shape::SurfacePoint& point : boundary.points) mesh.vertices.push_back(to_eigen(point.position));
  mesh.quads = boundary.quads;
  return mesh;
}
[[nodiscard]] inline SurfaceMesh grain_mesh(const shape::SuperquadricGrain& grain, int divisions = 8) {
  return grain_mesh(grain.solid(), divisions);
}

/// The balls of a sphere or cluster, each whole.
template <shape::BallShape S>
[[nodiscard]] SurfaceMesh grain_mesh(const S& shape, int divisions = 4) {
  alignas(64) double pose[S::pose_size + 1] = {};
  shape.orient(Matrix3<double>::identity(), pose);
  SurfaceMesh mesh;
  for (int k = 0; k < shape::ball_count(shape); ++k) {
    const shape::PosedBall ball = shape::posed_ball(shape, pose, k);
    const SurfaceMesh one = grain_mesh(shape::SuperquadricSolid(ball.radius), divisions);
    const auto base = static_cast<std::int32_t>(mesh.vertices.size());
    for (const Vec3& v : one.vertices) mesh.vertices.push_back(v + to_eigen(ball.centre));
    for (auto quad : one.quads) {
      for (std::int32_t& vertex : quad) vertex += base;
      mesh.quads.push_back(quad);
    }
  }
  return mesh;
}

/// The mesh of the kind that a mixed grain is.
template <class... Kinds>
[[nodiscard]] SurfaceMesh grain_mesh(const shape::Mixed<Kinds...>& mixed, int divisions = 4) {
  return std::visit([&](const auto& kind) { return grain_mesh(kind, divisions); }, mixed.kind());
}

}  // namespace dem::io
