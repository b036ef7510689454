#pragma once

#include <dem/pipeline/contact_evaluator.hpp>
#include <dem/pipeline/force_sums.hpp>
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

/// Lists that a thread uses again for each chunk.
struct SurfaceScratch {
  std::vector<std::uint32_t> law_of;
  std::vector<Hit> hits;
  std::vector<contact::SurfaceTouch<double>> touches;
  ContactForces forces;
};

/// Hits of the grains of one chunk on one surface.
template <class Shape, class Particles, class Surface>
void probe_surface(std::size_t begin, std::size_t end, std::size_t number, const Surface& surface, const Particles& p,
                   std::span<const Species<Shape>> species, double largest_radius, SurfaceScratch& s) {
  const Matrix3<Pack> axes = {{Pack(surface.axes.row0.x), Pack(surface.axes.row0.y), Pack(surface.axes.row0.z)},
                              {Pack(surface.axes.row1.x), Pack(surface.axes.row1.y), Pack(surface.axes.row1.z)},
                              {Pack(surface.axes.row2.x), Pack(surface.axes.row2.y), Pack(surface.axes.row2.z)}};
  const Vector3<Pack> origin = {Pack(surface.origin.x), Pack(surface.origin.y), Pack(surface.origin.z)};
  std::visit(
      [&](const auto& geometry) {
        for (std::size_t at = begin; at < end; at += static_cast<std::size_t>(pack_width)) {
          const Vector3<Pack> seen = transpose_times(axes, p.position.pack(at) - origin);
          for (std::uint32_t near = bits(geometry.near(seen, Pack(largest_radius))); near != 0; near &= near - 1) {
            const std::size_t i = at + static_cast<std::size_t>(std::countr_zero(near));
            if (i >= end) break;
            const Shape& shape = species[p.species[i]].shape;
            const Vector3<double> centre = transpose_times(surface.axes, p.position[i] - surface.origin);
            if (!geometry.near(centre, shape.bounding_radius())) continue;
            shape.probe(p.pose_of(i), [&](std::uint32_t probe, const Vector3<double>& offset, double radius) {
              geometry.touch(centre + transpose_times(surface.axes, offset), radius,
                             [&](std::uint32_t feature, const Vector3<double>& normal, double gap) {
                               s.hits.push_back({SurfaceKey::make(number, i - begin, probe, feature),
                                                 static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(number),
                                                 s.law_of[p.species[i]]});
                               s.touches.push_back({offset, surface.axes * normal, radius, gap});
                             });
            });
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
                           std::span<const Surface> surfaces, std::span<const Body> bodies, double largest_radius,
                           double dt, ForceSums& sums, SurfaceScratch& scratch) {
  const std::size_t begin = chunk_index * chunk_size;
  const std::size_t end = std::min(begin + chunk_size, p.count);
  const Vec3 low = chunk.low - Vec3::Constant(largest_radius), high = chunk.high + Vec3::Constant(largest_radius);
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
    for (std::size_t k = 0; k < species.size(); ++k) law_of[k] = materials.row(species[k].material, surface.material);
    probe_surface(begin, end, s, surface, p, species, largest_radius, scratch);
  }

  ContactEvaluator<Model, contact::SurfaceTouch> evaluator(materials.table(), dt);
  const double worst = evaluator.run(
      hits, chunk.surface_contacts, scratch.forces, [&](std::size_t c) { return scratch.touches[c]; },
      [&](std::size_t c) {
        const Hit& hit = hits[c];
        const Body& body = bodies[surfaces[hit.partner].body.index()];
        return Encounter<double>{body.motion.position - p.position[hit.i], p.velocity[hit.i] - body.motion.velocity,
                                 p.angular_velocity[hit.i], body.motion.rotation * body.motion.angular_velocity,
                                 species[p.species[hit.i]].inverse_mass + (body.fixed ? 0.0 : 1.0 / body.mass)};
      });
  chunk.worst_overlap = std::max(chunk.worst_overlap, worst);

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
