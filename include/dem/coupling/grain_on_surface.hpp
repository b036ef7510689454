#pragma once

#include <dem/core/compiled.hpp>
#include <dem/coupling/support_contacts.hpp>
#include <dem/geometry/contact_shares.hpp>
#include <dem/geometry/shape.hpp>
#include <dem/geometry/surface_traits.hpp>
#include <dem/grain/contact_evaluator.hpp>
#include <dem/grain/contact_key.hpp>
#include <dem/grain/grain_columns.hpp>

#include <vector>

namespace dem::coupling {

/// The sample point indices under which support points, and corners of surfaces in a grain, are remembered.
inline constexpr std::uint32_t support_sample = 0xff0, corner_sample = 0xfff;
inline constexpr std::uint32_t first_ball = 1u << 24;  ///< among its features

/// Lists that a thread uses again for each chunk.
struct SurfaceScratch {
  DEM_VALUE(SurfaceScratch)

  std::vector<std::uint32_t> law_of;
  std::vector<grain::Hit> hits;
  std::vector<contact::SurfaceContactPoint<double>> contact_points;
  std::vector<double> total_share;  ///< of contact points of patches (contact::PatchContactPoint); 1 from where it ends
  Columns3 images;                  ///< m, of the grains of a chunk, for one surface of a periodic world
  std::vector<PartnerView> views;   ///< of the contacts' grains as those images, in a periodic world
  SupportContacts supports;         ///< of one grain on one surface
  grain::ContactForces forces;
};

/// What all contacts of a grain with a surface have in common.
struct GrainAtSurface {
  std::uint32_t grain, local, surface, law;
  const double* pose;
  Vector3<double> centre;  ///< m, of the grain in the surface's frame

  void add(SurfaceScratch& s, std::uint32_t sample, std::uint32_t feature,
           const contact::SurfaceContactPoint<double>& point) const {
    s.hits.push_back({grain::SurfaceKey::make(surface, local, sample, feature).value, grain, surface, law});
    s.contact_points.push_back(point);
  }
};

/// A sample point of the grain on a surface, up to a gap where cohesion acts at a distance (else NoGap).
template <class Surface, class Geometry, class Gap>
void add_sample_contacts(const GrainAtSurface& at, std::uint32_t index, const contact::SamplePoint& sample,
                         const Surface& surface, const Geometry& geometry, Gap gap, SurfaceScratch& s) {
  const Vector3<double> seen = at.centre + transpose_times(surface.axes, sample.centre);
  const auto add = [&](std::uint32_t feature, const Vector3<double>& normal, double distance) {
    at.add(s, index, feature,
           {sample.centre, surface.axes * normal, sample.radius, distance,
            surface::radius_on(geometry, sample.effective_radius), sample.weight});
  };
  if constexpr (!std::is_same_v<Gap, shape::NoGap>) {
    if (sample.radius == 0.0) {
      surface::point_contacts(geometry, seen, gap, add);
      return;
    }
  }
  geometry.contacts(seen, shape::widened(sample.radius, gap), add);
}

/// Where a surface is flat, a grain meets it first with its support point, which lies between its sample points. The
/// bounding sphere of the grain finds the directions to the surface. `first`: number of the first contact of the
/// grain's own points, which lose their weight near a support point.
template <class Shape, class Surface, class Geometry, class Gap>
void add_support_contacts(const GrainAtSurface& at, const Shape& grain, const Surface& surface,
                          const Geometry& geometry, std::size_t first, Gap gap, SurfaceScratch& s) {
  s.supports.clear();
  const auto add_way = [&](std::uint32_t feature, const Vector3<double>& seen, double) {
    const Vector3<double> way = surface.axes * seen;
    s.supports.add_way({surface::family_of<Geometry>(feature), way, grain.even_support(at.pose, way)});
  };
  geometry.contacts(at.centre, shape::widened(grain.bounding_radius(), gap), add_way);
  const double radius = surface::radius_on(geometry, grain.mean_radius());
  for (std::size_t k = 0; k < s.supports.way_count(); ++k) {
    const Vector3<double> point = s.supports.way(k).point;
    const auto add = [&](std::uint32_t feature, const Vector3<double>& normal, double distance) {
      s.supports.add_point(k, surface::family_of<Geometry>(feature), feature,
                           {point, surface.axes * normal, 0.0, distance, radius, 1.0});
    };
    surface::point_contacts(geometry, at.centre + transpose_times(surface.axes, point), shape::widened(0.0, gap), add);
  }
  const std::size_t end = s.contact_points.size();
  for (const auto& t : s.supports.sorted()) at.add(s, support_sample, t.feature, t.point);
  for (std::size_t way = 0; way < s.supports.way_count(); ++way) {
    if (!s.supports.is_used(way)) continue;
    for (std::size_t k = first; k < end; ++k) {
      s.contact_points[k].weight *=
          grain.beside_support(s.contact_points[k].centre, s.supports.way(way).point, s.supports.way(way).along);
    }
  }
}

/// Corners and balls of a surface in a grain. A corner has the mean weight of the grain's own sample points, a ball
/// that of a whole contact.
template <class Shape, class Surface, class Geometry, class Gap>
void add_corner_contacts(const GrainAtSurface& at, const Shape& grain, const Surface& surface, const Geometry& geometry,
                         Gap gap, SurfaceScratch& s) {
  double samples = 0.0, weights = 0.0, radius = 0.0;
  const auto look_at_samples = [&] {
    if (samples > 0.0) return;
    grain.sample_points(at.pose, [&](std::uint32_t, const contact::SamplePoint& sample) {
      samples += 1.0;
      weights += sample.weight;
      radius += sample.effective_radius;
    });
  };
  // Seen from the grain, its boundary at `point` lies `depth` behind the surface.
  const auto add = [&](std::uint32_t number, const Vector3<double>& point, const Vector3<double>& normal, double depth,
                       double weight) {
    at.add(s, corner_sample, number,
           {point, normal, 0.0, -depth, surface::radius_on(geometry, radius / samples), weight});
  };
  const double reach = shape::widened(grain.bounding_radius(), gap);
  if constexpr (surface::HasCorners<Geometry>) {
    geometry.corners(at.centre, reach, [&](std::uint32_t corner, const Vector3<double>& place, double weight = 1.0) {
      double depth = 0.0;
      Vector3<double> outward{};
      const Vector3<double> point = surface.axes * (place - at.centre);
      if (!grain.penetration(at.pose, point, depth, outward)) return;
      look_at_samples();
      add(corner, point + depth * outward, outward, depth, weight * weights / samples);
    });
  }
  if constexpr (surface::HasBalls<Geometry> && shape::HasBallContact<Shape>) {
    if (!shape::has_shares(grain)) return;
    geometry.balls(at.centre, reach, [&](std::uint32_t ball, const Vector3<double>& centre, double of_ball) {
      contact::BallContactPoint t;
      const Vector3<double> seen = surface.axes * (centre - at.centre);
      bool found = false;
      if constexpr (std::is_same_v<Gap, shape::NoGap>) found = grain.ball_contact(at.pose, seen, of_ball, t);
      else found = grain.ball_contact(at.pose, seen, of_ball, t, gap);
      if (!found) return;
      if (!geometry.is_on_ball(at.centre + transpose_times(surface.axes, t.point))) return;
      look_at_samples();
      add(first_ball + ball, t.point + (0.5 * t.overlap) * t.normal, t.normal, t.overlap, 1.0);
    });
  }
}

/// Whether a grain's radii and exponents make it a ball, which meets surfaces as one.
template <class Shape>
bool touches_as_ball(const Shape& grain) {
  if constexpr (requires { grain.is_ball(); }) {
    return grain.is_ball() && shape::has_shares(grain);
  } else {
    return false;
  }
}

/// All contacts of a grain of one kind with a surface.
template <class Shape, class Surface, class Geometry, class Gap>
void add_grain_contacts(const GrainAtSurface& at, const Shape& grain, const Surface& surface, const Geometry& geometry,
                        Gap gap, SurfaceScratch& s) {
  const std::size_t first = s.contact_points.size();
  if constexpr (shape::HasBallContact<Shape> && surface::MayBeBall<Geometry>) {
    if (geometry.is_ball() && shape::has_shares(grain)) {  // one contact is all of it
      add_corner_contacts(at, grain, surface, geometry, gap, s);
      return;
    }
  }
  if constexpr (requires { grain.mean_radius(); }) {
    if (touches_as_ball(grain)) {
      const double radius = grain.mean_radius();
      add_sample_contacts(at, 0, {{0, 0, 0}, radius, radius, 1.0}, surface, geometry, gap, s);
      return;
    }
  }
  grain.sample_points(at.pose, [&](std::uint32_t index, const contact::SamplePoint& sample) {
    add_sample_contacts(at, index, sample, surface, geometry, gap, s);
  });
  if constexpr (shape::HasSupport<Shape>) {
    if (shape::has_shares(grain)) add_support_contacts(at, grain, surface, geometry, first, gap, s);
  }
  if constexpr (shape::HasPenetration<Shape>) add_corner_contacts(at, grain, surface, geometry, gap, s);
  if constexpr (requires { Shape::shares_fit; }) {
    if (!shape::has_shares(grain)) return;
    const auto point = [&](std::size_t k) -> contact::SurfaceContactPoint<double>& {
      return s.contact_points[first + k];
    };
    const std::size_t count = s.contact_points.size() - first;
    contact::fit_weights(count, Shape::shares_fit, point);
    if constexpr (shape::PatchShape<Shape>) {
      s.total_share.resize(first, 1.0);
      for (std::size_t k = 0; k < count; ++k) s.total_share.push_back(contact::total_share(count, k, point));
    }
  }
}

}  // namespace dem::coupling

#if DEM_DEFINES

namespace dem::coupling {

DEM_DEFINE_VALUE(SurfaceScratch)

}  // namespace dem::coupling

#endif
