#pragma once

/// Every shape of grain: superquadrics, polyhedra, mixtures, and how they touch each other. <dem/dem.hpp> has spheres
/// and clusters alone, as the others take some seconds to compile.

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/polyhedron/polyhedron_sphere.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/geometry/superquadric/superquadric_points.hpp>
#include <dem/geometry/superquadric/superquadric_polyhedron.hpp>
