#pragma once

/// What a program usually needs: worlds of spheres and clusters, all laws, machines. Other shapes are
/// <dem/geometry/shapes.hpp>. Single headers may be included instead; each stands alone.

#include <dem/core/compiler.hpp>
#include <dem/core/version.hpp>
#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/grain/broadphase/all_pairs.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/law/cohesion/constant.hpp>
#include <dem/law/cohesion/contact_stress.hpp>
#include <dem/law/cohesion/dmt.hpp>
#include <dem/law/cohesion/jkr.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/friction/coulomb_viscous.hpp>
#include <dem/law/friction/cundall_strack.hpp>
#include <dem/law/friction/mindlin.hpp>
#include <dem/law/friction/none.hpp>
#include <dem/law/friction/varying.hpp>
#include <dem/law/normal/hertz.hpp>
#include <dem/law/normal/hysteretic.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/law/rolling/constant_torque.hpp>
#include <dem/law/rolling/elastic_plastic.hpp>
#include <dem/law/rolling/sum.hpp>
#include <dem/law/rolling/torsion.hpp>
#include <dem/mbd/body/mesh_body.hpp>
#include <dem/mbd/mbd.hpp>
#include <dem/parallel/openmp.hpp>
#include <dem/parallel/serial.hpp>
#include <dem/world/memory.hpp>
#include <dem/world/world.hpp>
