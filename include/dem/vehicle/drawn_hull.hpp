#pragma once

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/io/drawn_surface.hpp>
#include <dem/vehicle/vehicle.hpp>

namespace dem::vehicle {

/// The car's body as it is drawn, in the axes of the chassis about its centre of mass: hull, cab and bonnet.
inline io::SurfaceMesh drawn_hull(const VehicleSpec& car) {
  IndexedMesh mesh = mesh::box(Vec3(4.6, 1.5, 0.35)).moved(Vec3(0, 0, 0.40));
  mesh += mesh::box(Vec3(2.5, 1.9, 0.60)).moved(Vec3(-0.35, 0, 0.85));
  mesh += mesh::box(Vec3(0.9, 1.2, 0.18)).moved(Vec3(1.6, 0, 0.66));
  return io::drawn(mesh.moved(-car.chassis_centre));
}

}  // namespace dem::vehicle
