#pragma once

#include <dem/pipeline/contact_evaluator.hpp>
#include <dem/pipeline/force_sums.hpp>
#include <dem/shape/shape.hpp>
#include <dem/state/chunk.hpp>
#include <dem/state/machine_surface.hpp>
#include <dem/state/species.hpp>

#include <span>

namespace dem::pipeline {

/// Key of a surface contact: surface, grain in the chunk, probe of the grain, feature of the surface; contacts are
/// found in this order.
struct SurfaceKey {
  static constexpr std::uint64_t make(std::size_t surface, std::size_t local, std::uint32_t probe,
                                      std::uint32_t feature) {
    return std::uint64_t{surface} << 48 | std::uint64_t{local} << 40 | std::uint64_t{probe} << 28 | feature;
  }
  static constexpr std::size_t surface(std::uint64_t key) { return key >> 48; }
  static constexpr std::size_t local(std::uint64_t key) { return key >> 40 & 0xff; }
  static constexpr std::uint64_t with_local(std::uint64_t key, std::size_t local) {
    return (key & ~(std::uint64_t{0xff} << 40)) | std::uint64_t{local} << 40;
  }
};

/// The probe index under which corners of surfaces in a grain are remembered.
inline constexpr std::uint32_t corner_probe = 0xfff;

/// A sharp grain may be entered by corners and edges of surfaces that none of its own points meets. Such a shape tells
/// how deep a point (from the grain's centre, global axes) lies inside of it and which way out is the shortest.
template <class Shape>
concept HasPenetration = requires(const Shape& shape, const double* pose, const Vector3<double>& point, double& depth,
                                  Vector3<double>& outward_normal) {
  { shape.penetration(pose, point, depth, outward_normal) } -> std::same_as<bool>;
};
/// A surface with corners: corners(point, radius, sink) calls sink(number, corner) for those within the radius.
template <class S>
concept HasCorners = requires(const S& s, const Vector3<double>& point) {
  s.corners(point, 1.0, [](std::uint32_t, const Vector3<double>&) {});
};

/// A surface that is much smaller than its bounding box: close(point, radius) is false if no probe in that sphere can
/// touch.
template <class S>
concept KnowsClose = requires(const S& s, const Vector3<double>& point) {
  { s.close(point, 1.0) } -> std::same_as<bool>;
};

/// Lists that a thread uses again for each chunk.
struct SurfaceScratch {
  std::vector<std::uint32_t> law_of;
  std::vector<Hit> hits;
  std::vector<contact::SurfaceTouch<double>> touches;
  ContactForces forces;
};

/// False if a surface knows that nothing in a sphere (global axes) touches it.
template <class Surface>
bool is_close(const Surface& surface, const Vec3& centre, double radius) {
  const Vector3<double> seen = transpose_times(surface.axes, from_eigen(centre) - surface.origin);
  return std::visit(
      [&]<class G>(const G& geometry) {
        if constexpr (KnowsClose<G>) return geometry.close(seen, radius);
        return true;
      },
      surface.geometry);
}

/// Corners of a surface inside of a grain. A corner counts as much as one of the grain's own probes does on average.
template <class Shape, class Particles, class Surface, class Geometry>
void probe_grain(std::size_t i, std::size_t local, std::size_t number, const Surface& surface, const Geometry& geometry,
                 const Particles& p, const Shape& shape, const Vector3<double>& centre, std::uint32_t law,
                 SurfaceScratch& s) {
  double probes = 0.0, area = 0.0, radius = 0.0;
  geometry.corners(centre, shape.bounding_radius(), [&](std::uint32_t corner, const Vector3<double>& at) {
    double depth = 0.0;
    Vector3<double> outward{};
    const Vector3<double> point = surface.axes * (at - centre);
    if (!shape.penetration(p.pose_of(i), point, depth, outward)) return;
    if (probes == 0.0) {
      shape.probe(p.pose_of(i), [&](std::uint32_t, const contact::Probe& probe) {
        probes += 1.0;
        area += probe.area;
        radius += probe.effective_radius;
      });
    }
    s.hits.push_back({SurfaceKey::make(number, local, corner_probe, corner), static_cast<std::uint32_t>(i),
                      static_cast<std::uint32_t>(number), law});
    // Seen from the grain, its skin over the corner is the point that is `depth` behind the surface.
    s.touches.push_back({point + depth * outward, outward, 0.0, -depth, radius / probes, area / probes});
  });
}

/// Hits of the grains of one chunk on one surface, up to a gap where cohesion acts at a distance (else NoGap).
template <class Shape, class Particles, class Surface, class Gap>
void probe_surface(std::size_t begin, std::size_t end, std::size_t number, const Surface& surface, const Particles& p,
                   std::span<const Species<Shape>> species, double largest_radius, Gap gap, SurfaceScratch& s) {
  const Matrix3<Pack> axes = {{Pack(surface.axes.row0.x), Pack(surface.axes.row0.y), Pack(surface.axes.row0.z)},
                              {Pack(surface.axes.row1.x), Pack(surface.axes.row1.y), Pack(surface.axes.row1.z)},
                              {Pack(surface.axes.row2.x), Pack(surface.axes.row2.y), Pack(surface.axes.row2.z)}};
  const Vector3<Pack> origin = {Pack(surface.origin.x), Pack(surface.origin.y), Pack(surface.origin.z)};
  std::visit(
      [&](const auto& geometry) {
        for (std::size_t at = begin; at < end; at += static_cast<std::size_t>(pack_width)) {
          const Vector3<Pack> seen = transpose_times(axes, p.position.pack(at) - origin);
          for (std::uint32_t near = bits(geometry.near(seen, Pack(shape::widened(largest_radius, gap)))); near != 0;
               near &= near - 1) {
            const std::size_t i = at + static_cast<std::size_t>(std::countr_zero(near));
            if (i >= end) break;
            const Shape& grain = species[p.species[i]].shape;
            const Vector3<double> centre = transpose_times(surface.axes, p.position[i] - surface.origin);
            if (!geometry.near(centre, shape::widened(grain.bounding_radius(), gap))) continue;
            // A shape of one probe asks the same question by touching.
            if constexpr (Shape::has_orientation && KnowsClose<std::remove_cvref_t<decltype(geometry)>>) {
              if (!geometry.close(centre, shape::widened(grain.bounding_radius(), gap))) continue;
            }
            grain.probe(p.pose_of(i), [&](std::uint32_t index, const contact::Probe& probe) {
              geometry.touch(centre + transpose_times(surface.axes, probe.centre), shape::widened(probe.radius, gap),
                             [&](std::uint32_t feature, const Vector3<double>& normal, double distance) {
                               s.hits.push_back({SurfaceKey::make(number, i - begin, index, feature),
                                                 static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(number),
                                                 s.law_of[p.species[i]]});
                               s.touches.push_back({probe.centre, surface.axes * normal, probe.radius, distance,
                                                    probe.effective_radius, probe.area});
                             });
            });
            if constexpr (HasPenetration<Shape> && HasCorners<std::remove_cvref_t<decltype(geometry)>>) {
              probe_grain(i, i - begin, number, surface, geometry, p, grain, centre, s.law_of[p.species[i]], s);
            }
          }
        }
      },
      surface.geometry);
}

/// Contacts of the grains of one chunk with the surfaces of machine parts, and the load that the chunk puts on each
/// surface. The chunk's bounding box selects the surfaces, anew each time, so fast parts need no neighbour list. Writes
/// to the chunk and its own grains' sums only.
template <class Model, class Particles, class Surface>
void find_surface_contacts(std::size_t chunk_index, Chunk<Model>& chunk, const Particles& p,
                           std::span<const Species<typename Model::Shape>> species, const Materials<Model>& materials,
                           std::span<const Surface> surfaces, double largest_radius, double dt, ForceSums& sums,
                           SurfaceScratch& scratch) {
  const std::size_t begin = chunk_index * chunk_size;
  const std::size_t end = std::min(begin + chunk_size, p.count);
  const auto gap = [&] {
    if constexpr (cohesion::reaches<typename Model::Cohesion>) {
      return materials.range();
    } else {
      return shape::NoGap{};
    }
  }();
  const double reach = shape::widened(largest_radius, gap);
  const Vec3 low = chunk.low - Vec3::Constant(reach), high = chunk.high + Vec3::Constant(reach);
  std::vector<Hit>& hits = scratch.hits;
  std::vector<std::uint32_t>& law_of = scratch.law_of;
  hits.clear();
  scratch.touches.clear();
  chunk.surface_loads.clear();
  law_of.resize(species.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const Surface& surface = surfaces[s];
    if (!surface.active || (low.array() > surface.high.array()).any() || (high.array() < surface.low.array()).any()) {
      continue;
    }
    if (!is_close(surface, 0.5 * (chunk.low + chunk.high), 0.5 * (chunk.high - chunk.low).norm() + reach)) {
      continue;
    }
    for (std::size_t k = 0; k < species.size(); ++k) law_of[k] = materials.row(species[k].material, surface.material);
    probe_surface(begin, end, s, surface, p, species, largest_radius, gap, scratch);
  }

  ContactEvaluator<Model, contact::SurfaceTouch> evaluator(materials.table(), dt);
  const Deepest deepest = evaluator.run(
      hits, chunk.surface_contacts, scratch.forces, [&](std::size_t c) { return scratch.touches[c]; },
      [&](std::size_t c) -> const PartnerView& { return p.view[hits[c].i]; },
      [&](std::size_t c) -> const PartnerView& { return surfaces[hits[c].partner].view; });
  if (deepest.overlap > chunk.deepest.overlap) {
    chunk.deepest = {deepest.overlap, hits[deepest.hit].i, hits[deepest.hit].partner, true};
  }

  // In the order of the contacts, surface by surface: the same sum whatever thread does it.
  for (std::size_t c = 0; c < hits.size(); ++c) {
    const Vector3<double> force = ContactForces::at(scratch.forces.force, c);
    sums.add(hits[c].i - begin, force, ContactForces::at(scratch.forces.torque_i, c));
    if (chunk.surface_loads.empty() || chunk.surface_loads.back().surface.value != hits[c].partner) {
      chunk.surface_loads.push_back({SurfaceId(hits[c].partner), {0, 0, 0}, {0, 0, 0}});
    }
    chunk.surface_loads.back().force -= force;
    chunk.surface_loads.back().torque += ContactForces::at(scratch.forces.torque_j, c);
  }
}

}  // namespace dem::pipeline
