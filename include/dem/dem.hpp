#pragma once

/// Everything of dem that a program usually needs. Single headers may be included instead; each stands alone.

#include <dem/broadphase/all_pairs.hpp>
#include <dem/cohesion/constant.hpp>
#include <dem/cohesion/contact_stress.hpp>
#include <dem/cohesion/dmt.hpp>
#include <dem/cohesion/jkr.hpp>
#include <dem/cohesion/liquid_bridge.hpp>
#include <dem/contact/hertz.hpp>
#include <dem/contact/hysteretic.hpp>
#include <dem/contact/linear_spring_dashpot.hpp>
#include <dem/core/version.hpp>
#include <dem/exec/serial.hpp>
#include <dem/friction/coulomb_viscous.hpp>
#include <dem/friction/cundall_strack.hpp>
#include <dem/friction/mindlin.hpp>
#include <dem/friction/none.hpp>
#include <dem/friction/varying.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/mbd/mbd.hpp>
#include <dem/rolling/constant_torque.hpp>
#include <dem/rolling/elastic_plastic.hpp>
#include <dem/rolling/sum.hpp>
#include <dem/rolling/torsion.hpp>
#include <dem/shape/mixed.hpp>
#include <dem/shape/polyhedra.hpp>
#include <dem/shape/polyhedron_sphere.hpp>
#include <dem/shape/sphere_cluster.hpp>
#include <dem/shape/superquadric.hpp>
#include <dem/shape/superquadric_points.hpp>
#include <dem/shape/superquadric_polyhedron.hpp>
#include <dem/world/memory.hpp>
#include <dem/world/world.hpp>
