#pragma once

#include <dem/rig/direct_shear/settings.hpp>

namespace dem::rig {
class Session;
}

namespace dem::rig::direct_shear {

struct Campaign;

/// Grains and an integrator that a program has a world for.
struct ShearWorld {
  const char* shape;                                  ///< as --shape says
  const char* integrator;                             ///< as --integrator says
  void (*run)(const Settings&, Campaign&, Session&);  ///< calls run_campaign() with this world
};

}  // namespace dem::rig::direct_shear
