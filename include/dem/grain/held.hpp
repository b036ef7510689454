#pragma once

#include <dem/core/ids.hpp>
#include <dem/integrator/motion.hpp>

#include <cstdint>
#include <vector>

namespace dem::grain {

/// A grain that is attached to a machine part.
struct HeldGrain {
  std::uint32_t id;
  Vector3<double> place;  ///< m, in the body's frame
  Matrix3<double> turn;   ///< grain frame -> body frame
  template <class V>
  void fields(V& v) {
    v("id", id), v("place", place, "m"), v("turn", turn);
  }
};

/// All grains that are attached to one body.
struct HeldGrains {
  BodyId body;
  std::vector<HeldGrain> grains;
  integrator::Motion<double> carried_to;  ///< of the body, when its grains were last put where it is
  template <class V>
  void fields(V& v) {
    v("body", body), v("grains", grains), v("carried_to", carried_to);
  }
};

}  // namespace dem::grain
