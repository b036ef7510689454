#pragma once

/// Everything of dem that a program usually needs. Single headers may be included instead; each stands alone.

#include <dem/broadphase/all_pairs.hpp>
#include <dem/core/version.hpp>
#include <dem/exec/serial.hpp>
#include <dem/friction/none.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/shape/sphere_cluster.hpp>
#include <dem/world/memory.hpp>
#include <dem/world/world.hpp>
