#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/part_kind.hpp>

#include <string>

namespace dem::mbd {

inline constexpr double endless_step = 1e30;  ///< s

/// Fills in every stiffness and damping that the user left open, for a time step dt (s); the formula stands in
/// part_kind.hpp. What the user gave stays.
void derive_stiffness(Parts& m, double dt);

/// The same machine with only the stiffness and damping that its user gave. It derives for an endlessly long time step,
/// for which every derived stiffness is 0. Dampers that are derived from a given stiffness stay.
Parts without_derived(Parts m);

/// What has no stiffness yet: its name, or an empty text. Without a time step nothing can be derived.
std::string first_underived(const Parts& m);

/// Throws Error if anything has no stiffness yet.
void require_derived(const Parts& m);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void derive_stiffness(Parts& m, double dt) {
  const detail::Derivation derivation(m, dt);
  for (const detail::PartKind* kind : m.kinds) {
    if (kind->derive) kind->derive(m, derivation);
  }
}

DEM_INLINE Parts without_derived(Parts m) {
  derive_stiffness(m, endless_step);
  return m;
}

DEM_INLINE std::string first_underived(const Parts& m) {
  for (const detail::PartKind* kind : m.kinds) {
    if (!kind->first_underived) continue;
    if (std::string open = kind->first_underived(m); !open.empty()) return open;
  }
  return {};
}

DEM_INLINE void require_derived(const Parts& m) {
  if (const std::string open = first_underived(m); !open.empty()) {
    fail(
        "the stiffness of {} is to be derived, but the machine does not know its time step: call "
        "machine.design_for(dt) before the first step, or give stiffness and damping",
        open);
  }
}

}  // namespace dem::mbd

#endif
