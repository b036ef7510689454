#pragma once
// Files for ParaView: points (grains), bodies, and their series in time.

#include <dem/io/surface_mesh.hpp>
#include <dem/io/vtk_bodies.hpp>
#include <dem/io/vtk_data.hpp>
#include <dem/io/vtk_points.hpp>
#include <dem/io/vtk_series.hpp>
