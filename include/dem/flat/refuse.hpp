#pragma once

#include <dem/flat/surface_view.hpp>
#include <dem/world/check.hpp>

#include <algorithm>
#include <type_traits>

namespace dem::flat {

/// Whether grains of a shape touch surfaces by their sample points and by nothing else.
template <class Shape>
inline constexpr bool touches_by_samples =
    !shape::HasPenetration<Shape> && !shape::HasSupport<Shape> && !shape::HasBallContact<Shape> &&
    !shape::PatchShape<Shape> && !requires(const Shape& s) {
  s.kind();
}
&&!requires { Shape::shares_fit; };

/// Refuses a model that the flat path cannot run, in words, when it is compiled.
template <class Model>
constexpr bool check_flat_model() {
  using Shape = typename Model::Shape;
  static_assert(shape::BitShape<Shape> && touches_by_samples<Shape>,
                "exec::Cuda, exec::Flat: grains must be shape::Sphere or a shape::SphereCluster of at most 8 spheres; "
                "choose exec::Threads for other shapes");
  static_assert(std::is_same_v<typename Model::Domain, domain::Open>,
                "exec::Cuda, exec::Flat: the Domain must be domain::Open; choose exec::Threads for other domains");
  static_assert(std::is_trivially_copyable_v<ContactParameters<Model>>,
                "exec::Cuda, exec::Flat: the Parameters of laws must be structs of numbers");
  return true;
}

/// Throws Error for a world that the flat path cannot run. Costs a look at a few lists.
template <class Model>
void check_flat(const WorldState<Model>& w) {
  constexpr const char* instead = "; leave it out, or choose exec::Threads as the model's Executor";
  if (w.options.sleep) fail("grains cannot sleep where the executor is exec::Cuda or exec::Flat{}", instead);
  if (w.carry_held) {
    fail("grains cannot be attached to machine parts where the executor is exec::Cuda or exec::Flat{}", instead);
  }
  if (std::any_of(w.inlets.begin(), w.inlets.end(), [](const Inlet& inlet) { return inlet.is_open(); })) {
    fail("no inlet can be open where the executor is exec::Cuda or exec::Flat; close it (World::set_open){}", instead);
  }
  if (!w.outlets.empty()) fail("there can be no outlets where the executor is exec::Cuda or exec::Flat{}", instead);
  if (w.borders && w.options.beyond_domain == BeyondDomain::remove) {
    fail("grains that leave the domain cannot be removed where the executor is exec::Cuda or exec::Flat{}", instead);
  }
  if (w.grain_load) fail("grains can have no load law where the executor is exec::Cuda or exec::Flat{}", instead);
  if (w.count_energy) fail("energy cannot be counted where the executor is exec::Cuda or exec::Flat{}", instead);
  for (std::size_t s = 0; s < w.surfaces.size(); ++s) {
    if (is_taken(w.surfaces[s].geometry)) continue;
    fail(
        "{} is of a kind that grains cannot touch where the executor is exec::Cuda or exec::Flat: these take planes, "
        "boxes, balls and cylinders; make it of them, or choose exec::Threads as the model's Executor",
        surface_in_words(w, s));
  }
}

}  // namespace dem::flat
