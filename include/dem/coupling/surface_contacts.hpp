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
inline constexpr bool shows_points = shape::HasPenetration<Shape> || requires(const Shape& s) {
  s.kind();
};

/// The grains of one chunk that meet the surfaces of machine parts.
template <class Model>
struct ChunkAtSurfaces {
  using Shape = typename Model::Shape;
  using Surface = MachineSurface<typename Model::Surfaces>;
  using Columns = GrainColumns<Shape, typename Model::Integrator>;

  std::size_t begin, end;  // rows
  Chunk<Model>& chunk;
  const Columns& grains;
  std::span<const Species<Shape>> species;
  const Materials<Model>& materials;
  std::span<const Surface> surfaces;
  double largest_radius;  ///< m, of all grains
  const typename Model::Domain& domain;
  SurfaceScratch& scratch;

  /// The gap (m) up to which cohesion acts at a distance, else NoGap.
  auto gap() const {
    if constexpr (cohesion::reaches<typename Model::Cohesion>) {
      return materials.range();
    } else {
      return shape::NoGap{};
    }
  }
  double reach() const { return shape::widened(largest_radius, gap()); }
};

/// Whether grains in a box, which is widened by their reach (m), may meet a surface or, across a border, an image of
/// it.
template <class Domain, class Surface>
bool may_meet(const Domain& domain, const Vec3& low, const Vec3& high, const Surface& s, double reach) {
  if constexpr (Domain::has_images) return domain.boxes_overlap(low, high, s.low, s.high, reach);
  else return boxes_overlap(low, high, s.low, s.high);
}

/// Where the grains of a chunk are for a surface: at their images that are nearest to it. Row `first` is the chunk's
/// first grain.
struct Positions {
  const Columns3& column;
  std::size_t first;
  Vector3<double> operator[](std::size_t i) const { return column[i - first]; }
  Vector3<Pack> pack(std::size_t i) const { return column.pack(i - first); }
};
template <class Model>
Positions positions_for(const ChunkAtSurfaces<Model>& at, const typename ChunkAtSurfaces<Model>::Surface& surface) {
  if constexpr (Model::Domain::has_images) {
    Columns3& images = at.scratch.images;
    images.for_each_column([](AlignedVector<double>& column) { column.resize(chunk_size, 0.0); });
    for (std::size_t i = at.begin; i < at.end; ++i) {
      images.set(i - at.begin, at.domain.nearest(at.grains.position[i], surface.low, surface.high, at.reach()));
    }
    return {images, at.begin};
  } else {
    return {at.grains.position, 0};
  }
}

/// Hits of a chunk's grains on one surface, whose geometry is a G. A world stores this function with each surface, so a
/// program has the code of the kinds that it adds and of no others.
template <class Model, class G>
void find_hits_on(const ChunkAtSurfaces<Model>& at, std::size_t number) {
  using Shape = typename Model::Shape;
  const auto& surface = at.surfaces[number];
  const G& geometry = *std::get_if<G>(&surface.geometry);
  const auto gap = at.gap();
  SurfaceScratch& s = at.scratch;
  if constexpr (surface::KnowsClose<G> && !Model::Domain::has_images) {
    const Vec3 middle = 0.5 * (at.chunk.low + at.chunk.high);
    const Vector3<double> seen = transpose_times(surface.axes, from_eigen(middle) - surface.origin);
    const double radius = 0.5 * (at.chunk.high - at.chunk.low).norm() + at.reach();
    if (!geometry.close(seen, radius, shows_points<Shape>)) return;
  }
  for (std::size_t k = 0; k < at.species.size(); ++k) {
    s.law_of[k] = at.materials.row(at.species[k].material, surface.material);
  }
  const std::size_t first = s.hits.size();
  const auto& p = at.grains;
  const Positions positions = positions_for(at, surface);
  const Matrix3<Pack> axes = {{Pack(surface.axes.row0.x), Pack(surface.axes.row0.y), Pack(surface.axes.row0.z)},
                              {Pack(surface.axes.row1.x), Pack(surface.axes.row1.y), Pack(surface.axes.row1.z)},
                              {Pack(surface.axes.row2.x), Pack(surface.axes.row2.y), Pack(surface.axes.row2.z)}};
  const Vector3<Pack> origin = {Pack(surface.origin.x), Pack(surface.origin.y), Pack(surface.origin.z)};
  for (std::size_t pack = at.begin; pack < at.end; pack += static_cast<std::size_t>(pack_width)) {
    const Vector3<Pack> seen = transpose_times(axes, positions.pack(pack) - origin);
    for (std::uint32_t near = bits(geometry.near(seen, Pack(at.reach()))); near != 0; near &= near - 1) {
      const std::size_t i = pack + static_cast<std::size_t>(std::countr_zero(near));
      if (i >= at.end) break;
      if (at.species[p.species[i]].is_held()) continue;
      const Shape& grain = at.species[p.species[i]].shape;
      const Vector3<double> centre = transpose_times(surface.axes, positions[i] - surface.origin);
      const double radius = shape::widened(grain.bounding_radius(), gap);
      if (!geometry.near(centre, radius)) continue;
      // A shape of one sample point asks the same question by contacts().
      if constexpr (Shape::has_orientation && surface::KnowsClose<G>) {
        if (!geometry.close(centre, radius, shows_points<Shape>)) continue;
      }
      const GrainAtSurface one = {static_cast<std::uint32_t>(i),
                                  static_cast<std::uint32_t>(i - at.begin),
                                  static_cast<std::uint32_t>(number),
                                  s.law_of[p.species[i]],
                                  p.pose_of(i),
                                  centre};
      shape::visit_kind(grain, [&](const auto& kind) { add_grain_contacts(one, kind, surface, geometry, gap, s); });
    }
  }
  if constexpr (Model::Domain::has_images) {
    for (std::size_t k = first; k < s.hits.size(); ++k) {
      s.views.push_back(p.view[s.hits[k].i]);
      s.views.back().position = positions[s.hits[k].i];
    }
  }
  if constexpr (history_size < Model >> 0 && surface::NamesDirections<G>) {
    follow_turns(std::span<const grain::Hit>(s.hits).subspan(first), at.chunk.surface_contacts.last,
                 [](std::uint64_t key) { return grain::SurfaceKey{key}.sample() != corner_sample; });
  }
}

/// find_hits_on() of a surface's kind.
template <class Model>
using FindHits = void (*)(const ChunkAtSurfaces<Model>&, std::size_t);

/// The contact point of a grain on a surface: of shapes whose contacts may be patches it knows the others' shares.
template <class Shape>
struct OnSurface {
  template <class T>
  using ContactPoint =
      std::conditional_t<shape::PatchShape<Shape>, contact::PatchContactPoint<T>, contact::SurfaceContactPoint<T>>;
};

/// The grain of a contact, where the surface sees it.
template <class Model, class Columns>
const PartnerView& view_of(const SurfaceScratch& s, std::size_t hit, const Columns& p) {
  if constexpr (Model::Domain::has_images) return s.views[hit];
  else return p.view[s.hits[hit].i];
}

/// Contacts of the grains of one chunk with the surfaces of machine parts, and the load that the chunk puts on each
/// surface. The chunk's bounding box selects the surfaces, anew each time, so fast parts need no neighbour list. Writes
/// to the chunk and its own grains' sums only.
template <class Model>
void find_surface_contacts(const ChunkAtSurfaces<Model>& at, std::span<const FindHits<Model>> find_hits, double dt,
                           grain::ForceSums& sums) {
  using Shape = typename Model::Shape;
  auto& [begin, end, chunk, p, species, materials, surfaces, largest_radius, domain, scratch] = at;
  const double reach = at.reach();
  const Vec3 low = chunk.low - filled(reach), high = chunk.high + filled(reach);
  const std::vector<grain::Hit>& hits = scratch.hits;
  scratch.hits.clear();
  scratch.views.clear();
  scratch.contact_points.clear();
  scratch.total_share.clear();
  chunk.surface_loads.clear();
  scratch.law_of.resize(species.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const auto& surface = surfaces[s];
    if (surface.active && may_meet(domain, low, high, surface, reach)) find_hits[s](at, s);
  }

  if constexpr (shape::PatchShape<Shape>) scratch.total_share.resize(scratch.contact_points.size(), 1.0);
  const auto contact_point_of = [&scratch = scratch](std::size_t c) {
    if constexpr (shape::PatchShape<Shape>) {
      return contact::PatchContactPoint<double>{scratch.contact_points[c], scratch.total_share[c]};
    } else {
      return scratch.contact_points[c];
    }
  };
  grain::ContactEvaluator<Model, OnSurface<Shape>::template ContactPoint> evaluator(materials.table(), dt);
  const grain::Deepest deepest = evaluator.run(
      hits, chunk.surface_contacts, scratch.forces, contact_point_of,
      [&](std::size_t c) -> const PartnerView& { return view_of<Model>(at.scratch, c, at.grains); },
      [&](std::size_t c) -> const PartnerView& { return at.surfaces[hits[c].partner].view; });
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
