#pragma once

#include <dem/world/check.hpp>

namespace dem {

/// Looks into the surfaces that were added since the last look, as their bodies stand. Throws Error for a grain whose
/// centre is so deep in one of them that its contacts are not surely found: it would pass through without a word. Other
/// grains that were put into a surface overlap it, which the first step reports.
template <class Model>
void check_buried_grains(WorldState<Model>& w) {
  const auto& p = w.grains;
  // A ball is found as deep as its radius; of other grains what sticks out may be smaller, as the balls of a cluster.
  constexpr double share = Model::Shape::has_orientation ? 0.5 : 1.0;
  for (std::size_t s = w.surfaces_looked_into; s < w.surfaces.size(); ++s) {
    const auto& surface = w.surfaces[s];
    const auto is_buried = w.is_buried[s];
    if (is_buried == nullptr || !surface.active) continue;
    const Body& body = w.machine.bodies()[surface.body.index()];
    const Matrix3<double> axes = body.motion.rotation * from_eigen(surface.rotation);
    const Vector3<double> origin = body.motion.position + body.motion.rotation * from_eigen(surface.position);
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < p.count; ++i) {
      const auto& kind = w.species[p.species[i]];
      if (kind.is_held() || p.row_of[p.id[i]] == p.gone) continue;
      const Vector3<double> centre = transpose_times(axes, Vector3<double>(p.position[i]) - origin);
      if (!is_buried(surface.geometry, centre, share * kind.shape.bounding_radius())) continue;
      if (count == 0 || p.id[i] < p.id[first]) first = i;
      ++count;
    }
    if (count == 0) continue;
    const Vec3 x = to_eigen(p.position[first]);
    fail(
        "grain {} at ({:.4g}, {:.4g}, {:.4g}) m lies within {}, so deep that it would not be felt{}; put it or the "
        "surface elsewhere, or remove it",
        p.id[first], x.x(), x.y(), x.z(), surface_in_words(w, s),
        count > 1 ? dem::text(" ({} grains do)", count) : std::string());
  }
  w.surfaces_looked_into = w.surfaces.size();
}

}  // namespace dem
