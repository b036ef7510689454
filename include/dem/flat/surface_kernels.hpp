#pragma once

#include <dem/flat/contact_result.hpp>
#include <dem/flat/grains_view.hpp>
#include <dem/flat/pair_kernels.hpp>
#include <dem/flat/surface_view.hpp>
#include <dem/grain/contact_key.hpp>

#include <cstddef>
#include <cstdint>

namespace dem::flat {

/// The contacts of grains with surfaces in one step: grain by grain, and those of a grain ascending in their keys,
/// which are grain::SurfaceKeys of a grain 0.
template <class Model>
struct SurfaceContactsView {
  std::uint32_t* first;  ///< contact of each grain, and one more
  std::uint64_t* key;
  HistoriesView histories;
};

/// The surfaces of a world.
template <class Model>
struct SurfacesView {
  const SurfaceView<typename Model::Surfaces>* surface;
  std::size_t count;
};

/// Whether a ball may meet a surface, as far as the surface's bounding box tells.
template <class Set>
DEM_FN bool may_meet(const SurfaceView<Set>& s, const Vector3<double>& x, double reach) {
  return s.active != 0 && x.x + reach >= s.low.x && x.x - reach <= s.high.x && x.y + reach >= s.low.y &&
         x.y - reach <= s.high.y && x.z + reach >= s.low.z && x.z - reach <= s.high.z;
}

/// f(surface, key, contact point) for each contact of a grain with surfaces, as coupling::find_hits_on finds them.
template <class Model, class F>
DEM_FN void for_each_surface_contact(const GrainsView<Model>& grains, const SurfacesView<Model>& surfaces,
                                     std::size_t i, const Gap<Model>& gap, F& f) {
  const Kind& kind = grains.kind_of(i);
  if (kind.inertia.inverse_mass == 0.0) return;  // held
  const Vector3<double> x = grains.view[i].position;
  const double reach = shape::widened(kind.radius, gap);
  for (std::size_t s = 0; s < surfaces.count; ++s) {
    const auto& surface = surfaces.surface[s];
    if (!may_meet(surface, x, reach)) continue;
    const Vector3<double> centre = transpose_times(surface.axes, x - surface.origin);
    const auto feel = [&](const auto& geometry) {
      if (!geometry.near(centre, reach)) return;
      grains.shape_of(i).sample_points(grains.pose_at(i), [&](std::uint32_t index, const contact::SamplePoint& sample) {
        const Vector3<double> seen = centre + transpose_times(surface.axes, sample.centre);
        geometry.contacts(seen, shape::widened(sample.radius, gap),
                          [&](std::uint32_t feature, const Vector3<double>& normal, double distance) {
                            f(s, grain::SurfaceKey::make(s, 0, index, feature).value,
                              contact::SurfaceContactPoint<double>{
                                  sample.centre, surface.axes * normal, sample.radius, distance,
                                  surface::radius_on(geometry, sample.effective_radius), sample.weight});
                          });
      });
    };
    visit_geometry(surface, feel);
  }
}

/// One thread a grain: how many contacts with surfaces it has.
template <class Model>
struct CountSurfaceContacts {
  GrainsView<Model> grains;
  SurfacesView<Model> surfaces;
  Gap<Model> gap;
  std::uint32_t* count;

  DEM_FN void operator()(std::size_t i) const {
    std::uint32_t found = 0;
    auto add = [&](std::size_t, std::uint64_t, const contact::SurfaceContactPoint<double>&) { ++found; };
    for_each_surface_contact(grains, surfaces, i, gap, add);
    count[i] = found;
  }
};

/// A number that was counted before.
struct CountedBefore {
  const std::uint32_t* count;
  DEM_FN std::uint32_t operator()(std::size_t i) const { return count[i]; }
};

/// One thread a grain: writes down whose its contacts are.
struct ListSurfaceContacts {
  const std::uint32_t* first;
  std::uint32_t* grain;  ///< of each contact

  DEM_FN void operator()(std::size_t i) const {
    for (std::uint32_t c = first[i]; c < first[i + 1]; ++c) grain[c] = static_cast<std::uint32_t>(i);
  }
};

/// One thread a contact: the first one of a grain evaluates the laws of all of that grain's contacts with surfaces, as
/// they are found together. Few grains have any, so a thread a grain would leave most of them idle. The contacts of the
/// last step are few, and looked through.
template <class Model>
struct EvaluateSurfaceContacts {
  GrainsView<Model> grains;
  SurfacesView<Model> surfaces;
  LawsView<Model> laws;  ///< partners are surfaces
  Gap<Model> gap;
  const std::uint32_t* grain_of;  ///< each contact
  SurfaceContactsView<Model> now, last;
  ContactResult* results;

  DEM_FN void operator()(std::size_t first) const {
    const std::size_t i = grain_of[first];
    std::uint32_t c = now.first[i];
    if (c != first) return;
    const std::uint32_t end = now.first[i + 1];
    const PartnerView view = load_wide(grains.view + i);
    auto evaluate = [&](std::size_t s, std::uint64_t key, const contact::SurfaceContactPoint<double>& point) {
      if (c == end) return;  // rounded otherwise than when it was counted: it only just touches
      ContactHistory<Model, double> history{};
      if constexpr (history_size < Model >> 0) {
        for (std::uint32_t k = last.first[i]; k < last.first[i + 1]; ++k) {
          if (last.key[k] == key) load_histories<Model>(last.histories, k, history);
        }
      }
      now.key[c] = key;
      store_wide(results + c, evaluate_contact<Model>(point, view, surfaces.surface[s].view,
                                                      laws.of(s, grains.species[i]), laws.time_step, history));
      store_histories<Model>(now.histories, c, history);
      ++c;
    };
    for_each_surface_contact(grains, surfaces, i, gap, evaluate);
    for (; c < end; ++c) forget(c);  // the same the other way
  }

 private:
  /// A contact that is none: nobody asks for its key.
  DEM_FN void forget(std::uint32_t c) const {
    constexpr std::uint32_t no_sample = 0xfef;
    now.key[c] = grain::SurfaceKey::make(surfaces.count - 1, 0, no_sample, c & 0xffffu).value;
    results[c] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0.0};
    store_histories<Model>(now.histories, c, ContactHistory<Model, double>{});
  }
};

/// What grains put on a surface: N, and N m about its body's centre of mass.
struct LoadOfGrains {
  Vector3<double> force, torque;
};

/// One thread a surface and a stretch of contacts: the load of these contacts. Surface s of stretch b stands at
/// b * surfaces + s.
struct SumStretches {
  static constexpr std::size_t stretch = 16;
  const std::uint64_t* key;
  const ContactResult* results;
  std::size_t contacts, surfaces;
  LoadOfGrains* loads;

  DEM_FN void operator()(std::size_t k) const {
    const std::size_t s = k % surfaces, from = k / surfaces * stretch;
    const std::size_t to = from + stretch < contacts ? from + stretch : contacts;
    LoadOfGrains sum{{0, 0, 0}, {0, 0, 0}};
    for (std::size_t c = from; c < to; ++c) {
      if (grain::SurfaceKey{key[c]}.surface() != s) continue;
      sum.force -= results[c].force;
      sum.torque += results[c].torque_j;
    }
    loads[k] = sum;
  }
};

/// One thread a surface and `fan` sums: their sum. So sums become fewer, in an order that does not depend on threads.
struct SumLoads {
  static constexpr std::size_t fan = 16;
  const LoadOfGrains* from;
  std::size_t sums, surfaces;
  LoadOfGrains* loads;

  DEM_FN void operator()(std::size_t k) const {
    const std::size_t s = k % surfaces, first = k / surfaces * fan;
    const std::size_t end = first + fan < sums ? first + fan : sums;
    LoadOfGrains sum{{0, 0, 0}, {0, 0, 0}};
    for (std::size_t b = first; b < end; ++b) {
      sum.force += from[b * surfaces + s].force;
      sum.torque += from[b * surfaces + s].torque;
    }
    loads[k] = sum;
  }
};

}  // namespace dem::flat
