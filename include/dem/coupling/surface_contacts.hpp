#pragma once

#include <dem/coupling/follow_turns.hpp>
#include <dem/coupling/grain_on_surface.hpp>
#include <dem/coupling/machine_surface.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/grain/force_sums.hpp>
#include <dem/grain/species.hpp>

#include <span>

namespace dem::coupling {

/// Whether a shape shows points to surfaces, not balls.
template <class Shape>
inline constexpr bool shows_points = HasPenetration<Shape> || requires(const Shape& s) {
  s.kind();
};

/// A surface that is much smaller than its bounding box: close(point, radius, points) is false if no probe in that
/// sphere can touch; `points`: whether there are probes without a radius among them.
template <class S>
concept KnowsClose = requires(const S& s, const Vector3<double>& point) {
  { s.close(point, 1.0, true) } -> std::same_as<bool>;
};

/// False if a surface knows that no probe of grains of a shape in a sphere (global axes) touches it.
template <class Shape, class Surface>
bool is_close(const Surface& surface, const Vec3& centre, double radius) {
  const Vector3<double> seen = transpose_times(surface.axes, from_eigen(centre) - surface.origin);
  return std::visit(
      [&]<class G>(const G& geometry) {
        if constexpr (KnowsClose<G>) return geometry.close(seen, radius, shows_points<Shape>);
        return true;
      },
      surface.geometry);
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
        for (std::size_t pack = begin; pack < end; pack += static_cast<std::size_t>(pack_width)) {
          const Vector3<Pack> seen = transpose_times(axes, p.position.pack(pack) - origin);
          for (std::uint32_t near = bits(geometry.near(seen, Pack(shape::widened(largest_radius, gap)))); near != 0;
               near &= near - 1) {
            const std::size_t i = pack + static_cast<std::size_t>(std::countr_zero(near));
            if (i >= end) break;
            const Shape& grain = species[p.species[i]].shape;
            const Vector3<double> centre = transpose_times(surface.axes, p.position[i] - surface.origin);
            if (!geometry.near(centre, shape::widened(grain.bounding_radius(), gap))) continue;
            // A shape of one probe asks the same question by touching.
            if constexpr (Shape::has_orientation && KnowsClose<std::remove_cvref_t<decltype(geometry)>>) {
              if (!geometry.close(centre, shape::widened(grain.bounding_radius(), gap), shows_points<Shape>)) continue;
            }
            const GrainAtSurface at = {static_cast<std::uint32_t>(i),
                                       static_cast<std::uint32_t>(i - begin),
                                       static_cast<std::uint32_t>(number),
                                       s.law_of[p.species[i]],
                                       p.pose_of(i),
                                       centre};
            shape::visit_kind(grain, [&](const auto& kind) { touch_surface(at, kind, surface, geometry, gap, s); });
          }
        }
      },
      surface.geometry);
}

/// The touch of a grain's point on a surface: of shapes whose contacts may be patches it knows the others' shares.
template <class Shape>
struct OnSurface {
  template <class T>
  using Touch = std::conditional_t<shape::PatchShape<Shape>, contact::PatchTouch<T>, contact::SurfaceTouch<T>>;
};

/// Contacts of the grains of one chunk with the surfaces of machine parts, and the load that the chunk puts on each
/// surface. The chunk's bounding box selects the surfaces, anew each time, so fast parts need no neighbour list. Writes
/// to the chunk and its own grains' sums only.
template <class Model, class Particles, class Surface>
void find_surface_contacts(std::size_t chunk_index, Chunk<Model>& chunk, const Particles& p,
                           std::span<const Species<typename Model::Shape>> species, const Materials<Model>& materials,
                           std::span<const Surface> surfaces, double largest_radius, double dt, grain::ForceSums& sums,
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
  const Vec3 low = chunk.low - filled(reach), high = chunk.high + filled(reach);
  std::vector<grain::Hit>& hits = scratch.hits;
  std::vector<std::uint32_t>& law_of = scratch.law_of;
  hits.clear();
  scratch.touches.clear();
  scratch.total_share.clear();
  chunk.surface_loads.clear();
  law_of.resize(species.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const Surface& surface = surfaces[s];
    if (!surface.active || !boxes_overlap(low, high, surface.low, surface.high)) {
      continue;
    }
    if (!is_close<typename Model::Shape>(surface, 0.5 * (chunk.low + chunk.high),
                                         0.5 * (chunk.high - chunk.low).norm() + reach)) {
      continue;
    }
    for (std::size_t k = 0; k < species.size(); ++k) law_of[k] = materials.row(species[k].material, surface.material);
    const std::size_t first = hits.size();
    probe_surface(begin, end, s, surface, p, species, largest_radius, gap, scratch);
    if constexpr (history_size < Model >> 0) {
      std::visit(
          [&]<class G>(const G&) {
            if constexpr (surface::NamesDirections<G>) {
              follow_turns(std::span<const grain::Hit>(hits).subspan(first), chunk.surface_contacts.last,
                           [](std::uint64_t key) { return grain::SurfaceKey::probe(key) != corner_probe; });
            }
          },
          surface.geometry);
    }
  }

  using Shape = typename Model::Shape;
  if constexpr (shape::PatchShape<Shape>) scratch.total_share.resize(scratch.touches.size(), 1.0);
  const auto touch_of = [&](std::size_t c) {
    if constexpr (shape::PatchShape<Shape>) {
      return contact::PatchTouch<double>{scratch.touches[c], scratch.total_share[c]};
    } else {
      return scratch.touches[c];
    }
  };
  grain::ContactEvaluator<Model, OnSurface<Shape>::template Touch> evaluator(materials.table(), dt);
  const grain::Deepest deepest = evaluator.run(
      hits, chunk.surface_contacts, scratch.forces, touch_of,
      [&](std::size_t c) -> const PartnerView& { return p.view[hits[c].i]; },
      [&](std::size_t c) -> const PartnerView& { return surfaces[hits[c].partner].view; });
  if (deepest.overlap > chunk.deepest.overlap) {
    chunk.deepest = {deepest.overlap, hits[deepest.hit].i, hits[deepest.hit].partner, true};
  }

  // In the order of the contacts, surface by surface: the same sum whatever thread does it.
  for (std::size_t c = 0; c < hits.size(); ++c) {
    const Vector3<double> force = grain::ContactForces::at(scratch.forces.force, c);
    sums.add(hits[c].i - begin, force, grain::ContactForces::at(scratch.forces.torque_i, c));
    if (chunk.surface_loads.empty() || chunk.surface_loads.back().surface.value != hits[c].partner) {
      chunk.surface_loads.push_back({SurfaceId(hits[c].partner), {0, 0, 0}, {0, 0, 0}});
    }
    chunk.surface_loads.back().force -= force;
    chunk.surface_loads.back().torque += grain::ContactForces::at(scratch.forces.torque_j, c);
  }
}

}  // namespace dem::coupling
