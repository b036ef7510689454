#pragma once

#include <dem/coupling/machine_surface.hpp>
#include <dem/geometry/box/box.hpp>
#include <dem/geometry/cylinder/cylinder.hpp>
#include <dem/geometry/plane/plane.hpp>
#include <dem/geometry/sphere/sphere_surface.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <variant>

namespace dem::flat {

/// Whether a kind of surface is felt in the flat path: its near() and contacts() run on devices, and it is copied there
/// by its bytes. Specialise it for a kind of your own that does.
template <class Kind>
inline constexpr bool takes_surface = false;
template <>
inline constexpr bool takes_surface<surface::Plane> = true;
template <>
inline constexpr bool takes_surface<surface::Box> = true;
template <>
inline constexpr bool takes_surface<surface::Sphere> = true;
template <>
inline constexpr bool takes_surface<surface::Cylinder> = true;

/// Room for any of a set's kinds that are taken.
template <class Set>
inline constexpr std::size_t surface_bytes = 8;
template <class... Kinds>
inline constexpr std::size_t surface_bytes<std::variant<Kinds...>> =
    std::max({std::size_t{8}, (takes_surface<Kinds> ? sizeof(Kinds) : std::size_t{8})...});

/// A surface of a machine part where it is now.
template <class Set>
struct SurfaceView {
  alignas(16) std::byte geometry[surface_bytes<Set>];
  std::uint32_t kind;    ///< which of the set
  std::uint32_t active;  ///< 0: touches nothing
  Vector3<double> origin;
  Matrix3<double> axes;
  Vector3<double> low, high;  ///< m, bounding box in global axes
  PartnerView view;           ///< of its body
};

/// Whether a surface is of a kind that is taken.
template <class... Kinds>
bool is_taken(const std::variant<Kinds...>& geometry) {
  return std::visit([]<class Kind>(const Kind&) { return takes_surface<Kind>; }, geometry);
}

/// What kernels see of a surface, of a kind that is taken.
template <class Set>
SurfaceView<Set> view_of(const MachineSurface<Set>& s) {
  SurfaceView<Set> v{};
  std::visit(
      [&]<class Kind>(const Kind& geometry) {
        if constexpr (takes_surface<Kind>) {
          static_assert(std::is_trivially_copyable_v<Kind>, "flat::takes_surface: the kind is copied by its bytes");
          std::memcpy(v.geometry, &geometry, sizeof(geometry));
        }
      },
      s.geometry);
  v.kind = static_cast<std::uint32_t>(s.geometry.index());
  v.active = s.active ? 1 : 0;
  v.origin = s.origin, v.axes = s.axes;
  v.low = from_eigen(s.low), v.high = from_eigen(s.high);
  v.view = s.view;
  return v;
}

/// f(geometry) of a surface as what it is.
template <class Set, std::size_t Index = 0, class F>
DEM_FN void visit_geometry(const SurfaceView<Set>& s, F& f) {
  if constexpr (Index < std::variant_size_v<Set>) {
    using Geometry = std::variant_alternative_t<Index, Set>;
    if constexpr (takes_surface<Geometry>) {
      if (s.kind == Index) return f(*reinterpret_cast<const Geometry*>(s.geometry));
    }
    visit_geometry<Set, Index + 1>(s, f);
  }
}

}  // namespace dem::flat
