// The searches of round grains and of simple surfaces, and the superquadric's function, compile for a device. Nothing
// is run. Clusters (which compare packs of spheres), polyhedra and meshes are searched by the host alone.

#include <dem/geometry/box/box.hpp>
#include <dem/geometry/cylinder/cylinder.hpp>
#include <dem/geometry/plane/plane.hpp>
#include <dem/geometry/sphere/sphere.hpp>
#include <dem/geometry/sphere/sphere_surface.hpp>
#include <dem/geometry/superquadric/superquadric_solid.hpp>

using dem::Vector3;

/// The deepest contact of a ball with a surface.
template <class Surface>
__device__ double nearest(const Surface& surface, const Vector3<double>& p, double radius) {
  double least = radius;
  if (!surface.near(p, radius)) return least;
  surface.contacts(p, radius, [&](auto, const Vector3<double>&, double gap) { least = dem::min(least, gap); });
  return least;
}

/// Sum of the overlaps of all contacts of two grains.
template <class Shape>
__device__ double overlap(const Shape& a, const double* pose_a, const Shape& b, const double* pose_b,
                          const Vector3<double>& d) {
  double sum = 0.0;
  Shape::collide(a, pose_a, b, pose_b, d, [&](auto, const auto& point) { sum += point.geometry().overlap; });
  return sum;
}

struct Scene {
  dem::surface::Box box;
  dem::surface::Cylinder cylinder;
  dem::surface::Plane plane;
  dem::surface::Sphere ball;
  dem::shape::Sphere sphere;
  dem::shape::SuperquadricSolid rounded;
  double radius;
};

__global__ void query(int n, const Scene* scene, const Vector3<double>* places, double* results) {
  const int k = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (k >= n) return;
  const Vector3<double>& p = places[k];
  double depth = 0.0;
  Vector3<double> normal;
  const bool inside = scene->rounded.penetration(p, depth, normal);
  results[k] = nearest(scene->box, p, scene->radius) + nearest(scene->cylinder, p, scene->radius) +
               nearest(scene->plane, p, scene->radius) + nearest(scene->ball, p, scene->radius) +
               overlap(scene->sphere, nullptr, scene->sphere, nullptr, p) + scene->rounded.gauge(p) +
               (inside ? depth : 0.0);
}
