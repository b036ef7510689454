#pragma once

#include <dem/rig/direct_shear/shear_world.hpp>

#include <span>

namespace shear = dem::rig::direct_shear;

// Each is in a source of its own, as a world takes a while to compile.
using ShearRun = void(const shear::Settings&, shear::Campaign&, dem::rig::Session&);
ShearRun cube8_verlet, cube8_euler, cube8_predictor_corrector, polyhedron_verlet, superquadric_verlet;

/// The worlds of this program: of direct_shear the one that it needs by default, of direct_shear_all every one.
std::span<const shear::ShearWorld> worlds();
