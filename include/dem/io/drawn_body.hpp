#pragma once
// Bodies of a machine as meshes to look at.

#include <dem/core/ids.hpp>
#include <dem/io/surface_mesh.hpp>

namespace dem::io {

/// A mesh that shows a body of a machine. It is given in the body's reference frame, that of the drawing or the mesh
/// that the body was made from, and stays the caller's.
struct DrawnBody {
  BodyId body = {};
  const SurfaceMesh* mesh = nullptr;
  Vec3 position = Vec3::Zero();      ///< of the mesh's origin, in the reference frame [m]
  Mat3 rotation = Mat3::Identity();  ///< from the mesh's frame to the reference frame
};

}  // namespace dem::io
