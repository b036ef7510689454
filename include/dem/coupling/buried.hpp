#pragma once

#include <dem/coupling/surface_contacts.hpp>

#include <variant>

namespace dem::coupling {

/// Whether a grain lies so deep in a solid that nothing of it is felt: its centre (m) in the surface's frame, and its
/// bounding radius (m).
template <class Model>
using IsBuried = bool (*)(const typename Model::Surfaces&, const Vector3<double>&, double);

/// What a program has for a kind of surface that it adds.
template <class Model>
struct SurfaceCode {
  FindHits<Model> find_hits;
  IsBuried<Model> is_buried;  ///< null of kinds in which grains are found at any depth
};

template <class Model, class G>
constexpr SurfaceCode<Model> code_for() {
  if constexpr (surface::HidesGrains<G>) {
    return {&find_hits_on<Model, G>,
            [](const typename Model::Surfaces& surface, const Vector3<double>& centre, double radius) {
              return std::get_if<G>(&surface)->hides(centre, radius, shows_points<typename Model::Shape>);
            }};
  } else {
    return {&find_hits_on<Model, G>, nullptr};
  }
}

/// Whether a grain is buried in a surface that follows its body, with its centre there (m) or at the nearest image.
template <class Model>
bool is_buried_in(IsBuried<Model> is_buried, const MachineSurface<typename Model::Surfaces>& surface,
                  [[maybe_unused]] const typename Model::Domain& domain, Vector3<double> centre, double radius) {
  if (is_buried == nullptr) return false;
  if constexpr (Model::Domain::has_images) centre = domain.nearest(centre, surface.low, surface.high, radius);
  return is_buried(surface.geometry, transpose_times(surface.axes, centre - surface.origin), radius);
}

}  // namespace dem::coupling
