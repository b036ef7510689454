#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/surface_traits.hpp>
#include <dem/world/in_words.hpp>

#include <algorithm>

namespace dem {

/// Whether points (radius 0) pass a surface unseen.
template <class Surface>
DEM_SETUP bool lets_points_through(const Surface& s) {
  return std::visit(
      []<class G>(const G& geometry) {
        if constexpr (surface::MayLetPointsThrough<G>) return geometry.lets_points_through();
        return false;
      },
      s.geometry);
}

/// Whether a grain meets surfaces with points of its boundary, which have no radius.
template <class Shape>
DEM_SETUP bool meets_with_points(const Shape& shape) {
  bool any = false;
  shape::visit_kind(shape, [&]<class Kind>(const Kind& grain) {
    if (coupling::touches_as_ball(grain)) return;
    alignas(64) double pose[std::max(1, Kind::pose_size)] = {};
    if constexpr (Kind::pose_size > 0) grain.orient(Matrix3<double>::identity(), pose);
    grain.sample_points(pose, [&](std::uint32_t, const contact::SamplePoint& sample) { any |= sample.radius <= 0.0; });
  });
  return any;
}

/// A point has no side of a two-sided sheet that it belongs to: grains and bodies that show points would fall through
/// without a word, so they are refused. Balls, and bodies that show no points (planes), meet such a sheet as any other.
/// Throws Error.
template <class Model>
DEM_SETUP void check_thin_sheets(const WorldState<Model>& w) {
  constexpr const char* remedy =
      "points find no side of it and would pass. Make it a closed plate (MeshSide::solid) of more than twice the "
      "overlap's thickness, or a sheet with one side (MeshSide::one_sided)";
  for (std::size_t k = 0; k < w.surfaces.size(); ++k) {
    if (!lets_points_through(w.surfaces[k])) continue;
    for (std::size_t s = 0; s < w.species.size(); ++s) {
      if (!meets_with_points(w.species[s].shape)) continue;
      fail(
          "{} is a two-sided sheet of triangles, but grains of species {} meet surfaces with points of their "
          "boundaries: {}",
          surface_in_words(w, k), s, remedy);
    }
  }
  const auto check = [&](SurfaceId sheet, SurfaceId other) {
    const auto& s = w.surfaces[other.index()];
    if (!lets_points_through(w.surfaces[sheet.index()]) || !coupling::has_points(s) || coupling::is_ball(s)) return;
    fail("{} is a two-sided sheet of triangles, but {}, which may touch it, shows points to it: {}",
         surface_in_words(w, sheet.index()), surface_in_words(w, other.index()), remedy);
  };
  for (const coupling::BodyPair& pair : w.body_contacts.pairs) {
    check(pair.a, pair.b);
    check(pair.b, pair.a);
  }
}

}  // namespace dem
